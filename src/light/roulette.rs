use super::Xi;
use crate::base::{Error, number_in};
use crate::num::{Real, Single, sqrt};

/// Russian roulette with the variance parameter δ.
///
/// A light of radiant intensity I is accepted at distance l with probability p = min(I/(δl²), 1), that is, if
/// p ≥ ξ. The estimate of its radiance L = I/l² is then L/p = max(L, δ), and 0 otherwise. So an accepted
/// light never counts less than δ, which is the scale of the noise [Tokuyoshi & Harada 2017, Eqs. 1–3].
///
/// ```
/// use stochastic_light_culling::{Roulette, Xi};
///
/// let roulette = Roulette::new(0.001)?;
/// let (intensity, distance_squared) = (0.5, 1000.0); // L = δ/2, so p = ½
/// assert_eq!(roulette.probability(intensity, distance_squared), 0.5);
/// assert!(roulette.accepts(intensity, distance_squared, Xi::new(0.5)?));
/// assert_eq!(roulette.estimate(intensity, distance_squared, Xi::new(0.4)?), 0.001);
/// assert_eq!(roulette.estimate(intensity, distance_squared, Xi::new(0.6)?), 0.0);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roulette {
    delta: f32,
    /// √δ times [`LIFT`].
    lifted_delta_root: f32,
}

/// Factor of numerator and denominator of √Φ/(√δ√ξ), 2³². It keeps √δ√ξ in the normal range, since √δ is in
/// \[2^−74.5, 2⁶⁴\] and √ξ in \[2^−74.5, 1\]. A power of two, it rounds nothing.
const LIFT: f32 = 4_294_967_296.0;

/// Pays for the rounding of √(Φ/(δξ)).
const SCALE_ROUNDINGS: u16 = 5;

impl Roulette {
    /// Creates a roulette with `delta` = δ, in the unit of radiance: intensity over squared distance. A
    /// smaller δ means less noise and more work.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `delta` is zero, negative, infinite or NaN.
    pub fn new(delta: f32) -> Result<Self, Error> {
        let valid = f32::from_bits(1)..=f32::MAX;
        number_in("variance parameter δ", delta, "in (0, ∞)", valid).map(|delta| Self {
            delta,
            lifted_delta_root: LIFT * sqrt(delta),
        })
    }

    /// The variance parameter δ.
    #[must_use]
    pub fn delta(&self) -> f32 {
        self.delta
    }

    /// The probability p = min(I/(δl²), 1) that a light is accepted, for `intensity` = I ≥ 0 and
    /// `distance_squared` = l² ≥ 0 [Tokuyoshi & Harada 2017, Eq. 2].
    ///
    /// Zero for I = 0 at any distance, and for NaN; 1 for l = 0 and I > 0.
    #[inline]
    #[must_use]
    pub fn probability(&self, intensity: f32, distance_squared: f32) -> f32 {
        if intensity > 0.0 {
            (intensity / (self.delta * distance_squared)).min(1.0)
        } else {
            0.0
        }
    }

    /// The range l_max = √(I/(δξ)) of a light in a direction in which its radiant intensity is
    /// `intensity` = I: the radius of its isosurface in that direction [Tokuyoshi & Harada 2017, Eq. 5].
    ///
    /// In the unit of length. Zero for I = 0, infinite for I = ∞.
    #[inline]
    #[must_use]
    pub fn radius(&self, intensity: f32, xi: Xi) -> f32 {
        self.radius_in_lanes(intensity, xi.get())
    }

    #[inline(always)]
    fn radius_in_lanes<N: Single>(&self, intensity: N, xi: N) -> N {
        intensity.sqrt() * LIFT / (xi.sqrt() * self.lifted_delta_root)
    }

    /// The scale √(Φ/(δξ)) of a light with `flux` = Φ, rounded up. It scales the isosurface of the lobe, and
    /// so its [`unit_bound`](crate::Bounded::unit_bound).
    ///
    /// Zero for Φ = 0 and for NaN; otherwise in the normal range of `f32`, to which it is clamped.
    #[inline]
    #[must_use]
    pub fn scale(&self, flux: f32, xi: Xi) -> f32 {
        self.scale_in_lanes(flux, xi.get())
    }

    #[inline(always)]
    pub(crate) fn scale_in_lanes<N: Single>(&self, flux: N, xi: N) -> N {
        let radius = self.radius_in_lanes(flux, xi).round_up(SCALE_ROUNDINGS);
        let normal = radius
            .max(flux.splat(f32::MIN_POSITIVE))
            .min(flux.splat(f32::MAX));
        N::select(flux.is_positive(), normal, flux.zero())
    }

    /// Whether a light is accepted at `distance_squared` = l²: p ≥ ξ, which is the same as l ≤ l_max.
    ///
    /// False for I = 0 and for NaN.
    #[inline]
    #[must_use]
    pub fn accepts(&self, intensity: f32, distance_squared: f32, xi: Xi) -> bool {
        self.accepts_in_lanes(intensity, distance_squared, xi.get())
    }

    #[inline(always)]
    pub(crate) fn accepts_in_lanes<N: Single>(
        &self,
        intensity: N,
        distance_squared: N,
        xi: N,
    ) -> N::Mask {
        let least = xi * (distance_squared * self.delta);
        intensity.is_positive() & least.le(intensity)
    }

    /// The estimate of the radiance: L/p of an accepted light, 0 of any other
    /// [Tokuyoshi & Harada 2017, Eq. 3].
    ///
    /// Its mean over ξ is L = I/l². At l = 0 it is infinite, as L is.
    #[inline]
    #[must_use]
    pub fn estimate(&self, intensity: f32, distance_squared: f32, xi: Xi) -> f32 {
        if self.accepts(intensity, distance_squared, xi) {
            self.accepted_radiance(intensity, distance_squared)
        } else {
            0.0
        }
    }

    /// The estimate max(L, δ) of the radiance of a light that is accepted.
    #[inline(always)]
    pub(crate) fn accepted_radiance<N: Single>(&self, intensity: N, distance_squared: N) -> N {
        Real::max(intensity / distance_squared, intensity.splat(self.delta))
    }

    /// The weight 1/p of an accepted light, 0 of any other: the factor of each channel of a coloured
    /// radiance.
    #[inline]
    #[must_use]
    pub fn weight(&self, intensity: f32, distance_squared: f32, xi: Xi) -> f32 {
        if self.accepts(intensity, distance_squared, xi) {
            (self.delta * distance_squared / intensity).max(1.0)
        } else {
            0.0
        }
    }
}
