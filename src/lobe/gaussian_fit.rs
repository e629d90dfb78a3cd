//! Spherical Gaussians that stand for other lobes: for those of surfaces, and for any by their mean direction.

use glam::Vec3;

use super::spherical_gaussian::direction_along;
use super::{Ggx, Incidence, SphericalGaussian, unit};
use crate::base::{Direction, Error, number_in};
use crate::num::{Vector3, exact_dot};

impl SphericalGaussian {
    /// The sharpness λ_d of the SG that stands for Lambert's lobe [Tokuyoshi 2016, Sec. 2.1].
    ///
    /// Least squares over all directions give 2.14 with a free amplitude, and 2.29 with the integral of the
    /// lobe. Toksvig's rule gives 2 for the lobe's mean direction, which is ⅔ of the normal.
    pub const DIFFUSE_SHARPNESS: f32 = 2.0;

    /// Approximates the [`LambertLobe`](crate::LambertLobe) of a surface with `normal` that reflects the share
    /// `albedo` of the light, by an SG with the same integral [Tokuyoshi 2016, Eq. 1].
    ///
    /// Unlike that lobe it does not end at the horizon. Its sharpness is
    /// [`DIFFUSE_SHARPNESS`](Self::DIFFUSE_SHARPNESS).
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `albedo` is outside \[0, 1\] or NaN.
    pub fn diffuse(albedo: f32, normal: Direction) -> Result<Self, Error> {
        let albedo = number_in("albedo", albedo, "in [0, 1]", 0.0..=1.0)?;
        Self::with_integral(normal, Self::DIFFUSE_SHARPNESS, albedo)
    }

    /// Approximates the [`GgxLobe`](crate::GgxLobe) of a surface that reflects the share `reflectance` = R_s
    /// of the light, by an SG with that integral [Tokuyoshi 2016, Eq. 2].
    ///
    /// The axis is the mirror direction ξ_s, and λ_s = 1/(2α²ξ_s·n): the NDF is an SG with the sharpness 2/α²
    /// in the half vector [Wang et al. 2009]. A λ_s above [`MAX_SHARPNESS`](Self::MAX_SHARPNESS) is lowered to
    /// that. For light from below the surface or at grazing incidence the SG is zero everywhere.
    ///
    /// The relative error in the square mean is 0.2 to 0.3 for α ≤ 0.4 and light from up to 30° off the normal,
    /// since the NDF has longer tails than a Gaussian. It is 0.4 to 0.5 at 60° and about 1 at 80°.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `reflectance` is outside \[0, 1\] or NaN.
    pub fn specular(ggx: Ggx, reflectance: f32, incidence: Incidence) -> Result<Self, Error> {
        let reflectance = number_in("reflectance", reflectance, "in [0, 1]", 0.0..=1.0)?;
        let Incidence { normal, incoming } = incidence;
        let cosine = exact_dot(Vector3::from(normal), incoming.into());
        let axis = incoming.mirrored(normal);
        if cosine <= 0.0 {
            return Self::new(axis, 0.0, 0.0);
        }
        let alpha = f64::from(ggx.roughness());
        let sharpness = 0.5 / (alpha * alpha * cosine);
        let sharpness = sharpness.min(Self::MAX_SHARPNESS.into()) as f32;
        Self::with_integral(axis, sharpness, reflectance)
    }

    /// Creates the SG with the given `integral` whose mean direction is `mean` = ξ̄, by Toksvig's rule: its
    /// axis is along ξ̄, and λ = ‖ξ̄‖/(1 − ‖ξ̄‖) [Tokuyoshi 2016, Sec. 3.1; Toksvig 2005].
    ///
    /// It undoes [`mean_direction`](Self::mean_direction). The weighted mean of the mean directions of several
    /// lobes makes the SG that stands for all of them. For ξ̄ = 0 the SG is constant, λ = 0, and its axis is
    /// arbitrary. λ is at most [`MAX_SHARPNESS`](Self::MAX_SHARPNESS), as for ‖ξ̄‖ = 1.
    ///
    /// `mean` is in double precision, since in single precision a length near 1 would lose the digits of λ.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if a component of `mean` is NaN or its length is above 1 by more than 10⁻⁶;
    /// [`Error::Number`] as [`with_integral`](Self::with_integral).
    pub fn from_mean_direction(mean: [f64; 3], integral: f32) -> Result<Self, Error> {
        let mean = Vector3::from(mean);
        let length = mean.length();
        // False for NaN.
        let is_valid = length <= 1.0 + 1e-6;
        if !is_valid {
            return Err(Error::Vector {
                quantity: "mean direction",
                value: Vec3::from(Vector3::narrow(mean)),
                valid: "no longer than 1",
            });
        }
        let (axis, sharpness) = toksvig(mean, 1.0 - length);
        Self::with_integral(axis, sharpness, integral)
    }

    /// The mean direction ξ̄ = λ/(λ+1) ξ by Toksvig's rule [Tokuyoshi 2016, Sec. 3.1].
    ///
    /// The rule is rational and easily undone ([`from_mean_direction`](Self::from_mean_direction)). The exact
    /// mean is coth λ − 1/λ times ξ: the same for λ → ∞, and a third as long for λ → 0.
    #[must_use]
    pub fn mean_direction(&self) -> [f64; 3] {
        let Vector3 { x, y, z } = self.mean();
        [x, y, z]
    }

    #[inline]
    pub(crate) fn mean(&self) -> Vector3<f64> {
        let sharpness = f64::from(self.sharpness());
        unit(Vector3::from(self.axis())) * (sharpness / (sharpness + 1.0))
    }
}

/// The axis and the sharpness ‖ξ̄‖/(1 − ‖ξ̄‖) of the SG with the mean direction `mean`, where
/// `rest` = 1 − ‖ξ̄‖. The axis is +z for a mean of zero.
pub(crate) fn toksvig(mean: Vector3<f64>, rest: f64) -> (Direction, f32) {
    let length = mean.length();
    let most = f64::from(SphericalGaussian::MAX_SHARPNESS);
    let sharpness = if rest * most > length {
        length / rest
    } else {
        most
    };
    let axis = direction_along(mean, length).unwrap_or(Direction::Z);
    (axis, sharpness as f32)
}
