//! The list of one depth interval of one tile, with the exact test.
//!
//! The *place* of a light is its position in the batch.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::Chunk;
use super::lanes::{LANES, load, parts, splat_tile};
use super::tile_list::{Row, write_touching};
use super::{LightBatch, LightLists};
use crate::num::{F32Lanes, Single};
use crate::touch::{BoxTest, Frustum};
use crate::view::ViewBounds;

/// Counts of the tests for one list.
pub(super) struct Tested {
    /// Box tests.
    pub lights: u64,
    /// Lights that pass the box test and fail the exact test.
    pub rejected: u64,
}

/// Appends the lights that touch `tile` by the exact test to `lists`.
///
/// Not inlined, so that culling without the exact test is compiled as if it did not exist.
#[inline(never)]
pub(super) fn append_list_exactly<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    rows: &[Row<P>],
    tile: ViewBounds<f32>,
    lists: &mut LightLists,
) -> Tested {
    simd.vectorize(
        #[inline(always)]
        || {
            let places = lists.room_for(lights.room_for_a_list());
            let places_of = |chunk: usize, _: &Chunk<P>, part: usize| {
                let first = (chunk * LANES + part * S::u32s::LEN) as u32;
                S::u32s::from_slice(simd, &FIRST_PLACES[..S::u32s::LEN]) + first
            };
            let in_lanes = splat_tile(simd, tile);
            let [passed, tested] = write_touching(simd, lights, rows, &in_lanes, places_of, places);
            // Most lists are empty, and need no room for the numbers of lights.
            let listed = match passed {
                0 => 0,
                _ => retain_touching(simd, lights.chunks(), tile, places, passed),
            };
            lists.advance(listed);
            Tested {
                lights: tested as u64,
                rejected: (passed - listed) as u64,
            }
        },
    )
}

/// The places of the lights of the first chunk.
const FIRST_PLACES: [u32; LANES] = {
    let mut places = [0; LANES];
    let mut place = 0;
    while place < LANES {
        places[place] = place as u32;
        place += 1;
    }
    places
};

/// Replaces the first `count` of `places` by the indices of those lights that touch `tile`. Returns the
/// number of these lights.
#[inline(always)]
fn retain_touching<S: Simd, P: BoxTest>(
    simd: S,
    chunks: &[Chunk<P>],
    tile: ViewBounds<f32>,
    places: &mut [u32],
    count: usize,
) -> usize {
    let (mut gathered, mut end) = (Chunk::nowhere(), 0);
    for start in (0..count).step_by(LANES) {
        let lanes = LANES.min(count - start);
        for (lane, place) in places[start..][..lanes].iter().enumerate() {
            let place = *place as usize;
            gathered.copy(lane, &chunks[place / LANES], place % LANES);
        }
        for part in 0..parts::<S>() {
            let wanted = ((1_u64 << lanes) - 1) >> (part * S::u32s::LEN);
            let touching = touching(simd, &gathered, part, wanted as u32, tile);
            let indices = &gathered.lights[part * S::u32s::LEN..][..S::u32s::LEN];
            let chosen = S::mask32s::from_bitmask(simd, touching.into());
            let chosen = S::u32s::from_slice(simd, indices).compress(chosen);
            // Does not overwrite places that are still to be read.
            chosen.store_slice(&mut places[end..end + S::u32s::LEN]);
            end += touching.count_ones() as usize;
        }
    }
    end
}

/// The bits of the `wanted` lights of a part of `chunk` that touch `tile`.
#[inline(always)]
fn touching<S: Simd, P: BoxTest>(
    simd: S,
    chunk: &Chunk<P>,
    part: usize,
    wanted: u32,
    tile: ViewBounds<f32>,
) -> u32 {
    let mut fields = P::fields_of(F32Lanes::new(simd, 0.0).widen());
    for (field, lanes) in fields.as_mut().iter_mut().zip(chunk.fields.as_ref()) {
        *field = load(simd, lanes, part).widen();
    }
    let frustum = Frustum::new(P::image(&fields), splat_tile(simd, tile).widen());
    let verdict = frustum.first_verdict();
    let misses = verdict.is_separated | frustum.is_out_of_reach();
    let mut touching = (!(misses | verdict.is_undecided)).to_bitmask() as u32 & wanted;
    let mut undecided = (verdict.is_undecided & !misses).to_bitmask() as u32 & wanted;
    while undecided != 0 {
        let lane = undecided.trailing_zeros();
        undecided &= undecided - 1;
        let touches = touches(chunk, part * S::u32s::LEN + lane as usize, tile);
        touching |= u32::from(touches) << lane;
    }
    touching
}

/// Whether the light in `lane` of `chunk` touches `tile` by the exact test.
#[inline(always)]
fn touches<P: BoxTest>(chunk: &Chunk<P>, lane: usize, tile: ViewBounds<f32>) -> bool {
    Frustum::new(P::image(&chunk.fields_of(lane)), tile.widen()).meets_ball()
}
