//! Points with lists of their own, as pairs of a point and a light: one pair in each lane.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::batch::ShadingBatch;
use super::block::BlockEstimates;
use super::kernel::{Frame, Lights, Points, ShadedLight};
use super::point::{Estimate, ShadedPoint};
use crate::cull::lanes::{LANES, store};
use crate::num::{F32Lanes, Vector3};

/// As many lights of a list are copied at once.
const STEP: usize = 8;

/// Pairs that wait until each lane has one.
struct Pairs<S: Simd> {
    /// The light of each lane, and whatever light after the last.
    lights: [u32; 2 * LANES],
    /// The turn of each lane's point.
    turns: [usize; 2 * LANES],
    points: Points<F32Lanes<S>>,
    len: usize,
}

impl<S: Simd> Pairs<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = Vector3::splat(F32Lanes::new(simd, 0.0), Vec3::ZERO.into());
        Self {
            lights: [0; 2 * LANES],
            turns: [0; 2 * LANES],
            points: Points {
                position: zero,
                normal: zero,
            },
            len: 0,
        }
    }

    /// Fills lanes with the point and the first lights of `list`. Returns the others.
    #[inline(always)]
    fn fill<'a>(
        &mut self,
        simd: S,
        turn: usize,
        point: &ShadedPoint,
        list: &'a [u32],
    ) -> &'a [u32] {
        let start = self.len % LANES;
        let (taken, rest) = list.split_at(list.len().min(S::f32s::LEN - start));
        // As many are written whatever the length of the list, which no branch predictor knows.
        let lanes = self.lights[start..].chunks_exact_mut(STEP);
        for (step, lanes) in lanes.take(taken.len().div_ceil(STEP)).enumerate() {
            for (i, lane) in lanes.iter_mut().enumerate() {
                *lane = taken[(step * STEP + i).min(taken.len() - 1)];
            }
        }
        self.turns[start..][..LANES].fill(turn);
        let from_start = mask_from::<S>(simd, start);
        let zero = F32Lanes::new(simd, 0.0);
        let Points { position, normal } = &mut self.points;
        for (vector, new) in [(position, point.position), (normal, point.normal)] {
            *vector = Vector3::select(from_start, Vector3::splat(zero, new.into()), *vector);
        }
        self.len = start + taken.len();
        rest
    }

    /// Evaluates the pairs, and folds those that are accepted into `state`.
    #[inline(always)]
    fn evaluate<L: ShadedLight, A>(
        &mut self,
        simd: S,
        frame: &Frame,
        lights: &ShadingBatch<L>,
        mut state: A,
        each: &mut impl FnMut(A, usize, &Estimate) -> A,
    ) -> A {
        let filled = u32::MAX >> (u32::BITS as usize - self.len);
        if self.len < S::f32s::LEN {
            // Any light, but one that there is.
            let light = self.lights[0];
            self.lights[self.len..].fill(light);
        }
        self.len = 0;
        let gathered = Lights::gathered(simd, lights, &self.lights);
        let lobe_of = |lane: usize| lights.lobes.get(self.lights[lane] as usize);
        let Some(found) = L::evaluate(frame, &gathered, lobe_of, &self.points) else {
            return state;
        };
        let mut estimates = BlockEstimates::NONE;
        store(&mut estimates.radiance, 0, found.radiance);
        store(&mut estimates.intensity, 0, found.intensity);
        store(&mut estimates.distance_squared, 0, found.distance_squared);
        let Vector3 { x, y, z } = found.direction;
        for (lanes, vector) in estimates.direction.iter_mut().zip([x, y, z]) {
            store(lanes, 0, vector);
        }
        if let Some(sharpness) = found.sharpness {
            store(&mut estimates.sharpness, 0, sharpness);
        }
        let mut accepted = found.accepted & filled;
        while accepted != 0 {
            let lane = accepted.trailing_zeros() as usize % LANES;
            accepted &= accepted - 1;
            estimates.light = self.lights[lane];
            state = each(state, self.turns[lane], &estimates.estimate(lane));
        }
        state
    }
}

/// The lanes from `start` on.
#[inline(always)]
fn mask_from<S: Simd>(simd: S, start: usize) -> S::mask32s {
    use fearless_simd::SimdMask;
    let lanes = u64::MAX >> (u64::BITS as usize - S::f32s::LEN);
    S::mask32s::from_bitmask(simd, (u64::MAX << start) & lanes)
}

/// Folds the estimates of the lights that points accept, each with the turn of its point: point by point, and in
/// the order of their lists.
#[inline(always)]
pub(super) fn fold_pairs<'l, S: Simd, L: ShadedLight, A>(
    simd: S,
    frame: &Frame,
    lights: &ShadingBatch<L>,
    points: impl Iterator<Item = (ShadedPoint, &'l [u32])>,
    mut state: A,
    mut each: impl FnMut(A, usize, &Estimate) -> A,
) -> A {
    let mut pairs = Pairs::new(simd);
    for (turn, (point, list)) in points.enumerate() {
        let mut rest = list;
        while !rest.is_empty() {
            rest = pairs.fill(simd, turn, &point, rest);
            if pairs.len == S::f32s::LEN {
                state = pairs.evaluate(simd, frame, lights, state, &mut each);
            }
        }
    }
    if pairs.len > 0 {
        state = pairs.evaluate(simd, frame, lights, state, &mut each);
    }
    state
}
