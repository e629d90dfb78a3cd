use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::rounding::round_up;

/// One truth value for each lane: `bool` for a scalar.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl<M: Copy + BitAnd<Output = M> + BitOr<Output = M> + Not<Output = M>> Mask for M {}

/// Four numbers of one light, which are copied and transposed as one vector.
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

    /// `value` in as many lanes as `self` has.
    fn splat(self, value: Self::Element) -> Self;
    fn abs(self) -> Self;
    /// √self, correctly rounded.
    fn sqrt(self) -> Self;
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
    fn is_finite(self) -> Self::Mask;

    /// `yes` where `mask` holds, `no` elsewhere.
    ///
    /// Values that share a mask are selected together: for a scalar that is one branch, where several
    /// single selects become a branch and a blend.
    fn select_all<const K: usize>(mask: Self::Mask, yes: [Self; K], no: [Self; K]) -> [Self; K];

    /// Whether `mask` is known to hold in no lane, so that a scalar can leave out what a `select` would
    /// discard. A vector is not asked: always false.
    fn is_known_false(mask: Self::Mask) -> bool;

    /// `yes` where `mask` holds, `no` elsewhere.
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        let [one] = Self::select_all(mask, [yes], [no]);
        one
    }

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
    /// As many numbers in double precision, which share the masks.
    type Double: Double<Mask = Self::Mask>;

    fn widen(self) -> Self::Double;
    /// Rounds to single precision.
    fn narrow(double: Self::Double) -> Self;

    /// The numbers at the start of `lanes`, one for each lane of `self`.
    fn load(self, lanes: &[f32]) -> Self;

    /// The numbers that `function` gives for the index of each lane of `self`.
    fn gather(self, function: impl FnMut(usize) -> f32) -> Self;

    /// Applies `function` to the index of each lane and its numbers: for what has no form in lanes, such as
    /// a caller's own function.
    fn per_lane<const K: usize>(
        numbers: [Self; K],
        function: impl FnMut(usize, [f32; K]) -> f32,
    ) -> Self;

    /// Applies `function` to four numbers of each lane and its bit of `mask`; the result is two quads.
    fn per_lane_quads(
        numbers: Quad<Self>,
        mask: Self::Mask,
        function: impl FnMut(Quad<f32>, bool) -> [Quad<f32>; 2],
    ) -> [Quad<Self>; 2];

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

    /// [`round_up`] in each lane.
    #[inline(always)]
    fn round_up(self, roundings: u16) -> Self {
        self * round_up(1.0, roundings)
    }
}

/// A [`Real`] in double precision: an `f64`, or one in each lane.
pub trait Double: Real<Element = f64> {}

impl<N: Real<Element = f64>> Double for N {}
