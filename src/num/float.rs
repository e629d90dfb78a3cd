//! Floating-point functions of the backend, `std` or `libm`. No other file names a backend.

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

/// √x, correctly rounded on either backend.
#[inline]
pub(crate) fn sqrt_f64(x: f64) -> f64 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let root = x.sqrt();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let root = libm::sqrt(x);
    root
}

/// tan x, with the accuracy of the backend.
pub(crate) fn tan(x: f32) -> f32 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let tangent = x.tan();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let tangent = libm::tanf(x);
    tangent
}

/// x^y for x > 0, with the accuracy of the backend.
pub(crate) fn power(x: f32, y: f32) -> f32 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let power = x.powf(y);
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let power = libm::powf(x, y);
    power
}

/// sin x and cos x, with the accuracy of the backend.
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let both = x.sin_cos();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let both = libm::sincosf(x);
    both
}

/// ln(1 + x) for x > −1, with the accuracy of the backend.
pub(crate) fn ln_1p_f64(x: f64) -> f64 {
    #[cfg(feature = "std")]
    #[expect(clippy::disallowed_methods, reason = "this is the backend")]
    let logarithm = x.ln_1p();
    #[cfg(all(feature = "libm", not(feature = "std")))]
    let logarithm = libm::log1p(x);
    logarithm
}
