//! Points with lists of their own, as pairs of a point and a light: one pair in each lane.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::batch::ShadingBatch;
use super::block::BlockEstimates;
use super::kernel::{Evaluated, Frame, Lights, Points, ShadedLight};
use super::point::{Estimate, ShadedPoint};
use super::receiver::reflected;
use crate::cull::lanes::{LANES, store};
use crate::lobe::{Lobe, LobeNumbers};
use crate::num::{F32Lanes, Real, Vector3};

/// As many lights of a list are copied at once.
const STEP: usize = 8;

/// The lobes of the points of all lanes, if they have any.
pub(super) trait ReceiverLanes<S: Simd> {
    /// What a point has of it.
    type One;

    fn new(simd: S) -> Self;

    /// Fills the lanes in `mask` with that of a point. The first of them is `start`.
    fn fill(&mut self, start: usize, mask: S::mask32s, one: &Self::One);

    /// The radiance that the point in each lane reflects.
    fn reflected(&self, arriving: &Evaluated<S>) -> F32Lanes<S>;
}

/// Points without a lobe, which reflect nothing.
pub(super) struct NoReceivers;

impl<S: Simd> ReceiverLanes<S> for NoReceivers {
    type One = ();

    #[inline(always)]
    fn new(_: S) -> Self {
        Self
    }

    #[inline(always)]
    fn fill(&mut self, _: usize, _: S::mask32s, (): &()) {}

    #[inline(always)]
    fn reflected(&self, arriving: &Evaluated<S>) -> F32Lanes<S> {
        arriving.radiance.zero()
    }
}

/// Points that each have a lobe of type `R`.
pub(super) struct Receivers<S: Simd, R> {
    numbers: LobeNumbers<F32Lanes<S>>,
    /// The lobes, if they are more than their numbers.
    lobes: [Option<R>; LANES],
}

impl<S: Simd, R: Lobe + Clone> ReceiverLanes<S> for Receivers<S, R> {
    type One = R;

    #[inline(always)]
    fn new(simd: S) -> Self {
        Self {
            numbers: [F32Lanes::new(simd, 0.0); _],
            lobes: [const { None }; LANES],
        }
    }

    #[inline(always)]
    fn fill(&mut self, start: usize, mask: S::mask32s, lobe: &R) {
        let used = &mut self.numbers[..R::numbers_in_use()];
        for (vector, number) in used.iter_mut().zip(lobe.numbers()) {
            *vector = F32Lanes::select(mask, vector.splat(number), *vector);
        }
        if R::has_more_than_numbers() {
            self.lobes[start..].fill(Some(lobe.clone()));
        }
    }

    #[inline(always)]
    fn reflected(&self, arriving: &Evaluated<S>) -> F32Lanes<S> {
        reflected::<S, R>(
            &self.numbers,
            #[inline(always)]
            |lane| self.lobes[lane].as_ref(),
            arriving,
        )
    }
}

/// Pairs that wait until each lane has one.
struct Pairs<S: Simd, R> {
    /// The light of each lane, and whatever light after the last.
    lights: [u32; 2 * LANES],
    /// The turn of each lane's point.
    turns: [usize; 2 * LANES],
    points: Points<F32Lanes<S>>,
    receivers: R,
    len: usize,
}

impl<S: Simd, R: ReceiverLanes<S>> Pairs<S, R> {
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
            receivers: R::new(simd),
            len: 0,
        }
    }

    /// Fills lanes with the point and the first lights of `list`. Returns the others.
    #[inline(always)]
    fn fill<'a>(
        &mut self,
        simd: S,
        turn: usize,
        (point, receiver): (&ShadedPoint, &R::One),
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
        self.receivers.fill(start, from_start, receiver);
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
        each: &mut impl FnMut(A, usize, &Estimate, f32) -> A,
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
        let mut reflected = [0.0; LANES];
        store(&mut reflected, 0, self.receivers.reflected(&found));
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
            let (turn, reflected) = (self.turns[lane], reflected[lane]);
            state = each(state, turn, &estimates.estimate(lane), reflected);
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

/// Folds the estimates of the lights that points accept, each with the turn of its point and what the point
/// reflects: point by point, and in the order of their lists.
#[inline(always)]
pub(super) fn fold_pairs<'l, S: Simd, L: ShadedLight, R: ReceiverLanes<S>, A>(
    simd: S,
    frame: &Frame,
    lights: &ShadingBatch<L>,
    points: impl Iterator<Item = (ShadedPoint, R::One, &'l [u32])>,
    mut state: A,
    mut each: impl FnMut(A, usize, &Estimate, f32) -> A,
) -> A {
    let mut pairs = Pairs::<S, R>::new(simd);
    for (turn, (point, receiver, list)) in points.enumerate() {
        let mut rest = list;
        while !rest.is_empty() {
            rest = pairs.fill(simd, turn, (&point, &receiver), rest);
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
