//! The lights of a block that may touch a part of it.

use fearless_simd::{Bytes, Select, Simd, SimdBase, SimdMask, f32x16, mask32x16, u8x64, u32x16};

use super::LightBatch;
use super::batch::{Chunk, Reach};
use super::lanes::{LANES, load, parts, store};
use crate::num::{F32Lanes, Real};
use crate::project::Projected;
use crate::touch::BoxTest;
use crate::view::ViewBounds;

/// The bits of those of sixteen chunks that reach depths of `tile`.
#[inline(always)]
pub(super) fn in_depth<S: Simd>(simd: S, reach: &Reach, tile: &ViewBounds<F32Lanes<S>>) -> u32 {
    let mut bits = 0;
    for part in 0..parts::<S>() {
        let near = load(simd, &reach.near, part).le(tile.depths[1]);
        let far = tile.depths[0].le(load(simd, &reach.far, part));
        bits |= ((near & far).to_bitmask() as u32) << (part * S::f32s::LEN);
    }
    bits
}

/// The `part`-th vector of each field of a chunk.
#[inline(always)]
pub(super) fn load_fields<S: Simd, P: Projected>(
    simd: S,
    chunk: &Chunk<P>,
    part: usize,
) -> P::Fields<F32Lanes<S>> {
    let mut fields = P::fields_of(F32Lanes::new(simd, 0.0));
    for (vector, lanes) in fields.as_mut().iter_mut().zip(chunk.fields.as_ref()) {
        *vector = load(simd, lanes, part);
    }
    fields
}

/// The bits of the lights of `chunk` that may touch `tile`.
#[inline(always)]
pub(super) fn touching<S: Simd, P: BoxTest>(
    simd: S,
    chunk: &Chunk<P>,
    tile: &ViewBounds<F32Lanes<S>>,
) -> u32 {
    bits_where(
        simd,
        chunk,
        #[inline(always)]
        |fields| {
            let apart = P::bounds_of(fields).are_apart(tile);
            !(apart | P::misses(fields, &P::row(fields, tile.down), tile))
        },
    )
}

/// The bits of the lights of `chunk` whose bounds touch `tile`: all that may touch it, and more.
#[inline(always)]
pub(super) fn bounds_touching<S: Simd, P: BoxTest>(
    simd: S,
    chunk: &Chunk<P>,
    tile: &ViewBounds<F32Lanes<S>>,
) -> u32 {
    bits_where(
        simd,
        chunk,
        #[inline(always)]
        |fields| !P::bounds_of(fields).are_apart(tile),
    )
}

/// The bits of the lights of `chunk` for whose fields `test` is true.
#[inline(always)]
fn bits_where<S: Simd, P: Projected>(
    simd: S,
    chunk: &Chunk<P>,
    test: impl Fn(&P::Fields<F32Lanes<S>>) -> S::mask32s,
) -> u32 {
    let mut bits = 0;
    for part in 0..parts::<S>() {
        let is_true = test(&load_fields(simd, chunk, part));
        bits |= (is_true.to_bitmask() as u32) << (part * S::f32s::LEN);
    }
    bits
}

/// Replaces `kept` by those of `lights` that touch `tile` by `test`, [`touching`] or [`bounds_touching`], in
/// the same order. Returns the number of tests.
#[inline(always)]
pub(super) fn filter<S: Simd, P: BoxTest>(
    simd: S,
    lights: &LightBatch<P>,
    tile: &ViewBounds<F32Lanes<S>>,
    kept: &mut LightBatch<P>,
    test: impl Fn(S, &Chunk<P>, &ViewBounds<F32Lanes<S>>) -> u32,
) -> u64 {
    let (mut len, mut tested) = (0, 0);
    for (group, reach) in lights.chunks().chunks(LANES).zip(lights.reach()) {
        let (to, to_reach) = kept.room_after(len);
        let mut candidates = in_depth(simd, reach, tile);
        tested += candidates.count_ones();
        while candidates != 0 {
            let index = candidates.trailing_zeros() as usize % LANES;
            candidates &= candidates - 1;
            let bits = test(simd, &group[index], tile);
            if bits != 0 {
                let end = len + bits.count_ones() as usize;
                append(simd, &group[index], bits, to, len);
                for chunk in [len / LANES, (end - 1) / LANES] {
                    to_reach[chunk / LANES].widen(chunk, reach.get(index));
                }
                len = end;
            }
        }
    }
    clear_after(simd, kept.room_after(len).0, len);
    kept.set_len(len);
    u64::from(tested) * LANES as u64
}

/// Copies the lights of `chunk` whose bits are set in `bits` to `to`, from position `start` on.
#[inline(always)]
fn append<S: Simd, P: Projected>(
    simd: S,
    chunk: &Chunk<P>,
    bits: u32,
    to: &mut [Chunk<P>],
    start: usize,
) {
    if S::f32s::LEN == LANES {
        append_vector(simd, chunk, bits, to, start);
    } else {
        append_each(chunk, bits, to, start);
    }
}

/// [`append`], light by light.
#[inline(always)]
fn append_each<P: Projected>(
    chunk: &Chunk<P>,
    mut bits: u32,
    to: &mut [Chunk<P>],
    mut position: usize,
) {
    while bits != 0 {
        let from = bits.trailing_zeros() as usize % LANES;
        bits &= bits - 1;
        to[position / LANES].copy(position % LANES, chunk, from);
        position += 1;
    }
}

/// [`append`], a vector at a time: the lights are rotated to begin at the first free lane. Those that do not
/// fit wrap around to the first lanes of the next chunk.
#[inline(always)]
fn append_vector<S: Simd, P: Projected>(
    simd: S,
    chunk: &Chunk<P>,
    bits: u32,
    to: &mut [Chunk<P>],
    start: usize,
) {
    let (index, first) = (start / LANES, start % LANES);
    let chosen = mask32x16::from_bitmask(simd, u64::from(bits));
    let taken = mask32x16::from_bitmask(simd, (1 << first) - 1);
    let lanes: u8x64<S> = u32x16::from_slice(simd, &LANE_BYTES)
        .compress(chosen)
        .bitcast();
    let lanes = lanes.swizzle_dyn(u8x64::from_slice(simd, &ROTATIONS[first]));
    let [last, next, ..] = &mut to[index..] else {
        return;
    };
    let fields = chunk.fields.as_ref().iter();
    let targets = last.fields.as_mut().iter_mut().zip(next.fields.as_mut());
    for (field, (last, next)) in fields.zip(targets) {
        let rotated = f32x16::from_slice(simd, field).swizzle_dyn(lanes);
        let merged = taken.select(f32x16::from_slice(simd, last), rotated);
        merged.store_slice(last);
        rotated.store_slice(next);
    }
    let rotated = u32x16::from_slice(simd, &chunk.lights).swizzle_dyn(lanes);
    let merged = taken.select(u32x16::from_slice(simd, &last.lights), rotated);
    merged.store_slice(&mut last.lights);
    rotated.store_slice(&mut next.lights);
}

/// Fills the lanes from position `len` to the end of its chunk with shapes that touch nothing.
#[inline(always)]
fn clear_after<S: Simd, P: Projected>(simd: S, chunks: &mut [Chunk<P>], len: usize) {
    let taken = (1_u64 << (len % LANES)) - 1;
    let fields = chunks[len / LANES].fields.as_mut().iter_mut();
    for (lanes, nowhere) in fields.zip(P::NOWHERE.as_ref()) {
        for part in 0..parts::<S>() {
            let bits = (taken >> (part * S::f32s::LEN)) & ((1 << S::f32s::LEN) - 1);
            let taken = S::mask32s::from_bitmask(simd, bits);
            let nowhere = F32Lanes::new(simd, *nowhere);
            let kept = F32Lanes::select(taken, load(simd, lanes, part), nowhere);
            store(lanes, part, kept);
        }
    }
}

/// For each lane, the indices of its four bytes in a vector.
const LANE_BYTES: [u32; LANES] = {
    let mut lanes = [0; LANES];
    let mut lane = 0;
    while lane < LANES {
        lanes[lane] = 0x0302_0100 + 0x0404_0404 * lane as u32;
        lane += 1;
    }
    lanes
};

/// `ROTATIONS[n]` holds the indices of the bytes of a vector after all lanes are moved up by n, with wrap
/// around the end.
const ROTATIONS: [[u8; 4 * LANES]; LANES] = {
    let mut rotations = [[0; 4 * LANES]; LANES];
    let mut n = 0;
    while n < LANES {
        let mut byte = 0;
        while byte < 4 * LANES {
            rotations[n][byte] = ((byte + 4 * LANES - 4 * n) % (4 * LANES)) as u8;
            byte += 1;
        }
        n += 1;
    }
    rotations
};
