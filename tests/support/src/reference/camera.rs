//! A view of the world, from an engine's two matrices.

use stochastic_light_culling::glam::{Mat4, Vec3, Vec4};

use super::Vector;

#[derive(Clone, Copy, Debug)]
pub struct View {
    pub from_world: Mat4,
    pub projection: Mat4,
    /// Whether view space looks along +z.
    pub left_handed: bool,
}

impl View {
    /// `point` of the world with depth in the place of z.
    pub fn to_camera_space(self, point: Vector) -> Vector {
        let columns = self.from_world.to_cols_array().map(f64::from);
        let row = |i: usize| Vector([columns[i], columns[4 + i], columns[8 + i]]);
        let [x, y, z] = std::array::from_fn(|i| row(i).dot(point) + columns[12 + i]);
        Vector([x, y, if self.left_handed { z } else { -z }])
    }

    /// Normalised device coordinates of a point of camera space.
    pub fn ndc(self, Vector([x, y, depth]): Vector) -> [f64; 3] {
        let z = if self.left_handed { depth } else { -depth };
        let columns = self.projection.to_cols_array().map(f64::from);
        let clip: [f64; 4] = std::array::from_fn(|i| {
            columns[i] * x + columns[4 + i] * y + columns[8 + i] * z + columns[12 + i]
        });
        [clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]]
    }

    /// The same view from where `target` is ahead at `depth`, to rounding.
    pub fn aimed_at(mut self, target: Vec3, depth: f64) -> Self {
        let seen = self.from_world.transform_vector3(target);
        let z = if self.left_handed { depth } else { -depth };
        self.from_world.w_axis = (Vec3::new(0.0, 0.0, z as f32) - seen).extend(1.0);
        self
    }
}

/// A perspective projection with the given slopes of the edges of the view, and clip depth
/// `a + b/depth`.
pub fn off_centre(
    left_handed: bool,
    [left, right]: [f32; 2],
    [bottom, top]: [f32; 2],
    [a, b]: [f32; 2],
) -> Mat4 {
    let forward = if left_handed { 1.0 } else { -1.0 };
    Mat4::from_cols(
        Vec4::new(2.0 / (right - left), 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / (top - bottom), 0.0, 0.0),
        Vec4::new(
            -forward * (right + left) / (right - left),
            -forward * (top + bottom) / (top - bottom),
            forward * a,
            forward,
        ),
        Vec4::new(0.0, 0.0, b, 0.0),
    )
}
