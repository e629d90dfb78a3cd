//! Runs WGSL over buffers of records on any Vulkan device, without a window: a GPU, else a software driver.
//!
//! For tests and examples of the shaders of `stochastic-light-culling`. Each mistake is an [`Error`] before anything is dispatched.

mod device;
mod error;
mod frame;
mod kernel;
mod map;

pub use device::Gpu;
pub use error::Error;
pub use frame::{Caller, Compiled, Frame, Method, Time};
pub use kernel::{Dispatch, Kernel};
pub use map::Map;
