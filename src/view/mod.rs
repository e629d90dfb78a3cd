//! The camera, the tiles of its image, and the depths in them.

mod bounds;
mod camera;
mod depth_interval;
mod grid;
mod interleave;
mod rectangle;

pub(crate) use bounds::ViewBounds;
#[cfg(feature = "cull")]
pub(crate) use bounds::meet;
pub use camera::Camera;
#[cfg(feature = "serde")]
pub(crate) use camera::CameraParts;
pub use depth_interval::DepthInterval;
pub use grid::{PixelRectangle, TileGrid};
pub use interleave::Interleave;
pub use rectangle::TileRectangle;
