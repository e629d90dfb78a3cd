//! How many of the lights in lists no pixel accepts.

use common::frame::{Frame, GlossyLight, Path, Subregion, Tiles};
use rayon::prelude::*;

/// The lights of each depth interval of each tile of a subregion.
pub type Lists<'a> = Box<dyn Fn([u32; 2], u32) -> &'a [u32] + Sync + 'a>;

pub struct Outcome {
    /// For each light and depth interval.
    pub ns: f64,
    /// Lights in all lists, and those of them that some pixel accepts.
    pub listed: usize,
    pub needed: usize,
    /// Lights in the lists of all pixels.
    pub at_pixels: usize,
}

pub fn outcome(
    frame: &Frame,
    tiles: &Tiles,
    lights: &[GlossyLight],
    lists: &[Lists],
    ns: f64,
) -> Outcome {
    let totals: Vec<[usize; 4]> = tiles
        .subregions()
        .par_iter()
        .zip(lists)
        .enumerate()
        .map(|(i, (subregion, lists))| {
            let i = i as u32;
            let of_subregion = frame.interleave.lights_in(i, lights.len() as u32) as usize;
            totals(frame, (i, subregion), lights, lists, of_subregion)
        })
        .collect();
    let [pairs, listed, needed, at_pixels]: [usize; 4] =
        std::array::from_fn(|i| totals.iter().map(|totals| totals[i]).sum());
    Outcome {
        ns: ns / pairs.max(1) as f64,
        listed,
        needed,
        at_pixels,
    }
}

/// Pairs of a light and a depth interval with surfaces, those listed, those needed, and the sum over all
/// pixels of the lights in their lists.
fn totals(
    frame: &Frame,
    (i, subregion): (u32, &Subregion),
    lights: &[GlossyLight],
    lists: &Lists,
    of_subregion: usize,
) -> [usize; 4] {
    let mut totals = [0; 4];
    for tile in subregion.grid.tiles() {
        let mut surfaces = vec![Vec::new(); subregion.depths.intervals() as usize];
        for pixel in subregion.grid.pixels(tile).pixels() {
            let surface = frame.surfaces.at(frame.interleave.join_pixel(i, pixel));
            if let Some(interval) = subregion.depths.interval_of(tile, surface.depth) {
                surfaces[interval as usize].push(surface);
            }
        }
        for (surfaces, interval) in surfaces.iter().zip(0..) {
            if surfaces.is_empty() {
                continue;
            }
            let list = lists(tile, interval);
            let accepts = |light: &GlossyLight| {
                surfaces.iter().any(|surface| {
                    let path = Path::new(light, surface, frame.least_distance_squared);
                    frame
                        .roulette
                        .estimate(path.intensity, path.distance_squared, light.xi)
                        > 0.0
                })
            };
            let needed = list
                .iter()
                .filter(|light| accepts(&lights[**light as usize]))
                .count();
            totals[0] += of_subregion;
            totals[1] += list.len();
            totals[2] += needed;
            totals[3] += list.len() * surfaces.len();
        }
    }
    totals
}
