//! Many lights against many tiles.
//!
//! # What is done when
//!
//! The screen is cut into blocks, those into smaller blocks, and the last ones into tiles. Of the lights
//! that may touch a block, those that may touch a part of it are copied out, sixteen at a time, and only
//! they go on to that part. Blocks are tested as tiles are, by the box around all that their tiles see.
//!
//! Before that, lights become bounds and bounds become shapes, sixteen at a time as well (`group`).
//!
//! Of each sixteen lights the range of depths that they reach is known, and a block or a tile that sees
//! no such depth passes over them with a sixteenth of a comparison. That is worth most if neighbours in
//! a batch are neighbours in depth: see [`LightBatch`].
//!
//! # Why no light is lost
//!
//! The lanes of a vector run the function that [`TileTest::touches`](crate::TileTest::touches) runs, so the
//! lists are those of the scalar test. A block holds its tiles' rectangles and depths,
//! and every operation of the test is monotone, as is rounding: what touches a tile touches its block,
//! bit for bit, without any margin. The shapes have the bits that the scalar functions give. What
//! the exact test then rejects is its own promise: see
//! [`TileTest::touches_exactly`](crate::TileTest::touches_exactly).

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
mod tile_depths;
mod tile_list;

pub use batch::LightBatch;
pub use builder::BatchBuilder;
pub use culler::{CullCounters, Culler};
pub use depth_order::DepthOrder;
pub use lists::LightLists;
pub use tile_depths::TileDepths;
