use core::marker::PhantomData;

use glam::Vec3;

use crate::bound::HalfSpace;
use crate::num::{UNIT_ROUNDOFF, Vector3};
use crate::view::{Camera, Perspective, Projection};

/// Budget for n·q, in units of ‖q‖.
const OFFSET_ROUNDINGS: f32 = 6.0;
/// Budget for n·x at a corner x of a tile, in units of the length of x: at depth 1 of a perspective, the secant of the
/// corner of the view.
const CORNER_ROUNDINGS: f32 = 8.0;
/// Budget for the angle by which a view that is not orthonormal turns n, in units of its deviation δ.
const NORMAL_DEVIATIONS: f32 = 3.0;
/// Factor of all that is subtracted from n·q. Pays for the difference, and for a measured δ that is short.
const OFFSET_GROWTH: f32 = 1.5;

/// A [`HalfSpace`] projected to camera space: n·x > n·q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedHalfSpace<P = Perspective> {
    normal: Vec3,
    /// n·q, rounded down.
    offset: f32,
    /// Upper bound of the error of n·x for a point x of a tile at depth 1 of a perspective, or, with parallel rays, at a
    /// distance of 1 from the origin of camera space.
    rounding_at_one: f32,
    projection: PhantomData<P>,
}

impl HalfSpace {
    /// Projects the half-space to the space of `camera`.
    ///
    /// It is enlarged for rounding, so that [`ProjectedHalfSpace::touches`] never misses a tile that holds a
    /// point of it.
    #[must_use]
    pub fn project<P: Projection>(&self, camera: &Camera<P>) -> ProjectedHalfSpace<P> {
        let view = camera.view();
        let normal = view.direction_to_camera_space(*self.normal());
        let point = view.transform_point(self.position());
        let turn = NORMAL_DEVIATIONS * view.rotation_deviation();
        let rounding = (OFFSET_ROUNDINGS * UNIT_ROUNDOFF + turn) * point.length()
            + view.rounding_of_terms(Vector3::from(self.position()));
        let of_corner = CORNER_ROUNDINGS * UNIT_ROUNDOFF + turn;
        ProjectedHalfSpace {
            normal,
            offset: normal.dot(point) - OFFSET_GROWTH * rounding,
            rounding_at_one: camera.farthest(Vector3::new(0.0, 0.0, 1.0), 0.0, of_corner),
            projection: PhantomData,
        }
    }
}

impl<P> ProjectedHalfSpace<P> {
    /// n, the unit normal in camera space, to within rounding.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// n·q in camera space, rounded down. −∞ or NaN if it overflows; such a half-space touches every tile.
    #[must_use]
    pub fn offset(&self) -> f32 {
        self.offset
    }

    pub(crate) fn rounding_at_one(&self) -> f32 {
        self.rounding_at_one
    }
}
