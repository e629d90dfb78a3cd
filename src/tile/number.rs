//! What the exact test reckons with: one `f64`, or as many as a vector has lanes.

#![allow(
    clippy::inline_always,
    reason = "so that a culler has it compiled for its own processor"
)]

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

use crate::math;

/// An `f64`, or many side by side.
pub trait Number:
    Copy
    + Debug
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// Whether something is so, of each.
    type Truth;

    /// `value` in place of this one.
    fn constant(self, value: f64) -> Self;
    fn times(self, factor: f64) -> Self;
    fn abs(self) -> Self;
    fn sqrt(self) -> Self;

    /// The greater of both, `otherwise` where this is NaN.
    fn greater(self, otherwise: Self) -> Self;
    /// The lesser of both, `otherwise` where this is NaN.
    fn lesser(self, otherwise: Self) -> Self;
    fn is_greater(self, other: Self) -> Self::Truth;
}

impl Number for f64 {
    type Truth = bool;

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        math::sqrt_of_wide(self)
    }

    // One instruction, unlike `f64::max`.
    #[inline(always)]
    fn greater(self, otherwise: Self) -> Self {
        if self > otherwise { self } else { otherwise }
    }

    #[inline(always)]
    fn lesser(self, otherwise: Self) -> Self {
        if self < otherwise { self } else { otherwise }
    }

    #[inline(always)]
    fn is_greater(self, other: Self) -> bool {
        self > other
    }
}
