//! Rows of pixels with lists of lights of their own.

use std::ops::Range;

use rayon::prelude::*;
use stochastic_light_culling::{
    RadianceEstimator, Receiver, Roulette, Seed, ShadingBatch, Xi, glam::Vec3,
};

use super::Profiled;
use crate::frame::{Frame, GlossyLight};

/// A pixel that draws.
pub struct Drawing {
    pub subregion: u32,
    /// Of the pixel in its subregion, along a curve.
    pub rank: u32,
}

impl Drawing {
    /// A number that is spread over neighbouring pixels.
    pub fn xi(&self, seed: Seed) -> Xi {
        seed.subregion(self.subregion)
            .frame(0)
            .xi_of_rank(self.rank)
    }
}

/// The lights that are drawn, with their weights.
#[derive(Default)]
pub struct Drawn {
    lights: Vec<u32>,
    weights: Vec<f32>,
}

impl Drawn {
    #[inline(always)]
    pub fn push(&mut self, light: u32, weight: f32) {
        self.lights.push(light);
        self.weights.push(weight);
    }
}

/// What a row needs: memory that is used row after row.
#[derive(Default)]
struct Row {
    columns: Vec<usize>,
    drawings: Vec<Drawing>,
    /// Which of the drawn lights are a pixel's.
    parts: Vec<Range<usize>>,
    drawn: Drawn,
    /// What the pixel reflects of each.
    reflected: Vec<f32>,
}

/// The radiance that `receivers` reflect to the eye, for each pixel the `sum` of what it reflects of the lights that it
/// draws.
pub fn shade_drawn<R: Profiled>(
    frame: &Frame,
    lights: &[GlossyLight],
    receivers: &[Option<Receiver<R>>],
    draw: impl Fn(&Drawing, &Receiver<R>, &mut Drawn) + Sync,
    sum: impl Fn(&Drawing, &[u32], &[f32], &[f32]) -> Vec3 + Sync,
) -> Vec<Vec3> {
    let width = frame.surfaces.image_size[0] as usize;
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|light| (&light.vpl, light.xi)));
    // So small that all lights are accepted.
    let roulette = Roulette::new(1e-30).expect("in range");
    let estimator = RadianceEstimator::new(&roulette);
    let estimator = estimator
        .with_least_distance_squared(frame.least_distance_squared)
        .unwrap_or(estimator);

    let mut radiance = vec![Vec3::ZERO; receivers.len()];
    let rows = radiance.par_chunks_mut(width).enumerate();
    rows.for_each_init(Row::default, |row, (y, radiance)| {
        let receivers = &receivers[y * width..][..width];
        row.columns.clear();
        row.drawings.clear();
        row.parts.clear();
        row.drawn.lights.clear();
        row.drawn.weights.clear();
        for (x, receiver) in receivers.iter().enumerate() {
            let Some(receiver) = receiver else { continue };
            let (subregion, local) = frame.interleave.split_pixel([x as u32, y as u32]);
            let drawing = Drawing {
                subregion,
                rank: interleaved_bits(local),
            };
            let start = row.drawn.lights.len();
            draw(&drawing, receiver, &mut row.drawn);
            row.columns.push(x);
            row.drawings.push(drawing);
            row.parts.push(start..row.drawn.lights.len());
        }
        row.reflected.clear();
        row.reflected.resize(row.drawn.lights.len(), 0.0);
        let Row {
            columns,
            drawings,
            parts,
            drawn,
            reflected,
        } = row;
        let points = columns.iter().zip(&*parts).filter_map(|(x, part)| {
            let receiver = receivers[*x].clone()?;
            Some((receiver, &drawn.lights[part.clone()]))
        });
        // Lights come in order, without those that send nothing.
        let place = |mut at: usize, turn: usize, estimate: &_, value: f32| {
            let estimate: &stochastic_light_culling::Estimate = estimate;
            at = at.max(parts[turn].start);
            while drawn.lights[at] != estimate.light {
                at += 1;
            }
            reflected[at] = value;
            at + 1
        };
        estimator.fold_reflected_at_points(&batch, points, 0, place);
        for ((x, part), drawing) in columns.iter().zip(&*parts).zip(&*drawings) {
            let part = part.clone();
            radiance[*x] = sum(
                drawing,
                &drawn.lights[part.clone()],
                &drawn.weights[part.clone()],
                &reflected[part],
            );
        }
    });
    radiance
}

/// The rank of a pixel along the Morton curve.
fn interleaved_bits([x, y]: [u32; 2]) -> u32 {
    let spread = |n: u32| {
        let n = (n | n << 8) & 0x00ff_00ff;
        let n = (n | n << 4) & 0x0f0f_0f0f;
        let n = (n | n << 2) & 0x3333_3333;
        (n | n << 1) & 0x5555_5555
    };
    spread(x & 0xffff) | spread(y & 0xffff) << 1
}
