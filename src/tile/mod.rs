//! A tile of the screen, and whether a light touches it.

mod depth_interval;
mod frustum;
mod grid;
mod number;
mod rectangle;
mod tile_test;

pub use depth_interval::DepthInterval;
#[cfg(feature = "cull")]
pub(crate) use frustum::{Frustum, Image};
pub use grid::{PixelRectangle, TileGrid};
#[cfg(feature = "cull")]
pub(crate) use number::Number;
pub use rectangle::TileRectangle;
pub use tile_test::TileTest;
