//! The lists of a culler that tests exactly.

use fearless_simd::Simd;

use super::batch::Chunk;
use super::filter::{in_depth, touching};
use super::lanes::LANES;
use super::shape::{BatchShape, TileLanes};
use super::{LightBatch, LightLists};

/// How many lights were tested, and how many of those that pass the box test touch nothing.
pub(super) struct Tested {
    pub lights: u64,
    pub rejected: u64,
}

/// Appends the lights that touch the tile with these `sides`, exactly, to `lists`.
///
/// The box test is done in lanes, as everywhere, and the exact one light by light. A function of its own,
/// so that culling without it is compiled as if it were not there.
#[inline(never)]
pub(super) fn list_exactly<S: Simd, T: BatchShape>(
    simd: S,
    lights: &LightBatch<T>,
    sides: [[f32; 2]; 3],
    lists: &mut LightLists,
) -> Tested {
    simd.vectorize(
        #[inline(always)]
        || list(simd, lights, sides, lists),
    )
}

#[inline(always)]
fn list<S: Simd, T: BatchShape>(
    simd: S,
    lights: &LightBatch<T>,
    sides: [[f32; 2]; 3],
    lists: &mut LightLists,
) -> Tested {
    let [across, down, depths] = sides;
    let tile = TileLanes::new(simd, across, down, depths);
    let chunks = lights.chunks();
    let numbers = lists.room_for((chunks.len() + 1) * LANES);
    let (mut end, mut tested, mut passed) = (0, 0, 0);
    for (chunks, reach) in chunks.chunks(LANES).zip(lights.reach()) {
        let mut candidates = in_depth(simd, reach, &tile);
        tested += candidates.count_ones();
        while candidates != 0 {
            let chunk = &chunks[candidates.trailing_zeros() as usize % LANES];
            candidates &= candidates - 1;
            let mut bits = touching(simd, chunk, &tile);
            passed += bits.count_ones();
            while bits != 0 {
                let lane = bits.trailing_zeros() as usize % LANES;
                bits &= bits - 1;
                // Written in any case: the next one keeps only what counts.
                numbers[end] = chunk.numbers[lane];
                end += usize::from(meets(chunk, lane, sides));
            }
        }
    }
    lists.take(end);
    Tested {
        lights: u64::from(tested) * LANES as u64,
        rejected: u64::from(passed) - end as u64,
    }
}

#[inline(always)]
fn meets<T: BatchShape>(chunk: &Chunk<T>, lane: usize, sides: [[f32; 2]; 3]) -> bool {
    let mut fields = T::fields_of(0.0);
    for (field, lanes) in fields.as_mut().iter_mut().zip(chunk.fields.as_ref()) {
        *field = lanes[lane];
    }
    T::meets(&fields, sides)
}
