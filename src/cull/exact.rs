//! The lists of a culler that tests exactly.

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::Chunk;
use super::lanes::{LANES, load, parts, splat_tile};
use super::tile_list::{Row, find};
use super::{LightBatch, LightLists};
use crate::num::{F32Lanes, Single};
use crate::touch::{BoxTest, Frustum, TileBounds};

/// How many lights were tested, and how many of those that pass the box test do not touch the tile.
pub(super) struct Tested {
    pub lights: u64,
    pub rejected: u64,
}

/// Appends the lights that touch `tile`, exactly, to `lists`.
///
/// A function of its own, so that culling without it is compiled as if it were not there.
#[inline(never)]
pub(super) fn list_exactly<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    rows: &[Row<P>],
    tile: TileBounds<f32>,
    lists: &mut LightLists,
) -> Tested {
    simd.vectorize(
        #[inline(always)]
        || {
            let places = lists.room_for((lights.chunks().len() + 1) * LANES);
            let place = |chunk: usize, _: &Chunk<P>, part: usize| {
                let first = (chunk * LANES + part * S::u32s::LEN) as u32;
                S::u32s::from_slice(simd, &FIRST_PLACES[..S::u32s::LEN]) + first
            };
            let in_lanes = splat_tile(simd, tile);
            let [passed, tested] = find(simd, lights, rows, &in_lanes, place, places);
            let listed = keep(simd, lights.chunks(), tile, places, passed);
            lists.take(listed);
            Tested {
                lights: tested as u64,
                rejected: (passed - listed) as u64,
            }
        },
    )
}

/// The places of the lights of the first chunk: a light's place is where it is in the batch.
const FIRST_PLACES: [u32; LANES] = {
    let mut places = [0; LANES];
    let mut place = 0;
    while place < LANES {
        places[place] = place as u32;
        place += 1;
    }
    places
};

/// Puts the indices of those lights that touch the tile in place of the first `count` of `places`; gives
/// how many these are.
#[inline(always)]
fn keep<S: Simd, P: BoxTest>(
    simd: S,
    chunks: &[Chunk<P>],
    tile: TileBounds<f32>,
    places: &mut [u32],
    count: usize,
) -> usize {
    let (mut side_by_side, mut end) = (Chunk::nowhere(), 0);
    for start in (0..count).step_by(LANES) {
        let lanes = LANES.min(count - start);
        for (lane, place) in places[start..][..lanes].iter().enumerate() {
            let place = *place as usize;
            side_by_side.copy(lane, &chunks[place / LANES], place % LANES);
        }
        for part in 0..parts::<S>() {
            let wanted = ((1_u64 << lanes) - 1) >> (part * S::u32s::LEN);
            let touching = touching(simd, &side_by_side, part, wanted as u32, tile);
            let of_part = &side_by_side.lights[part * S::u32s::LEN..][..S::u32s::LEN];
            let chosen = S::mask32s::from_bitmask(simd, touching.into());
            let chosen = S::u32s::from_slice(simd, of_part).compress(chosen);
            // Never beyond the places that were read.
            chosen.store_slice(&mut places[end..end + S::u32s::LEN]);
            end += touching.count_ones() as usize;
        }
    }
    end
}

/// Which of the `wanted` lights touch the tile, as bits.
#[inline(always)]
fn touching<S: Simd, P: BoxTest>(
    simd: S,
    chunk: &Chunk<P>,
    part: usize,
    wanted: u32,
    tile: TileBounds<f32>,
) -> u32 {
    let mut fields = P::fields_of(F32Lanes::new(simd, 0.0).widen());
    for (field, lanes) in fields.as_mut().iter_mut().zip(chunk.fields.as_ref()) {
        *field = load(simd, lanes, part).widen();
    }
    let frustum = Frustum::new(P::image(&fields), splat_tile(simd, tile).widen());
    let verdict = frustum.first_verdict();
    let apart = verdict.is_separated | frustum.is_out_of_reach();
    let mut touching = (!(apart | verdict.is_undecided)).to_bitmask() as u32 & wanted;
    let mut open = (verdict.is_undecided & !apart).to_bitmask() as u32 & wanted;
    while open != 0 {
        let lane = open.trailing_zeros();
        open &= open - 1;
        let meets = meets(chunk, part * S::u32s::LEN + lane as usize, tile);
        touching |= u32::from(meets) << lane;
    }
    touching
}

#[inline(always)]
fn meets<P: BoxTest>(chunk: &Chunk<P>, lane: usize, tile: TileBounds<f32>) -> bool {
    Frustum::new(P::image(&chunk.fields_of(lane)), tile.widen()).meets_ball()
}
