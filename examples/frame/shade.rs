//! Irradiance of each pixel from the lights in its tile's list.

use rayon::prelude::*;
use stochastic_light_culling::{LightLists, Lobe, glam::Vec3};

use super::{Frame, Light, Tiling};
use crate::scene::Surface;

/// For each pixel of an image, row by row: irradiance, the lights whose lobe was evaluated, and those
/// of them that were accepted.
#[derive(Clone, Debug)]
pub struct Shaded {
    pub irradiance: Vec<Vec3>,
    pub evaluated: Vec<u32>,
    pub contributing: Vec<u32>,
}

impl Shaded {
    /// At how many pixels the irradiance or the lights accepted differ in any bit.
    pub fn pixels_unlike(&self, other: &Self) -> usize {
        let bits = |irradiance: &Vec3| irradiance.to_array().map(f32::to_bits);
        let irradiance = self.irradiance.iter().zip(&other.irradiance);
        let contributing = self.contributing.iter().zip(&other.contributing);
        irradiance
            .zip(contributing)
            .filter(|((a, b), (m, n))| bits(a) != bits(b) || m != n)
            .count()
    }
}

/// One pixel's sums.
#[derive(Clone, Copy, Default)]
struct Sums {
    irradiance: Vec3,
    evaluated: u32,
    contributing: u32,
}

/// Shades all pixels by the lists of their tiles; calls `done` after each row of a subregion.
pub fn shade<L: Lobe + Sync>(
    frame: &Frame,
    tiling: &Tiling,
    lights: &[Light<L>],
    lists: &[LightLists],
    done: impl Fn() + Sync,
) -> Shaded {
    let shade_pixel = |pixel: &[u32; 2]| {
        let surface = frame.surfaces.at(*pixel);
        let place = tiling.tiles.place_of(*pixel, surface.depth)?;
        let list = lists[place.subregion].of(place.tile, place.interval);
        Some(sums(frame, lights, list, surface, tiling.refined))
    };
    // Neighbours in a subregion share most of their lights; those in the image, none.
    let rows = frame.interleaved_rows();
    let shaded: Vec<Vec<Option<Sums>>> = rows
        .par_iter()
        .map(|row| {
            let sums = row.iter().map(shade_pixel).collect();
            done();
            sums
        })
        .collect();

    let count = frame.surfaces.surfaces.len();
    let mut image = Shaded {
        irradiance: vec![Vec3::ZERO; count],
        evaluated: vec![0; count],
        contributing: vec![0; count],
    };
    for (pixel, sums) in rows.iter().flatten().zip(shaded.iter().flatten()) {
        if let Some(sums) = sums {
            let index = frame.surfaces.index(*pixel);
            image.irradiance[index] = sums.irradiance;
            image.evaluated[index] = sums.evaluated;
            image.contributing[index] = sums.contributing;
        }
    }
    image
}

/// If `refined`, lights that lie with their backs to the surface are passed over before their lobe is
/// evaluated, in which they are zero.
///
/// In the order of the list, which is the same for every bound: the sums are then the same too.
fn sums<L: Lobe>(
    frame: &Frame,
    lights: &[Light<L>],
    list: &[u32],
    surface: &Surface,
    refined: bool,
) -> Sums {
    let mut sums = Sums::default();
    for number in list {
        let light = &lights[*number as usize];
        let to_surface = surface.position - light.vpl.position();
        if refined && light.normal.dot(to_surface) <= 0.0 {
            continue;
        }
        sums.evaluated += 1;
        let path = Path::new(light, surface, frame.least_distance_squared);
        let (intensity, distance_squared) = (path.intensity, path.distance_squared);
        let radiance = (frame.roulette).estimate(intensity, distance_squared, light.xi);
        // Zero where the light is not accepted.
        sums.contributing += u32::from(radiance > 0.0);
        sums.irradiance += radiance * path.cosine * light.tint;
    }
    sums
}

/// The way from a light to a surface.
pub struct Path {
    pub intensity: f32,
    pub distance_squared: f32,
    /// Of the angle of arrival; zero from behind.
    pub cosine: f32,
}

impl Path {
    #[inline]
    pub fn new<L: Lobe>(light: &Light<L>, surface: &Surface, least_distance_squared: f32) -> Self {
        let to_surface = surface.position - light.vpl.position();
        let true_distance_squared = to_surface.length_squared();
        // Of no length where the two coincide: no direction, hence no light.
        let direction = to_surface * true_distance_squared.sqrt().max(f32::MIN_POSITIVE).recip();
        Self {
            intensity: light.vpl.radiant_intensity(direction),
            distance_squared: true_distance_squared.max(least_distance_squared),
            cosine: (-direction).dot(surface.normal).max(0.0),
        }
    }

    #[inline]
    pub fn irradiance(&self) -> f32 {
        self.intensity / self.distance_squared * self.cosine
    }
}
