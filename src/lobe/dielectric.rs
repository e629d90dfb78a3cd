use super::{Fresnel, FresnelMajorant};
use crate::base::{Error, number_in};
use crate::num::Single;

/// The Fresnel factor of a smooth interface between two transparent media, for unpolarised light
/// [Tokuyoshi & Harada 2017, supplemental Eqs. 3–5].
///
/// Let c = cosθ_h, s = sinθ_h and w = √(η² − s²). Both amplitudes share the factor
/// (c − w)/(c + w) = (1 − η²)/(c + w)², whose right-hand side does not cancel for η near 1. So
///
/// F = ½ ((1 − η²)/(c + w)²)² (1 + ((cw − s²)/(cw + s²))²).
///
/// F increases with θ_h for 2 − √3 ≤ η ≤ 2 + √3, and is quasi-convex for all other η. The proof is that of
/// [`Conductor`](super::Conductor), whose extinction coefficient is zero here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    relative_index: f32,
    majorant: FresnelMajorant,
}

impl Dielectric {
    /// Creates an interface with `relative_index` = η = n_t/n_i: the refractive index of the medium behind it
    /// over that of the medium in which the light arrives. η is 1.5 for glass in air, and 1/1.5 from inside
    /// the glass, where light beyond the critical angle is reflected totally. F is 0 for η = 1, but 1 at
    /// grazing incidence.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `relative_index` is outside \[10⁻⁹, 10⁹\] or NaN.
    pub fn new(relative_index: f32) -> Result<Self, Error> {
        number_in(
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

    /// The relative refractive index η.
    #[must_use]
    pub fn relative_index(&self) -> f32 {
        self.relative_index
    }
}

impl Fresnel for Dielectric {
    const HAS_VALID_MAJORANT: bool = true;
    const IS_IN_LANES: bool = true;

    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        reflectance(self.relative_index, half_angle_cosine)
    }

    fn critical_cosine(&self) -> f32 {
        critical_cosine(self.relative_index, 0.0)
    }

    #[inline]
    fn majorant(&self) -> FresnelMajorant {
        self.majorant
    }

    #[inline(always)]
    fn reflectance_in_lanes<N: Single>(fresnels: &[Self], half_angle_cosine: N) -> N {
        let index = half_angle_cosine.gather(
            #[inline(always)]
            |i| fresnels[i].relative_index,
        );
        reflectance(index, half_angle_cosine)
    }

    #[inline]
    fn parameters(&self) -> [f32; 2] {
        [self.relative_index, 0.0]
    }

    #[inline(always)]
    fn critical_cosine_of_parameters<N: Single>([index, _]: [N; 2]) -> Option<N> {
        Some(critical_cosine(index, index.zero()))
    }

    #[inline(always)]
    fn reflectance_of_parameters<N: Single>([index, _]: [N; 2], cosine: N) -> Option<N> {
        Some(reflectance(index, cosine))
    }
}

/// The cosine where w² is zero, but for its imaginary part: √(1 − η² + κ²). Zero if there is none.
#[inline(always)]
pub(super) fn critical_cosine<N: Single>(eta: N, kappa: N) -> N {
    let squared = eta.one_minus() * (eta + 1.0) + kappa * kappa;
    let (zero, one) = (eta.zero(), eta.splat(1.0));
    N::select(one.gt(squared), squared.max(zero).sqrt(), zero)
}

#[inline(always)]
fn reflectance<N: Single>(eta: N, c: N) -> N {
    let w_squared = index_squared_less_sine_squared(eta, c);
    let is_total = w_squared.le(w_squared.zero());
    if N::is_known_false(!is_total) {
        return c.splat(1.0);
    }
    let w = w_squared.sqrt();
    let s_squared = c.one_minus() * (c + 1.0);
    let amplitude = (eta.one_minus() / (c + w)) * ((eta + 1.0) / (c + w));
    let polarisation = (c * w - s_squared) / (c * w + s_squared);
    let partial = amplitude * 0.5 * amplitude * (polarisation * polarisation + 1.0);
    N::select(is_total, c.splat(1.0), partial.min(c.splat(1.0)))
}

/// η² − s² for s² = 1 − c². Its error is a few roundings of the smaller of s² and c², which matters at the
/// critical angle.
#[inline(always)]
pub(super) fn index_squared_less_sine_squared<N: Single>(eta: N, c: N) -> N {
    N::select(
        (c * c).gt(c.splat(0.5)),
        eta * eta - c.one_minus() * (c + 1.0),
        c * c + (eta - 1.0) * (eta + 1.0),
    )
}
