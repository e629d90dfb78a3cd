//! One frame: lights and their ranges, bounds, lists of lights for tiles, shading by those lists, and
//! what to compare it with.

mod bounds;
mod cull;
mod denoise;
mod lights;
mod measure;
mod metrics;
mod reference;
mod shade;
mod tile;

pub use bounds::BoundKind;
pub use denoise::cross_bilateral;
pub use lights::{Light, Lights};
pub use measure::{Measured, measure_diffuse, measure_glossy, timed};
pub use metrics::{mean_over_surfaces, rmse};
pub use reference::Reference;
pub use shade::Shaded;
pub use tile::Tile;

use stochastic_light_culling::{Interleave, Roulette};

use crate::scene::SurfaceBuffer;

/// What all steps of a frame share.
pub struct Frame<'a> {
    pub surfaces: &'a SurfaceBuffer,
    pub tiles: &'a [Tile],
    pub interleave: Interleave,
    pub roulette: Roulette,
    /// A light stands for a patch of this squared radius. Nearer than that a point would be brighter
    /// than its patch, without limit, so distances are taken to be at least this.
    pub least_distance_squared: f32,
}
