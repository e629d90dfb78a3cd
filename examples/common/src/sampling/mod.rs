//! Lights that each pixel draws by importance: what is used where lights are not culled.
//!
//! A pixel draws a few lights out of all of its subregion, each with a weight that makes the sum exact in the mean. Two
//! ways: [`tree`], in which a pixel finds lights by the importance of clusters, and [`resampled`], in which it evaluates
//! candidates and keeps some. There is no visibility, as in the rest of the frame.

mod group;
mod pixels;
mod profile;
mod resampled;
mod tree;

pub use profile::{Profile, Profiled};
pub use resampled::{CANDIDATES, shade_resampled};
pub use tree::{LightTrees, shade_by_tree};
