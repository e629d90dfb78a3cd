use super::{Fresnel, FresnelMajorant};
use crate::{Error, error, math};

/// Unpolarised light at a smooth interface between two transparent media
/// [Tokuyoshi & Harada 2017, supplemental Eqs. 3–5].
///
/// With c = cosθ_h, s = sinθ_h and w = √(η² − s²), both amplitudes share the factor
/// (c − w)/(c + w) = (1 − η²)/(c + w)², whose right-hand side does not cancel for η near 1, and
///
/// F = ½ ((1 − η²)/(c + w)²)² (1 + ((cw − s²)/(cw + s²))²).
///
/// F increases with θ_h for 2 − √3 ≤ η ≤ 2 + √3, and is quasi-convex for all other η.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::unchecked::Dielectric"))]
pub struct Dielectric {
    relative_index: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    majorant: FresnelMajorant,
}

impl Dielectric {
    /// An interface with `relative_index` = η = n_t/n_i: the refractive index of the medium behind
    /// it over that of the medium which the light arrives in. 1.5 for glass seen from air, 1/1.5
    /// from within, where light past the critical angle is reflected totally.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `relative_index` is outside \[10⁻⁹, 10⁹\] or NaN.
    pub fn new(relative_index: f32) -> Result<Self, Error> {
        error::number_in(
            "relative refractive index η",
            relative_index,
            "in [1e-9, 1e9]",
            1e-9..=1e9,
        )
        .map(|relative_index| Self {
            relative_index,
            majorant: FresnelMajorant::of(|cosine| reflectance(relative_index, cosine)),
        })
    }
}

impl Fresnel for Dielectric {
    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        reflectance(self.relative_index, half_angle_cosine)
    }

    #[inline]
    fn majorant(&self) -> FresnelMajorant {
        self.majorant
    }
}

#[inline]
fn reflectance(eta: f32, c: f32) -> f32 {
    let w_squared = index_squared_less_sine_squared(eta, c);
    if w_squared <= 0.0 {
        return 1.0;
    }
    let w = math::sqrt(w_squared);
    let s_squared = (1.0 - c) * (1.0 + c);
    let amplitude = ((1.0 - eta) / (c + w)) * ((1.0 + eta) / (c + w));
    let polarisation = (c * w - s_squared) / (c * w + s_squared);
    (0.5 * amplitude * amplitude * (1.0 + polarisation * polarisation)).min(1.0)
}

/// η² − s² for s² = 1 − c², with an error of a few roundings of the lesser of s² and c², which at the
/// critical angle decides.
#[inline]
pub(super) fn index_squared_less_sine_squared(eta: f32, c: f32) -> f32 {
    if c * c > 0.5 {
        eta * eta - (1.0 - c) * (1.0 + c)
    } else {
        c * c + (eta - 1.0) * (eta + 1.0)
    }
}
