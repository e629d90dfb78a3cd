//! What surfaces reflect of light that arrives as a spherical Gaussian.

use core::f64::consts::{FRAC_1_PI, PI};

use super::{
    AnisotropicGgx, AnisotropicSphericalGaussian, Fresnel, GgxLobe, GgxLobes, Incidence,
    LambertLobe, Lobe, MaskingShadowing, SphericalGaussian, unit,
};
use crate::base::Direction;
use crate::num::{Double, Real, Single, Vector3, exponential};

impl SphericalGaussian {
    /// The share of the integral that lies above the horizon of `normal`, approximately: in \[0, 1\], and off by
    /// less than 0.025.
    ///
    /// With c = ξ·n it is 1/(1 + e⁻ˣ), x = λc(c² + (1−c²)/√(1 + πλ/8)). That is exact for c = ±1 and for c = 0,
    /// and has the slope of the share at c = 0 for λ → 0 and for λ → ∞.
    #[must_use]
    pub fn share_above(&self, normal: Direction) -> f32 {
        let cosine = unit(Vector3::from(self.axis())).dot(unit(Vector3::from(normal)));
        share_above(f64::from(self.sharpness()), cosine) as f32
    }
}

/// The share of SGs with `sharpness` = λ above planes to whose normals their axes have the `cosine`.
#[inline(always)]
fn share_above<D: Double>(sharpness: D, cosine: D) -> D {
    let one = cosine.splat(1.0);
    let square = (cosine * cosine).min(one);
    let spread = (sharpness * (PI / 8.0) + 1.0).sqrt();
    let x = sharpness * cosine * (square + (one - square) / spread);
    let power = exponential(-x.abs());
    let least = power / (power + 1.0);
    D::select(x.is_positive(), one - least, least)
}

impl LambertLobe {
    /// Approximates ∫ v(ω) g(ω) dω, where v is this lobe and g the SG `gaussian`: the radiance that the surface
    /// reflects of the light g, in any direction [Tokuyoshi 2016, Sec. 4.2].
    ///
    /// It is the lobe's value towards the axis of g times the integral of g. So it is exact for light from one
    /// direction, and zero for light whose axis is at or below the horizon, though part of it lies above. An SG
    /// in place of the cosine would not be zero there, but leak light from farther below. For light from all
    /// around it is up to four times too bright; the error is at most 0.9/√(1+λ) of what the surface reflects
    /// of light from its normal.
    #[must_use]
    pub fn product_integral(&self, gaussian: &SphericalGaussian) -> f32 {
        finite(f64::from(self.value(*gaussian.axis())) * f64::from(gaussian.integral()))
    }
}

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// Approximates ∫ v(ω) g(ω) dω, where v is this lobe and g the SG `gaussian`, by filtering the NDF
    /// [Tokuyoshi et al. 2024].
    ///
    /// With the direction to the viewer as the lobe's incoming direction, since the BRDF is reciprocal, it is the
    /// radiance that the surface sends to the viewer of the light g.
    ///
    /// Near the mirror direction the half vector is spread by half of what ω is in the plane of incidence, and
    /// by 1/(2μ) of it across. In the domain of slopes, where the NDF has the variance α²/(1−α²) but for a
    /// factor, that adds 1/(2λ) and 1/(2λμ²). The filtered NDF has the squared roughness P/(1+P) for a sum P.
    /// At the half vector of the SG's axis it gives D; the result is D/(4√(ωᵀQω + μ²)) with the filtered
    /// roughness, times the Fresnel factor, the integral of g, and
    /// the share of g above the surface.
    ///
    /// It is positive and finite for every SG but one from straight behind the viewer. For λ ≥ 10 and viewers
    /// up to 0.8 radians off the normal it is within 40 % of the integral, where that is at least a third of
    /// its largest over all axes. For λ → ∞ it is the lobe's value but for shadowing. The tails, which are far
    /// darker, are too bright, and this is the method's own error: a Gaussian has no tails, so that those of the
    /// exact integral are the NDF's, in proportion to α′² = α²/(1−α²), but the filtered NDF has tails in proportion
    /// to its own squared roughness, α′² + 1/(2λ) for a viewer on the normal. That is too bright by a factor of
    /// 1 + 1/(2λα′²), and near grazing incidence by up to a hundred. `tests/reflected_gaussian.rs` prints the table.
    /// The result does not depend on the masking function.
    /// Zero if the lobe is empty.
    #[must_use]
    pub fn product_integral(&self, gaussian: &SphericalGaussian) -> f32 {
        let share = self.lanes().mean_over_gaussians(
            #[inline(always)]
            |cosine| self.fresnel().reflectance(cosine),
            gaussian.axis().into(),
            gaussian.sharpness(),
        );
        finite(f64::from(gaussian.integral()) * f64::from(share))
    }

    /// Approximates ∫ v(ω) g(ω) dω as [`product_integral`](Self::product_integral) does, by the ASG that
    /// stands for the lobe [Tokuyoshi 2016, Sec. 4.2].
    ///
    /// The lobe is C(ω) times the [`AnisotropicSphericalGaussian::specular`] of its microsurface. C, which has
    /// Fresnel factor and masking, is taken at the SG's axis, and the rest is
    /// [`AnisotropicSphericalGaussian::product_integral`]. It is accurate where the lobe is narrow, away from
    /// grazing incidence, and the SG's axis near the mirror direction. Farther off it is too dark, down to
    /// zero, since the NDF has longer tails than a Gaussian. Zero if the SG's axis is below the surface.
    #[must_use]
    pub fn product_integral_by_asg(&self, gaussian: &SphericalGaussian) -> f32 {
        let light = *gaussian.axis();
        let value = f64::from(self.value(light));
        let half = *self.incoming() + light;
        let at_half = f64::from(self.ggx().ndf_at(half, *self.normal()));
        // False for NaN.
        let is_lit = value > 0.0 && at_half > 0.0;
        if !is_lit {
            return 0.0;
        }
        let roughness = self.ggx().roughness();
        let incidence = Incidence {
            normal: self.normal(),
            incoming: self.incoming(),
        };
        let (tangent, _) = Vector3::from(self.normal()).any_orthonormal_pair();
        let lobe = AnisotropicGgx::new(roughness, roughness).and_then(|ggx| {
            let tangent = Direction::from_unit(tangent.into());
            AnisotropicSphericalGaussian::specular(ggx, incidence, tangent)
        });
        let alpha_squared = f64::from(roughness) * f64::from(roughness);
        let constant = value / at_half * (FRAC_1_PI / alpha_squared);
        lobe.map_or(0.0, |lobe| {
            finite(constant * f64::from(lobe.product_integral(gaussian)))
        })
    }
}

impl<N: Single> GgxLobes<N> {
    /// [`GgxLobe::product_integral`] with SGs of unit integral, where `reflectance` is F as a function of cosθ_h.
    #[inline(always)]
    pub fn mean_over_gaussians(
        &self,
        reflectance: impl FnOnce(N) -> N,
        axis: Vector3<N>,
        sharpness: N,
    ) -> N {
        let [normal, view, light] = [self.normal, self.incoming, axis].map(unit);
        let (cosine, lambda) = (self.incident_cosine.widen(), sharpness.widen());
        let (zero, one) = (cosine.zero(), cosine.splat(1.0));
        let alpha = self.roughness.widen();
        let alpha_squared = alpha * alpha;
        let of_ndf = alpha_squared / (one - alpha_squared).max(cosine.splat(1e-7));
        let of_light = one * 0.5 / lambda.max(cosine.splat(1e-9));
        // P/(1+P) for the directions in and across the plane of incidence; both finite.
        let filtered = [of_light, of_light / (cosine * cosine)]
            .map(|of_light| one / (one / (of_ndf + of_light) + 1.0));
        let half = view + light;
        let length_squared = half.length_squared();
        let across = normal.cross(view);
        let sine_squared = across.length_squared();
        let (_, arbitrary) = self.normal.any_orthonormal_pair();
        let across = Vector3::select(
            sine_squared.gt(one * 1e-24),
            across / sine_squared.sqrt(),
            arbitrary.widen(),
        );
        let [x, y, z] = [across.cross(normal), across, normal].map(|axis| axis.dot(half));
        let spread = (x * x / filtered[0] + y * y / filtered[1] + z * z) / length_squared;
        let ndf = one * FRAC_1_PI / ((filtered[0] * filtered[1]).sqrt() * spread * spread);
        let root = (filtered[0] * sine_squared + cosine * cosine).sqrt();
        let half_cosine = (length_squared.sqrt() * 0.5).min(one);
        let fresnel = reflectance(N::narrow(half_cosine)).widen();
        let share = share_above(lambda, light.dot(normal));
        let mean = share * fresnel * ndf / (root * 4.0);
        // Light from behind the surface, opposite to the viewer, has no half vector.
        let has_half = length_squared.gt(one * 1e-14);
        let is_lit = self.incident_cosine.is_positive() & has_half;
        let mean = <N::Double as Real>::select(is_lit, mean.max(zero), zero);
        N::narrow(mean.min(cosine.splat(f32::MAX.into())))
    }
}

/// `value`, or the largest `f32` if it is larger; zero for NaN.
fn finite(value: f64) -> f32 {
    value.max(0.0).min(f32::MAX.into()) as f32
}
