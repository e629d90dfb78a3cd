use glam::Vec3;

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
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// The index of the light.
    pub light: u32,
    /// The estimate of the radiance, max(L, δ): [`Roulette::estimate`](crate::Roulette::estimate) of the next
    /// two.
    pub radiance: f32,
    /// The radiant intensity towards the point.
    pub intensity: f32,
    /// The squared distance, or the least one of the estimator.
    pub distance_squared: f32,
    /// The direction from the light to the point, as [`Vpl::direction_to`](crate::Vpl::direction_to) gives
    /// it.
    pub direction: Vec3,
}
