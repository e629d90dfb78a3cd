//! Serialization, and records for a GPU.

#[cfg(feature = "bytemuck")]
mod gpu;
#[cfg(feature = "serde")]
mod impl_serde;

#[cfg(feature = "bytemuck")]
pub use gpu::{GpuEllipsoid, GpuSphere};
