//! Runs WGSL over buffers of records on any Vulkan device, without a window: a GPU, else a software driver.
//!
//! For tests and examples. Each mistake is an [`Error`] before anything is dispatched.

mod device;
mod error;
mod kernel;
mod map;

pub use device::Gpu;
pub use error::Error;
pub use kernel::{Dispatch, Kernel};
pub use map::Map;
