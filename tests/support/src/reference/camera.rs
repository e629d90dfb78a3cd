//! A view of the world, from an engine's two matrices.

use stochastic_light_culling::glam::{Mat4, Vec3, Vec4};

use super::Vector;

#[derive(Clone, Copy, Debug)]
pub struct View {
    pub from_world: Mat4,
    pub projection: Mat4,
    /// Whether depth grows along +z of view space.
    pub left_handed: bool,
}

impl View {
    /// `point` of the world with depth in the place of z.
    pub fn to_camera_space(self, point: Vector) -> Vector {
        let [x, y, z] = self.rows();
        Vector([x, y, z].map(|[a, b, c, d]| Vector([a, b, c]).dot(point) + d))
    }

    /// The rows of the affine map from world space to camera space, as the camera has them.
    pub fn rows(self) -> [[f64; 4]; 3] {
        let columns = self.from_world.to_cols_array().map(f64::from);
        let row = |i: usize| [0, 4, 8, 12].map(|column| columns[column + i]);
        let forward = if self.left_handed { 1.0 } else { -1.0 };
        let mut depth = row(2).map(|x| forward * x);
        if self.is_orthographic() {
            // Depth is (2 + NDC z) H, and its offset an f32.
            depth[3] = f64::from((depth[3] + self.depth_at_origin()) as f32);
        }
        [row(0), row(1), depth]
    }

    /// (2 + b) H for NDC z = ±z/H + b of an orthographic projection.
    fn depth_at_origin(self) -> f64 {
        let [per_z, offset] = [self.projection.z_axis.z, self.projection.w_axis.z].map(f64::from);
        (2.0 + offset) / per_z.abs()
    }

    pub fn is_orthographic(self) -> bool {
        self.projection.w_axis.w != 0.0
    }

    /// Normalised device coordinates of a point of camera space.
    pub fn ndc(self, Vector([x, y, depth]): Vector) -> [f64; 3] {
        let depth = if self.is_orthographic() {
            depth - self.depth_at_origin()
        } else {
            depth
        };
        let z = if self.left_handed { depth } else { -depth };
        let columns = self.projection.to_cols_array().map(f64::from);
        let clip: [f64; 4] = std::array::from_fn(|i| {
            columns[i] * x + columns[4 + i] * y + columns[8 + i] * z + columns[12 + i]
        });
        [clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]]
    }

    /// The same view from where `target` is ahead at `depth`, to rounding; with parallel rays in the middle of the view.
    pub fn aimed_at(mut self, target: Vec3, depth: f64) -> Self {
        let seen = self.from_world.transform_vector3(target);
        let mut place = Vec3::new(0.0, 0.0, depth as f32);
        if self.is_orthographic() {
            let [x, y] = [self.projection.x_axis.x, self.projection.y_axis.y];
            let [a, b, ..] = self.projection.w_axis.to_array();
            place = Vec3::new(-a / x, -b / y, (depth - self.depth_at_origin()) as f32);
        }
        if !self.left_handed {
            place.z = -place.z;
        }
        self.from_world.w_axis = (place - seen).extend(1.0);
        self
    }
}

/// An orthographic projection with these edges of the view, and NDC z = ±(z of view space) `a` + `b`, rising with
/// depth.
pub fn orthographic(
    left_handed: bool,
    [left, right]: [f32; 2],
    [bottom, top]: [f32; 2],
    [a, b]: [f32; 2],
) -> Mat4 {
    let forward = if left_handed { 1.0 } else { -1.0 };
    let offset = |low: f32, high: f32| -(low + high) / (high - low);
    Mat4::from_cols(
        Vec4::new(2.0 / (right - left), 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / (top - bottom), 0.0, 0.0),
        Vec4::new(0.0, 0.0, forward * a, 0.0),
        Vec4::new(offset(left, right), offset(bottom, top), b, 1.0),
    )
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
