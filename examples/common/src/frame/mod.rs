//! One frame: lights and their ranges, bounds, lists of lights for tiles, shading by those lists, and
//! what to compare it with.

mod bounds;
mod clusters;
mod cull;
mod denoise;
mod lights;
mod measure;
mod metrics;
mod reference;
mod reflectance;
mod shade;
mod smooth;
mod tiles;

pub use bounds::{BoundKind, GlossyLight};
pub use clusters::{Cluster, Clustering, LightMaps};
pub use denoise::cross_bilateral;
pub use lights::{Light, Lights, ordered, redraw};
pub use measure::{Measured, Tiling, measure_diffuse, measure_glossy, timed};
pub use metrics::{mean_over_surfaces, rmse};
pub use reference::Reference;
pub use shade::{Path, Shaded, Shading, Sums, count_facing, shade};
pub use smooth::{SmoothLight, measure_smooth, smooth_lights};
pub use tiles::{Slicing, Subregion, Tiles};

use stochastic_light_culling::{Interleave, Roulette};

use crate::scene::SurfaceBuffer;

/// What all steps of a frame share.
pub struct Frame<'a> {
    pub surfaces: &'a SurfaceBuffer,
    pub interleave: Interleave,
    pub roulette: Roulette,
    /// A light stands for a patch of this squared radius. Nearer than that a point would be brighter
    /// than its patch, without limit, so distances are taken to be at least this.
    pub least_distance_squared: f32,
}

impl Frame<'_> {
    /// The pixels of the image, as rows of its subregions.
    pub fn interleaved_rows(&self) -> Vec<Vec<[u32; 2]>> {
        let interleave = &self.interleave;
        let rows = |subregion| {
            let [width, height] = interleave.subregion_size(subregion);
            let pixel = move |x, y| interleave.join_pixel(subregion, [x, y]);
            (0..height).map(move |y| (0..width).map(|x| pixel(x, y)).collect())
        };
        (0..interleave.subregions()).flat_map(rows).collect()
    }
}
