use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::rounding::round_up;

/// A truth value for each lane: `bool` for a scalar.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl<M: Copy + BitAnd<Output = M> + BitOr<Output = M> + Not<Output = M>> Mask for M {}

/// Four numbers of one light. They are copied and transposed as one vector.
pub type Quad<N> = [N; 4];

/// A real number: an `f32` or an `f64`, or one in each lane of a vector.
///
/// The operators also take an [`Element`](Self::Element) on their right, the same for all lanes.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<<Self as Real>::Element, Output = Self>
    + Sub<<Self as Real>::Element, Output = Self>
    + Mul<<Self as Real>::Element, Output = Self>
{
    /// The number in one lane.
    type Element: Copy + Default;
    /// The result of a comparison.
    type Mask: Mask;

    /// Puts `value` into as many lanes as `self` has.
    fn splat(self, value: Self::Element) -> Self;
    /// |self|
    fn abs(self) -> Self;
    /// √self, correctly rounded.
    fn sqrt(self) -> Self;
    /// |self| with the sign of `sign`.
    fn copysign(self, sign: Self) -> Self;

    /// The greater operand; `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// The lesser operand; `other` if either is NaN.
    fn min(self, other: Self) -> Self;

    /// self > other
    fn gt(self, other: Self) -> Self::Mask;
    /// self ≤ other
    fn le(self, other: Self) -> Self::Mask;
    /// self = other
    fn eq(self, other: Self) -> Self::Mask;
    /// Whether the number is neither infinite nor NaN.
    fn is_finite(self) -> Self::Mask;

    /// `yes` where `mask` holds, `no` elsewhere.
    ///
    /// Select values that share a mask together: a scalar then takes one branch, where several single selects
    /// become a branch and a blend.
    fn select_all<const K: usize>(mask: Self::Mask, yes: [Self; K], no: [Self; K]) -> [Self; K];

    /// Whether `mask` is known to hold in no lane, so that a scalar can skip what a `select` would discard.
    /// Always false for a vector.
    fn is_known_false(mask: Self::Mask) -> bool;

    /// Whether `mask` holds in a lane.
    fn any(mask: Self::Mask) -> bool;

    /// `yes` where `mask` holds, `no` elsewhere.
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        let [one] = Self::select_all(mask, [yes], [no]);
        one
    }

    /// Zero in as many lanes as `self` has.
    #[inline(always)]
    fn zero(self) -> Self {
        self.splat(Self::Element::default())
    }

    /// self > 0
    #[inline(always)]
    fn is_positive(self) -> Self::Mask {
        self.gt(self.zero())
    }

    /// self² · self² · self
    #[inline(always)]
    fn fifth_power(self) -> Self {
        let squared = self * self;
        squared * squared * self
    }
}

/// A [`Real`] in single precision: an `f32`, or one in each lane.
pub trait Single: Real<Element = f32> {
    /// The number of lanes.
    const LANES: usize;

    /// As many lanes in double precision, with the same masks.
    type Double: Double<Mask = Self::Mask>;

    /// Converts to double precision, exactly.
    fn widen(self) -> Self::Double;
    /// Rounds to single precision.
    fn narrow(double: Self::Double) -> Self;

    /// Loads one number for each lane of `self` from the start of `lanes`, which must be long enough.
    fn load(self, lanes: &[f32]) -> Self;

    /// Collects what `function` returns for the index of each lane of `self`.
    fn gather(self, function: impl FnMut(usize) -> f32) -> Self;

    /// Applies `function` to the index and the numbers of each lane: for what cannot be computed in lanes,
    /// such as a function of the caller.
    fn per_lane<const K: usize>(
        numbers: [Self; K],
        function: impl FnMut(usize, [f32; K]) -> f32,
    ) -> Self;

    /// Applies `function` to four numbers and the bit of `mask` of each lane, and collects its two quads.
    fn per_lane_quads(
        numbers: Quad<Self>,
        mask: Self::Mask,
        function: impl FnMut(Quad<f32>, bool) -> [Quad<f32>; 2],
    ) -> [Quad<Self>; 2];

    /// self · factor + addend, rounded once where the processor fuses them, and else twice: for tests that leave room
    /// for either, not for results.
    fn times_plus(self, factor: Self, addend: Self) -> Self;

    /// The power of two 2^(k − 16), where k is what the last five bits hold. Infinite if all of them are set.
    fn power_in_last_bits(self) -> Self;

    /// This number, with the least [power](Self::power_in_last_bits) in its last bits that is not below `least`, which
    /// must not be NaN.
    fn with_power_in_last_bits(self, least: Self) -> Self;

    /// 1 − self
    #[inline(always)]
    fn one_minus(self) -> Self {
        -self + 1.0
    }

    /// 1/self
    #[inline(always)]
    fn recip(self) -> Self {
        self.splat(1.0) / self
    }

    /// Applies [`round_up`] in each lane.
    #[inline(always)]
    fn round_up(self, roundings: u16) -> Self {
        self * round_up(1.0, roundings)
    }
}

/// The bits that hold a [power](Single::power_in_last_bits), which are the last of its exponent.
pub(super) const POWER_BITS: u32 = 31;
/// The others of the exponent, for a power times 2¹¹³.
pub(super) const POWER_BASE: u32 = 0x7000_0000;
/// 2¹¹³ and its reciprocal.
pub(super) const POWER_SCALE: f32 = 1.038_459_4e34;
pub(super) const POWER_UNIT: f32 = 1.0 / POWER_SCALE;
/// Where the exponent begins, and all bits before it.
pub(super) const EXPONENT_SHIFT: u32 = 23;
pub(super) const FRACTION_BITS: u32 = (1 << EXPONENT_SHIFT) - 1;

/// A [`Real`] in double precision: an `f64`, or one in each lane.
pub trait Double: Real<Element = f64> {}

impl<N: Real<Element = f64>> Double for N {}
