//! Lights drawn for tiles by brute force: every light at every tile.

use std::collections::BTreeMap;

use common::frame::{Frame, GlossyLight, Path};
use rayon::prelude::*;
use stochastic_light_culling::{Blind, ReceiverCluster, Seed, TileProbability, glam::Vec3};

use super::way::Way;
use super::{LISTED, TILE};

/// Of exponential depth intervals in a factor of e.
const INTERVALS: f32 = 4.0;

/// A depth interval of a tile.
pub struct Tile {
    subregion: u32,
    /// In the image.
    pixels: Vec<usize>,
    /// The upper bound of the radiance over δ, of each light of the subregion.
    greatest: Vec<f32>,
}

/// The tiles of a grid that is moved by `offset` pixels.
pub fn tiles(frame: &Frame, lights: &[GlossyLight], offset: [u32; 2]) -> Vec<Tile> {
    let interleave = &frame.interleave;
    let width = frame.surfaces.image_size[0];
    let mut groups = BTreeMap::<_, Vec<usize>>::new();
    for (i, surface) in frame.surfaces.surfaces.iter().enumerate() {
        if !surface.is_sky() {
            let pixel = [i as u32 % width, i as u32 / width];
            let (subregion, local) = interleave.split_pixel(pixel);
            let [x, y] = [0, 1].map(|i| (local[i] + offset[i]) / TILE);
            let interval = (surface.depth.ln() * INTERVALS).floor() as i32;
            let group = groups.entry((subregion, y, x, interval));
            group.or_default().push(i);
        }
    }
    let groups: Vec<_> = groups.into_iter().collect();
    let tile = |((subregion, ..), pixels): ((u32, u32, u32, i32), Vec<usize>)| {
        let positions = pixels.iter().map(|i| frame.surfaces.surfaces[*i].position);
        let receivers = ReceiverCluster::of(positions.map(|position| (position, Blind)));
        let receivers = receivers.expect("a group has a pixel");
        let count = interleave.lights_in(subregion, lights.len() as u32);
        let greatest = |local: u32| {
            let light = &lights[interleave.join_light(subregion, local) as usize].vpl;
            let least = frame.least_distance_squared;
            receivers.greatest_radiance(light, &frame.roulette, least)
        };
        Tile {
            subregion,
            pixels,
            greatest: (0..count).map(greatest).collect(),
        }
    };
    groups.into_par_iter().map(tile).collect()
}

/// The δ that gives a pixel [`LISTED`] lights in the mean, for tiles whose δ is less.
pub fn delta_of_lists(tiles: &[Tile], delta: f32) -> f32 {
    let pixels = tiles.iter().map(|tile| tile.pixels.len()).sum::<usize>();
    let listed = |delta: f64| {
        let of_tile = |tile: &Tile| {
            let drawn = tile
                .greatest
                .iter()
                .map(|of| (f64::from(*of) / delta).min(1.0));
            drawn.sum::<f64>() * tile.pixels.len() as f64
        };
        tiles.par_iter().map(of_tile).sum::<f64>() / pixels.max(1) as f64
    };
    // How many times greater.
    let (mut low, mut high) = (1.0_f64, 1e8_f64);
    for _ in 0..30 {
        let middle = (low * high).sqrt();
        if listed(middle) > LISTED {
            low = middle;
        } else {
            high = middle;
        }
    }
    delta * high as f32
}

/// The irradiance of all pixels in a frame, and the lights in the list of a pixel.
pub fn light(
    way: Way,
    frame: &Frame,
    lights: &[GlossyLight],
    tiles: &[Tile],
    (seed, number): (Seed, u32),
) -> (Vec<Vec3>, f64) {
    let interleave = &frame.interleave;
    let lit = tiles.par_iter().enumerate().map(|(index, tile)| {
        let drawn = (0..).zip(&tile.greatest).filter_map(|(local, greatest)| {
            let p = TileProbability::bound().probability(*greatest, 0.0);
            let i = interleave.join_light(tile.subregion, local);
            let light = &lights[i as usize];
            let xi = way.xi(seed, number, index as u32, [i, local], light.xi);
            (p > 0.0 && xi.get() <= p).then_some((light, 1.0 / p))
        });
        let drawn: Vec<_> = drawn.collect();
        let at = |pixel: &usize| {
            let surface = &frame.surfaces.surfaces[*pixel];
            let mut sum = Vec3::ZERO;
            for (light, weight) in &drawn {
                let path = Path::new(light, surface, frame.least_distance_squared);
                let radiance = if way == Way::Pixel {
                    let Path {
                        intensity,
                        distance_squared,
                        ..
                    } = path;
                    frame
                        .roulette
                        .estimate(intensity, distance_squared, light.xi)
                } else {
                    path.intensity / path.distance_squared * weight
                };
                sum += radiance * path.cosine * light.tint;
            }
            (*pixel, sum)
        };
        let sums: Vec<_> = tile.pixels.iter().map(at).collect();
        (sums, drawn.len() * tile.pixels.len())
    });
    let lit: Vec<_> = lit.collect();
    let mut image = vec![Vec3::ZERO; frame.surfaces.surfaces.len()];
    let (mut listed, mut pixels) = (0, 0);
    for (sums, count) in lit {
        listed += count;
        pixels += sums.len();
        for (pixel, sum) in sums {
            image[pixel] = sum;
        }
    }
    (image, listed as f64 / pixels.max(1) as f64)
}
