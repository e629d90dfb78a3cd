//! The lights of one tile.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::Chunk;
use super::filter::in_depth;
use super::lanes::{LANES, Lanes, load, parts};
use super::shape::{BatchShape, InLanes, TileLanes};
use super::{LightBatch, LightLists};

/// What the lights of a chunk share with all tiles of a row.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Row<T: InLanes>(pub T::Row<Lanes>);

impl<T: InLanes> Row<T> {
    pub const NONE: Self = Self(T::NO_ROW);
}

/// Appends the lights that may touch `tile` to `lists`; gives the number of tests.
#[inline(always)]
pub(super) fn list<S: Simd, T: BatchShape>(
    simd: S,
    lights: &LightBatch<T>,
    rows: &[Row<T>],
    tile: &TileLanes<S>,
    lists: &mut LightLists,
) -> u64 {
    let numbers = lists.room_for((lights.chunks().len() + 1) * LANES);
    let name = |_, chunk: &Chunk<T>, part| {
        let of_chunk = &chunk.numbers[part * S::u32s::LEN..][..S::u32s::LEN];
        S::u32s::from_slice(simd, of_chunk)
    };
    let [count, tested] = find(simd, lights, rows, tile, name, numbers);
    lists.take(count);
    tested as u64
}

/// Writes what `name` calls the lights that may touch `tile` to the front of `names`; gives how many these
/// are, and the number of tests.
#[inline(always)]
pub(super) fn find<S: Simd, T: BatchShape>(
    simd: S,
    lights: &LightBatch<T>,
    rows: &[Row<T>],
    tile: &TileLanes<S>,
    name: impl Fn(usize, &Chunk<T>, usize) -> S::u32s,
    names: &mut [u32],
) -> [usize; 2] {
    // Each write is of a whole vector, of which the next one keeps only what counts.
    let (mut end, mut tested, mut first) = (0, 0, 0);
    let groups = lights.chunks().chunks(LANES).zip(rows.chunks(LANES));
    for ((chunks, rows), reach) in groups.zip(lights.reach()) {
        let mut candidates = in_depth(simd, reach, tile);
        tested += candidates.count_ones() as usize;
        while candidates != 0 {
            let index = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            let (chunk, row) = (&chunks[index], &rows[index].0);
            for part in 0..parts::<S>() {
                let mut shared = T::row_of(S::f32s::splat(simd, 0.0));
                for (vector, lanes) in shared.as_mut().iter_mut().zip(row.as_ref()) {
                    *vector = load(simd, lanes, part);
                }
                let touching = !T::misses(simd, &chunk.fields, part, &shared, tile);
                // Without asking first whether there are any: it would be guessed wrong too often.
                let chosen = name(first + index, chunk, part).compress(touching);
                chosen.store_slice(&mut names[end..end + S::u32s::LEN]);
                end += touching.to_bitmask().count_ones() as usize;
            }
        }
        first += LANES;
    }
    [end, tested * LANES]
}
