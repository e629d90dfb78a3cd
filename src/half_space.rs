use glam::Vec3;

use crate::{Camera, Direction, math};

/// The side of a surface that light reflected by it can reach, in camera space: n·(x − q) > 0.
///
/// No bound of a lobe knows of it. A light that fails this test, or the test of its bound, does not
/// touch the tile.
///
/// ```
/// use stochastic_light_culling::{
///     Camera, DepthInterval, Direction, HalfSpace, PixelRectangle, TileTest, glam::Vec3,
/// };
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let all = PixelRectangle { min: [0, 0], max: [1, 1] };
/// let view = camera.tile_rectangle([1, 1], all);
/// // A wall at depth 5 that faces the eye lights what is before it.
/// let before_wall = HalfSpace::new(Vec3::new(0.0, 0.0, -5.0), Direction::Z, &camera);
/// assert!(before_wall.touches(&view, &DepthInterval::new(1.0, 4.0)?));
/// assert!(!before_wall.touches(&view, &DepthInterval::new(6.0, 9.0)?));
/// assert!((before_wall.offset() + 5.0).abs() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    normal: Vec3,
    /// n·q, less what rounding can have added to it.
    offset: f32,
    /// What rounding can have taken from n·x at depth 1.
    rounding_at_one: f32,
}

impl HalfSpace {
    /// The half-space before `camera` that begins at `position` = q and lies along `normal` = n.
    ///
    /// Enlarged by what rounding can take: n and q before the camera are rounded once and n·q five
    /// times, 6u‖q‖; a tile's corner, at depth 1 no longer than the secant s of the corner of the
    /// view, is off by 8us; and a view that is orthonormal to δ turns n by 3δ.
    pub fn new(position: Vec3, normal: Direction, camera: &Camera) -> Self {
        let rotated = [0, 1, 2].map(|i| math::dot(camera.rotation().row(i), *normal) as f32);
        let normal = Vec3::from_array(rotated);
        let point = camera.to_camera_space(position);
        let turned = 3.0 * camera.rotation_deviation();
        let of_offset = (6.0 * math::UNIT_ROUNDOFF + turned) * point.length()
            + camera.rounding_of_terms([position, Vec3::ZERO]);
        Self {
            normal,
            offset: normal.dot(point) - 1.5 * of_offset,
            rounding_at_one: (8.0 * math::UNIT_ROUNDOFF + turned) * camera.corner_secant(),
        }
    }

    /// n in camera space.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// n·q in camera space, rounded down.
    pub fn offset(&self) -> f32 {
        self.offset
    }

    pub(crate) fn rounding_at_one(&self) -> f32 {
        self.rounding_at_one
    }
}
