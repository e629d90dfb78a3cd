//! The camera, the tiles of its image, and the depths in them.

mod bounds;
mod camera;
mod depth_interval;
mod grid;
mod interleave;
mod orthographic;
mod perspective;
mod projection;
mod receiver_cluster;
mod rectangle;
mod rigid;

#[cfg(feature = "cull")]
pub(crate) use bounds::meet;
pub(crate) use bounds::{ViewBounds, common};
#[cfg(feature = "serde")]
pub(crate) use camera::CameraParts;
pub use camera::{AnyCamera, Camera};
pub use depth_interval::DepthInterval;
pub use grid::{PixelRectangle, TileGrid};
pub use interleave::Interleave;
pub use orthographic::Orthographic;
pub use perspective::Perspective;
pub use projection::Projection;
pub use receiver_cluster::ReceiverCluster;
pub use rectangle::TileRectangle;
