//! Shapes in the space of a camera, as tile tests take them.

mod ellipsoid;
mod half_space;
mod projected;
mod sphere;
mod spheroid;

pub use ellipsoid::{ProjectedEllipsoid, stretch_matrix, stretch_rotation};
pub use half_space::ProjectedHalfSpace;
pub(crate) use projected::Field;
pub use projected::Projected;
#[cfg(feature = "cull")]
pub(crate) use projected::ProjectedLanes;
pub use sphere::ProjectedSphere;

use crate::bound::{Bounded, Shape};
use crate::num::{Single, UNIT_ROUNDOFF, Vector3};
use crate::view::Camera;

/// A shape that a tile can be tested against once it is in camera space. For generic code: each shape has
/// `project` itself.
pub trait Project: Shape {
    /// The shape in camera space.
    type Projected: Projected;

    /// The shape in the space of `camera`; `None` if it is empty.
    fn project(&self, camera: &Camera) -> Option<Self::Projected>;

    /// [`project`](Self::project) in each lane, of shapes that are not empty.
    #[doc(hidden)]
    fn project_lanes<N: Single>(
        lanes: Self::Lanes<N>,
        camera: &Camera,
    ) -> projected::ProjectedLanes<N, Self::Projected>;
}

/// The projected shape of the recommended bound of lobes of type `L`: what batches of such lights hold.
pub type ProjectedBound<L> = <<L as Bounded>::Shape as Project>::Projected;

/// The length by which rounding can move a point within `reach` of `center`, in camera space, against
/// the box of a tile that holds it, if that takes so many roundings of the centre and of the box.
#[inline(always)]
fn margin<N: Single>(
    camera: &Camera,
    center: Vector3<N>,
    reach: N,
    [of_center, of_box]: [f32; 2],
) -> N {
    let farthest_depth = center.z.max(reach.zero()) + reach;
    // In place of its length, which is no larger and a root more.
    let of_center = center.abs().element_sum() * of_center;
    let of_box = farthest_depth * (of_box * camera.corner_secant());
    (of_center + of_box) * UNIT_ROUNDOFF
}
