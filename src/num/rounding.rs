//! Outward rounding. docs/rounding.md counts the roundings that its callers name.

/// Largest relative error of one correctly rounded `f32` operation, u = 2⁻²⁴.
pub(crate) const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// Pays for the product, for the rounding of its factor, and for terms of second order.
const OWN_ROUNDINGS: f32 = 2.0;

/// `x ≥ 0`, enlarged by more than `roundings` correctly rounded operations can have taken from it.
///
/// n operations take at most a share n·2⁻²⁴; the two more pay for this product and sum.
#[inline]
pub(crate) const fn round_up(x: f32, roundings: u16) -> f32 {
    x * (1.0 + (roundings as f32 + OWN_ROUNDINGS) * UNIT_ROUNDOFF)
}

/// `x ≥ 0`, reduced by more than `roundings` correctly rounded operations can have added to it.
#[inline]
pub(crate) const fn round_down(x: f32, roundings: u16) -> f32 {
    x * (1.0 - (roundings as f32 + OWN_ROUNDINGS) * UNIT_ROUNDOFF)
}
