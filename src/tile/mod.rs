//! A tile of the screen, and whether a light touches it.

mod depth_interval;
mod grid;
mod rectangle;
mod tile_test;

pub use depth_interval::DepthInterval;
pub use grid::{PixelRectangle, TileGrid};
pub use rectangle::TileRectangle;
pub use tile_test::TileTest;
