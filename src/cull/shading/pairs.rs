//! Points with lists of their own, as pairs of a point and a light: one pair in each lane.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::batch::ShadingBatch;
use super::block::BlockEstimates;
use super::decision::{Decision, Drawn, LightList};
use super::kernel::{Arriving, Lights, Points, Settings, ShadedLight};
use super::point::{Estimate, ShadedPoint};
use super::receiver::{NoReceivers, ReceiverLanes, value};
use crate::cull::lanes::{LANES, store};
use crate::cull::receivers::WeightedList;
use crate::lobe::{Lobe, LobeNumbers};
use crate::num::{F32Lanes, Real, Single, Vector3};

/// As many lights of a list are copied at once.
const STEP: usize = 8;

/// The lobes of the points of all lanes, if they have any, filled point by point.
pub(super) trait FilledLanes<S: Simd>: ReceiverLanes<S> {
    /// What a point has of it.
    type One;

    fn new(simd: S) -> Self;

    /// Fills the lanes in `mask` with that of a point. The first of them is `start`.
    fn fill(&mut self, start: usize, mask: S::mask32s, one: &Self::One);
}

impl<S: Simd> FilledLanes<S> for NoReceivers {
    type One = ();

    #[inline(always)]
    fn new(_: S) -> Self {
        Self
    }

    #[inline(always)]
    fn fill(&mut self, _: usize, _: S::mask32s, (): &()) {}
}

/// Points that each have a lobe of type `R`.
pub(super) struct Receivers<S: Simd, R> {
    numbers: LobeNumbers<F32Lanes<S>>,
    /// The lobes, if they are more than their numbers.
    lobes: [Option<R>; LANES],
}

impl<S: Simd, R: Lobe + Clone> FilledLanes<S> for Receivers<S, R> {
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
}

impl<S: Simd, R: Lobe> ReceiverLanes<S> for Receivers<S, R> {
    #[inline(always)]
    fn value(&self, arriving: &Arriving<S>) -> Option<F32Lanes<S>> {
        Some(value::<S, R>(
            &self.numbers,
            #[inline(always)]
            |lane| self.lobes[lane].as_ref(),
            arriving,
        ))
    }
}

/// The points of pairs that wait until each lane has one.
///
/// Apart from [`ListLanes`], which is in memory since a list may begin at any lane: in one structure with it these
/// vectors would be in memory, too, and a vector that is written in parts is slow to read.
struct PointLanes<S: Simd, R> {
    points: Points<F32Lanes<S>>,
    receivers: R,
}

/// What lists say of these pairs.
struct ListLanes {
    /// The light of each lane, and whatever light after the last.
    lights: [u32; 2 * LANES],
    /// The weight of each lane's light, if lists have weights.
    weights: [f32; 2 * LANES],
    /// The turn of each lane's point.
    turns: [usize; 2 * LANES],
    len: usize,
    /// What was evaluated last.
    estimates: BlockEstimates,
}

impl<S: Simd, R: FilledLanes<S>> PointLanes<S, R> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let zero = Vector3::splat(F32Lanes::new(simd, 0.0), Vec3::ZERO.into());
        Self {
            points: Points {
                position: zero,
                normal: zero,
            },
            receivers: R::new(simd),
        }
    }

    /// Fills the lanes from `start` on with the point.
    #[inline(always)]
    fn fill(&mut self, simd: S, start: usize, (point, receiver): (&ShadedPoint, &R::One)) {
        let from_start = mask_from::<S>(simd, start);
        let zero = F32Lanes::new(simd, 0.0);
        let position = Vector3::splat(zero, point.position.into());
        let normal = Vector3::splat(zero, point.normal.into());
        self.points = Points {
            position: Vector3::select(from_start, position, self.points.position),
            normal: Vector3::select(from_start, normal, self.points.normal),
        };
        self.receivers.fill(start, from_start, receiver);
    }
}

impl ListLanes {
    fn new() -> Self {
        Self {
            lights: [0; 2 * LANES],
            weights: [1.0; 2 * LANES],
            turns: [0; 2 * LANES],
            len: 0,
            estimates: BlockEstimates::NONE,
        }
    }

    /// Fills the lanes from `start` on with the first lights of `list`, which is that of the point of this turn.
    /// Returns the others.
    #[inline(always)]
    fn fill<'a, S: Simd, D: Decision>(
        &mut self,
        start: usize,
        turn: usize,
        list: WeightedList<'a>,
    ) -> WeightedList<'a> {
        let WeightedList {
            lights,
            mut weights,
        } = list;
        let count = lights.len().min(S::f32s::LEN - start);
        let (taken, lights) = lights.split_at(count);
        copy(taken, &mut self.lights[start..]);
        if D::HAS_WEIGHTS {
            let taken;
            (taken, weights) = weights.split_at(count);
            copy(taken, &mut self.weights[start..]);
        }
        self.turns[start..][..S::f32s::LEN].fill(turn);
        self.len = start + count;
        WeightedList { lights, weights }
    }

    /// Evaluates the pairs, and folds those that are accepted into `state`.
    #[inline(always)]
    fn evaluate<S: Simd, D: Decision, L: ShadedLight, A>(
        &mut self,
        simd: S,
        point_lanes: &PointLanes<S, impl FilledLanes<S>>,
        settings: &Settings<D>,
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
        let arriving = L::arriving(
            settings.least_distance_squared,
            // With other lights and points in each lane, one of them counts nearly always.
            None,
            &gathered,
            lobe_of,
            &point_lanes.points,
        );
        let decided = arriving.and_then(
            #[inline(always)]
            |arriving| {
                let drawn = Drawn {
                    xi: gathered.xi,
                    weight: gathered.xi.load(&self.weights),
                };
                settings
                    .decision
                    .decide(arriving, drawn, &point_lanes.receivers)
            },
        );
        let Some(found) = decided else {
            return state;
        };
        let mut reflected = [0.0; LANES];
        store(&mut reflected, 0, found.reflected);
        self.estimates.store(0, &found);
        let mut accepted = found.accepted & filled;
        while accepted != 0 {
            let lane = accepted.trailing_zeros() as usize % LANES;
            accepted &= accepted - 1;
            self.estimates.light = self.lights[lane];
            let (turn, reflected) = (self.turns[lane], reflected[lane]);
            state = each(state, turn, &self.estimates.estimate(lane), reflected);
        }
        state
    }
}

/// Copies `from`, which is not longer than `to`, to the front of `to`. What comes after it may change too.
///
/// As many are written whatever the length, which no branch predictor knows.
#[inline(always)]
fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    let steps = to.chunks_exact_mut(STEP).take(from.len().div_ceil(STEP));
    for (step, to) in steps.enumerate() {
        for (i, to) in to.iter_mut().enumerate() {
            *to = from[(step * STEP + i).min(from.len() - 1)];
        }
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
pub(super) fn fold_pairs<'l, S: Simd, D: Decision, L: ShadedLight, R: FilledLanes<S>, A>(
    simd: S,
    settings: &Settings<D>,
    lights: &ShadingBatch<L>,
    points: impl Iterator<Item = (ShadedPoint, R::One, D::List<'l>)>,
    mut state: A,
    mut each: impl FnMut(A, usize, &Estimate, f32) -> A,
) -> A {
    let (mut pairs, mut pair_points) = (ListLanes::new(), PointLanes::<S, R>::new(simd));
    for (turn, (point, receiver, list)) in points.enumerate() {
        let mut rest = list.with_any_weights();
        while !rest.lights.is_empty() {
            let start = pairs.len % LANES;
            pair_points.fill(simd, start, (&point, &receiver));
            rest = pairs.fill::<S, D>(start, turn, rest);
            if pairs.len == S::f32s::LEN {
                state = pairs.evaluate(simd, &pair_points, settings, lights, state, &mut each);
            }
        }
    }
    if pairs.len > 0 {
        state = pairs.evaluate(simd, &pair_points, settings, lights, state, &mut each);
    }
    state
}
