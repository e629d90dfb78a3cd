use alloc::vec::Vec;
use core::borrow::Borrow;
use core::marker::PhantomData;

use fearless_simd::{Simd, SimdBase, SimdMask, dispatch};

use super::culler::widest;
use super::lanes::{LANES, compress, write_chosen};
use super::records::{
    Line, fields_of_record, lines_for, load_records, record, record_mut, store_records,
};
use crate::num::{F32Lanes, Twice};
use crate::project::Projected;
use crate::view::ViewBounds;

/// Projected lights, as a [`Culler`](super::Culler) takes them: 92 bytes each, or 60 for spheres.
///
/// A [`BatchBuilder`](super::BatchBuilder) adds many lights at a time, from lights or kept bounds;
/// [`push`](Self::push) adds one that is projected already. Keeps its memory when cleared.
///
/// Lists hold their lights in the order of the batch. Any order is as fast.
///
/// ```
/// use stochastic_light_culling::{Camera, LightBatch, Sphere, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let mut batch = LightBatch::new();
/// for light in 0..100 {
///     let sphere = Sphere::new(Vec3::new(0.0, 0.0, -0.5 * light as f32), 1.0)?;
///     batch.extend(sphere.project(&camera).map(|shape| (light, shape)));
/// }
/// assert_eq!(batch.len(), 100);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
///
/// The type of shape follows from the lobe of the lights:
///
/// ```
/// use stochastic_light_culling::{
///     BatchBuilder, Bounded, Seed, LightBatch, Project, ProjectedBound, Vpl,
/// };
///
/// /// For lights that are new in each frame.
/// fn batch_of<L: Bounded<Shape: Project>>(
///     lights: &[Vpl<L>],
///     builder: &BatchBuilder,
/// ) -> LightBatch<ProjectedBound<L>> {
///     let mut batch = LightBatch::new();
///     let seed = Seed(0).frame(0);
///     let with_xi = (0..).zip(lights).map(|(i, light)| (i, light, seed.xi(i)));
///     builder.add(with_xi, &mut batch);
///     batch
/// }
///
/// /// For lights whose unit bounds are kept, here all with the same scale.
/// fn batch_of_bounds<L: Bounded<Shape: Project>>(
///     lights: &[(Vpl<L>, L::Shape)],
///     builder: &BatchBuilder,
///     scale: f32,
/// ) -> LightBatch<ProjectedBound<L>> {
///     let mut batch = LightBatch::new();
///     let lights = (0..).zip(lights);
///     let placed = lights.map(|(i, (light, bound))| (i, bound, light.position(), scale));
///     builder.add_placed(placed, &mut batch);
///     batch
/// }
/// ```
#[derive(Clone, Debug)]
pub struct LightBatch<P: Projected> {
    len: usize,
    /// The records of the lights. Longer than `len` takes, so that lights can be written before they are counted.
    lines: Vec<Line>,
    /// The bounds of each shape once more, an array for each end: the order of [`ViewBounds`]. Most lights are
    /// rejected by these alone, so that their records are never read.
    pub(super) bounds: [Vec<f32>; ENDS],
    /// The index of each light.
    lights: Vec<u32>,
    shape: PhantomData<P>,
}

/// The number of ends of the three ranges of bounds.
const ENDS: usize = 6;

impl<P: Projected> LightBatch<P> {
    /// Creates an empty batch. Does not allocate.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            len: 0,
            lines: Vec::new(),
            bounds: [const { Vec::new() }; ENDS],
            lights: Vec::new(),
            shape: PhantomData,
        }
    }

    /// The number of lights.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether the batch holds no lights.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Removes all lights and keeps the memory.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Adds a light: its index `light`, which lists will hold, and its projected `shape`.
    ///
    /// All shapes must be projected with the camera whose tiles are culled.
    #[inline]
    pub fn push(&mut self, light: u32, shape: &P) {
        self.extend([(light, shape)]);
    }

    /// Iterates over the indices and shapes of the lights, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (u32, P)> {
        let records = (0..self.len).map_while(|place| self.record(place));
        let shapes = records.map(|record| P::from_fields(fields_of_record::<P>(record)));
        self.lights().iter().copied().zip(shapes)
    }

    /// Adds two vectors of lights, of which those in `chosen` are kept: their indices and fields. There must be
    /// [room](Self::make_room).
    #[inline(always)]
    pub(super) fn append<S: Simd>(
        &mut self,
        simd: S,
        Twice(first, second): Twice<S::mask32s>,
        lights: &[u32],
        fields: &P::Fields<Twice<F32Lanes<S>>>,
    ) {
        let lanes = S::f32s::LEN;
        let (start, end) = (self.len, self.len + 2 * lanes);
        let lights = &lights[..2 * lanes];
        let places = &mut self.lights[start..end];
        let bounds = self.bounds.iter_mut().map(|ends| &mut ends[start..end]);
        let bounds = bounds.zip(ends(P::bounds_of(fields)));
        let mut count = lanes;
        // Most vectors are full.
        if (first & second).all_true() {
            places.copy_from_slice(lights);
            for (ends, Twice(a, b)) in bounds {
                a.0.store_slice(&mut ends[..lanes]);
                b.0.store_slice(&mut ends[lanes..]);
            }
            self.len = end;
        } else {
            let load = |lights: &[u32]| S::u32s::from_slice(simd, lights);
            count = write_chosen::<S>(load(&lights[..lanes]), first, places).min(lanes);
            let numbers = load(&lights[lanes..]);
            self.len += count + write_chosen::<S>(numbers, second, &mut places[count..]);
            for (ends, Twice(a, b)) in bounds {
                compress::<S>(a, first).store_slice(&mut ends[..lanes]);
                compress::<S>(b, second).store_slice(&mut ends[count..count + lanes]);
            }
        }
        // Last, since it branches: what is computed for it is found by then.
        let (lines, fields) = (&mut self.lines[..], fields.as_ref().iter());
        let of_first = fields.clone().map(|field| field.0);
        store_records::<S, P>(simd, of_first, first, lines, start);
        let of_second = fields.map(|field| field.1);
        store_records::<S, P>(simd, of_second, second, lines, start + count);
    }

    #[inline(always)]
    fn add<Q: Borrow<P>>(&mut self, lights: impl Iterator<Item = (u32, Q)>) {
        let mut end = self.len;
        for (light, shape) in lights {
            self.make_room(end + 1);
            let fields = shape.borrow().to_fields();
            record_mut::<P>(&mut self.lines, end).copy_from_slice(&fields.as_ref()[..P::STORED]);
            self.lights[end] = light;
            end += 1;
            // While the records are in the cache.
            if end == self.len + GROUP {
                self.count(end);
            }
        }
        self.count(end);
    }

    /// Counts the lights up to `end`, whose records are written.
    fn count(&mut self, end: usize) {
        dispatch!(widest(), simd => self.copy_bounds(simd, end));
        self.len = end;
    }

    /// Copies the bounds of the lights from `len` to `end` out of their records.
    #[inline(always)]
    fn copy_bounds<S: Simd>(&mut self, simd: S, end: usize) {
        for first in (self.len..end).step_by(S::f32s::LEN) {
            let fields = load_records::<S, P>(simd, |lane| {
                self.record(first + lane).expect("there is room")
            });
            for (ends, end) in self.bounds.iter_mut().zip(ends(P::bounds_of(&fields))) {
                end.0.store_slice(&mut ends[first..][..S::f32s::LEN]);
            }
        }
    }

    /// The bounds of as many lights as a vector has lanes, from place `first` on. Arbitrary past the last light.
    #[inline(always)]
    pub(super) fn bounds<S: Simd>(&self, simd: S, first: usize) -> ViewBounds<F32Lanes<S>> {
        let [left, right, bottom, top, near, far] = &self.bounds;
        let load =
            |ends: &[f32]| F32Lanes(S::f32s::from_slice(simd, &ends[first..][..S::f32s::LEN]));
        ViewBounds {
            across: [load(left), load(right)],
            down: [load(bottom), load(top)],
            depths: [load(near), load(far)],
        }
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub(super) fn bytes(&self) -> usize {
        let bounds = self.bounds.iter().map(|ends| size_of_val(&ends[..]));
        size_of_val(&self.lines[..]) + bounds.sum::<usize>() + size_of_val(&self.lights[..])
    }

    /// The record of the light at `place`. `None` for a place far past the last light; arbitrary near it.
    #[inline(always)]
    pub(super) fn record(&self, place: usize) -> Option<&[f32]> {
        record::<P>(&self.lines, place)
    }

    /// The index of each light.
    pub(super) fn lights(&self) -> &[u32] {
        &self.lights[..self.len]
    }

    /// Makes room for `count` lights in all, and for a vector after them.
    #[inline(always)]
    pub(super) fn make_room(&mut self, count: usize) {
        let room = count + LANES;
        if self.lights.len() < room {
            self.grow(room);
        }
    }

    /// Not inlined: beside its calls, the numbers of vectors would not stay in registers.
    #[cold]
    #[inline(never)]
    fn grow(&mut self, room: usize) {
        grow(&mut self.lights, room, 0);
        let room = self.lights.len();
        self.lines.resize(lines_for::<P>(room), Line::ZERO);
        for ends in &mut self.bounds {
            ends.resize(room, 0.0);
        }
    }
}

/// The ends of bounds, in the order in which a batch has them.
#[inline(always)]
fn ends<N>(bounds: ViewBounds<N>) -> [N; ENDS] {
    let ViewBounds {
        across: [left, right],
        down: [bottom, top],
        depths: [near, far],
    } = bounds;
    [left, right, bottom, top, near, far]
}

impl<P: Projected> Default for LightBatch<P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P: Projected> Extend<(u32, P)> for LightBatch<P> {
    fn extend<I: IntoIterator<Item = (u32, P)>>(&mut self, lights: I) {
        self.add(lights.into_iter());
    }
}

/// Copies each shape once less.
impl<'a, P: Projected + 'a> Extend<(u32, &'a P)> for LightBatch<P> {
    fn extend<I: IntoIterator<Item = (u32, &'a P)>>(&mut self, lights: I) {
        self.add(lights.into_iter());
    }
}

/// Lights whose bounds are copied together.
const GROUP: usize = 4 * LANES;

/// The least number of values that a buffer has room for.
const LEAST_ROOM: usize = 32;

/// Makes room for `len` values. Where the vector must grow, it grows by half as many again, since the number
/// that a frame needs is random.
#[inline(always)]
pub(super) fn grow<V: Copy>(values: &mut Vec<V>, len: usize, value: V) {
    if values.len() < len {
        // Small numbers of lights vary most.
        values.resize((len + len / 2).max(LEAST_ROOM), value);
    }
}
