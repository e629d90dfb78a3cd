//! The text of the shaders: that it is valid, that its numbers are those of the documentation, and that it loses no light
//! however badly WGSL allows its operations to be done.
#![cfg(all(feature = "wgsl", feature = "bytemuck"))]

mod arithmetic;
mod kernels;
mod lost;
mod machine;
mod operations;
mod valid;
mod value;
