//! Serialization, and records and shader text for a GPU.

#[cfg(feature = "serde")]
mod impl_serde;
#[cfg(feature = "bytemuck")]
mod records;

#[cfg(feature = "wgsl")]
pub mod wgsl;

#[cfg(feature = "bytemuck")]
pub use records::{
    GpuBound, GpuBuffer, GpuCamera, GpuEllipsoid, GpuFrame, GpuKernel, GpuLight, GpuProjected,
    GpuSphere, GpuTile,
};
