use super::Xi;
use crate::base::{Error, number_in};
use crate::num::{Single, sqrt};

/// Russian roulette with variance parameter δ.
///
/// A light of radiant intensity I is accepted at distance l with probability
/// p = min(I/(δl²), 1), that is, wherever p ≥ ξ, and its radiance L = I/l² then counts L/p. Since
/// L/p = max(L, δ), the estimate of an accepted light is never below δ: δ is the radiance that the
/// noise is made of [Tokuyoshi & Harada 2017, Eqs. 1–3].
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

/// A factor of both sides of √Φ/(√δ√ξ), exact since it is a power of two. It keeps √δ√ξ in the normal
/// range, since √δ is in \[2^−74.5, 2⁶⁴\] and √ξ in \[2^−74.5, 1\].
const LIFT: f32 = 4_294_967_296.0;

/// Pays for the rounding of √(Φ/(δξ)).
const SCALE_ROUNDINGS: u16 = 5;

impl Roulette {
    /// Roulette with `delta` = δ in the unit of the shaded radiance, I over squared distance: less
    /// is less noise and more work.
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

    /// δ.
    #[must_use]
    pub fn delta(&self) -> f32 {
        self.delta
    }

    /// p = min(I/(δl²), 1) for `intensity` = I ≥ 0 and `distance_squared` = l² ≥ 0
    /// [Tokuyoshi & Harada 2017, Eq. 2]. Zero where no light goes, at any distance.
    #[inline]
    #[must_use]
    pub fn probability(&self, intensity: f32, distance_squared: f32) -> f32 {
        if intensity > 0.0 {
            (intensity / (self.delta * distance_squared)).min(1.0)
        } else {
            0.0
        }
    }

    /// l_max = √(I/(δξ)), how far a light reaches in a direction in which it sends `intensity` = I:
    /// the radius of its isosurface there [Tokuyoshi & Harada 2017, Eq. 5].
    ///
    /// In the unit of length; zero for I = 0.
    #[inline]
    #[must_use]
    pub fn radius(&self, intensity: f32, xi: Xi) -> f32 {
        self.radius_in_lanes(intensity, xi.get())
    }

    #[inline(always)]
    fn radius_in_lanes<N: Single>(&self, intensity: N, xi: N) -> N {
        intensity.sqrt() * LIFT / (xi.sqrt() * self.lifted_delta_root)
    }

    /// √(Φ/(δξ)), rounded up: what the isosurface of a lobe of unit intensity, and so its
    /// [`unit_bound`](crate::Bounded::unit_bound), is scaled by for a light of `flux` = Φ.
    ///
    /// Zero for Φ = 0, and else within the normal range of `f32`.
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

    /// Whether p ≥ ξ: whether the light counts at squared distance l² = `distance_squared`, which is
    /// to say that l ≤ l_max.
    #[inline]
    #[must_use]
    pub fn accepts(&self, intensity: f32, distance_squared: f32, xi: Xi) -> bool {
        intensity > 0.0 && intensity >= xi.get() * (self.delta * distance_squared)
    }

    /// The radiance estimate L/p of a light that is accepted, else 0
    /// [Tokuyoshi & Harada 2017, Eq. 3].
    ///
    /// Its mean over ξ is L = I/l². Infinite, as L is, at distance zero of a light.
    #[inline]
    #[must_use]
    pub fn estimate(&self, intensity: f32, distance_squared: f32, xi: Xi) -> f32 {
        if self.accepts(intensity, distance_squared, xi) {
            (intensity / distance_squared).max(self.delta)
        } else {
            0.0
        }
    }

    /// 1/p of a light that is accepted, else 0: the factor for each channel of a coloured radiance.
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
