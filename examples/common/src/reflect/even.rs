//! A δ for each tile, so that noise is even to the eye.

use rayon::prelude::*;
use stochastic_light_culling::{EvenNoise, glam::Vec3};

use crate::frame::{Frame, Subregion, Tiles};

/// One pixel in so many of a tile is looked at, which is as good: pixels of a tile share their lights. Coprime to the sizes
/// of tiles, so that columns are met alike.
const STRIDE: usize = 11;

/// δ of each depth interval of each tile over that of the frame.
pub struct DeltaScales {
    columns: u32,
    intervals: u32,
    scales: Vec<f32>,
}

impl DeltaScales {
    /// By what tiles show in a `picture` with random numbers of another seed, on which those of this frame do not depend.
    ///
    /// A tile has the same place in all subregions, and sees nearly the same there. So they share a scale, which is known
    /// better: of many more pixels, and of all lights.
    pub fn new(frame: &Frame, tiles: &Tiles, picture: &[Vec3]) -> Self {
        let subregions = tiles.subregions();
        let most = |of: fn(&Subregion) -> u32| subregions.iter().map(of).max().unwrap_or(0);
        let columns = most(|subregion| subregion.grid.size()[0]);
        let rows = most(|subregion| subregion.grid.size()[1]);
        let intervals = most(|subregion| subregion.depths.intervals());
        let slot = |[x, y]: [u32; 2], interval| ((y * columns + x) * intervals + interval) as usize;
        let of_subregion = |(index, Subregion { grid, depths }): (usize, &Subregion)| {
            let mut sums = vec![(0.0, 0.0); (columns * rows * intervals) as usize];
            for tile in grid.tiles() {
                for pixel in grid.pixels(tile).pixels().step_by(STRIDE) {
                    let pixel = frame.interleave.join_pixel(index as u32, pixel);
                    let depth = frame.surfaces.at(pixel).depth;
                    if let Some(interval) = depths.interval_of(tile, depth) {
                        let (sum, count) = &mut sums[slot(tile, interval)];
                        *sum += picture[frame.surfaces.index(pixel)].element_sum() / 3.0;
                        *count += 1.0;
                    }
                }
            }
            sums
        };
        let add = |mut all: Vec<(f32, f32)>, more: Vec<(f32, f32)>| {
            for ((sum, count), (more, others)) in all.iter_mut().zip(more) {
                *sum += more;
                *count += others;
            }
            all
        };
        let of_subregions = subregions.par_iter().enumerate().map(of_subregion);
        let sums = of_subregions.reduce_with(add).unwrap_or_default();
        let (all, count) = sums.iter().fold((0.0, 0.0), |(all, of_all), (sum, count)| {
            (all + sum, of_all + count)
        });
        // A black picture tells nothing, and a tile without pixels has the NaN of 0/0.
        let even = EvenNoise::new(all / count);
        let scale = |(sum, count): (f32, f32)| {
            even.as_ref()
                .map_or(1.0, |even| even.delta_scale(sum / count))
        };
        Self {
            columns,
            intervals,
            scales: sums.into_iter().map(scale).collect(),
        }
    }

    pub fn of(&self, [x, y]: [u32; 2], interval: u32) -> f32 {
        self.scales[((y * self.columns + x) * self.intervals + interval) as usize]
    }
}
