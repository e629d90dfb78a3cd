//! Two numbers side by side as one number.

use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use fearless_simd::{Simd, SimdBase};

use super::lanes::{F32Lanes, load_quads};
use super::real::{Mask, Quad, Real, Single};

/// Two numbers, of which each operation computes both: of vectors, twice as many lanes.
///
/// Most formulas are long chains, in which each operation waits for the one before. A processor has time for those of
/// a second vector, but finds them only if they are near.
#[derive(Clone, Copy, Debug)]
pub struct Twice<T>(pub T, pub T);

impl<M: Mask> BitAnd for Twice<M> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0, self.1 & other.1)
    }
}

impl<M: Mask> BitOr for Twice<M> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0, self.1 | other.1)
    }
}

impl<M: Mask> Not for Twice<M> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<N: Real> Neg for Twice<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

/// Implements operators with another pair, and with one number for all lanes.
macro_rules! operators {
    ($($operator:ident $function:ident $sign:tt $($element:ty)*,)*) => {$(
        impl<N: Real> $operator for Twice<N> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(self.0 $sign other.0, self.1 $sign other.1)
            }
        }

        $(
            impl<N: Real<Element = $element>> $operator<$element> for Twice<N> {
                type Output = Self;

                #[inline(always)]
                fn $function(self, other: $element) -> Self {
                    Self(self.0 $sign other, self.1 $sign other)
                }
            }
        )*
    )*};
}

operators! {
    Add add + f32 f64,
    Sub sub - f32 f64,
    Mul mul * f32 f64,
    Div div /,
}

/// Implements functions of one pair and of two.
macro_rules! each {
    ($($function:ident($($other:ident)?) -> $result:ty,)*) => {$(
        #[inline(always)]
        fn $function(self, $($other: Self)?) -> $result {
            Twice(self.0.$function($($other.0)?), self.1.$function($($other.1)?))
        }
    )*};
}

impl<N: Real> Real for Twice<N>
where
    Self: Add<N::Element, Output = Self>
        + Sub<N::Element, Output = Self>
        + Mul<N::Element, Output = Self>,
{
    type Element = N::Element;
    type Mask = Twice<N::Mask>;

    each! {
        abs() -> Self,
        sqrt() -> Self,
        copysign(sign) -> Self,
        max(other) -> Self,
        min(other) -> Self,
        gt(other) -> Self::Mask,
        le(other) -> Self::Mask,
        eq(other) -> Self::Mask,
        is_finite() -> Self::Mask,
    }

    #[inline(always)]
    fn splat(self, value: N::Element) -> Self {
        let value = self.0.splat(value);
        Self(value, value)
    }

    #[inline(always)]
    fn select_all<const K: usize>(
        mask: Self::Mask,
        mut yes: [Self; K],
        no: [Self; K],
    ) -> [Self; K] {
        for (yes, no) in yes.iter_mut().zip(no) {
            yes.0 = N::select(mask.0, yes.0, no.0);
            yes.1 = N::select(mask.1, yes.1, no.1);
        }
        yes
    }

    #[inline(always)]
    fn is_known_false(mask: Self::Mask) -> bool {
        N::is_known_false(mask.0) && N::is_known_false(mask.1)
    }

    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        N::any(mask.0) || N::any(mask.1)
    }
}

#[expect(
    clippy::redundant_closure,
    reason = "a reference to a closure is called, not inlined"
)]
impl<N: Single> Single for Twice<N> {
    const LANES: usize = 2 * N::LANES;

    type Double = Twice<N::Double>;

    #[inline(always)]
    fn widen(self) -> Twice<N::Double> {
        Twice(self.0.widen(), self.1.widen())
    }

    #[inline(always)]
    fn narrow(double: Twice<N::Double>) -> Self {
        Self(N::narrow(double.0), N::narrow(double.1))
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Self(
            self.0.times_plus(factor.0, addend.0),
            self.1.times_plus(factor.1, addend.1),
        )
    }

    #[inline(always)]
    fn power_in_last_bits(self) -> Self {
        Self(self.0.power_in_last_bits(), self.1.power_in_last_bits())
    }

    #[inline(always)]
    fn with_power_in_last_bits(self, least: Self) -> Self {
        Self(
            self.0.with_power_in_last_bits(least.0),
            self.1.with_power_in_last_bits(least.1),
        )
    }

    #[inline(always)]
    fn load(self, lanes: &[f32]) -> Self {
        Self(self.0.load(lanes), self.1.load(&lanes[N::LANES..]))
    }

    #[inline(always)]
    fn gather(self, mut function: impl FnMut(usize) -> f32) -> Self {
        let first = self.0.gather(
            #[inline(always)]
            |lane| function(lane),
        );
        let second = self.1.gather(
            #[inline(always)]
            |lane| function(N::LANES + lane),
        );
        Self(first, second)
    }

    #[inline(always)]
    fn per_lane<const K: usize>(
        numbers: [Self; K],
        mut function: impl FnMut(usize, [f32; K]) -> f32,
    ) -> Self {
        let Twice(first, second) = of_each(numbers);
        let first = N::per_lane(
            first,
            #[inline(always)]
            |lane, numbers| function(lane, numbers),
        );
        let second = N::per_lane(
            second,
            #[inline(always)]
            |lane, numbers| function(N::LANES + lane, numbers),
        );
        Self(first, second)
    }

    #[inline(always)]
    fn per_lane_quads(
        numbers: Quad<Self>,
        mask: Self::Mask,
        mut function: impl FnMut(Quad<f32>, bool) -> [Quad<f32>; 2],
    ) -> [Quad<Self>; 2] {
        let Twice(first, second) = of_each(numbers);
        let [a, b] = N::per_lane_quads(
            first,
            mask.0,
            #[inline(always)]
            |numbers, flag| function(numbers, flag),
        );
        let [c, d] = N::per_lane_quads(
            second,
            mask.1,
            #[inline(always)]
            |numbers, flag| function(numbers, flag),
        );
        [side_by_side(a, c), side_by_side(b, d)]
    }
}

/// The first numbers of pairs, and the second ones.
#[inline(always)]
fn of_each<N: Real, const K: usize>(pairs: [Twice<N>; K]) -> Twice<[N; K]> {
    // Not `array::map`, which the compiler makes a call through memory.
    let (mut first, mut second) = ([pairs[0].0; K], [pairs[0].1; K]);
    for ((first, second), pair) in first.iter_mut().zip(&mut second).zip(pairs) {
        (*first, *second) = (pair.0, pair.1);
    }
    Twice(first, second)
}

/// The inverse of [`of_each`].
#[inline(always)]
fn side_by_side<N: Real, const K: usize>(first: [N; K], second: [N; K]) -> [Twice<N>; K] {
    let mut pairs = [Twice(first[0], second[0]); K];
    for (pair, (first, second)) in pairs.iter_mut().zip(first.into_iter().zip(second)) {
        *pair = Twice(first, second);
    }
    pairs
}

/// [`load_quads`] for two vectors of lanes.
#[inline(always)]
pub fn load_quads_twice<S: Simd>(simd: S, quads: &[Quad<f32>]) -> Quad<Twice<F32Lanes<S>>> {
    let (first, second) = quads.split_at(S::f32s::LEN);
    side_by_side(load_quads(simd, first), load_quads(simd, second))
}
