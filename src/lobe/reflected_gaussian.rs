//! What surfaces reflect of light that arrives as a spherical Gaussian.

use core::f64::consts::{FRAC_1_PI, PI};

use super::{
    AnisotropicGgx, AnisotropicSphericalGaussian, Fresnel, GgxLobe, Incidence, LambertLobe, Lobe,
    MaskingShadowing, SphericalGaussian, unit,
};
use crate::base::Direction;
use crate::num::{Vector3, exponential, sqrt_f64};

impl SphericalGaussian {
    /// The share of the integral that lies above the horizon of `normal`, approximately: in \[0, 1\], and off by
    /// less than 0.025.
    ///
    /// With c = ξ·n it is 1/(1 + e⁻ˣ), x = λc(c² + (1−c²)/√(1 + πλ/8)). That is exact for c = ±1 and for c = 0,
    /// and has the slope of the share at c = 0 for λ → 0 and for λ → ∞.
    #[must_use]
    pub fn share_above(&self, normal: Direction) -> f32 {
        self.share_above_plane(unit(Vector3::from(normal))) as f32
    }

    fn share_above_plane(&self, normal: Vector3<f64>) -> f64 {
        let lambda = f64::from(self.sharpness());
        let cosine = unit(Vector3::from(self.axis())).dot(normal);
        let square = (cosine * cosine).min(1.0);
        let x = lambda * cosine * (square + (1.0 - square) / sqrt_f64(1.0 + lambda * (PI / 8.0)));
        let power = exponential(-x.abs());
        let least = power / (1.0 + power);
        if x < 0.0 { least } else { 1.0 - least }
    }
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
    /// its largest over all axes. For λ → ∞ it is the lobe's value but for shadowing. In the tails, which are far darker,
    /// it is mostly too bright: by a factor of several, and near grazing incidence for narrow lobes of up to a
    /// hundred. `tests/reflected_gaussian.rs` prints the table. It does not depend on the masking function.
    /// Zero if the lobe is empty.
    #[must_use]
    pub fn product_integral(&self, gaussian: &SphericalGaussian) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let normal = unit(Vector3::from(self.normal()));
        let view = unit(Vector3::from(self.incoming()));
        let light = unit(Vector3::from(gaussian.axis()));
        let cosine = f64::from(self.incident_cosine());
        let lambda = f64::from(gaussian.sharpness());
        let alpha = f64::from(self.ggx().roughness());
        let alpha_squared = alpha * alpha;
        let of_ndf = alpha_squared / (1.0 - alpha_squared).max(1e-7);
        let of_light = 0.5 / lambda.max(1e-9);
        // P/(1+P) for the directions in and across the plane of incidence; both finite.
        let filtered = [of_light, of_light / (cosine * cosine)].map(|of_light| {
            let sum = of_ndf + of_light;
            1.0 / (1.0 + 1.0 / sum)
        });
        let half = view + light;
        let length_squared = half.length_squared();
        // Light from behind the surface, opposite to the viewer, has no half vector.
        if length_squared < 1e-14 {
            return 0.0;
        }
        let across = normal.cross(view);
        let sine_squared = across.length_squared();
        let across = if sine_squared > 1e-24 {
            across / sqrt_f64(sine_squared)
        } else {
            let (_, across) = Vector3::from(self.normal()).any_orthonormal_pair();
            across.widen()
        };
        let [x, y, z] = [across.cross(normal), across, normal].map(|axis| axis.dot(half));
        let spread = (x * x / filtered[0] + y * y / filtered[1] + z * z) / length_squared;
        let ndf = FRAC_1_PI / (sqrt_f64(filtered[0] * filtered[1]) * spread * spread);
        let root = sqrt_f64(filtered[0] * sine_squared + cosine * cosine);
        let half_cosine = (0.5 * sqrt_f64(length_squared)).min(1.0);
        let fresnel = f64::from(self.fresnel().reflectance(half_cosine as f32));
        let share = gaussian.share_above_plane(normal);
        finite(f64::from(gaussian.integral()) * share * fresnel * ndf / (4.0 * root))
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

/// `value`, or the largest `f32` if it is larger; zero for NaN.
fn finite(value: f64) -> f32 {
    value.max(0.0).min(f32::MAX.into()) as f32
}
