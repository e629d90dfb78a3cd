//! A light behind a window.

use stochastic_light_culling::glam::Vec3;

/// A point light behind a square window, the frustum of its reflective shadow map.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    pub position: Vec3,
    /// The unit direction to the middle of the window.
    pub axis: Vec3,
    /// The tangent of the angle between the axis and an edge of the window.
    pub half_width: f32,
    /// W/sr in each direction through the window.
    pub intensity: Vec3,
}

impl Spot {
    /// A spot of intensity `intensity_at_target`·d² through whose window a sphere just fits, so that
    /// the irradiance there does not depend on the distance d or the unit of length.
    pub fn aimed_at(position: Vec3, target: Vec3, radius: f32, irradiance: Vec3) -> Self {
        let to_target = target - position;
        let distance = to_target.length();
        // A window wider than 140° would be mostly stretched edges.
        let half_width = (radius / distance).clamp(1e-3, 0.94).asin().tan();
        Self {
            position,
            axis: to_target.normalize_or(Vec3::NEG_Y),
            half_width,
            intensity: irradiance * distance * distance,
        }
    }

    /// The ray through (`x`, `y`) of the window in \[−1, 1\]², not of unit length, and the solid
    /// angle per area of that square there.
    pub fn ray(&self, x: f32, y: f32) -> (Vec3, f32) {
        let (right, up) = self.axis.any_orthonormal_pair();
        let direction = self.axis + self.half_width * (x * right + y * up);
        let length_squared = direction.length_squared();
        let solid_angle =
            self.half_width * self.half_width / (length_squared * length_squared.sqrt());
        (direction, solid_angle)
    }
}
