//! The irradiance of all lights, with none left to chance: what the frame is an estimate of.

use rayon::prelude::*;
use stochastic_light_culling::{Lobe, glam::Vec3};

use super::shade::Path;
use super::{Frame, Light, Lights};

/// The irradiance at some pixels, glossy and diffuse lights apart.
pub struct Reference {
    /// Every so many pixels across and down.
    pub stride: usize,
    /// Places in the image, row by row.
    pub pixels: Vec<usize>,
    pub glossy: Vec<Vec3>,
    pub diffuse: Vec<Vec3>,
}

impl Reference {
    /// At every `stride`-th pixel across and down that is not sky; calls `done` after each.
    pub fn new(frame: &Frame, lights: &Lights, stride: usize, done: impl Fn() + Sync) -> Self {
        let pixels = Self::pixels(frame, stride);
        let both: Vec<[Vec3; 2]> = pixels
            .par_iter()
            .map(|pixel| {
                let glossy = irradiance_of_all_lights(frame, &lights.glossy, *pixel);
                let diffuse = irradiance_of_all_lights(frame, &lights.diffuse, *pixel);
                done();
                [glossy, diffuse]
            })
            .collect();
        Self {
            stride,
            pixels,
            glossy: both.iter().map(|[glossy, _]| *glossy).collect(),
            diffuse: both.iter().map(|[_, diffuse]| *diffuse).collect(),
        }
    }

    /// The irradiance of glossy and of diffuse lights for all of `count` pixels, black for sky; `None`
    /// if only some pixels were taken.
    pub fn images(&self, count: usize) -> Option<[Vec<Vec3>; 2]> {
        if self.stride > 1 {
            return None;
        }
        Some([&self.glossy, &self.diffuse].map(|irradiance| {
            let mut image = vec![Vec3::ZERO; count];
            for (pixel, irradiance) in self.pixels.iter().zip(irradiance) {
                image[*pixel] = *irradiance;
            }
            image
        }))
    }

    /// The places of the pixels that [`Self::new`] would take.
    pub fn pixels(frame: &Frame, stride: usize) -> Vec<usize> {
        let [width, height] = frame.surfaces.image_size;
        let rows = (0..height).step_by(stride);
        rows.flat_map(|y| (0..width).step_by(stride).map(move |x| [x, y]))
            .map(|pixel| frame.surfaces.index(pixel))
            .filter(|index| !frame.surfaces.surfaces[*index].is_sky())
            .collect()
    }
}

/// The irradiance at the `pixel`-th surface of the frame.
fn irradiance_of_all_lights<L: Lobe>(frame: &Frame, lights: &[Light<L>], pixel: usize) -> Vec3 {
    let surface = &frame.surfaces.surfaces[pixel];
    let sum: Vec3 = lights
        .iter()
        // From behind the surface nothing arrives, whatever the lobe.
        .filter(|light| (light.vpl.position() - surface.position).dot(surface.normal) > 0.0)
        .map(|light| {
            let path = Path::new(light, surface, frame.least_distance_squared);
            path.irradiance() * light.tint
        })
        .sum();
    // Each light is weighted for one subregion, and here lights them all.
    sum / frame.interleave.weight()
}
