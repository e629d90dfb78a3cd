//! The only module that names a float backend, and the one home of outward rounding.

use glam::Vec3;

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!(
    "stochastic-light-culling needs a float backend: enable the feature `std` (default) or `libm`"
);

/// √x, correctly rounded on either backend.
#[inline]
pub(crate) fn sqrt(x: f32) -> f32 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let root = x.sqrt();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let root = libm::sqrtf(x);
    root
}

/// tan x, to the accuracy of the backend.
pub(crate) fn tan(x: f32) -> f32 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let tangent = x.tan();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let tangent = libm::tanf(x);
    tangent
}

/// x^y for x > 0, to the accuracy of the backend.
pub(crate) fn power(x: f32, y: f32) -> f32 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let power = x.powf(y);
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let power = libm::powf(x, y);
    power
}

/// One correctly rounded `f32` operation errs by at most this share of its result: 2⁻²⁴.
pub(crate) const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// `x ≥ 0`, enlarged by more than `roundings` correctly rounded operations can have taken from it.
///
/// n operations take at most a share n·2⁻²⁴; the two more pay for this product and sum.
#[inline]
pub(crate) fn round_up(x: f32, roundings: u16) -> f32 {
    x * (1.0 + (f32::from(roundings) + 2.0) * UNIT_ROUNDOFF)
}

/// The counterpart of [`round_up`]: `x ≥ 0`, reduced.
#[inline]
pub(crate) fn round_down(x: f32, roundings: u16) -> f32 {
    x * (1.0 - (f32::from(roundings) + 2.0) * UNIT_ROUNDOFF)
}

/// The greater of two numbers that are not NaN, as processors find it: without asking for one.
#[inline]
pub(crate) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser of two numbers that are not NaN.
#[inline]
pub(crate) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// x⁵.
#[inline]
pub(crate) fn fifth_power(x: f32) -> f32 {
    let squared = x * x;
    squared * squared * x
}

/// a·b with the rounding of `f64`, in which products of `f32` numbers are exact.
#[inline]
pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    let [x, y, z] = products(a, b);
    x + y + z
}

#[inline]
fn products(a: Vec3, b: Vec3) -> [f64; 3] {
    [
        f64::from(a.x) * f64::from(b.x),
        f64::from(a.y) * f64::from(b.y),
        f64::from(a.z) * f64::from(b.z),
    ]
}

/// a·b, exact but for one rounding to `f64`, however far its terms cancel: what the sums lose is added
/// at the end.
#[inline]
pub(crate) fn exact_dot(a: Vec3, b: Vec3) -> f64 {
    let [x, y, z] = products(a, b);
    let (sum, first) = sum_with_rest(x, y);
    let (sum, second) = sum_with_rest(sum, z);
    sum + (first + second)
}

/// a + b in `f64`, and what rounding took from it [Knuth 1969, 4.2.2].
#[inline]
fn sum_with_rest(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// a × b with the rounding of `f64`: nearly parallel vectors keep the direction of their product.
#[inline]
pub(crate) fn cross(a: Vec3, b: Vec3) -> [f64; 3] {
    let minor = |a0: f32, a1: f32, b0: f32, b1: f32| {
        f64::from(a0) * f64::from(b1) - f64::from(a1) * f64::from(b0)
    };
    [
        minor(a.y, a.z, b.y, b.z),
        minor(a.z, a.x, b.z, b.x),
        minor(a.x, a.y, b.x, b.y),
    ]
}

/// ‖v‖. The squares of an `f32` cross product do not underflow in `f64`.
#[inline]
pub(crate) fn length([x, y, z]: [f64; 3]) -> f64 {
    sqrt_of_wide(x * x + y * y + z * z)
}

/// √x, correctly rounded on either backend.
#[inline]
pub(crate) fn sqrt_of_wide(x: f64) -> f64 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let root = x.sqrt();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let root = libm::sqrt(x);
    root
}
