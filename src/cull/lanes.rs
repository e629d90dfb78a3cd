//! Sixteen lights side by side, processed by vectors of any width.

use fearless_simd::{Simd, SimdBase, SimdMask};

use crate::num::{F32Lanes, MAX_LANES};
use crate::view::ViewBounds;

/// The number of lights in a chunk: the lanes of the widest vectors.
pub(super) const LANES: usize = MAX_LANES;

/// One value for each of sixteen lights.
pub(super) type Lanes<T = f32> = [T; LANES];

/// The number of vectors of this width in a chunk.
pub(super) const fn parts<S: Simd>() -> usize {
    LANES / S::f32s::LEN
}

/// The `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, lanes: &Lanes, part: usize) -> F32Lanes<S> {
    F32Lanes(S::f32s::from_slice(
        simd,
        &lanes[part * S::f32s::LEN..][..S::f32s::LEN],
    ))
}

/// Stores the `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn store<S: Simd>(lanes: &mut Lanes, part: usize, vector: F32Lanes<S>) {
    let part = &mut lanes[part * S::f32s::LEN..][..S::f32s::LEN];
    vector.0.store_slice(part);
}

/// The `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn load_indices<S: Simd>(simd: S, lanes: &Lanes<u32>, part: usize) -> S::u32s {
    S::u32s::from_slice(simd, &lanes[part * S::u32s::LEN..][..S::u32s::LEN])
}

/// The mask of the first `count` lanes, or of all.
#[inline(always)]
pub(super) fn mask_of_first<S: Simd>(simd: S, count: usize) -> S::mask32s {
    S::mask32s::from_bitmask(simd, (1 << count.min(S::f32s::LEN)) - 1)
}

/// The numbers from `first` on.
#[inline(always)]
pub(super) fn numbers_from<S: Simd>(simd: S, first: usize) -> S::u32s {
    const ZERO_AND_SO_ON: Lanes<u32> = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
    load_indices(simd, &ZERO_AND_SO_ON, 0) + first as u32
}

/// The same range in each lane.
#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, [min, max]: [f32; 2]) -> [F32Lanes<S>; 2] {
    [F32Lanes::new(simd, min), F32Lanes::new(simd, max)]
}

/// The same bounds in each lane.
#[inline(always)]
pub(super) fn splat_bounds<S: Simd>(simd: S, bounds: &ViewBounds<f32>) -> ViewBounds<F32Lanes<S>> {
    ViewBounds {
        across: splat(simd, bounds.across),
        down: splat(simd, bounds.down),
        depths: splat(simd, bounds.depths),
    }
}

/// Moves the numbers that are `chosen` to the first lanes.
#[inline(always)]
pub(super) fn compress<S: Simd>(numbers: F32Lanes<S>, chosen: S::mask32s) -> S::f32s {
    numbers.0.compress(chosen)
}

/// Writes those of `numbers` that are `chosen` to the front of `out`. The rest of it may change too. Returns
/// how many are chosen.
///
/// Does not branch on which lanes are chosen, since it would often be mispredicted.
#[inline(always)]
pub(super) fn write_chosen<S: Simd>(
    numbers: S::u32s,
    chosen: S::mask32s,
    out: &mut [u32],
) -> usize {
    let bits = chosen.to_bitmask();
    if S::u32s::LEN > 4 {
        numbers
            .compress(chosen)
            .store_slice(&mut out[..S::u32s::LEN]);
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
