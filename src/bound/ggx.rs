use super::{Bounded, Spheroid};
use crate::{Fresnel, GgxLobe, MaskingShadowing, math};

/// Half an ulp in each component of the axis, which is all that its rounding to f32 tilts it by.
pub(crate) const AXIS_TILT_RADIANS: f32 = 0.87 * math::UNIT_ROUNDOFF;

impl<F: Fresnel, G: MaskingShadowing> Bounded for GgxLobe<F, G> {
    type Bound = Spheroid;

    /// The paper's spheroid for Φ/(δξ) = 1.
    ///
    /// F ≤ F_max, G2 ≤ G1(μ) and D(ω_h·n) ≤ D(cos(θ/2)), where θ is the angle between ω_o and ω_u:
    /// the lobe is at most that of the spheroid with
    /// r² = F_max G1(μ)/(4πμ) [Tokuyoshi & Harada 2017, Eqs. 9–12].
    ///
    /// Touched ahead of the light but for F, G2 and rounding.
    fn unit_bound(&self) -> Spheroid {
        let reflected = if self.incident_cosine() > 0.0 {
            self.max_fresnel()
        } else {
            0.0
        };
        let radius_squared =
            reflected * self.masking_over_four_cosines() * core::f32::consts::FRAC_1_PI;
        Spheroid::around_tilted_axis(
            self.mirror_direction(),
            math::sqrt(radius_squared),
            self.ggx().roughness(),
            AXIS_TILT_RADIANS,
        )
    }
}
