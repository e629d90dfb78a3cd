//! A lobe with a position and a flux, and Russian roulette: how far a light reaches in a frame, and what it
//! counts for there.

mod roulette;
mod vpl;
mod xi;

pub use roulette::Roulette;
pub use vpl::Vpl;
pub use xi::{FrameSeed, Seed, Xi};
