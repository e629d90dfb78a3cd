//! Serialization, and records and shader text for a GPU.

#[cfg(feature = "bytemuck")]
mod gpu;
#[cfg(feature = "serde")]
mod impl_serde;

#[cfg(feature = "wgsl")]
pub mod wgsl;

#[cfg(feature = "bytemuck")]
pub use gpu::{GpuEllipsoid, GpuSphere};
