//! The lights whose bounds touch each part of an area.
//!
//! The *place* of a light is its position in the batch.

use alloc::vec::Vec;

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::LightBatch;
use super::batch::grow;
use super::lanes::{
    LANES, Lanes, load_indices, mask_of_first, numbers_from, parts as vectors, splat, write_chosen,
};
use super::records::load_records;
use super::tile_depths::NONE;
use crate::num::F32Lanes;
use crate::project::Projected;
use crate::touch::BoxTest;
use crate::view::{ViewBounds, meet};

/// The place of no light.
const NO_PLACE: u32 = u32::MAX;

/// The places of the lights of a chunk. [`NO_PLACE`] where there are fewer than sixteen.
#[derive(Clone, Copy)]
pub(super) struct Places(pub Lanes<u32>);

impl Places {
    /// Iterates over chunks of `places`.
    #[inline(always)]
    pub fn chunks(places: &[u32]) -> impl Iterator<Item = Self> {
        places.chunks(LANES).map(
            #[inline(always)]
            |chunk| {
                // A copy of known length is a move of a register.
                if let Ok(full) = chunk.try_into() {
                    return Self(full);
                }
                let mut lanes = [NO_PLACE; LANES];
                lanes[..chunk.len()].copy_from_slice(chunk);
                Self(lanes)
            },
        )
    }

    /// The places of the `part`-th vector.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S, part: usize) -> S::u32s {
        load_indices(simd, &self.0, part)
    }

    /// The fields of the lights of the `part`-th vector. Where there is no light, those of `nowhere`.
    #[inline(always)]
    pub fn load_fields<S: Simd, P: Projected>(
        &self,
        simd: S,
        batch: &LightBatch<P>,
        nowhere: &P::Fields<f32>,
        part: usize,
    ) -> P::Fields<F32Lanes<S>> {
        let nowhere = &nowhere.as_ref()[..P::STORED];
        load_records::<S, P>(
            simd,
            #[inline(always)]
            |lane| {
                let place = self.0[part * S::f32s::LEN + lane];
                batch.record(place as usize).unwrap_or(nowhere)
            },
        )
    }

    /// The indices of the lights.
    #[inline(always)]
    pub fn lights<P: Projected>(&self, batch: &LightBatch<P>) -> Lanes<u32> {
        let mut lights = [0; LANES];
        for (light, place) in lights.iter_mut().zip(self.0) {
            *light = *batch.lights().get(place as usize).unwrap_or(&0);
        }
        lights
    }
}

/// Upper limit of the columns and of the rows of parts.
pub(super) const MAX_SIDE: usize = 4;

/// A grid of parts of an area.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    /// The number of columns and of rows.
    pub size: [usize; 2],
    /// The slopes x/z of each column.
    pub across: Ranges<MAX_SIDE>,
    /// The slopes y/z of each row.
    pub down: Ranges<MAX_SIDE>,
    /// The depths of each part, row by row.
    pub depths: Ranges<{ MAX_SIDE * MAX_SIDE }>,
}

/// Ranges, in the layout in which an end is loaded to all lanes fastest.
#[derive(Clone, Copy)]
pub(super) struct Ranges<const K: usize> {
    least: [f32; K],
    greatest: [f32; K],
}

impl<const K: usize> Ranges<K> {
    /// Ranges that hold nothing.
    pub const NONE: Self = Self {
        least: [NONE[0]; K],
        greatest: [NONE[1]; K],
    };

    pub fn set(&mut self, index: usize, range: [f32; 2]) {
        [self.least[index], self.greatest[index]] = range;
    }

    /// The range of this index in each lane.
    #[inline(always)]
    fn splat<S: Simd>(&self, simd: S, index: usize) -> [F32Lanes<S>; 2] {
        splat(simd, [self.least[index], self.greatest[index]])
    }
}

/// The places of the lights whose bounds touch each part of an area.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// The places for each part, `stride` apart.
    places: Vec<u32>,
    stride: usize,
    /// The end of the places for each part.
    ends: [usize; MAX_SIDE * MAX_SIDE],
}

impl Selection {
    pub const fn new() -> Self {
        Self {
            places: Vec::new(),
            stride: 0,
            ends: [0; MAX_SIDE * MAX_SIDE],
        }
    }

    /// Selects those of all lights of `batch` whose bounds touch each of `parts`.
    #[inline(always)]
    pub fn select_of_all<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        batch: &LightBatch<P>,
        parts: &Parts,
    ) {
        let mut writer = self.begin(batch.len(), parts);
        for first in (0..batch.len()).step_by(S::f32s::LEN) {
            let bounds = batch.bounds(simd, first);
            let wanted = mask_of_first(simd, batch.len() - first);
            let places = numbers_from(simd, first);
            writer.write(simd, places, wanted, &bounds, |bounds_meet, _| bounds_meet);
        }
        self.ends = writer.ends;
    }

    /// Selects those of `places` whose bounds touch each of `parts`.
    #[inline(always)]
    pub fn select<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        batch: &LightBatch<P>,
        places: &[u32],
        parts: &Parts,
    ) {
        self.select_where(simd, batch, places, parts, |_, bounds_meet, _| bounds_meet);
    }

    /// Selects those of `places` that may touch each of `parts`, by their bounds and by the box of the part.
    #[inline(always)]
    pub fn select_by_boxes<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        batch: &LightBatch<P>,
        places: &[u32],
        parts: &Parts,
    ) {
        self.select_where(
            simd,
            batch,
            places,
            parts,
            #[inline(always)]
            |fields, bounds_meet, index| {
                if !bounds_meet.any_true() {
                    return bounds_meet;
                }
                let [column, row] = [index % parts.size[0], index / parts.size[0]];
                let across = parts.across.splat(simd, column);
                let outline = P::outline(fields, across, parts.down.splat(simd, row));
                bounds_meet & !P::misses(fields, &outline, parts.depths.splat(simd, index))
            },
        );
    }

    /// Selects those of `places` for which `touching` is true, given their fields, whether their bounds meet those
    /// of a part, and the index of the part.
    #[inline(always)]
    fn select_where<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        batch: &LightBatch<P>,
        places: &[u32],
        parts: &Parts,
        touching: impl Fn(&P::Fields<F32Lanes<S>>, S::mask32s, usize) -> S::mask32s,
    ) {
        let mut writer = self.begin(places.len(), parts);
        let all = S::mask32s::splat(simd, true);
        for chunk in Places::chunks(places) {
            for part in 0..vectors::<S>() {
                let fields = chunk.load_fields(simd, batch, &P::NOWHERE, part);
                let (places, bounds) = (chunk.load(simd, part), P::bounds_of(&fields));
                writer.write(
                    simd,
                    places,
                    all,
                    &bounds,
                    #[inline(always)]
                    |bounds_meet, index| touching(&fields, bounds_meet, index),
                );
            }
        }
        self.ends = writer.ends;
    }

    /// Clears the selection, and makes room for as many as `count` lights for each of `parts`.
    #[inline(always)]
    fn begin<'a>(&'a mut self, count: usize, parts: &'a Parts) -> Writer<'a> {
        // Whole vectors are written.
        self.stride = count + LANES;
        grow(
            &mut self.places,
            parts.size[0] * parts.size[1] * self.stride,
            0,
        );
        let mut ends = [0; MAX_SIDE * MAX_SIDE];
        for (index, end) in ends.iter_mut().enumerate() {
            *end = index * self.stride;
        }
        Writer {
            parts,
            places: &mut self.places,
            ends,
        }
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.places[..])
    }

    /// The places selected for the area of this index, in the order in which they were given.
    pub fn of(&self, area: usize) -> &[u32] {
        &self.places[area * self.stride..self.ends[area]]
    }
}

/// Writes the places of selected lights.
struct Writer<'a> {
    parts: &'a Parts,
    places: &'a mut [u32],
    ends: [usize; MAX_SIDE * MAX_SIDE],
}

impl Writer<'_> {
    /// Writes those of `places` that are `wanted` and for which `touching` is true, given whether their bounds meet
    /// those of a part, and the index of the part.
    #[inline(always)]
    fn write<S: Simd>(
        &mut self,
        simd: S,
        places: S::u32s,
        wanted: S::mask32s,
        bounds: &ViewBounds<F32Lanes<S>>,
        touching: impl Fn(S::mask32s, usize) -> S::mask32s,
    ) {
        let (parts, [columns, rows]) = (self.parts, self.parts.size.map(|n| n.min(MAX_SIDE)));
        let mut across = [wanted; MAX_SIDE];
        for (column, across) in across[..columns].iter_mut().enumerate() {
            *across = wanted & meet(bounds.across, parts.across.splat(simd, column));
        }
        let mut index = 0;
        for row in 0..rows {
            let down = meet(bounds.down, parts.down.splat(simd, row));
            for across in &across[..columns] {
                let depths = meet(bounds.depths, parts.depths.splat(simd, index));
                let touching = touching(*across & down & depths, index);
                let end = &mut self.ends[index];
                *end += write_chosen::<S>(places, touching, &mut self.places[*end..]);
                index += 1;
            }
        }
    }
}
