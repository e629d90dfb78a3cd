//! What points and smooth lights estimate.

use common::frame::{Lights, Reference};
use stochastic_light_culling::glam::Vec3;

use super::method::Stage;
use crate::subject::Subject;

/// The irradiance at some pixels, as the mean over sets of many points, and how well it is known.
pub struct Truth<'a> {
    subject: &'a Subject<'a>,
    pixels: Vec<usize>,
    irradiance: Vec<Vec3>,
    brightness: f64,
    /// The mean over the pixels of the squared standard error of their radiance.
    variance: f64,
}

/// How far a frame is from the truth, over the mean radiance or its square.
pub struct Deviation {
    /// Without what the truth is off itself.
    pub relative_mse: f64,
    pub relative_bias: f64,
}

impl<'a> Truth<'a> {
    pub fn new(stage: &Stage<'a>) -> Self {
        let subject = stage.subject;
        // Half the pixels each way that other studies take, and many rays at once: they are spread evenly, and lobes
        // are narrow.
        let stride = 2 * subject.stride() - 1;
        let [sets, rays] = if subject.effort.is_quick {
            [2, 1 << 14]
        } else {
            [4, 1 << 20]
        };
        let sets: Vec<Reference> = (0..sets)
            .map(|set| {
                let seed = subject.seed_of(u32::MAX - set);
                let points = subject.points_moved(stage.gloss, rays, seed, 0.0);
                let frame = subject.frame(stage.interleave, 1.0);
                let lights = Lights::new(&points, &stage.interleave, &frame.roulette, seed);
                let lights = lights.expect("scenes are checked when they are loaded");
                let glossy = Lights {
                    diffuse: Vec::new(),
                    ..lights
                };
                Reference::new(&frame, &glossy, stride, || ()).expect("its roulette is in range")
            })
            .collect();
        let pixels = sets[0].pixels.clone();
        let count = sets.len() as f32;
        let irradiance: Vec<Vec3> = (0..pixels.len())
            .map(|i| sets.iter().map(|set| set.glossy[i]).sum::<Vec3>() / count)
            .collect();
        let of_sets = sets
            .iter()
            .map(|set| mean_squared(subject, &pixels, &set.glossy, &irradiance));
        // Each set against the mean of all, of which it is a part.
        let variance = of_sets.sum::<f64>() / f64::from(count * (count - 1.0));
        Self {
            subject,
            brightness: subject.brightness(&pixels, &irradiance),
            pixels,
            irradiance,
            variance,
        }
    }

    /// How far a frame is off, by the irradiance of all its pixels.
    pub fn error(&self, irradiance: &[Vec3]) -> Deviation {
        let shown: Vec<Vec3> = self.pixels.iter().map(|pixel| irradiance[*pixel]).collect();
        let mse = mean_squared(self.subject, &self.pixels, &shown, &self.irradiance);
        let brightness = self.subject.brightness(&self.pixels, &shown);
        Deviation {
            relative_mse: (mse - self.variance) / self.brightness.powi(2),
            relative_bias: brightness / self.brightness - 1.0,
        }
    }
}

/// The mean over pixels and channels of the squared difference in radiance.
pub fn mean_squared(subject: &Subject, pixels: &[usize], a: &[Vec3], b: &[Vec3]) -> f64 {
    let surfaces = pixels
        .iter()
        .map(|pixel| &subject.surfaces.surfaces[*pixel]);
    let squared = surfaces
        .zip(a.iter().zip(b))
        .map(|(surface, (a, b))| f64::from(surface.reflected(*a - *b).length_squared()) / 3.0);
    squared.sum::<f64>() / pixels.len().max(1) as f64
}
