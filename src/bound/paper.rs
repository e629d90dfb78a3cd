//! The spheroid of [Tokuyoshi & Harada 2017] around a GGX lobe.

use core::f32::consts::FRAC_1_PI;

use super::shape::{Quads, padded};
use super::spheroid::Spheroids;
use super::{BoundStrategy, Paper, Shape, Spheroid};
use crate::lobe::{Fresnel, GgxLobe, GgxLobes, MaskingShadowing};
use crate::num::{Single, UNIT_ROUNDOFF};

/// The tilt of the axis by its rounding to `f32`: half an ulp in each component.
const AXIS_TILT_RADIANS: f32 = 0.87 * UNIT_ROUNDOFF;

/// Bounds the lobe by the paper's spheroid.
///
/// F ≤ F_max, G2 ≤ G1(μ) and D(ω_h·n) ≤ D(cos(θ/2)), where θ is the angle between ω_o and ω_u. So the
/// spheroid with r² = F_max G1(μ)/(4πμ) contains the lobe [Tokuyoshi & Harada 2017, Eqs. 9–12]. If F and G2
/// were at their bounds, the lobe would touch it ahead of the light.
impl<F: Fresnel, G: MaskingShadowing> BoundStrategy<GgxLobe<F, G>> for Paper {
    type Shape = Spheroid;

    // Of an empty lobe too, since an empty spheroid keeps its axis.
    fn unit_bound(&self, lobe: &GgxLobe<F, G>) -> Spheroid {
        let (quads, fresnel) = BoundStrategy::<GgxLobe<F, G>>::to_quads(self, lobe);
        let lanes = BoundStrategy::<GgxLobe<F, G>>::unit_bounds(self, &quads, &[fresnel]);
        Spheroid::from_lanes(lanes)
    }

    type PerLight = F;

    const QUADS: usize = 3;

    #[inline(always)]
    fn to_quads(&self, lobe: &GgxLobe<F, G>) -> (Quads<f32>, F) {
        (padded(lobe.quads()), *lobe.fresnel())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, fresnels: &[F]) -> Spheroids<N> {
        let lobe = GgxLobes::from_quads([quads[0], quads[1], quads[2]]);
        let is_lit = lobe.incident_cosine.is_positive();
        let reflected = N::select(is_lit, lobe.max_fresnel(fresnels), lobe.roughness.zero());
        let radius_squared = reflected * lobe.masking_over_four_cosines() * FRAC_1_PI;
        Spheroids::around_tilted_axis(
            lobe.mirror_direction(),
            radius_squared.sqrt(),
            lobe.roughness,
            AXIS_TILT_RADIANS,
        )
    }
}
