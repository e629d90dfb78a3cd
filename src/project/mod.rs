//! Shapes projected to camera space, in the form that tile tests take.
//!
//! `docs/rounding.md` counts the roundings that each budget here pays for.

mod ellipsoid;
mod half_space;
mod projected;
mod slopes;
mod sphere;
mod spheroid;

pub use ellipsoid::{ProjectedEllipsoid, stretch_matrix, stretch_rotation};
pub use half_space::ProjectedHalfSpace;

pub use projected::Projected;
pub use sphere::ProjectedSphere;

use crate::bound::{Bounded, Shape};
use crate::num::{Single, UNIT_ROUNDOFF, Vector3};
use crate::view::Camera;

/// A shape that can be projected to camera space and tested against tiles.
///
/// For generic code. Each shape also has `project` as an inherent function.
pub trait Project: Shape {
    /// The projected shape.
    type Projected: Projected;

    /// Projects the shape to the space of `camera`. `None` if the shape is empty.
    fn project(&self, camera: &Camera) -> Option<Self::Projected>;

    /// [`project`](Self::project) in each lane, for shapes that are not empty.
    #[doc(hidden)]
    fn project_lanes<N: Single>(
        lanes: Self::Lanes<N>,
        camera: &Camera,
    ) -> <Self::Projected as Projected>::Fields<N>;
}

/// The projected shape of the recommended bound of lobes of type `L`, as batches of such lights hold it.
pub type ProjectedBound<L> = <<L as Bounded>::Shape as Project>::Projected;

/// Upper bound of the length by which rounding moves a point within `radius` of `center`, in camera space,
/// against the box of a tile that holds the point.
///
/// `center_roundings` is the number of roundings of the centre, and `box_roundings` that of the box.
#[inline(always)]
fn margin<N: Single>(
    camera: &Camera,
    center: Vector3<N>,
    radius: N,
    center_roundings: f32,
    box_roundings: f32,
) -> N {
    let farthest_depth = center.z.max(radius.zero()) + radius;
    // The sum of the coordinates is no less than the length, and needs no root.
    let of_center = center.abs().element_sum() * center_roundings;
    let of_box = farthest_depth * (box_roundings * camera.corner_secant());
    (of_center + of_box) * UNIT_ROUNDOFF
}
