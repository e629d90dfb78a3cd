//! Outward rounding. `docs/rounding.md` derives the number of roundings that each caller passes.

/// The largest relative error of a correctly rounded `f32` operation, u = 2⁻²⁴.
pub(crate) const UNIT_ROUNDOFF: f32 = f32::EPSILON / 2.0;

/// Pays for the product, for the rounding of its factor, and for terms of second order.
const OWN_ROUNDINGS: f32 = 2.0;

/// Enlarges `x ≥ 0` by more than `roundings` = n correctly rounded operations can have taken from it: by a
/// share of (n + 2)·2⁻²⁴.
#[inline]
pub(crate) const fn round_up(x: f32, roundings: u16) -> f32 {
    x * (1.0 + (roundings as f32 + OWN_ROUNDINGS) * UNIT_ROUNDOFF)
}

/// Reduces `x ≥ 0` by more than `roundings` correctly rounded operations can have added to it.
#[inline]
pub(crate) const fn round_down(x: f32, roundings: u16) -> f32 {
    x * (1.0 - (roundings as f32 + OWN_ROUNDINGS) * UNIT_ROUNDOFF)
}
