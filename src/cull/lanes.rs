//! Sixteen lights side by side, processed by vectors of any width.

use fearless_simd::{Simd, SimdBase};

use crate::num::{F32Lanes, MAX_LANES};
use crate::view::ViewBounds;

/// The number of lights in a chunk: the lanes of the widest vectors.
pub(super) const LANES: usize = MAX_LANES;

/// One value for each of sixteen lights.
pub(super) type Lanes<T = f32> = [T; LANES];

/// The number of vectors in a chunk where they are narrowest, of four lanes.
pub(super) const MAX_PARTS: usize = LANES / 4;

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

/// The same tile in each lane.
#[inline(always)]
pub(super) fn splat_tile<S: Simd>(simd: S, tile: ViewBounds<f32>) -> ViewBounds<F32Lanes<S>> {
    let splat = |[min, max]: [f32; 2]| [F32Lanes::new(simd, min), F32Lanes::new(simd, max)];
    ViewBounds {
        across: splat(tile.across),
        down: splat(tile.down),
        depths: splat(tile.depths),
    }
}
