//! Sixteen lights side by side, and how a vector of any width goes over them.

use fearless_simd::{Simd, SimdBase};

/// Lights in a chunk: what the widest vectors hold.
pub(super) const LANES: usize = 16;

/// One number of each of sixteen lights.
pub(super) type Lanes<T = f32> = [T; LANES];

/// How many vectors of this width make up a chunk.
pub(super) const fn parts<S: Simd>() -> usize {
    LANES / S::f32s::LEN
}

/// The `part`-th vector of `lanes`.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, lanes: &Lanes, part: usize) -> S::f32s {
    S::f32s::from_slice(simd, &lanes[part * S::f32s::LEN..][..S::f32s::LEN])
}

/// The vectors of each of four numbers that are held light by light, in as many `lanes`.
#[inline(always)]
pub(super) fn load_fours<S: Simd>(simd: S, lanes: &[[f32; 4]]) -> [S::f32s; 4] {
    let numbers = lanes.as_flattened();
    let [a, b, c, d] = [0, 1, 2, 3]
        .map(|i| S::f32s::from_slice(simd, &numbers[i * S::f32s::LEN..][..S::f32s::LEN]));
    let [(first_and_third, second_and_fourth), (third, fourth)] =
        [a.deinterleave(b), c.deinterleave(d)];
    let (first, third) = first_and_third.deinterleave(third);
    let (second, fourth) = second_and_fourth.deinterleave(fourth);
    [first, second, third, fourth]
}

#[inline(always)]
pub(super) fn store<S: Simd>(lanes: &mut Lanes, part: usize, vector: S::f32s) {
    vector.store_slice(&mut lanes[part * S::f32s::LEN..][..S::f32s::LEN]);
}

/// Both ends of a range, in each lane.
pub(super) type Ends<S> = [<S as Simd>::f32s; 2];

#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, [low, high]: [f32; 2]) -> Ends<S> {
    [S::f32s::splat(simd, low), S::f32s::splat(simd, high)]
}

/// The range of `factor` times a number in `range`.
#[inline(always)]
pub(super) fn scaled<S: Simd>(factor: S::f32s, range: Ends<S>) -> Ends<S> {
    let (a, b) = (factor * range[0], factor * range[1]);
    [a.min(b), a.max(b)]
}

#[inline(always)]
pub(super) fn shifted<S: Simd>(range: Ends<S>, by: Ends<S>) -> Ends<S> {
    [range[0] + by[0], range[1] + by[1]]
}

/// How far `center` is from `range` times a number in `depths`.
#[inline(always)]
pub(super) fn apart_at_depths<S: Simd>(
    center: S::f32s,
    range: Ends<S>,
    depths: Ends<S>,
) -> S::f32s {
    let [low, _] = scaled::<S>(range[0], depths);
    let [_, high] = scaled::<S>(range[1], depths);
    apart::<S>(center, [low, high])
}

/// How far `center` is from `range`.
#[inline(always)]
pub(super) fn apart<S: Simd>(center: S::f32s, range: Ends<S>) -> S::f32s {
    center - center.max(range[0]).min(range[1])
}

/// x² + y² + z².
#[inline(always)]
pub(super) fn length_squared<S: Simd>(x: S::f32s, y: S::f32s, z: S::f32s) -> S::f32s {
    x * x + y * y + z * z
}
