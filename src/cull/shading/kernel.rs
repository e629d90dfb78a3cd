//! The evaluation of one light at one point, in each lane.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::{LINE, LOBE, ShadingBatch, XI};
use super::receiver::ReceiverLanes;
use crate::cull::records::load_lines;
use crate::light::unit;
use crate::lobe::{FIRST_NUMBERS, Lobe, LobeNumbers};
use crate::num::{F32Lanes, Real, Single, Twice, Vector3};

/// What all evaluations of an estimator share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings<D> {
    pub decision: D,
    pub least_distance_squared: f32,
}

/// A light in each lane, without what its lobe has besides numbers.
pub struct Lights<N> {
    pub(in crate::cull) position: Vector3<N>,
    pub(in crate::cull) flux: N,
    pub(in crate::cull) xi: N,
    pub(in crate::cull) numbers: LobeNumbers<N>,
}

impl<S: Simd> Lights<F32Lanes<S>> {
    #[inline(always)]
    fn from_lines(simd: S, lines: [[F32Lanes<S>; LINE]; 2]) -> Self {
        let [first, second] = lines;
        let mut numbers = [F32Lanes::new(simd, 0.0); FIRST_NUMBERS + LINE];
        numbers[..FIRST_NUMBERS].copy_from_slice(&first[LOBE..XI]);
        numbers[FIRST_NUMBERS..].copy_from_slice(&second);
        Self {
            position: Vector3::new(first[0], first[1], first[2]),
            flux: first[3],
            xi: first[XI],
            numbers,
        }
    }

    /// The same light in each lane.
    #[inline(always)]
    pub fn broadcast<L: ShadedLight>(simd: S, batch: &ShadingBatch<L>, light: u32) -> Self {
        let lines = ShadingBatch::<L>::lines_per_light();
        let stored = &batch.lines[ShadingBatch::<L>::first_line(light)..][..lines];
        let mut vectors = [[F32Lanes::new(simd, 0.0); LINE]; 2];
        for (vectors, line) in vectors.iter_mut().zip(stored) {
            for (vector, number) in vectors.iter_mut().zip(line.0) {
                *vector = F32Lanes::new(simd, number);
            }
        }
        Self::from_lines(simd, vectors)
    }

    /// The lights with the first of `indices`, one in each lane.
    #[inline(always)]
    pub fn gathered<L: ShadedLight>(simd: S, batch: &ShadingBatch<L>, indices: &[u32]) -> Self {
        let mut vectors = [[F32Lanes::new(simd, 0.0); LINE]; 2];
        let lines = ShadingBatch::<L>::lines_per_light();
        for (line, vectors) in vectors[..lines].iter_mut().enumerate() {
            *vectors = load_lines(
                simd,
                #[inline(always)]
                |lane| &batch.lines[ShadingBatch::<L>::first_line(indices[lane]) + line],
            );
        }
        Self::from_lines(simd, vectors)
    }
}

impl<S: Simd> Lights<Twice<F32Lanes<S>>> {
    /// The lights with the first of `indices`, one in each lane of two vectors.
    #[inline(always)]
    pub fn gathered_twice<L: ShadedLight>(
        simd: S,
        batch: &ShadingBatch<L>,
        indices: &[u32],
    ) -> Self {
        let (first, second) = indices.split_at(S::f32s::LEN);
        let first = Lights::gathered(simd, batch, first);
        let second = Lights::gathered(simd, batch, second);
        let zero = F32Lanes::new(simd, 0.0);
        let mut numbers = [Twice(zero, zero); FIRST_NUMBERS + LINE];
        let used = FIRST_NUMBERS + LINE * (ShadingBatch::<L>::lines_per_light() - 1);
        let of_each = first.numbers.iter().zip(&second.numbers);
        for (both, (first, second)) in numbers[..used].iter_mut().zip(of_each) {
            *both = Twice(*first, *second);
        }
        Self {
            position: Vector3::new(
                Twice(first.position.x, second.position.x),
                Twice(first.position.y, second.position.y),
                Twice(first.position.z, second.position.z),
            ),
            flux: Twice(first.flux, second.flux),
            xi: Twice(first.xi, second.xi),
            numbers,
        }
    }
}

/// A point in each lane.
#[derive(Clone, Copy)]
pub struct Points<N> {
    pub(super) position: Vector3<N>,
    pub(super) normal: Vector3<N>,
}

/// What a light sends to a point in each lane, before it is decided whether that counts.
pub struct Arriving<S: Simd> {
    /// The lanes in which the light may arrive; at least one.
    pub(super) may_be_lit: S::mask32s,
    pub(super) intensity: F32Lanes<S>,
    pub(super) distance_squared: F32Lanes<S>,
    pub(super) direction: Vector3<F32Lanes<S>>,
    /// `None` for point lights, where it is infinite.
    pub(super) sharpness: Option<F32Lanes<S>>,
}

/// A light's estimate at a point in each lane.
pub struct Evaluated<S: Simd> {
    /// The bits of the lanes in which the light is accepted; at least one.
    pub(super) accepted: u32,
    /// Zero where the light is not accepted.
    pub(super) radiance: F32Lanes<S>,
    /// What the receiver reflects of the radiance. Zero where the light is not accepted, and without receivers.
    pub(super) reflected: F32Lanes<S>,
    pub(super) arriving: Arriving<S>,
}

impl<S: Simd> Evaluated<S> {
    /// The estimate `radiance`, which is zero where the light is not `accepted`, and what receivers reflect of it.
    #[inline(always)]
    pub fn reflecting(
        arriving: Arriving<S>,
        accepted: S::mask32s,
        radiance: F32Lanes<S>,
        receivers: &impl ReceiverLanes<S>,
    ) -> Self {
        let reflected = match receivers.value(&arriving) {
            Some(value) => {
                F32Lanes::select(radiance.is_positive(), radiance * value, radiance.zero())
            }
            None => radiance.zero(),
        };
        Self {
            accepted: accepted.to_bitmask() as u32,
            radiance,
            reflected,
            arriving,
        }
    }
}

/// What the lights of a [`ShadingBatch`](crate::ShadingBatch) are: a [`Lobe`], for the lights [`Vpl`](crate::Vpl)
/// with such a lobe, or [`Vsgl`](crate::Vsgl).
pub trait ShadedLight: Sized {
    /// The lines of numbers that a light takes.
    #[doc(hidden)]
    fn lines() -> usize;

    /// Evaluates what a light sends to a point in each lane, over a squared distance of at least `least`. `None` if
    /// it arrives in no lane, and if it is quick to see that its radiance is below `faintest` in all. `kept_of` gives
    /// what is kept of a lane's light beside its numbers.
    #[doc(hidden)]
    fn arriving<'a, S: Simd>(
        least: f32,
        faintest: Option<F32Lanes<S>>,
        lights: &Lights<F32Lanes<S>>,
        kept_of: impl Fn(usize) -> Option<&'a Self>,
        points: &Points<F32Lanes<S>>,
    ) -> Option<Arriving<S>>
    where
        Self: 'a;
}

impl<L: Lobe> ShadedLight for L {
    #[inline(always)]
    fn lines() -> usize {
        if L::numbers_in_use() > FIRST_NUMBERS {
            2
        } else {
            1
        }
    }

    #[inline(always)]
    fn arriving<'a, S: Simd>(
        least: f32,
        faintest: Option<F32Lanes<S>>,
        lights: &Lights<F32Lanes<S>>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        points: &Points<F32Lanes<S>>,
    ) -> Option<Arriving<S>>
    where
        Self: 'a,
    {
        arriving(least, faintest, lights, lobe_of, points)
    }
}

/// The square (16u)² of the sine below the horizon from which on rounding cannot lift a point above it.
const DARK_SINE_SQUARED: f32 = 9.094_947e-13;

/// Keeps the square of n·w away from where products underflow.
const LEAST_DARK_SQUARE: f32 = 1e-30;

/// Evaluates what a light sends to a point in each lane. `None` if it arrives in no lane, and if the lobe sees without a
/// division that its radiance is below `faintest` in all.
///
/// Direction and intensity are those of scalar code. Where every lane is dark, because the light faces away or is
/// below the point's horizon, there is neither a root nor a division.
#[inline(always)]
fn arriving<'a, S: Simd, L: Lobe + 'a>(
    least: f32,
    faintest: Option<F32Lanes<S>>,
    lights: &Lights<F32Lanes<S>>,
    lobe_of: impl Fn(usize) -> Option<&'a L>,
    points: &Points<F32Lanes<S>>,
) -> Option<Arriving<S>> {
    let way = points.position - lights.position;
    let length_squared = way.length_squared();
    let mut may_be_lit = !points.normal.dot(way).is_positive();
    if let Some(normal) = L::horizon_in_lanes(&lights.numbers) {
        let height = normal.near_dot(way);
        let least = length_squared.splat(-LEAST_DARK_SQUARE);
        let least = length_squared.times_plus(least.splat(-DARK_SINE_SQUARED), least);
        // False for NaN, which nothing accepts.
        may_be_lit &= (height * height.abs()).gt(least);
    }
    if !may_be_lit.any_true() {
        return None;
    }
    let is_fainter = faintest.and_then(
        #[inline(always)]
        |least| L::is_fainter_in_lanes(&lights.numbers, lights.flux, way, length_squared, least),
    );
    if let Some(is_fainter) = is_fainter {
        may_be_lit &= !is_fainter;
        if !may_be_lit.any_true() {
            return None;
        }
    }
    let direction = unit(way, length_squared);
    let intensity = lights.flux * L::value_in_lanes(&lights.numbers, lobe_of, direction);
    // NaN if the squared length is.
    let distance_squared = length_squared.splat(least).max(length_squared);
    Some(Arriving {
        may_be_lit,
        intensity,
        distance_squared,
        direction,
        sharpness: None,
    })
}
