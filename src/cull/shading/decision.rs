//! How it is decided which lights of a list a point counts, and with which weight.

use fearless_simd::{Simd, SimdMask};

use super::kernel::{Arriving, Evaluated};
use super::receiver::ReceiverLanes;
use crate::cull::receivers::WeightedList;
use crate::light::Roulette;
use crate::num::{F32Lanes, Real, Single};

/// How a [`RadianceEstimator`](crate::RadianceEstimator) decides which lights of a list a point counts, and with
/// which weight: [`AtPoint`], [`AtReceiver`] or [`InList`].
pub trait Decision: Sized {
    /// A list of lights: their indices, or a [`WeightedList`].
    type List<'l>: LightList<'l>;

    /// Whether lists bring weights.
    #[doc(hidden)]
    const HAS_WEIGHTS: bool;

    /// The radiance below which what arrives cannot count, for lights with these ξ, if there is any.
    #[doc(hidden)]
    #[inline(always)]
    fn faintest<N: Single>(&self, _xi: N) -> Option<N> {
        None
    }

    /// Decides in each lane whether what arrives counts. `None` if it does nowhere.
    #[doc(hidden)]
    fn decide<S: Simd>(
        &self,
        arriving: Arriving<S>,
        drawn: Drawn<F32Lanes<S>>,
        receivers: &impl ReceiverLanes<S>,
    ) -> Option<Evaluated<S>>;
}

/// A [`Decision`] that needs no lobe of the receiver: [`AtPoint`] or [`InList`].
pub trait PointDecision: Decision {}

/// A list of lights, with or without weights.
pub trait LightList<'l>: Copy {
    /// The indices, with the weights if there are any, or else with none.
    fn with_any_weights(self) -> WeightedList<'l>;
}

impl<'l> LightList<'l> for &'l [u32] {
    #[inline(always)]
    fn with_any_weights(self) -> WeightedList<'l> {
        WeightedList {
            lights: self,
            weights: &[],
        }
    }
}

impl<'l> LightList<'l> for WeightedList<'l> {
    #[inline(always)]
    fn with_any_weights(self) -> Self {
        self
    }
}

/// The random numbers and the weights of the lights in all lanes.
pub struct Drawn<N> {
    pub(super) xi: N,
    /// Anything where lists have no weights.
    pub(super) weight: N,
}

/// Each point decides by the radiance L = I/l² that arrives there: a light is accepted with the probability
/// p = min(L/δ, 1), and then counts L/p = max(L, δ), as by [`Roulette::estimate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtPoint {
    pub(super) roulette: Roulette,
}

/// Each receiver decides by the radiance c = L v that it reflects to the eye, v being the value of its lobe towards
/// the light: a light is accepted with the probability p = min(c/δ, 1), and then reflects c/p = max(c, δ), as by
/// [`Roulette::estimate`] of the intensity I·v.
///
/// Lists must hold every light with c ≥ δξ at one of their receivers, which those by the bounds of lights alone do
/// not: v may be far above 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtReceiver {
    pub(super) roulette: Roulette,
}

/// Points decide nothing: a light was drawn when it was listed, with a probability p for all points of the list. It
/// counts L/p wherever it arrives; 1/p is its weight in the list.
///
/// The mean is exact for any p that does not depend on the light's own ξ, and is positive where the light arrives.
/// A light whose weight is zero, negative or NaN does not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InList;

impl Decision for AtPoint {
    type List<'l> = &'l [u32];

    const HAS_WEIGHTS: bool = false;

    #[inline(always)]
    fn faintest<N: Single>(&self, xi: N) -> Option<N> {
        Some(xi * self.roulette.delta())
    }

    #[inline(always)]
    fn decide<S: Simd>(
        &self,
        arriving: Arriving<S>,
        drawn: Drawn<F32Lanes<S>>,
        receivers: &impl ReceiverLanes<S>,
    ) -> Option<Evaluated<S>> {
        let Arriving {
            intensity,
            distance_squared,
            ..
        } = arriving;
        let roulette = &self.roulette;
        let accepted = roulette.accepts_in_lanes(intensity, distance_squared, drawn.xi);
        let accepted = accepted & arriving.may_be_lit;
        if !accepted.any_true() {
            return None;
        }
        let radiance = roulette.accepted_radiance(intensity, distance_squared);
        let radiance = F32Lanes::select(accepted, radiance, radiance.zero());
        Some(Evaluated::reflecting(
            arriving, accepted, radiance, receivers,
        ))
    }
}

impl PointDecision for AtPoint {}

impl Decision for AtReceiver {
    type List<'l> = &'l [u32];

    const HAS_WEIGHTS: bool = false;

    #[inline(always)]
    fn decide<S: Simd>(
        &self,
        arriving: Arriving<S>,
        drawn: Drawn<F32Lanes<S>>,
        receivers: &impl ReceiverLanes<S>,
    ) -> Option<Evaluated<S>> {
        // What arrives nowhere needs no value.
        let may_count = arriving.may_be_lit & arriving.intensity.is_positive();
        if !may_count.any_true() {
            return None;
        }
        let value = receivers.value(&arriving)?;
        let intensity = arriving.intensity * value;
        let distance_squared = arriving.distance_squared;
        let roulette = &self.roulette;
        let accepted = roulette.accepts_in_lanes(intensity, distance_squared, drawn.xi);
        let accepted = accepted & may_count;
        if !accepted.any_true() {
            return None;
        }
        let zero = intensity.zero();
        let reflected = roulette.accepted_radiance(intensity, distance_squared);
        // L/p = max(L, δ/v). The value v is positive where a light is accepted.
        let least = zero.splat(roulette.delta()) / value;
        let radiance = Real::max(arriving.intensity / distance_squared, least);
        Some(Evaluated {
            accepted: accepted.to_bitmask() as u32,
            radiance: F32Lanes::select(accepted, radiance, zero),
            reflected: F32Lanes::select(accepted, reflected, zero),
            arriving,
        })
    }
}

impl Decision for InList {
    type List<'l> = WeightedList<'l>;

    const HAS_WEIGHTS: bool = true;

    #[inline(always)]
    fn decide<S: Simd>(
        &self,
        arriving: Arriving<S>,
        drawn: Drawn<F32Lanes<S>>,
        receivers: &impl ReceiverLanes<S>,
    ) -> Option<Evaluated<S>> {
        let radiance = arriving.intensity / arriving.distance_squared * drawn.weight;
        // False for NaN.
        let accepted = arriving.may_be_lit & radiance.is_positive();
        if !accepted.any_true() {
            return None;
        }
        let radiance = F32Lanes::select(accepted, radiance, radiance.zero());
        Some(Evaluated::reflecting(
            arriving, accepted, radiance, receivers,
        ))
    }
}

impl PointDecision for InList {}
