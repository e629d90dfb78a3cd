//! Neither culling nor roulette: some of the lights, drawn at random, each that much brighter.

use common::frame::{Frame, GlossyLight, Path};
use rayon::prelude::*;
use stochastic_light_culling::{Seed, glam::Vec3};

/// The irradiance of all pixels by one in `share` of their subregion's lights, but at least one; by all
/// of them if `share` is 1.
pub fn light(frame: &Frame, lights: &[GlossyLight], share: u32, seed: u32) -> Vec<Vec3> {
    let interleave = &frame.interleave;
    let drawn: Vec<(Vec<u32>, f32)> = (0..interleave.subregions())
        .into_par_iter()
        .map(|subregion| {
            let count = interleave.lights_in(subregion, lights.len() as u32);
            let mut indices: Vec<u32> = (0..count)
                .map(|local| interleave.join_light(subregion, local))
                .collect();
            let order = |index: &u32| Seed(seed).frame(share).hashed_xi(*index).get();
            indices.sort_by(|a, b| order(a).total_cmp(&order(b)));
            indices.truncate((count / share).max(1) as usize);
            let weight = count as f32 / indices.len().max(1) as f32;
            (indices, weight)
        })
        .collect();
    let [width, _] = frame.surfaces.image_size;
    let surfaces = frame.surfaces.surfaces.par_iter().enumerate();
    surfaces
        .map(|(i, surface)| {
            if surface.is_sky() {
                return Vec3::ZERO;
            }
            let pixel = [i as u32 % width, i as u32 / width];
            let (subregion, _) = interleave.split_pixel(pixel);
            let (indices, weight) = &drawn[subregion as usize];
            let irradiance = |index: &u32| {
                let light = &lights[*index as usize];
                if light.has_back_to(surface) {
                    return Vec3::ZERO;
                }
                let path = Path::new(light, surface, frame.least_distance_squared);
                path.irradiance() * light.tint
            };
            *weight * indices.iter().map(irradiance).sum::<Vec3>()
        })
        .collect()
}
