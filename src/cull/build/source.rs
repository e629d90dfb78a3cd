//! What shapes are made of: lights, and bounds with the places that they are put in.

use core::ops::Range;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask};
use glam::Vec3;

use super::vector::round_up;
use super::view::{Seen, View};
use crate::cull::LightBatch;
use crate::cull::batch::Chunk;
use crate::cull::lanes::{LANES, load_fours, parts, splat, store};
use crate::cull::shape::{InLanes, Lane};
use crate::{BatchShape, Roulette, Xi};

/// Something that shapes are made of, sixteen at a time.
pub trait Source: Copy {
    type Light;
    type Given: Given;
    type Shape: BatchShape;
    /// How many fours of numbers a light has.
    type Fours: Count;
    /// What a light has besides numbers.
    type Rest: Copy;

    fn numbers(light: &Self::Light, given: Self::Given) -> FoursOf<Self, [f32; 4]>;
    fn rest(light: &Self::Light) -> Self::Rest;

    /// Whether a light may reach somewhere. That is but a guess, which spares the work on those that do
    /// not.
    fn may_reach(light: &Self::Light, given: Self::Given) -> bool;

    /// The shapes of lights, and which of them are shapes of lights that reach somewhere.
    fn shapes<S: Simd>(
        simd: S,
        numbers: &FoursOf<Self, [S::f32s; 4]>,
        given: S::f32s,
        rest: &[Self::Rest],
        frame: &Frame,
    ) -> (OfShape<S, Self::Shape>, S::mask32s);
}

/// The fours of a light, each of type `T`.
pub type FoursOf<L, T> = <<L as Source>::Fours as Count>::Of<T>;

/// So many of anything.
pub trait Count {
    type Of<T: Lane>: Lane + AsRef<[T]> + AsMut<[T]>;

    fn of<T: Lane>(value: T) -> Self::Of<T>;
}

/// `N` fours.
pub struct Fours<const N: usize>;

impl<const N: usize> Count for Fours<N> {
    type Of<T: Lane> = [T; N];

    fn of<T: Lane>(value: T) -> [T; N] {
        [value; N]
    }
}

/// What a light is given besides in a frame: its ξ, or where a bound is put.
pub trait Given: Copy {
    /// ξ, or the scale.
    fn number(self) -> f32;
}

impl Given for Xi {
    #[inline]
    fn number(self) -> f32 {
        self.get()
    }
}

/// The position and the scale that a bound is placed with.
pub(super) type Place = (Vec3, f32);

impl Given for Place {
    #[inline]
    fn number(self) -> f32 {
        self.1
    }
}

pub(super) type OfShape<S, T> = Seen<S, <T as InLanes>::Fields<<S as Simd>::f32s>>;

/// What all lights of a frame share.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub(super) roulette: Roulette,
    pub(super) view: View,
}

/// How many chunks are made in a row: while one waits for its roots, the next can begin.
const CHUNKS: usize = u64::BITS as usize / LANES;
/// The lights of a group, as many as an integer has bits.
pub(super) const GROUP: usize = CHUNKS * LANES;

/// Lights, and the shapes that are made of them.
#[repr(C, align(64))]
pub(super) struct Group<T: Source> {
    /// Light by light, since four numbers are copied at once.
    numbers: FoursOf<T, [[f32; 4]; GROUP]>,
    given: [f32; GROUP],
    rest: [T::Rest; GROUP],
    names: [u32; GROUP],
    made: [Made<T::Shape>; CHUNKS],
}

/// Shapes of sixteen lights.
#[derive(Clone, Copy)]
struct Made<T: BatchShape> {
    chunk: Chunk<T>,
    /// Those that have a shape, as bits, and the depths that these reach.
    shaped: u32,
    reach: [f32; 2],
}

impl<T: Source> Group<T> {
    /// `light` in all lanes.
    pub fn splat(light: &T::Light, given: T::Given) -> Self {
        let mut numbers = T::Fours::of([[0.0; 4]; GROUP]);
        let of_light = T::numbers(light, given);
        for (lanes, four) in numbers.as_mut().iter_mut().zip(of_light.as_ref()) {
            *lanes = [*four; GROUP];
        }
        let none = Made {
            chunk: Chunk::NOWHERE,
            shaped: 0,
            reach: [0.0; 2],
        };
        Self {
            numbers,
            given: [given.number(); GROUP],
            rest: [T::rest(light); GROUP],
            names: [0; GROUP],
            made: [none; CHUNKS],
        }
    }

    /// Puts a light in `lane` < [`GROUP`].
    #[inline]
    pub fn set(&mut self, lane: usize, name: u32, light: &T::Light, given: T::Given) {
        let lane = lane % GROUP;
        let numbers = self.numbers.as_mut().iter_mut();
        for (lanes, four) in numbers.zip(T::numbers(light, given).as_ref()) {
            lanes[lane] = *four;
        }
        self.given[lane] = given.number();
        self.rest[lane] = T::rest(light);
        self.names[lane] = name;
    }

    /// Makes the shapes of these lanes, at least one.
    #[inline(always)]
    pub fn shape<S: Simd>(&mut self, simd: S, lanes: &Range<usize>, frame: &Frame) {
        // From bit 0, which is the first lane.
        let wanted = (u64::MAX >> (GROUP - lanes.end)) & (u64::MAX << lanes.start);
        for chunk in 0..lanes.end.div_ceil(LANES) {
            self.shape_chunk(simd, chunk, wanted, frame);
        }
    }

    #[inline(always)]
    fn shape_chunk<S: Simd>(&mut self, simd: S, chunk: usize, wanted: u64, frame: &Frame) {
        let zero = S::f32s::splat(simd, 0.0);
        let [mut nearest, mut farthest] = splat(simd, [f32::INFINITY, f32::NEG_INFINITY]);
        let made = &mut self.made[chunk];
        made.shaped = 0;
        for part in 0..parts::<S>() {
            let first = chunk * LANES + part * S::f32s::LEN;
            let mut numbers = T::Fours::of([zero; 4]);
            for (vectors, lanes) in numbers.as_mut().iter_mut().zip(self.numbers.as_ref()) {
                *vectors = load_fours(simd, &lanes[first..][..S::f32s::LEN]);
            }
            let rest = &self.rest[first..][..S::f32s::LEN];
            let given = S::f32s::from_slice(simd, &self.given[first..][..S::f32s::LEN]);
            let (seen, somewhere) = T::shapes(simd, &numbers, given, rest, frame);
            let fields = made.chunk.fields.as_mut().iter_mut();
            for (lanes, vector) in fields.zip(seen.fields.as_ref()) {
                store::<S>(lanes, part, *vector);
            }

            let of_part = (wanted >> first) & ((1 << S::f32s::LEN) - 1);
            let shaped = somewhere & S::mask32s::from_bitmask(simd, of_part);
            let [near, far] = seen.reach;
            nearest = shaped.select(nearest.min(near), nearest);
            farthest = shaped.select(farthest.max(far), farthest);
            made.shaped |= (shaped.to_bitmask() as u32) << (part * S::f32s::LEN);
        }
        made.reach = [nearest.reduce_min(), farthest.reduce_max()];
        let names = &self.names[chunk * LANES..][..LANES];
        made.chunk.numbers.copy_from_slice(names);
    }

    /// Adds the shapes that were made of the lanes before `end` to `batch`.
    #[inline(always)]
    pub fn append_to(&self, batch: &mut LightBatch<T::Shape>, end: usize) {
        for made in &self.made[..end.div_ceil(LANES)] {
            batch.append(&made.chunk, made.shaped, made.reach);
        }
    }
}

/// [`Roulette::scale`].
#[inline(always)]
pub(super) fn scale<S: Simd>(simd: S, roulette: &Roulette, flux: S::f32s, xi: S::f32s) -> S::f32s {
    let zero = S::f32s::splat(simd, 0.0);
    let radius = flux.sqrt() / (xi.sqrt() * roulette.delta_root());
    let normal = round_up::<S>(radius, 5)
        .max(f32::MIN_POSITIVE)
        .min(f32::MAX);
    flux.simd_gt(zero).select(normal, zero)
}

/// A vector and one number more.
#[inline(always)]
pub(super) fn four(v: Vec3, number: f32) -> [f32; 4] {
    [v.x, v.y, v.z, number]
}
