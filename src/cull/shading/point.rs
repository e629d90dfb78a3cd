use glam::Vec3;

use crate::base::Direction;
use crate::lobe::SphericalGaussian;

/// A surface point that lights are evaluated at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadedPoint {
    /// Its position in world space. A point with a NaN or infinite coordinate accepts no light.
    pub position: Vec3,
    /// The normal of its surface, of any length. Lights below the surface, with n·(p − q) > 0 for the point p
    /// and the light at q, are left out before they are evaluated. Zero for a point that is lit from all sides.
    pub normal: Vec3,
}

/// A point that is lit from all sides.
impl From<Vec3> for ShadedPoint {
    fn from(position: Vec3) -> Self {
        Self {
            position,
            normal: Vec3::ZERO,
        }
    }
}

/// A light that a point accepts.
///
/// Of a [`Vsgl`](crate::Vsgl) the intensity is its [`scalar_irradiance`](crate::Vsgl::scalar_irradiance) E at the
/// point, in W/m², and the squared distance is 1: E counts as the intensity of a light at unit distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The index of the light.
    pub light: u32,
    /// The estimate L/p of the radiance L = I/l², from the next two. If the point decides by L, it is max(L, δ), as by
    /// [`Roulette::estimate`](crate::Roulette::estimate).
    pub radiance: f32,
    /// The radiant intensity towards the point.
    pub intensity: f32,
    /// The squared distance, or the least one of the estimator.
    pub distance_squared: f32,
    /// The direction from the light to the point, as [`Vpl::direction_to`](crate::Vpl::direction_to) gives
    /// it. Of a [`Vsgl`](crate::Vsgl) the direction that its light arrives along, opposite to the axis of
    /// [`incoming`](crate::Vsgl::incoming).
    pub direction: Vec3,
    /// The sharpness of the light as it arrives: infinite from a point light, that of
    /// [`Vsgl::incoming`](crate::Vsgl::incoming) from a [`Vsgl`](crate::Vsgl).
    pub sharpness: f32,
}

impl Estimate {
    /// The light that arrives, as a spherical Gaussian whose integral is the estimate
    /// [`radiance`](Self::radiance). A sharpness above [`SphericalGaussian::MAX_SHARPNESS`] is that.
    ///
    /// Since `product_integral` of a receiver, such as [`LambertLobe`](crate::LambertLobe::product_integral), is
    /// proportional to this integral, its mean over ξ is that of [`Vsgl::incoming`](crate::Vsgl::incoming).
    #[must_use]
    pub fn incoming(&self) -> SphericalGaussian {
        let from = -self.direction;
        let axis = if (from.length_squared() - 1.0).abs() < 5e-7 {
            Direction::from_unit(from)
        } else {
            // At a point light the direction is short.
            Direction::new(from).unwrap_or(Direction::Z)
        };
        let sharpness = self.sharpness.min(SphericalGaussian::MAX_SHARPNESS);
        SphericalGaussian::arriving(axis, sharpness, self.radiance)
    }
}
