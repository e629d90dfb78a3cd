use super::dielectric::index_squared_less_sine_squared;
use super::{Fresnel, FresnelMajorant};
use crate::base::{Error, number_in};
use crate::num::Single;

/// The Fresnel factor of a smooth metal with the complex refractive index η + iκ, for unpolarised light.
///
/// It has the form of [`Dielectric`](super::Dielectric) with w = a + ib = √((η + iκ)² − s²):
///
/// F = ½ |1 − (η + iκ)²|²/|c + w|⁴ (1 + |cw − s²|²/|cw + s²|²).
///
/// [`maximum`](Fresnel::maximum) needs F to be quasi-convex in θ_h. For metals this is not proved; a
/// numerical search over η and κ found no exception.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    index: f32,
    extinction: f32,
    majorant: FresnelMajorant,
}

impl Conductor {
    /// Creates a metal with the refractive index `index` = η and the extinction coefficient `extinction` = κ,
    /// both relative to the medium in front of it. Gold at 650 nm has η = 0.16 and κ = 3.5.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `index` is outside \[10⁻⁹, 10⁹\], `extinction` neither 0 nor in
    /// \[10⁻¹², 10⁹\], or either is NaN.
    pub fn new(index: f32, extinction: f32) -> Result<Self, Error> {
        let index = number_in("refractive index η", index, "in [1e-9, 1e9]", 1e-9..=1e9)?;
        let least = if extinction == 0.0 { 0.0 } else { 1e-12 };
        let valid = "0 or in [1e-12, 1e9]";
        let range = least..=1e9;
        let extinction = number_in("extinction coefficient κ", extinction, valid, range)?;
        Ok(Self {
            index,
            extinction,
            majorant: FresnelMajorant::of(|cosine| reflectance(index, extinction, cosine)),
        })
    }

    /// The refractive index η.
    #[must_use]
    pub fn index(&self) -> f32 {
        self.index
    }

    /// The extinction coefficient κ.
    #[must_use]
    pub fn extinction(&self) -> f32 {
        self.extinction
    }
}

impl Fresnel for Conductor {
    const IS_IN_LANES: bool = true;

    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        reflectance(self.index, self.extinction, half_angle_cosine)
    }

    #[inline]
    fn majorant(&self) -> FresnelMajorant {
        self.majorant
    }

    #[inline(always)]
    fn reflectance_in_lanes<N: Single>(fresnels: &[Self], half_angle_cosine: N) -> N {
        let index = half_angle_cosine.gather(
            #[inline(always)]
            |i| fresnels[i].index,
        );
        let extinction = half_angle_cosine.gather(
            #[inline(always)]
            |i| fresnels[i].extinction,
        );
        reflectance(index, extinction, half_angle_cosine)
    }

    #[inline]
    fn parameters(&self) -> [f32; 2] {
        [self.index, self.extinction]
    }

    #[inline(always)]
    fn reflectance_of_parameters<N: Single>([index, extinction]: [N; 2], cosine: N) -> Option<N> {
        Some(reflectance(index, extinction, cosine))
    }
}

#[inline(always)]
fn reflectance<N: Single>(eta: N, kappa: N, c: N) -> N {
    let s_squared = c.one_minus() * (c + 1.0);
    // w² = real + i·imaginary. The larger of a and b is a root, the other follows from 2ab = imaginary, so
    // that neither cancels.
    let real = index_squared_less_sine_squared(eta, c) - kappa * kappa;
    let half_imaginary = eta * kappa;
    let modulus = (real * real + half_imaginary * 4.0 * half_imaginary).sqrt();
    let larger = ((modulus + real.abs()) * 0.5).sqrt();
    let smaller = half_imaginary / larger.max(c.splat(f32::MIN_POSITIVE));
    let [a, b] = N::select_all(real.is_positive(), [larger, smaller], [smaller, larger]);

    let kappa_squared = kappa * kappa;
    let sum = (a + c) * (a + c) + b * b;
    let perpendicular = ((eta.one_minus() * eta.one_minus() + kappa_squared) / sum)
        * (((eta + 1.0) * (eta + 1.0) + kappa_squared) / sum);
    let cb_squared = c * c * b * b;
    let (minus, plus) = (c * a - s_squared, c * a + s_squared);
    let polarisation = (minus * minus + cb_squared) / (plus * plus + cb_squared);
    (perpendicular * 0.5 * (polarisation + 1.0)).min(c.splat(1.0))
}
