//! Culling of many lights against many tiles.
//!
//! # Stages
//!
//! 1. [`BatchBuilder`] turns lights into a [`LightBatch`]. A group of 64 lights (`group`) is transposed, so
//!    that each vector holds one field of several lights. The vectors then run the generic functions that
//!    scalar code runs: bound, placement, projection.
//! 2. [`TileDepths`] holds the slopes of a grid of tiles and the depth intervals of each tile.
//! 3. [`Culler`] subdivides the grid into blocks, those into smaller blocks, and the last ones into tiles
//!    (`block`). For each block, `filter` copies the lights that may touch it, so that only these are tested
//!    against its parts. For each depth interval of each tile, `tile_list` appends the indices of the lights
//!    that may touch it to [`LightLists`]. `exact` does the same with the exact test after that.
//! 4. `parallel` gives blocks to threads and concatenates their lists.
//! 5. `shading` evaluates the lights of a list at the points of its tile.
//!
//! # Layout
//!
//! A [chunk](batch::Chunk) holds sixteen lights, as many as the widest vectors have lanes: an array for each
//! field. Narrower vectors process a chunk in parts, so batches and lists do not depend on the processor.
//!
//! Each chunk has the range of depths that its lights reach. One comparison of a vector finds which of
//! sixteen chunks reach the depths of a tile; the others are skipped. That is worth most if lights that are
//! neighbours in a batch are neighbours in depth: see [`DepthOrder`].
//!
//! # No light is lost
//!
//! - The shapes in a batch are those of the scalar functions, bit for bit.
//! - Each lane runs the function that [`touches`](crate::TileTest::touches) runs, so lists are those of the
//!   scalar test.
//! - The rectangle and depths of a block hold those of its tiles. Every operation of the test is monotone,
//!   and so is rounding. So whatever touches a tile touches its block, bit for bit, without a margin.
//! - The range of depths of a chunk holds every depth at which the test finds one of its lights.
//! - The exact test has its own promise: see [`touches_exactly`](crate::TileTest::touches_exactly).

mod batch;
mod block;
mod builder;
mod culler;
mod depth_order;
mod exact;
mod filter;
mod group;
mod lanes;
mod lists;
#[cfg(feature = "rayon")]
mod parallel;
mod shading;
mod tile_depths;
mod tile_list;

pub use batch::LightBatch;
pub use builder::BatchBuilder;
pub use culler::{CullCounters, Culler};
pub use depth_order::DepthOrder;
pub use lists::LightLists;
pub use shading::{
    BlockEstimates, Estimate, PointBlock, RadianceEstimator, ShadedPoint, ShadingBatch,
};
pub use tile_depths::TileDepths;
