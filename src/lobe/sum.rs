use glam::Vec3;

use super::{Cap, Caps, FIRST_NUMBERS, Lobe, LobeNumbers, Majorant, padded, value_per_lane};
use crate::base::{Direction, Error, number_in};
use crate::num::{Real, Single, Vector3};

/// Budget for the majorant: two products and a sum, and the same in the value.
const MAJORANT_ROUNDINGS: u16 = 4;

/// A weighted sum of two lobes, such as what a surface reflects diffusely and what its coat does.
///
/// Both may have normals of their own. More than two lobes are a sum of sums.
///
/// It is the lobe of a [`Receiver`](crate::Receiver) that is diffuse and glossy at once. A light like that is two
/// lights at one place, each with its own range.
///
/// ```
/// use stochastic_light_culling::{
///     Dielectric, Direction, Ggx, GgxLobe, Incidence, LambertLobe, Lobe, LobeSum, glam::Vec3,
/// };
///
/// let normal = Direction::Z;
/// let incidence = Incidence { normal, incoming: Direction::new(Vec3::new(-1.0, 0.0, 1.0))? };
/// let paint = LambertLobe::new(0.5, normal)?;
/// let varnish = GgxLobe::new(Ggx::new(0.06)?, Dielectric::new(1.5)?, incidence);
/// let varnished = LobeSum::new(paint, varnish);
/// let highlight = Vec3::new(1.0, 0.0, 1.0).normalize();
/// assert_eq!(varnished.value(highlight), paint.value(highlight) + varnish.value(highlight));
///
/// // A metal has no diffuse part, a half rusted one half of it.
/// let rusted = LobeSum::weighted([0.5, 0.5], paint, varnish)?;
/// assert!(rusted.value(highlight) < varnished.value(highlight));
/// assert!(LobeSum::weighted([0.5, 1.5], paint, varnish).is_err());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeSum<A, B> {
    lobes: (A, B),
    weights: [f32; 2],
}

impl<A: Lobe, B: Lobe> LobeSum<A, B> {
    /// Creates the sum of both lobes.
    pub fn new(first: A, second: B) -> Self {
        Self {
            lobes: (first, second),
            weights: [1.0; 2],
        }
    }

    /// Creates the sum of both lobes, each times its weight.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if a weight is outside \[0, 1\] or NaN.
    pub fn weighted(weights: [f32; 2], first: A, second: B) -> Result<Self, Error> {
        for weight in weights {
            number_in("weight of a lobe", weight, "in [0, 1]", 0.0..=1.0)?;
        }
        Ok(Self {
            lobes: (first, second),
            weights,
        })
    }

    /// Both lobes.
    pub fn lobes(&self) -> &(A, B) {
        &self.lobes
    }

    /// The weights of both, in \[0, 1\].
    pub fn weights(&self) -> [f32; 2] {
        self.weights
    }

    fn is_each_empty(&self) -> [bool; 2] {
        let [first, second] = self.weights;
        [
            first <= 0.0 || self.lobes.0.is_empty(),
            second <= 0.0 || self.lobes.1.is_empty(),
        ]
    }

    /// Whether the numbers of both lobes and the weights are few enough to be stored side by side.
    fn has_numbers() -> bool {
        A::numbers_in_use() + B::numbers_in_use() + 2 <= FIRST_NUMBERS + 16
    }

    /// The numbers of the second lobe, and the weights.
    #[inline(always)]
    fn split<N: Single>(numbers: &LobeNumbers<N>) -> (LobeNumbers<N>, [N; 2]) {
        let (first, second) = (A::numbers_in_use(), B::numbers_in_use());
        let mut of_second = [numbers[0].zero(); FIRST_NUMBERS + 16];
        of_second[..second].copy_from_slice(&numbers[first..][..second]);
        let weights = first + second;
        (of_second, [numbers[weights], numbers[weights + 1]])
    }

    /// What [`majorant_in_lanes`](Lobe::majorant_in_lanes) computes, of this sum alone.
    fn majorant(&self, cap: &Caps<f32>) -> Majorant<f32> {
        let (first, second) = &self.lobes;
        let of_first = A::majorant_in_lanes(&first.numbers(), |_| Some(first), cap);
        let of_second = B::majorant_in_lanes(&second.numbers(), |_| Some(second), cap);
        weighted_majorant([of_first, of_second], self.weights)
    }

    /// What [`mean_in_lanes`](Lobe::mean_in_lanes) computes, of this sum alone.
    fn mean(&self, axis: Vector3<f32>, sharpness: f32) -> f32 {
        let (first, second) = &self.lobes;
        let of_first = A::mean_in_lanes(&first.numbers(), |_| Some(first), axis, sharpness);
        let of_second = B::mean_in_lanes(&second.numbers(), |_| Some(second), axis, sharpness);
        weighted([of_first, of_second], self.weights)
    }
}

impl<A: Lobe, B: Lobe> Lobe for LobeSum<A, B> {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        let (first, second) = &self.lobes;
        weighted(
            [first.value(outgoing), second.value(outgoing)],
            self.weights,
        )
    }

    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        self.majorant(&cap.lanes()).greatest
    }

    /// That of both lobes if they have the same one, or that of the only one that is not empty.
    fn horizon_normal(&self) -> Option<Direction> {
        let [first, second] = self.is_each_empty();
        let (of_first, of_second) = (self.lobes.0.horizon_normal(), self.lobes.1.horizon_normal());
        if second {
            of_first
        } else {
            of_second.filter(|normal| first || of_first == Some(*normal))
        }
    }

    fn is_empty(&self) -> bool {
        self.is_each_empty() == [true; 2]
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        if !Self::has_numbers() {
            return padded([]);
        }
        let (first, second) = &self.lobes;
        let (of_first, of_second) = (A::numbers_in_use(), B::numbers_in_use());
        let mut numbers = first.numbers();
        numbers[of_first..][..of_second].copy_from_slice(&second.numbers()[..of_second]);
        numbers[of_first + of_second..][..2].copy_from_slice(&self.weights);
        numbers
    }

    fn numbers_in_use() -> usize {
        if Self::has_numbers() {
            A::numbers_in_use() + B::numbers_in_use() + 2
        } else {
            0
        }
    }

    fn has_more_than_numbers() -> bool {
        !Self::has_numbers() || A::has_more_than_numbers() || B::has_more_than_numbers()
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N
    where
        Self: 'a,
    {
        if !Self::has_numbers() {
            return value_per_lane(lobe_of, outgoing);
        }
        let (of_second, weights) = Self::split(numbers);
        let first = A::value_in_lanes(
            numbers,
            #[inline(always)]
            |i| lobe_of(i).map(|sum| &sum.lobes.0),
            outgoing,
        );
        let second = B::value_in_lanes(
            &of_second,
            #[inline(always)]
            |i| lobe_of(i).map(|sum| &sum.lobes.1),
            outgoing,
        );
        weighted([first, second], weights)
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N>
    where
        Self: 'a,
    {
        if !Self::has_numbers() {
            return Majorant::exactly(cap.per_lane(
                #[inline(always)]
                |i, cap| lobe_of(i).map_or(f32::INFINITY, |sum| sum.majorant(cap).greatest),
            ));
        }
        let (of_second, weights) = Self::split(numbers);
        let first = A::majorant_in_lanes(
            numbers,
            #[inline(always)]
            |i| lobe_of(i).map(|sum| &sum.lobes.0),
            cap,
        );
        let second = B::majorant_in_lanes(
            &of_second,
            #[inline(always)]
            |i| lobe_of(i).map(|sum| &sum.lobes.1),
            cap,
        );
        weighted_majorant([first, second], weights)
    }

    #[inline(always)]
    fn mean_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        axis: Vector3<N>,
        sharpness: N,
    ) -> N
    where
        Self: 'a,
    {
        if !Self::has_numbers() {
            return N::per_lane(
                [axis.x, axis.y, axis.z, sharpness],
                #[inline(always)]
                |i, [x, y, z, sharpness]| {
                    lobe_of(i).map_or(0.0, |sum| sum.mean(Vector3::new(x, y, z), sharpness))
                },
            );
        }
        let (of_second, weights) = Self::split(numbers);
        let first = A::mean_in_lanes(
            numbers,
            #[inline(always)]
            |i| lobe_of(i).map(|sum| &sum.lobes.0),
            axis,
            sharpness,
        );
        let second = B::mean_in_lanes(
            &of_second,
            #[inline(always)]
            |i| lobe_of(i).map(|sum| &sum.lobes.1),
            axis,
            sharpness,
        );
        weighted([first, second], weights)
    }
}

/// w₁v₁ + w₂v₂, finite.
#[inline(always)]
fn weighted<N: Single>([first, second]: [N; 2], weights: [N; 2]) -> N {
    (first * weights[0] + second * weights[1]).min(first.splat(f32::MAX))
}

/// The same of upper bounds, which may be infinite.
#[inline(always)]
fn weighted_bound<N: Single>([first, second]: [N; 2], weights: [N; 2]) -> N {
    // A weight of zero times infinity is NaN.
    let zero = first.zero();
    Real::max(first * weights[0], zero) + Real::max(second * weights[1], zero)
}

#[inline(always)]
pub(super) fn weighted_majorant<N: Single>(
    majorants: [Majorant<N>; 2],
    weights: [N; 2],
) -> Majorant<N> {
    let [first, second] = majorants;
    let greatest = weighted_bound([first.greatest, second.greatest], weights);
    let greatest = greatest.round_up(MAJORANT_ROUNDINGS);
    let typical = weighted_bound([first.typical, second.typical], weights);
    // It may underflow.
    let typical = Real::max(typical, typical.splat(f32::MIN_POSITIVE));
    Majorant {
        greatest,
        typical: typical.min(greatest),
    }
}
