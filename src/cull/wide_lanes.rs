//! Numbers of `f64` in lanes of `f32`, which are half as wide.

use core::ops::{Add, Div, Mul, Sub};

use fearless_simd::{
    ExtractToken, MaskNarrow, Select, Simd, SimdBase, SimdFloat, SimdNarrow, SimdWiden,
};

use crate::tile::Number;

/// An `f64` in each lane: the vector of the lower lanes, and that of the upper ones.
#[derive(Clone, Copy, Debug)]
pub struct Wide<S: Simd> {
    low: S::f64s,
    high: S::f64s,
}

impl<S: Simd> Wide<S> {
    #[inline(always)]
    pub fn new(numbers: S::f32s) -> Self {
        let (low, high) = numbers.widen();
        Self { low, high }
    }

    #[inline(always)]
    pub fn splat(simd: S, number: f64) -> Self {
        let numbers = S::f64s::splat(simd, number);
        Self {
            low: numbers,
            high: numbers,
        }
    }

    /// Rounded.
    #[inline(always)]
    pub fn narrowed(self) -> S::f32s {
        self.low.narrow(self.high)
    }
}

impl<S: Simd> Add for Wide<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            low: self.low + other.low,
            high: self.high + other.high,
        }
    }
}

impl<S: Simd> Add<f64> for Wide<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self {
            low: self.low + other,
            high: self.high + other,
        }
    }
}

impl<S: Simd> Sub for Wide<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            low: self.low - other.low,
            high: self.high - other.high,
        }
    }
}

impl<S: Simd> Mul for Wide<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self {
            low: self.low * other.low,
            high: self.high * other.high,
        }
    }
}

impl<S: Simd> Mul<f64> for Wide<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self {
            low: self.low * other,
            high: self.high * other,
        }
    }
}

impl<S: Simd> Div for Wide<S> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self {
            low: self.low / other.low,
            high: self.high / other.high,
        }
    }
}

impl<S: Simd> Number for Wide<S> {
    type Truth = S::mask32s;

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.low.token(), value)
    }

    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * factor
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self {
            low: self.low.abs(),
            high: self.high.abs(),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self {
            low: self.low.sqrt(),
            high: self.high.sqrt(),
        }
    }

    #[inline(always)]
    fn greater(self, otherwise: Self) -> Self {
        // Elsewhere, unlike on x86, a NaN makes the result one.
        if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
            Self {
                low: self.low.max(otherwise.low),
                high: self.high.max(otherwise.high),
            }
        } else {
            let low = self.low.simd_gt(otherwise.low);
            let high = self.high.simd_gt(otherwise.high);
            Self {
                low: low.select(self.low, otherwise.low),
                high: high.select(self.high, otherwise.high),
            }
        }
    }

    #[inline(always)]
    fn lesser(self, otherwise: Self) -> Self {
        if cfg!(any(target_arch = "x86", target_arch = "x86_64")) {
            Self {
                low: self.low.min(otherwise.low),
                high: self.high.min(otherwise.high),
            }
        } else {
            let low = self.low.simd_lt(otherwise.low);
            let high = self.high.simd_lt(otherwise.high);
            Self {
                low: low.select(self.low, otherwise.low),
                high: high.select(self.high, otherwise.high),
            }
        }
    }

    #[inline(always)]
    fn is_greater(self, other: Self) -> S::mask32s {
        let low = self.low.simd_gt(other.low);
        low.narrow(self.high.simd_gt(other.high))
    }
}
