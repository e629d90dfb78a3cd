//! The lights of one tile.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::Chunk;
use super::filter::{in_depth, load_fields};
use super::lanes::{LANES, Lanes, load, parts};
use super::{LightBatch, LightLists};
use crate::num::F32Lanes;
use crate::touch::{BoxTest, TileBounds};

/// What the lights of a chunk share with all tiles of a row.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Row<P: BoxTest>(pub P::Row<Lanes>);

impl<P: BoxTest> Row<P> {
    pub fn none() -> Self {
        Self(P::row_of([0.0; LANES]))
    }
}

/// Appends the lights that may touch `tile` to `lists`; gives the number of tests.
#[inline(always)]
pub(super) fn list<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    rows: &[Row<P>],
    tile: &TileBounds<F32Lanes<S>>,
    lists: &mut LightLists,
) -> u64 {
    let room = lists.room_for((lights.chunks().len() + 1) * LANES);
    let index = |_, chunk: &Chunk<P>, part| {
        let of_chunk = &chunk.lights[part * S::u32s::LEN..][..S::u32s::LEN];
        S::u32s::from_slice(simd, of_chunk)
    };
    let [count, tested] = find(simd, lights, rows, tile, index, room);
    lists.take(count);
    tested as u64
}

/// Writes the `index` of each light that may touch `tile` to the front of `found`; gives how many these
/// are, and the number of tests.
#[inline(always)]
pub(super) fn find<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    rows: &[Row<P>],
    tile: &TileBounds<F32Lanes<S>>,
    index: impl Fn(usize, &Chunk<P>, usize) -> S::u32s,
    found: &mut [u32],
) -> [usize; 2] {
    // Each write is of a whole vector, of which the next one keeps only what counts.
    let (mut end, mut tested, mut first) = (0, 0, 0);
    let groups = lights.chunks().chunks(LANES).zip(rows.chunks(LANES));
    for ((chunks, rows), reach) in groups.zip(lights.reach()) {
        let mut candidates = in_depth(simd, reach, tile);
        tested += candidates.count_ones() as usize;
        while candidates != 0 {
            let place = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            let (chunk, row) = (&chunks[place], &rows[place].0);
            for part in 0..parts::<S>() {
                let mut shared = P::row_of(F32Lanes::new(simd, 0.0));
                for (vector, lanes) in shared.as_mut().iter_mut().zip(row.as_ref()) {
                    *vector = load(simd, lanes, part);
                }
                let fields = load_fields(simd, chunk, part);
                let touching = !P::misses(&fields, &shared, tile);
                // Without asking first whether there are any: it would be guessed wrong too often.
                let chosen = index(first + place, chunk, part).compress(touching);
                chosen.store_slice(&mut found[end..end + S::u32s::LEN]);
                end += touching.to_bitmask().count_ones() as usize;
            }
        }
        first += LANES;
    }
    [end, tested * LANES]
}
