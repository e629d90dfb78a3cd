use glam::Vec3;

use crate::bound::HalfSpace;
use crate::num::{UNIT_ROUNDOFF, Vector3};
use crate::view::Camera;

/// A [`HalfSpace`] in camera space, as a tile test takes it: n·x > n·q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedHalfSpace {
    normal: Vec3,
    /// n·q, less what rounding can have added to it.
    offset: f32,
    /// What rounding can have taken from n·x at depth 1.
    rounding_at_one: f32,
}

impl HalfSpace {
    /// The half-space in the space of `camera`.
    ///
    /// Enlarged by what rounding can take: n and q in camera space are rounded once and n·q five
    /// times, 6u‖q‖; a tile's corner, at depth 1 no longer than the secant s of the corner of the
    /// view, is off by 8us; and a view that is orthonormal to δ turns n by 3δ.
    #[must_use]
    pub fn project(&self, camera: &Camera) -> ProjectedHalfSpace {
        let normal = camera.turn(*self.normal());
        let point = camera.to_camera_space(self.position());
        let turned = 3.0 * camera.rotation_deviation();
        let of_offset = (6.0 * UNIT_ROUNDOFF + turned) * point.length()
            + camera.rounding_of_terms([self.position(), Vec3::ZERO].map(Vector3::from));
        ProjectedHalfSpace {
            normal,
            offset: normal.dot(point) - 1.5 * of_offset,
            rounding_at_one: (8.0 * UNIT_ROUNDOFF + turned) * camera.corner_secant(),
        }
    }
}

impl ProjectedHalfSpace {
    /// n in camera space.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// n·q in camera space, rounded down.
    #[must_use]
    pub fn offset(&self) -> f32 {
        self.offset
    }

    pub(crate) fn rounding_at_one(&self) -> f32 {
        self.rounding_at_one
    }
}
