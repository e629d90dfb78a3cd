//! The list of one depth interval of one tile.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::Chunk;
use super::filter::{in_depth, load_fields};
use super::lanes::{LANES, Lanes, MAX_PARTS, load, parts, store};
use super::{LightBatch, LightLists};
use crate::num::F32Lanes;
use crate::touch::BoxTest;
use crate::view::ViewBounds;

/// For the lights of a chunk, the intermediate results of the box test that all tiles of a row share.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Row<P: BoxTest>(pub P::Row<Lanes>);

impl<P: BoxTest> Row<P> {
    pub fn zero() -> Self {
        Self(P::row_of([0.0; LANES]))
    }
}

/// Computes `rows`, the intermediate results of `chunks` for the row of tiles with the slopes y/z = `down`.
#[inline(always)]
pub(super) fn fill_rows<S: Simd, P: BoxTest>(
    simd: S,
    chunks: &[Chunk<P>],
    down: [f32; 2],
    rows: &mut [Row<P>],
) {
    let down = [F32Lanes::new(simd, down[0]), F32Lanes::new(simd, down[1])];
    for (chunk, row) in chunks.iter().zip(rows) {
        for part in 0..parts::<S>() {
            let fields = load_fields(simd, chunk, part);
            let shared = P::row(&fields, down);
            for (lanes, vector) in row.0.as_mut().iter_mut().zip(shared.as_ref()) {
                store(lanes, part, *vector);
            }
        }
    }
}

/// Appends the lights that may touch `tile` to `lists`. Returns the number of tests.
#[inline(always)]
pub(super) fn append_list<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    rows: &[Row<P>],
    tile: &ViewBounds<F32Lanes<S>>,
    lists: &mut LightLists,
) -> u64 {
    let room = lists.room_for(lights.room_for_a_list());
    let indices = |_, chunk: &Chunk<P>, part| {
        let lights = &chunk.lights[part * S::u32s::LEN..][..S::u32s::LEN];
        S::u32s::from_slice(simd, lights)
    };
    let [count, tested] = write_touching(simd, lights, rows, tile, indices, room);
    lists.advance(count);
    tested as u64
}

/// Writes a number for each light that may touch `tile` to the front of `out`. Returns the number of these
/// lights and the number of tests.
///
/// `values` gives the numbers for a vector of lights. Its arguments are the index of a chunk, the chunk, and
/// the part of it.
#[inline(always)]
pub(super) fn write_touching<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    rows: &[Row<P>],
    tile: &ViewBounds<F32Lanes<S>>,
    values: impl Fn(usize, &Chunk<P>, usize) -> S::u32s,
    out: &mut [u32],
) -> [usize; 2] {
    // Each write is of a whole vector. The next one overwrites the lanes that do not count.
    let (mut end, mut tested, mut first) = (0, 0, 0);
    let groups = lights.chunks().chunks(LANES).zip(rows.chunks(LANES));
    for ((chunks, rows), reach) in groups.zip(lights.reach()) {
        let candidates = in_depth(simd, reach, tile);
        tested += candidates.count_ones() as usize;
        let mut vectors = [0; MAX_PARTS * LANES];
        let count = within_bounds(simd, chunks, candidates, tile, &mut vectors);
        for vector in &vectors[..count] {
            let (index, part) = (*vector as usize / MAX_PARTS, *vector as usize % MAX_PARTS);
            let (chunk, row) = (&chunks[index], &rows[index].0);
            let mut shared = P::row_of(F32Lanes::new(simd, 0.0));
            for (vector, lanes) in shared.as_mut().iter_mut().zip(row.as_ref()) {
                *vector = load(simd, lanes, part);
            }
            let fields = load_fields(simd, chunk, part);
            let apart = P::bounds_of(&fields).are_apart(tile);
            let touching = !(apart | P::misses(&fields, &shared, tile));
            let numbers = values(first + index, chunk, part);
            end += write_chosen::<S>(numbers, touching, &mut out[end..end + S::u32s::LEN]);
        }
        first += LANES;
    }
    [end, tested * LANES]
}

/// So few vectors are not compared by their bounds alone. All of them have lights in the block of the tile, so
/// most have one in the tile, and to compare them twice takes longer than it saves.
const FEW: usize = 2;

/// Writes to `vectors` which vectors of the `candidates` among `chunks` have a light whose bounds touch `tile`:
/// [`MAX_PARTS`] times the index of the chunk, plus the part of it. Returns their number.
///
/// Does not branch on the result, since it would often be mispredicted.
#[inline(always)]
fn within_bounds<S: Simd, P: BoxTest>(
    simd: S,
    chunks: &[Chunk<P>],
    mut candidates: u32,
    tile: &ViewBounds<F32Lanes<S>>,
    vectors: &mut [u8; MAX_PARTS * LANES],
) -> usize {
    let are_few = chunks.len() * parts::<S>() <= FEW;
    let mut count = 0;
    while candidates != 0 {
        let index = candidates.trailing_zeros() as usize % LANES;
        candidates &= candidates - 1;
        for part in 0..parts::<S>() {
            vectors[count % (MAX_PARTS * LANES)] = (index * MAX_PARTS + part) as u8;
            count += if are_few {
                1
            } else {
                let fields = load_fields(simd, &chunks[index], part);
                let apart = P::bounds_of(&fields).are_apart(tile);
                usize::from(!apart.all_true())
            };
        }
    }
    count
}

/// Writes those of `numbers` that are `chosen` to the front of `out`. The rest of it may change too. Returns
/// how many are chosen.
///
/// Does not branch on which lanes are chosen, since it would often be mispredicted.
#[inline(always)]
fn write_chosen<S: Simd>(numbers: S::u32s, chosen: S::mask32s, out: &mut [u32]) -> usize {
    let bits = chosen.to_bitmask();
    if S::u32s::LEN > 4 {
        numbers.compress(chosen).store_slice(out);
        return bits.count_ones() as usize;
    }
    // SSE2 has no instruction to compress. Each number is overwritten by the next one unless it is chosen.
    let mut end = 0;
    for (lane, number) in numbers.as_slice().iter().enumerate() {
        out[end] = *number;
        end += (bits >> lane & 1) as usize;
    }
    end
}
