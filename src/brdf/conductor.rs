use super::{Fresnel, FresnelMajorant, dielectric::index_squared_less_sine_squared};
use crate::{Error, error, math};

/// Unpolarised light at a smooth absorbing surface, a metal, with complex index η + iκ.
///
/// The same form as [`Dielectric`](super::Dielectric) with w = a + ib = √((η + iκ)² − s²):
///
/// F = ½ |1 − (η + iκ)²|²/|c + w|⁴ (1 + |cw − s²|²/|cw + s²|²).
///
/// Its quasi-convexity in θ_h, which [`maximum`](Fresnel::maximum) needs, is known numerically (a
/// search over η and κ found no exception), not proved.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::unchecked::Conductor"))]
pub struct Conductor {
    index: f32,
    extinction: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    majorant: FresnelMajorant,
}

impl Conductor {
    /// A metal with refractive index `index` = η and extinction coefficient `extinction` = κ, both
    /// relative to the medium in front of it. Gold at 650 nm has η = 0.16, κ = 3.5.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `index` is outside \[10⁻⁹, 10⁹\], `extinction` neither 0 nor in
    /// \[10⁻¹², 10⁹\], or either is NaN.
    pub fn new(index: f32, extinction: f32) -> Result<Self, Error> {
        let index = error::number_in("refractive index η", index, "in [1e-9, 1e9]", 1e-9..=1e9)?;
        let least = if extinction == 0.0 { 0.0 } else { 1e-12 };
        let valid = "0 or in [1e-12, 1e9]";
        let range = least..=1e9;
        let extinction = error::number_in("extinction coefficient κ", extinction, valid, range)?;
        Ok(Self {
            index,
            extinction,
            majorant: FresnelMajorant::of(|cosine| reflectance(index, extinction, cosine)),
        })
    }
}

impl Fresnel for Conductor {
    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        reflectance(self.index, self.extinction, half_angle_cosine)
    }

    #[inline]
    fn majorant(&self) -> FresnelMajorant {
        self.majorant
    }
}

#[inline]
fn reflectance(eta: f32, kappa: f32, c: f32) -> f32 {
    let s_squared = (1.0 - c) * (1.0 + c);
    // w² = real + i·imaginary. Of the two roots the larger is taken first, and the other from
    // 2ab = imaginary, so that neither cancels.
    let real = index_squared_less_sine_squared(eta, c) - kappa * kappa;
    let half_imaginary = eta * kappa;
    let modulus = math::sqrt(real * real + 4.0 * half_imaginary * half_imaginary);
    let larger = math::sqrt(0.5 * (modulus + real.abs()));
    let smaller = half_imaginary / larger.max(f32::MIN_POSITIVE);
    let (a, b) = if real > 0.0 {
        (larger, smaller)
    } else {
        (smaller, larger)
    };

    let kappa_squared = kappa * kappa;
    let sum = (a + c) * (a + c) + b * b;
    let perpendicular = (((1.0 - eta) * (1.0 - eta) + kappa_squared) / sum)
        * (((1.0 + eta) * (1.0 + eta) + kappa_squared) / sum);
    let cb_squared = c * c * b * b;
    let (minus, plus) = (c * a - s_squared, c * a + s_squared);
    let polarisation = (minus * minus + cb_squared) / (plus * plus + cb_squared);
    (0.5 * perpendicular * (1.0 + polarisation)).min(1.0)
}
