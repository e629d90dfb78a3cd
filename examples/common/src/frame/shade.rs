//! Irradiance of each pixel from the lights in its list.

use std::ops::Range;

use rayon::prelude::*;
use stochastic_light_culling::{Lobe, glam::Vec3};

use super::{Frame, Light};
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
    /// An image of `count` pixels without light.
    pub fn black(count: usize) -> Self {
        Self {
            irradiance: vec![Vec3::ZERO; count],
            evaluated: vec![0; count],
            contributing: vec![0; count],
        }
    }

    pub fn set(&mut self, pixel: usize, sums: &Sums) {
        self.irradiance[pixel] = sums.irradiance;
        self.evaluated[pixel] = sums.evaluated;
        self.contributing[pixel] = sums.contributing;
    }

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
pub struct Sums {
    pub irradiance: Vec3,
    pub evaluated: u32,
    pub contributing: u32,
}

impl Sums {
    /// Adds what `light` sends to `surface`, if that accepts it.
    ///
    /// Sums over the same lights in the same order are the same, whatever else was passed over.
    #[inline]
    pub fn add<L: Lobe>(&mut self, frame: &Frame, light: &Light<L>, surface: &Surface) {
        self.evaluated += 1;
        let path = Path::new(light, surface, frame.least_distance_squared);
        let (intensity, distance_squared) = (path.intensity, path.distance_squared);
        let radiance = (frame.roulette).estimate(intensity, distance_squared, light.xi);
        // Zero where the light is not accepted.
        self.contributing += u32::from(radiance > 0.0);
        self.irradiance += radiance * path.cosine * light.tint;
    }
}

/// Shades all pixels by the lists that `list_of` gives for a pixel and the depth of its surface; calls
/// `done` after each row of a subregion.
///
/// If `refined`, lights that lie with their backs to the surface are passed over before their lobe is
/// evaluated, in which they are zero.
pub fn shade<'a, L: Lobe + Sync>(
    frame: &Frame,
    refined: bool,
    lights: &[Light<L>],
    list_of: impl Fn([u32; 2], f32) -> Option<&'a [u32]> + Sync,
    done: impl Fn() + Sync,
) -> Shaded {
    let mut image = Shaded::black(frame.surfaces.surfaces.len());
    let all = 0..frame.interleave.subregions();
    shade_subregions(frame, all, refined, lights, list_of, &mut image, done);
    image
}

/// Shades the pixels of some subregions of `image`, as [`shade`] does all.
pub fn shade_subregions<'a, L: Lobe + Sync>(
    frame: &Frame,
    subregions: Range<u32>,
    refined: bool,
    lights: &[Light<L>],
    list_of: impl Fn([u32; 2], f32) -> Option<&'a [u32]> + Sync,
    image: &mut Shaded,
    done: impl Fn() + Sync,
) {
    let shade_pixel = |pixel: [u32; 2]| {
        let surface = frame.surfaces.at(pixel);
        let mut sums = Sums::default();
        for i in list_of(pixel, surface.depth)? {
            let light = &lights[*i as usize];
            if !(refined && light.has_back_to(surface)) {
                sums.add(frame, light, surface);
            }
        }
        Some(sums)
    };
    // Neighbours in a subregion share most of their lights; those in the image, none.
    let rows = frame.rows_of(subregions);
    let shaded: Vec<Vec<Option<Sums>>> = rows
        .par_iter()
        .map(|row| {
            let sums = row.iter().map(|pixel| shade_pixel(*pixel)).collect();
            done();
            sums
        })
        .collect();

    for (pixel, sums) in rows.iter().flatten().zip(shaded.iter().flatten()) {
        if let Some(sums) = sums {
            image.set(frame.surfaces.index(*pixel), sums);
        }
    }
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
