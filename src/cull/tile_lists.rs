//! The lists of the depth intervals of the tiles of an area.

use alloc::vec::Vec;

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::grow;
use super::block::{Numbers, Output, Scene};
use super::lanes::{
    LANES, Lanes, load, load_indices, parts, splat, splat_bounds, store, write_chosen,
};
use super::select::Places;
use super::tile_depths::{Area, is_none};
use super::tile_lanes::LaneWriter;
use super::{CullCounters, TileDepths};
use crate::num::F32Lanes;
use crate::project::Projected;
use crate::touch::{BoxTest, Outline};
use crate::view::ViewBounds;

/// Sixteen lights: the fields of their shapes, and a number for each, which lists hold.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Chunk<P: Projected> {
    fields: P::Fields<Lanes>,
    numbers: Lanes<u32>,
}

impl<P: Projected> Chunk<P> {
    fn zero() -> Self {
        Self {
            fields: P::fields_of([0.0; LANES]),
            numbers: [0; LANES],
        }
    }

    /// The fields of a light in all lanes, and its number.
    #[inline(always)]
    pub fn splat<S: Simd>(&self, simd: S, lane: usize) -> (P::Fields<F32Lanes<S>>, u32) {
        let mut fields = P::fields_of(F32Lanes::new(simd, 0.0));
        for (vector, lanes) in fields.as_mut().iter_mut().zip(self.fields.as_ref()) {
            *vector = F32Lanes::new(simd, lanes[lane]);
        }
        (fields, self.numbers[lane])
    }

    /// The `part`-th vector of each field.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S, part: usize) -> P::Fields<F32Lanes<S>> {
        let mut fields = P::fields_of(F32Lanes::new(simd, 0.0));
        for (vector, lanes) in fields.as_mut().iter_mut().zip(self.fields.as_ref()) {
            *vector = load(simd, lanes, part);
        }
        fields
    }
}

/// The memory in which the lists of an area are made.
#[derive(Clone, Debug)]
pub(super) struct TileLists<P: BoxTest> {
    chunks: Vec<Chunk<P>>,
    writer: ListWriter,
    lane_writer: LaneWriter,
}

impl<P: BoxTest> TileLists<P> {
    pub const fn new() -> Self {
        Self {
            chunks: Vec::new(),
            writer: ListWriter {
                candidates: Vec::new(),
                lists: Vec::new(),
                lens: Vec::new(),
            },
            lane_writer: LaneWriter::new(),
        }
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.chunks[..])
            + size_of_val(&self.writer.lists[..])
            + self.lane_writer.bytes()
    }

    /// Writes the lists of the tiles of `area`: those of the lights at `places` that touch each.
    #[inline(always)]
    pub fn write<S: Simd>(
        &mut self,
        simd: S,
        scene: &Scene<P>,
        places: &[u32],
        area: Area,
        output: &mut Output,
        counters: &mut CullCounters,
    ) {
        if places.is_empty() {
            return;
        }
        simd.vectorize(
            #[inline(always)]
            || self.gather(simd, scene, places, output.numbers),
        );
        let chunks = &self.chunks[..places.len().div_ceil(LANES)];
        let (writer, lane_writer) = (&mut self.writer, &mut self.lane_writer);
        let are_in_lanes = scene.tiles.intervals() == 1 && area.len() >= S::u32s::LEN;
        simd.vectorize(
            #[inline(always)]
            || {
                if are_in_lanes {
                    lane_writer.write(simd, chunks, scene.tiles, area, output, counters);
                } else {
                    writer.write(simd, chunks, scene.tiles, area, output, counters);
                }
            },
        );
    }

    /// Lays the lights at `places` side by side in chunks.
    #[inline(always)]
    fn gather<S: Simd>(&mut self, simd: S, scene: &Scene<P>, places: &[u32], numbers: Numbers) {
        grow(
            &mut self.chunks,
            places.len().div_ceil(LANES),
            Chunk::zero(),
        );
        for (chunk, places) in self.chunks.iter_mut().zip(Places::chunks(places)) {
            for part in 0..parts::<S>() {
                let fields = places.load_fields(simd, scene.batch, &P::NOWHERE, part);
                for (lanes, vector) in chunk.fields.as_mut().iter_mut().zip(fields.as_ref()) {
                    store(lanes, part, *vector);
                }
            }
            chunk.numbers = match numbers {
                Numbers::Lights => places.lights(scene.batch),
                Numbers::Places => places.0,
            };
        }
    }
}

/// Makes the lists of one tile at a time.
#[derive(Clone, Debug)]
struct ListWriter {
    /// The vectors that have a light whose bounds touch the tile.
    candidates: Vec<u32>,
    /// The list of each depth interval, all with the same room.
    lists: Vec<u32>,
    /// The length of each list. Zero between tiles.
    lens: Vec<usize>,
}

impl ListWriter {
    /// Writes the lists of the tiles of `area` for the lights of `chunks`.
    #[inline(always)]
    fn write<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        chunks: &[Chunk<P>],
        tiles: &TileDepths,
        area: Area,
        output: &mut Output,
        counters: &mut CullCounters,
    ) {
        let intervals = tiles.intervals() as usize;
        let vectors = chunks.len() * parts::<S>();
        // Whole vectors are written.
        let room = (vectors + 1) * S::u32s::LEN;
        grow(&mut self.candidates, vectors, 0);
        grow(&mut self.lists, intervals * room, 0);
        grow(&mut self.lens, intervals, 0);
        for y in area.min[1]..area.max[1] {
            for x in area.min[0]..area.max[0] {
                let tile = ViewBounds {
                    across: tiles.across(x),
                    down: tiles.down(y),
                    depths: tiles.hull(x, y),
                };
                if is_none(tile.depths) {
                    counters.empty += intervals as u64;
                    continue;
                }
                counters.tile_tests += (vectors * S::u32s::LEN) as u64;
                let tile = splat_bounds(simd, &tile);
                let count = self.find_candidates(simd, chunks, &tile);
                if count == 0 {
                    continue;
                }
                counters.box_tests += (count * intervals * S::u32s::LEN) as u64;
                let slot = output.window.slot([x, y], intervals);
                if intervals == 1 {
                    // The only list of the tile is made where it stays.
                    let list = output.lists.room_for((count + 1) * S::u32s::LEN);
                    let mut len = 0;
                    for vector in &self.candidates[..count] {
                        let candidate = Candidate::load(simd, chunks, *vector, &tile);
                        len += candidate.write_touching(&tile, &mut list[len..]);
                    }
                    output.lists.set_range(slot, 0..len);
                    output.lists.advance(len);
                    continue;
                }
                self.test_candidates(simd, chunks, &tile, count, tiles.depths_of(x, y), room);
                for interval in 0..intervals {
                    let len = core::mem::take(&mut self.lens[interval]);
                    let list = &self.lists[interval * room..][..room];
                    output.lists.append_list(simd, slot + interval, list, len);
                }
            }
        }
    }

    /// Finds the vectors with a light whose bounds touch `tile`. Returns their number.
    ///
    /// Does not branch on the result, since it would often be mispredicted.
    #[inline(always)]
    fn find_candidates<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        chunks: &[Chunk<P>],
        tile: &ViewBounds<F32Lanes<S>>,
    ) -> usize {
        let mut count = 0;
        for (index, chunk) in chunks.iter().enumerate() {
            for part in 0..parts::<S>() {
                let fields = chunk.load(simd, part);
                let meet = P::bounds_of(&fields).meet(tile).any_true();
                self.candidates[count] = (index * parts::<S>() + part) as u32;
                count += usize::from(meet);
            }
        }
        count
    }

    /// Writes the numbers of those of the first `count` candidates that may touch each depth interval of `tile`
    /// to the list of the interval.
    #[inline(always)]
    fn test_candidates<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        chunks: &[Chunk<P>],
        tile: &ViewBounds<F32Lanes<S>>,
        count: usize,
        intervals: &[[f32; 2]],
        room: usize,
    ) {
        for vector in &self.candidates[..count] {
            let candidate = Candidate::load(simd, chunks, *vector, tile);
            for (interval, depths) in intervals.iter().enumerate() {
                if is_none(*depths) {
                    continue;
                }
                let depths = splat(simd, *depths);
                let part = ViewBounds { depths, ..*tile };
                let len = &mut self.lens[interval];
                let list = &mut self.lists[interval * room + *len..];
                *len += candidate.write_touching(&part, list);
            }
        }
    }
}

/// A vector of lights that is tested against the depth intervals of a tile.
struct Candidate<S: Simd, P: BoxTest> {
    fields: P::Fields<F32Lanes<S>>,
    numbers: S::u32s,
    outline: Outline<F32Lanes<S>>,
}

impl<S: Simd, P: BoxTest> Candidate<S, P> {
    /// The `vector`-th vector of `chunks`, to be tested against `tile`.
    #[inline(always)]
    fn load(simd: S, chunks: &[Chunk<P>], vector: u32, tile: &ViewBounds<F32Lanes<S>>) -> Self {
        let vector = vector as usize;
        let (chunk, part) = (&chunks[vector / parts::<S>()], vector % parts::<S>());
        let fields = chunk.load(simd, part);
        Self {
            numbers: load_indices(simd, &chunk.numbers, part),
            outline: P::outline(&fields, tile.across, tile.down),
            fields,
        }
    }

    /// Writes the numbers of the lights that may touch the tile at the depths of `part` to the front of `list`.
    /// Returns how many do.
    #[inline(always)]
    fn write_touching(&self, part: &ViewBounds<F32Lanes<S>>, list: &mut [u32]) -> usize {
        let meet = P::bounds_of(&self.fields).meet(part);
        let touching = meet & !P::misses(&self.fields, &self.outline, part.depths);
        write_chosen::<S>(self.numbers, touching, list)
    }
}
