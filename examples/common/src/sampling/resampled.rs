//! Resampled importance sampling [Talbot et al. 2005].

use rayon::prelude::*;
use stochastic_light_culling::{Receiver, Seed, glam::Vec3};

use super::Profiled;
use super::pixels::{Drawing, Drawn, shade_drawn};
use crate::frame::{Frame, GlossyLight};

/// How many candidates are evaluated for each sample.
pub const CANDIDATES: usize = 32;

/// The lights of a subregion, to be drawn by flux.
struct Fluxes {
    lights: Vec<u32>,
    /// The sums of the flux up to each light, with it.
    sums: Vec<f64>,
    /// For each of as many parts of the whole flux as there are lights, the first light that reaches into it.
    guide: Vec<u32>,
}

impl Fluxes {
    fn new(all: &[GlossyLight], lights: Vec<u32>) -> Self {
        let mut sum = 0.0;
        let add = |light: &u32| {
            sum += f64::from(all[*light as usize].vpl.flux());
            sum
        };
        let sums: Vec<f64> = lights.iter().map(add).collect();
        let (count, mut at) = (lights.len(), 0);
        let first = |part: usize| {
            let start = sum * part as f64 / count as f64;
            while at + 1 < count && sums[at] <= start {
                at += 1;
            }
            at as u32
        };
        Self {
            guide: (0..count).map(first).collect(),
            lights,
            sums,
        }
    }

    fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The place of the light at the share `u` in [0, 1) of the flux.
    #[inline]
    fn at(&self, u: f64) -> usize {
        let last = self.lights.len() - 1;
        let place = ((u * self.lights.len() as f64) as usize).min(last);
        let (mut at, flux) = (self.guide[place] as usize, u * self.total());
        while at < last && self.sums[at] <= flux {
            at += 1;
        }
        at
    }
}

/// The radiance that each of `receivers` reflects to the eye, by `samples` lights a pixel, each kept of
/// [`CANDIDATES`] that are drawn by flux.
///
/// The target is the light that is reflected, in its brightest channel. So a sample only chooses which colour the mean of
/// its candidates has: without visibility there is nothing else that candidates do not know.
pub fn shade_resampled<R: Profiled>(
    frame: &Frame,
    lights: &[GlossyLight],
    receivers: &[Option<Receiver<R>>],
    samples: usize,
    seed: Seed,
) -> Vec<Vec3> {
    let interleave = &frame.interleave;
    let fluxes: Vec<Fluxes> = (0..interleave.subregions())
        .into_par_iter()
        .map(|subregion| {
            let count = interleave.lights_in(subregion, lights.len() as u32);
            let indices = (0..count).map(|local| interleave.join_light(subregion, local));
            Fluxes::new(lights, indices.collect())
        })
        .collect();
    let candidates = samples * CANDIDATES;
    let draw = |drawing: &Drawing, _: &Receiver<R>, drawn: &mut Drawn| {
        let fluxes = &fluxes[drawing.subregion as usize];
        let total = fluxes.total();
        if total <= 0.0 {
            return;
        }
        let xi = f64::from(drawing.xi(seed).get());
        for i in 0..candidates {
            let light = fluxes.lights[fluxes.at((i as f64 + xi) / candidates as f64)];
            let flux = f64::from(lights[light as usize].vpl.flux());
            drawn.push(light, (total / (flux * candidates as f64)) as f32);
        }
    };
    let keep = |drawing: &Drawing, drawn: &[u32], weights: &[f32], reflected: &[f32]| {
        let mut radiance = Vec3::ZERO;
        let choices = seed.subregion(drawing.subregion).frame(1);
        for sample in 0..samples.min(drawn.len()) {
            let own = || (sample..drawn.len()).step_by(samples);
            let sum: f32 = own().map(|i| weights[i] * reflected[i]).sum();
            let index = drawing
                .rank
                .wrapping_mul(samples as u32)
                .wrapping_add(sample as u32);
            let mut rest = choices.hashed_xi(index).get() * sum;
            let mut kept = None;
            for i in own().filter(|i| reflected[*i] > 0.0) {
                kept = Some(i);
                rest -= weights[i] * reflected[i];
                if rest <= 0.0 {
                    break;
                }
            }
            if let Some(kept) = kept {
                radiance += sum * lights[drawn[kept] as usize].tint;
            }
        }
        radiance
    };
    shade_drawn(frame, lights, receivers, draw, keep)
}
