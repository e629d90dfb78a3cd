//! Culling of lights against the receivers of tiles: by what each surface reflects to the eye.
//!
//! [`TileReceivers`] holds a cluster of receivers for each depth interval of each tile, and one for each block of
//! tiles, of blocks, and so on up to the whole image (`tiles`). [`ReceiverCuller`] walks down from there: the
//! lights that may light a block are tested against each of its parts, as many side by side as two vectors have lanes
//! (`walk`). The lists of the last parts are what it returns, with a weight for each light if lights are drawn for a
//! tile as a whole (`culler`, `lists`).
//!
//! # No light is lost
//!
//! Lists are those of the scalar [`greatest_radiance`](TileReceivers::greatest_radiance) of each tile, since that of
//! a block is at least as great: see `touch::receivers`.

mod culler;
mod lists;
#[cfg(feature = "rayon")]
mod parallel;
mod tiles;
mod walk;

pub use culler::ReceiverCuller;
pub use lists::{WeightedList, WeightedLists};
pub use tiles::TileReceivers;
