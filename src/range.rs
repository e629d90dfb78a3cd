//! Russian roulette: how far a light reaches in this frame, and what it counts for there.

use crate::{Error, error, math};

/// A light's random number ξ in (0, 1] for one frame, shared by all points that it may light.
///
/// Zero is left out, since it would let the light reach infinitely far.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::unchecked::Xi"))]
pub struct Xi(f32);

impl Xi {
    /// A random number of the caller's own.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `xi` is outside (0, 1] or NaN.
    pub fn new(xi: f32) -> Result<Self, Error> {
        error::number_in("random number ξ", xi, "in (0, 1]", f32::from_bits(1)..=1.0).map(Self)
    }

    /// The number of light `light` in frame `frame`: the same for the same three arguments, with no
    /// state to keep.
    ///
    /// A multiple of 2⁻³², rounded to `f32`, from the hash of [Jarzynski & Olano 2020, "pcg3d"].
    ///
    /// ```
    /// use stochastic_light_culling::Xi;
    ///
    /// assert_eq!(Xi::hashed(7, 0, 1), Xi::hashed(7, 0, 1));
    /// assert_ne!(Xi::hashed(7, 0, 1), Xi::hashed(7, 1, 1));
    /// ```
    #[inline]
    pub fn hashed(light: u32, frame: u32, seed: u32) -> Self {
        let [bits, ..] = pcg3d([light, frame, seed]);
        // The sum takes 33 bits; its conversion rounds once, and the power of two is exact.
        Self((u64::from(bits) + 1) as f32 * (1.0 / 4_294_967_296.0))
    }

    /// ξ.
    pub fn get(self) -> f32 {
        self.0
    }
}

/// Three hashed words of three words [Jarzynski & Olano 2020].
#[inline]
fn pcg3d(words: [u32; 3]) -> [u32; 3] {
    fn stir([x, y, z]: [u32; 3]) -> [u32; 3] {
        let x = x.wrapping_add(y.wrapping_mul(z));
        let y = y.wrapping_add(z.wrapping_mul(x));
        let z = z.wrapping_add(x.wrapping_mul(y));
        [x, y, z]
    }
    let congruential = words.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    stir(stir(congruential).map(|v| v ^ (v >> 16)))
}

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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::unchecked::Roulette"))]
pub struct Roulette {
    delta: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    delta_root: f32,
}

impl Roulette {
    /// Roulette with `delta` = δ in the unit of the shaded radiance, I over squared distance: less
    /// is less noise and more work.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `delta` is zero, negative, infinite or NaN.
    pub fn new(delta: f32) -> Result<Self, Error> {
        let valid = f32::from_bits(1)..=f32::MAX;
        error::number_in("variance parameter δ", delta, "in (0, ∞)", valid).map(|delta| Self {
            delta,
            delta_root: math::sqrt(delta),
        })
    }

    /// δ.
    pub fn delta(&self) -> f32 {
        self.delta
    }

    /// √δ.
    #[cfg(feature = "cull")]
    pub(crate) fn delta_root(&self) -> f32 {
        self.delta_root
    }

    /// p = min(I/(δl²), 1) for `intensity` = I ≥ 0 and `distance_squared` = l² ≥ 0
    /// [Tokuyoshi & Harada 2017, Eq. 2]. Zero where no light goes, at any distance.
    #[inline]
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
    pub fn radius(&self, intensity: f32, xi: Xi) -> f32 {
        math::sqrt(intensity) / (self.delta_root * math::sqrt(xi.0))
    }

    /// √(Φ/(δξ)), rounded up: what the isosurface of a lobe of unit intensity, and so its
    /// [`unit_bound`](crate::Bounded::unit_bound), is scaled by for a light of `flux` = Φ.
    ///
    /// Zero for Φ = 0, and else within the normal range of `f32`.
    #[inline]
    pub fn scale(&self, flux: f32, xi: Xi) -> f32 {
        if flux > 0.0 {
            math::round_up(self.radius(flux, xi), 5).clamp(f32::MIN_POSITIVE, f32::MAX)
        } else {
            0.0
        }
    }

    /// Whether p ≥ ξ: whether the light counts at squared distance l² = `distance_squared`, which is
    /// to say that l ≤ l_max.
    #[inline]
    pub fn accepts(&self, intensity: f32, distance_squared: f32, xi: Xi) -> bool {
        intensity > 0.0 && intensity >= xi.0 * (self.delta * distance_squared)
    }

    /// The radiance estimate L/p of a light that is accepted, else 0
    /// [Tokuyoshi & Harada 2017, Eq. 3].
    ///
    /// Its mean over ξ is L = I/l². Infinite, as L is, at distance zero of a light.
    #[inline]
    pub fn estimate(&self, intensity: f32, distance_squared: f32, xi: Xi) -> f32 {
        if self.accepts(intensity, distance_squared, xi) {
            (intensity / distance_squared).max(self.delta)
        } else {
            0.0
        }
    }

    /// 1/p of a light that is accepted, else 0: the factor for each channel of a coloured radiance.
    #[inline]
    pub fn weight(&self, intensity: f32, distance_squared: f32, xi: Xi) -> f32 {
        if self.accepts(intensity, distance_squared, xi) {
            (self.delta * distance_squared / intensity).max(1.0)
        } else {
            0.0
        }
    }
}
