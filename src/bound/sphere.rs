use glam::Vec3;

use super::{Bound, rounding_of_sum, scaled};
use crate::{Error, error, math};

/// A ball, its surface included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: Vec3,
    radius: f32,
}

impl Sphere {
    /// The ball of `radius` around `center`; a radius of zero is the empty set.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `center` is not finite, [`Error::Number`] if `radius` is negative,
    /// infinite or NaN.
    pub fn new(center: Vec3, radius: f32) -> Result<Self, Error> {
        Ok(Self {
            center: error::finite("sphere centre", center)?,
            radius: error::number_in("sphere radius", radius, "in [0, ∞)", 0.0..=f32::MAX)?,
        })
    }

    pub(super) fn from_parts(center: Vec3, radius: f32) -> Self {
        Self { center, radius }
    }

    /// The centre.
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The radius; infinite for a light too bright for its range to be an `f32`.
    pub fn radius(&self) -> f32 {
        self.radius
    }
}

impl Bound for Sphere {
    #[inline]
    fn placed(self, position: Vec3, scale: f32) -> Self {
        let radius = scaled(self.radius, scale);
        if radius == 0.0 {
            return Self::from_parts(position, 0.0);
        }
        let offset = self.center * scale;
        let center = position + offset;
        let rounding = rounding_of_sum(offset) + rounding_of_sum(center);
        Self::from_parts(center, math::round_up(radius + rounding, 2))
    }

    fn is_empty(&self) -> bool {
        self.radius == 0.0
    }
}
