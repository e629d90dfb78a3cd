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
use crate::view::{Camera, Perspective, Projection};

/// A shape that can be projected to camera space and tested against tiles.
///
/// For generic code. Each shape also has `project` as an inherent function.
pub trait Project: Shape {
    /// The projected shape, for a projection of either kind.
    type Projected<P: Projection>: Projected;

    /// Projects the shape to the space of `camera`. `None` if the shape is empty.
    fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<Self::Projected<P>>;

    /// [`project`](Self::project) in each lane, for shapes that are not empty.
    #[doc(hidden)]
    fn project_lanes<N: Single, P: Projection>(
        lanes: Self::Lanes<N>,
        camera: &Camera<P>,
    ) -> <Self::Projected<P> as Projected>::Fields<N>;
}

/// The projected shape of the recommended bound of lobes of type `L`, as batches of such lights hold it.
pub type ProjectedBound<L, P = Perspective> = <<L as Bounded>::Shape as Project>::Projected<P>;

/// Upper bound of the length by which rounding moves a point within `radius` of `center`, in camera space,
/// against the box of a tile that holds the point.
///
/// `center_roundings` is the number of roundings of the centre, and `box_roundings` that of the box.
#[inline(always)]
fn margin<N: Single, P: Projection>(
    camera: &Camera<P>,
    center: Vector3<N>,
    radius: N,
    center_roundings: f32,
    box_roundings: f32,
) -> N {
    // The sum of the coordinates is no less than the length, and needs no root.
    let of_center = center.abs().element_sum() * center_roundings;
    let of_box = camera.farthest(center, radius, box_roundings);
    (of_center + of_box) * UNIT_ROUNDOFF
}
