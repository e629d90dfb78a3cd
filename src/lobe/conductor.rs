//! The Fresnel factor of a conductor, and the proof that it is quasi-convex.
//!
//! # The reflectance as a quotient
//!
//! Let c and s be cosine and sine of the angle θ, x = c², w = a + ib and m = |w|². For κ > 0, a is positive.
//! The two polarisations reflect ((m + c²) − 2ac)/((m + c²) + 2ac), and that times (q − 2acs²)/(q + 2acs²) with
//! q = c²m + s⁴. Their mean is
//!
//! F = (m + c² − 2ac) q/((m + c² + 2ac)(q + 2acs²)).
//!
//! # It is quasi-convex
//!
//! w² is x plus a constant, so dw/dx = 1/(2w), and hence da/dx = a/(2m) and db/dx = −b/(2m). Two identities
//! follow, in which all is a polynomial in c, a and b:
//!
//! dF/dx = −F · 2as²K/(mc q(q + 2acs²)), K = q(1 + ½(m − c²) + 2ac) + c²m(2 − c² − m) − 2a²c⁴,
//!
//! **mc² dK/dx = (1 + m − 2ac)K − (3 + 2s²)b²c² − ½s²(1 + m + s²)(c²m + s² + s²m)**.
//!
//! Let 0 < x < 1. In the second, 1 + m − 2ac ≥ (1 − a)² is not negative, and the last term is. So K falls
//! wherever it is not positive: once it is zero it is negative for all larger x. By the first, F falls with x
//! while K is positive, and rises then. So F falls, then rises, or does only one of both.
//!
//! `tests/quasi_convex.rs` checks both identities with exact integers.
//!
//! # Without extinction
//!
//! For κ = 0 and w² > 0 all of this holds, with b = 0. Where w² ≤ 0, at the smallest x, F is 1: the reflection
//! is total. For η = 1 F is 0 for every x > 0. At x = 1 K is −½η²(η² − 4η + 1). For 2 − √3 ≤ η ≤ 2 + √3 that is
//! not negative, so K is positive for all smaller x, and F rises with θ at all angles.

use super::dielectric::{critical_cosine, index_squared_less_sine_squared};
use super::{Fresnel, FresnelMajorant};
use crate::base::{Error, number_in};
use crate::num::Single;

/// The Fresnel factor of a smooth metal with the complex refractive index η + iκ, for unpolarised light.
///
/// It has the form of [`Dielectric`](super::Dielectric) with w = a + ib = √((η + iκ)² − s²):
///
/// F = ½ |1 − (η + iκ)²|²/|c + w|⁴ (1 + |cw − s²|²/|cw + s²|²).
///
/// F is quasi-convex in θ_h for every η and κ: it falls, then rises, or does only one of both. So
/// [`maximum`](Fresnel::maximum) holds. The proof is in the source of this type.
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
    const HAS_VALID_MAJORANT: bool = true;
    const IS_IN_LANES: bool = true;

    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        reflectance(self.index, self.extinction, half_angle_cosine)
    }

    fn critical_cosine(&self) -> f32 {
        critical_cosine(self.index, self.extinction)
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
    fn critical_cosine_of_parameters<N: Single>([index, extinction]: [N; 2]) -> Option<N> {
        Some(critical_cosine(index, extinction))
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
