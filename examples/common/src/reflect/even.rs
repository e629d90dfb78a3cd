//! A δ for each tile, so that noise is even to the eye.

use stochastic_light_culling::EvenNoise;

use crate::frame::{Subregion, Tiles};

/// What the depth intervals of tiles showed, in all frames that have been added.
///
/// A tile has the same place in all subregions, and sees nearly the same there. So subregions share their sums, which are
/// of many more pixels, and of all lights.
#[derive(Clone, Debug)]
pub struct Shown {
    columns: u32,
    intervals: u32,
    /// The radiance of all pixels, and how many there are.
    sums: Vec<[f64; 2]>,
}

impl Shown {
    /// Of no frame.
    pub fn nothing(tiles: &Tiles) -> Self {
        let subregions = tiles.subregions();
        let most = |of: fn(&Subregion) -> u32| subregions.iter().map(of).max().unwrap_or(0);
        let columns = most(|subregion| subregion.grid.size()[0]);
        let rows = most(|subregion| subregion.grid.size()[1]);
        let intervals = most(|subregion| subregion.depths.intervals());
        Self {
            columns,
            intervals,
            sums: vec![[0.0; 2]; (columns * rows * intervals) as usize],
        }
    }

    /// The place of an interval of a tile among all of them.
    pub fn slot(&self, [x, y]: [u32; 2], interval: u32) -> usize {
        ((y * self.columns + x) * self.intervals + interval) as usize
    }

    /// How many places there are.
    pub fn slots(&self) -> usize {
        self.sums.len()
    }

    /// Adds `pixels` that show `radiance` together.
    pub fn add(&mut self, slot: usize, radiance: f64, pixels: f64) {
        let [sum, count] = &mut self.sums[slot];
        *sum += radiance;
        *count += pixels;
    }

    /// Adds other frames of the same tiles.
    pub fn add_all(&mut self, other: &Self) {
        for (slot, [radiance, pixels]) in other.sums.iter().enumerate() {
            self.add(slot, *radiance, *pixels);
        }
    }

    /// δ of each slot over that of the frame. Random numbers of that frame must be of another seed than those of the frames
    /// here.
    pub fn delta_scales(&self) -> Vec<f32> {
        // Where nothing is seen yet, more lights would be for nothing.
        let mean = |[radiance, pixels]: &[f64; 2]| {
            let is_seen = *radiance > 0.0;
            if is_seen {
                (radiance / pixels) as f32
            } else {
                f32::NAN
            }
        };
        let radiances: Vec<f32> = self.sums.iter().map(mean).collect();
        // Black frames tell nothing.
        let even = EvenNoise::of_tiles(&mut radiances.clone());
        let scale = |radiance| even.as_ref().map_or(1.0, |even| even.delta_scale(radiance));
        radiances.into_iter().map(scale).collect()
    }
}
