//! Lights and clusters of lights, and the Russian roulette that decides how far a light reaches in a frame and with which weight.

mod cluster;
mod curve;
mod even_noise;
mod map;
mod pyramid;
mod roulette;
mod tile_probability;
mod vpl;
mod vsgl;
mod window;
mod xi;

pub use cluster::ClusterSums;
pub use curve::rank_along_curve;
pub use even_noise::EvenNoise;
pub use map::{FilteredSample, FilteredSampling};
pub use pyramid::{MipPyramid, pyramid_len};
pub use roulette::Roulette;
pub use tile_probability::TileProbability;
pub use vpl::Vpl;
#[cfg(feature = "cull")]
pub(crate) use vpl::unit;
pub use vsgl::Vsgl;
#[cfg(feature = "cull")]
pub(crate) use vsgl::Vsgls;
pub use window::DistanceWindow;
pub use xi::{FrameSeed, Seed, Xi};
