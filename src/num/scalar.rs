use super::real::{
    EXPONENT_SHIFT, FRACTION_BITS, POWER_BASE, POWER_BITS, POWER_SCALE, POWER_UNIT, Quad, Real,
    Single,
};
use super::{sqrt, sqrt_f64};

macro_rules! real {
    ($float:ty, $sqrt:path) => {
        impl Real for $float {
            type Element = Self;
            type Mask = bool;

            #[inline(always)]
            fn splat(self, value: Self) -> Self {
                value
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Self::abs(self)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }

            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                Self::copysign(self, sign)
            }

            // A single instruction, unlike the inherent function.
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self > other { self } else { other }
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if self < other { self } else { other }
            }

            #[inline(always)]
            fn gt(self, other: Self) -> bool {
                self > other
            }

            #[inline(always)]
            fn le(self, other: Self) -> bool {
                self <= other
            }

            #[inline(always)]
            fn eq(self, other: Self) -> bool {
                self == other
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                Self::is_finite(self)
            }

            #[inline(always)]
            fn select_all<const K: usize>(mask: bool, yes: [Self; K], no: [Self; K]) -> [Self; K] {
                if mask { yes } else { no }
            }

            #[inline(always)]
            fn is_known_false(mask: bool) -> bool {
                !mask
            }

            #[inline(always)]
            fn any(mask: bool) -> bool {
                mask
            }
        }
    };
}

real!(f32, sqrt);
real!(f64, sqrt_f64);

impl Single for f32 {
    const LANES: usize = 1;

    type Double = f64;

    #[inline(always)]
    fn widen(self) -> f64 {
        self.into()
    }

    #[inline(always)]
    fn narrow(double: f64) -> Self {
        double as Self
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }

    #[inline(always)]
    fn power_in_last_bits(self) -> Self {
        let exponent = (self.to_bits() & POWER_BITS) << EXPONENT_SHIFT;
        Self::from_bits(exponent | POWER_BASE) * POWER_UNIT
    }

    #[inline(always)]
    fn with_power_in_last_bits(self, least: Self) -> Self {
        let scaled = Real::max(least * POWER_SCALE, Self::from_bits(POWER_BASE));
        let exponent = (scaled.to_bits() + FRACTION_BITS) >> EXPONENT_SHIFT;
        Self::from_bits(self.to_bits() & !POWER_BITS | exponent & POWER_BITS)
    }

    #[inline(always)]
    fn load(self, lanes: &[Self]) -> Self {
        lanes[0]
    }

    #[inline(always)]
    fn gather(self, mut function: impl FnMut(usize) -> Self) -> Self {
        function(0)
    }

    #[inline(always)]
    fn per_lane<const K: usize>(
        numbers: [Self; K],
        mut function: impl FnMut(usize, [Self; K]) -> Self,
    ) -> Self {
        function(0, numbers)
    }

    #[inline(always)]
    fn per_lane_quads(
        numbers: Quad<Self>,
        mask: bool,
        mut function: impl FnMut(Quad<Self>, bool) -> [Quad<Self>; 2],
    ) -> [Quad<Self>; 2] {
        function(numbers, mask)
    }
}
