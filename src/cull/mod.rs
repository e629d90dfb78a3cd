//! Culling of many lights against many tiles.
//!
//! # Stages
//!
//! 1. [`BatchBuilder`] turns lights into a [`LightBatch`]. A group of 64 lights (`group`) is transposed, so
//!    that each vector holds one field of several lights. The vectors then run the generic functions that
//!    scalar code runs: bound, placement, projection.
//! 2. [`TileDepths`] holds the slopes of a grid of tiles and the depth intervals of each tile.
//! 3. [`Culler`] looks at each light once and sorts the *places* of lights, their positions in the batch, into
//!    blocks of tiles (`bins`). A grid of few tiles is one block.
//! 4. For each part of a block, and for each part of that, the places of the lights that may touch it are selected
//!    (`block`, `select`).
//! 5. The lights of the last parts are gathered into chunks, and tested against each tile and each of its depth
//!    intervals (`tile_lists`), or with as many tiles at once as there are lanes (`tile_lanes`). Their indices are
//!    appended to [`LightLists`].
//! 6. With the exact test, a block's lists of places are made first, and their pairs of a light and an interval are
//!    tested side by side (`exact`).
//! 7. `parallel` gives shares of the lights and of the blocks to threads, and concatenates their lists.
//! 8. `shading` evaluates the lights of a list at the points of its tile.
//!
//! # Layout
//!
//! A batch holds a *record* of each light, and the bounds of the shapes once more, an array for each of the six ends.
//! A record is a cache line with all fields of an ellipsoid, or half of one with those of a sphere from which its
//! other fields follow (`records`). Most lights are rejected by their bounds, which are read in order.
//! The records of the others are gathered: as many as a vector has lanes are transposed to a vector for each field.
//! So lights may be in any order.
//!
//! A *chunk* holds sixteen lights, as many as the widest vectors have lanes. Narrower vectors process a chunk in
//! parts, so batches and lists do not depend on the processor.
//!
//! # No light is lost
//!
//! - The shapes in a batch are those of the scalar functions, bit for bit.
//! - Each lane runs the function that [`touches`](crate::TileTest::touches) runs, so lists are those of the
//!   scalar test.
//! - The rectangle and depths of a block hold those of its parts, and so on down to the tiles. Every operation of
//!   the test is monotone, and so is rounding. So whatever touches a tile touches what holds it, bit for bit,
//!   without a margin.
//! - The blocks of a light are found by a monotone function of slopes: see `bins`.
//! - The exact test has its own promise: see [`touches_exactly`](crate::TileTest::touches_exactly).

mod batch;
#[cfg(test)]
mod batch_tests;
mod bins;
mod block;
mod builder;
mod culler;
mod exact;
mod group;
mod lanes;
mod lists;
#[cfg(feature = "rayon")]
mod parallel;
mod receivers;
mod records;
mod select;
mod shading;
mod tile_depths;
mod tile_lanes;
mod tile_lists;

pub use batch::LightBatch;
pub use builder::BatchBuilder;
pub use culler::{CullCounters, Culler};
pub use lists::LightLists;
pub use receivers::{ReceiverCuller, TileReceivers, WeightedList, WeightedLists};
pub use shading::{
    AtPoint, AtReceiver, BlockEstimates, Decision, Estimate, InList, PointBlock, PointDecision,
    RadianceEstimator, Receiver, ReceiverBlock, ShadedLight, ShadedPoint, ShadingBatch,
};
pub use tile_depths::TileDepths;
