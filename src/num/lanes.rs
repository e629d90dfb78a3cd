//! Vector registers as [`Real`] numbers.

use core::ops::{Add, Div, Mul, Neg, Sub};

use fearless_simd::{
    Bytes, ExtractToken, Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, SimdWiden,
};

use super::double_lanes::{F64Lanes, max, min};
use super::real::{
    EXPONENT_SHIFT, FRACTION_BITS, POWER_BASE, POWER_BITS, POWER_SCALE, POWER_UNIT, Quad, Real,
    Single,
};

/// The number of lanes of the widest vectors.
pub(crate) const MAX_LANES: usize = 16;

/// An `f32` in each lane.
#[derive(Clone, Copy, Debug)]
pub struct F32Lanes<S: Simd>(pub S::f32s);

impl<S: Simd> F32Lanes<S> {
    /// Puts `value` into each lane.
    #[inline(always)]
    pub fn new(simd: S, value: f32) -> Self {
        Self(S::f32s::splat(simd, value))
    }
}

/// Implements operators with another vector, and with one number for all lanes.
macro_rules! operators {
    ($($operator:ident $function:ident $sign:tt,)*) => {$(
        impl<S: Simd> $operator for F32Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }

        impl<S: Simd> $operator<f32> for F32Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: f32) -> Self {
                Self(self.0 $sign other)
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

impl<S: Simd> Neg for F32Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<S: Simd> Real for F32Lanes<S> {
    type Element = f32;
    type Mask = S::mask32s;

    #[inline(always)]
    fn splat(self, value: f32) -> Self {
        Self(S::f32s::splat(self.0.token(), value))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        Self(self.0.copysign(sign.0))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(max(self.0, other.0))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(min(self.0, other.0))
    }

    #[inline(always)]
    fn gt(self, other: Self) -> S::mask32s {
        self.0.simd_gt(other.0)
    }

    #[inline(always)]
    fn le(self, other: Self) -> S::mask32s {
        self.0.simd_le(other.0)
    }

    #[inline(always)]
    fn eq(self, other: Self) -> S::mask32s {
        self.0.simd_eq(other.0)
    }

    #[inline(always)]
    fn is_finite(self) -> S::mask32s {
        self.0.is_finite()
    }

    #[inline(always)]
    fn select_all<const K: usize>(
        mask: S::mask32s,
        mut yes: [Self; K],
        no: [Self; K],
    ) -> [Self; K] {
        for (yes, no) in yes.iter_mut().zip(no) {
            yes.0 = mask.select(yes.0, no.0);
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

impl<S: Simd> Single for F32Lanes<S> {
    const LANES: usize = S::f32s::LEN;

    type Double = F64Lanes<S>;

    #[inline(always)]
    fn widen(self) -> F64Lanes<S> {
        let (low, high) = self.0.widen();
        F64Lanes { low, high }
    }

    #[inline(always)]
    fn narrow(double: F64Lanes<S>) -> Self {
        Self(double.low.narrow(double.high))
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0))
    }

    #[inline(always)]
    fn power_in_last_bits(self) -> Self {
        let exponent = (self.0.bitcast::<S::u32s>() & POWER_BITS) << EXPONENT_SHIFT;
        Self((exponent | POWER_BASE).bitcast()) * POWER_UNIT
    }

    #[inline(always)]
    fn with_power_in_last_bits(self, least: Self) -> Self {
        let scaled = (least * POWER_SCALE).max(self.splat(f32::from_bits(POWER_BASE)));
        let exponent = (scaled.0.bitcast::<S::u32s>() + FRACTION_BITS) >> EXPONENT_SHIFT;
        let others = self.0.bitcast::<S::u32s>() & !POWER_BITS;
        Self((others | exponent & POWER_BITS).bitcast())
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> Self {
        Self(S::f32s::from_slice(self.0.token(), &lanes[..S::f32s::LEN]))
    }

    #[inline(always)]
    fn gather(self, mut function: impl FnMut(usize) -> f32) -> Self {
        let mut lanes = [0.0; MAX_LANES];
        for (i, lane) in lanes[..S::f32s::LEN].iter_mut().enumerate() {
            *lane = function(i);
        }
        self.load(&lanes)
    }

    #[inline(always)]
    fn per_lane<const K: usize>(
        numbers: [Self; K],
        mut function: impl FnMut(usize, [f32; K]) -> f32,
    ) -> Self {
        const { assert!(K > 0) }
        let mut lanes = [[0.0; MAX_LANES]; K];
        for (lanes, numbers) in lanes.iter_mut().zip(numbers) {
            numbers.0.store_slice(&mut lanes[..S::f32s::LEN]);
        }
        numbers[0].gather(
            #[inline(always)]
            |i| {
                let mut of_lane = [0.0; K];
                for (number, lanes) in of_lane.iter_mut().zip(&lanes) {
                    *number = lanes[i];
                }
                function(i, of_lane)
            },
        )
    }

    #[inline(always)]
    fn per_lane_quads(
        numbers: Quad<Self>,
        mask: S::mask32s,
        mut function: impl FnMut(Quad<f32>, bool) -> [Quad<f32>; 2],
    ) -> [Quad<Self>; 2] {
        let (simd, mask) = (numbers[0].0.token(), mask.to_bitmask());
        let mut lanes = [[0.0; MAX_LANES]; 4];
        for (lanes, numbers) in lanes.iter_mut().zip(numbers) {
            numbers.0.store_slice(&mut lanes[..S::f32s::LEN]);
        }
        let [a, b, c, d] = lanes;
        let [mut first, mut second] = [[[0.0; 4]; MAX_LANES]; 2];
        for i in 0..S::f32s::LEN {
            [first[i], second[i]] = function([a[i], b[i], c[i], d[i]], mask >> i & 1 != 0);
        }
        [
            load_quads(simd, &first[..S::f32s::LEN]),
            load_quads(simd, &second[..S::f32s::LEN]),
        ]
    }
}

/// Transposes one quad per lane into one vector for each of the four numbers.
#[inline(always)]
pub(crate) fn load_quads<S: Simd>(simd: S, quads: &[Quad<f32>]) -> Quad<F32Lanes<S>> {
    let (numbers, lanes) = (quads.as_flattened(), S::f32s::LEN);
    // Not `array::map`, which the compiler makes a call through memory.
    let a = S::f32s::from_slice(simd, &numbers[..lanes]);
    let b = S::f32s::from_slice(simd, &numbers[lanes..2 * lanes]);
    let c = S::f32s::from_slice(simd, &numbers[2 * lanes..3 * lanes]);
    let d = S::f32s::from_slice(simd, &numbers[3 * lanes..4 * lanes]);
    let [(first_and_third, second_and_fourth), (third, fourth)] =
        [a.deinterleave(b), c.deinterleave(d)];
    let (first, third) = first_and_third.deinterleave(third);
    let (second, fourth) = second_and_fourth.deinterleave(fourth);
    [
        F32Lanes(first),
        F32Lanes(second),
        F32Lanes(third),
        F32Lanes(fourth),
    ]
}
