//! Vector registers in double precision, as [`Real`] numbers.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{
    ExtractToken, MaskNarrow, MaskWiden, Select, Simd, SimdBase, SimdFloat, SimdMask,
};

use super::real::Real;

/// Whether the vector instructions for max and min return their second operand for NaN, as [`Real`] requires.
/// On processors other than x86 they return NaN.
const NATIVE_MAX_PASSES_NAN_OVER: bool = cfg!(any(target_arch = "x86", target_arch = "x86_64"));

#[inline(always)]
pub(super) fn max<S: Simd, V: SimdFloat<S>>(a: V, other: V) -> V {
    if NATIVE_MAX_PASSES_NAN_OVER {
        a.max(other)
    } else {
        a.simd_gt(other).select(a, other)
    }
}

#[inline(always)]
pub(super) fn min<S: Simd, V: SimdFloat<S>>(a: V, other: V) -> V {
    if NATIVE_MAX_PASSES_NAN_OVER {
        a.min(other)
    } else {
        a.simd_lt(other).select(a, other)
    }
}

/// An `f64` in each lane: one vector for the lower half of the lanes, and one for the upper half.
#[derive(Clone, Copy, Debug)]
pub struct F64Lanes<S: Simd> {
    pub(super) low: S::f64s,
    pub(super) high: S::f64s,
}

/// Implements operators with another number in each lane, and with one number for all lanes.
macro_rules! operators {
    ($($operator:ident $function:ident $sign:tt,)*) => {$(
        impl<S: Simd> $operator for F64Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self {
                    low: self.low $sign other.low,
                    high: self.high $sign other.high,
                }
            }
        }

        impl<S: Simd> $operator<f64> for F64Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                Self {
                    low: self.low $sign other,
                    high: self.high $sign other,
                }
            }
        }
    )*};
}

operators! {
    Add add +,
    Sub sub -,
    Mul mul *,
    Div div /,
}

impl<S: Simd> Neg for F64Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            low: -self.low,
            high: -self.high,
        }
    }
}

impl<S: Simd> Real for F64Lanes<S> {
    type Element = f64;
    type Mask = S::mask32s;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        let value = S::f64s::splat(self.low.token(), value);
        Self {
            low: value,
            high: value,
        }
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
    fn copysign(self, sign: Self) -> Self {
        Self {
            low: self.low.copysign(sign.low),
            high: self.high.copysign(sign.high),
        }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self {
            low: max(self.low, other.low),
            high: max(self.high, other.high),
        }
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self {
            low: min(self.low, other.low),
            high: min(self.high, other.high),
        }
    }

    #[inline(always)]
    fn gt(self, other: Self) -> S::mask32s {
        let low = self.low.simd_gt(other.low);
        low.narrow(self.high.simd_gt(other.high))
    }

    #[inline(always)]
    fn le(self, other: Self) -> S::mask32s {
        let low = self.low.simd_le(other.low);
        low.narrow(self.high.simd_le(other.high))
    }

    #[inline(always)]
    fn eq(self, other: Self) -> S::mask32s {
        let low = self.low.simd_eq(other.low);
        low.narrow(self.high.simd_eq(other.high))
    }

    #[inline(always)]
    fn is_finite(self) -> S::mask32s {
        self.low.is_finite().narrow(self.high.is_finite())
    }

    #[inline(always)]
    fn select_all<const K: usize>(
        mask: S::mask32s,
        mut yes: [Self; K],
        no: [Self; K],
    ) -> [Self; K] {
        let (low, high) = mask.widen();
        for (yes, no) in yes.iter_mut().zip(no) {
            yes.low = low.select(yes.low, no.low);
            yes.high = high.select(yes.high, no.high);
        }
        yes
    }

    #[inline(always)]
    fn is_known_false(_: S::mask32s) -> bool {
        false
    }

    #[inline(always)]
    fn any(mask: S::mask32s) -> bool {
        mask.any_true()
    }
}
