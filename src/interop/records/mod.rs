//! Records of plain numbers at the offsets that shaders expect.

mod buffer;
mod frame;
mod kernel;
mod light;
mod shape;
mod view;

pub use buffer::GpuBuffer;
pub use frame::GpuFrame;
pub use kernel::GpuKernel;
pub use light::GpuLight;
pub use shape::{GpuBound, GpuEllipsoid, GpuProjected, GpuSphere};
pub use view::{GpuCamera, GpuTile};
