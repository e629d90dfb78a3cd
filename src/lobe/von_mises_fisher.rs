//! The von Mises–Fisher distribution: directions drawn in proportion to a spherical Gaussian.

use core::f32::consts::TAU;

use glam::Vec3;

use super::spherical_gaussian::{direction_along, solid_angle};
use super::{Lobe, SphericalGaussian};
use crate::base::Direction;
use crate::num::{Vector3, ln_1p_f64, one_minus_exponential, sin_cos, sqrt_f64};

impl SphericalGaussian {
    /// Draws a direction with the density v(ω)/∫v dω, the von Mises–Fisher distribution, from two independent
    /// numbers that are evenly distributed in \[0, 1).
    ///
    /// 1 − ω·ξ = −ln(1 − x(1 − e^{−2λ}))/λ inverts the distribution of the first number x: without
    /// cancellation for sharp lobes, and evenly over the sphere for λ = 0. Numbers outside \[0, 1\] are moved to
    /// its ends, and NaN to 0.
    #[must_use]
    pub fn sample(&self, numbers: [f32; 2]) -> Direction {
        // Zero for NaN.
        let [x, turn] = numbers.map(|number| if number > 0.0 { number.min(1.0) } else { 0.0 });
        let (x, sharpness) = (f64::from(x), f64::from(self.sharpness()));
        let height = if sharpness > 1e-9 {
            -ln_1p_f64(-x * one_minus_exponential(2.0 * sharpness)) / sharpness
        } else {
            2.0 * x
        };
        let height = height.min(2.0);
        let radius = sqrt_f64(height * (2.0 - height));
        let (v, w) = Vector3::from(self.axis()).any_orthonormal_pair();
        let (sine, cosine) = sin_cos(turn * TAU);
        let drawn = Vector3::combine([
            (1.0 - height, Vector3::from(self.axis()).widen()),
            (radius * f64::from(cosine), v.widen()),
            (radius * f64::from(sine), w.widen()),
        ]);
        direction_along(drawn, drawn.length()).unwrap_or(self.axis())
    }

    /// The density v(ω)/∫v dω in sr⁻¹ with which [`sample`](Self::sample) draws the unit vector `direction`,
    /// whatever the amplitude. Zero for NaN.
    #[must_use]
    pub fn density(&self, direction: Vec3) -> f32 {
        let amplitude = 1.0 / solid_angle(f64::from(self.sharpness()));
        Self::of_parts(self.axis(), self.sharpness(), amplitude as f32).value(direction)
    }
}
