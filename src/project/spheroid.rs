use super::{Project, Projected, ProjectedEllipsoid};
use crate::bound::{Ellipsoid, Spheroid, Spheroids};
use crate::num::Single;
use crate::view::{Camera, Projection};

impl Spheroid {
    /// Projects the spheroid to a unit sphere in the space of `camera`. `None` if the spheroid is empty.
    #[must_use]
    pub fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<ProjectedEllipsoid<P>> {
        Ellipsoid::from(*self).project(camera)
    }
}

impl Project for Spheroid {
    type Projected<P: Projection> = ProjectedEllipsoid<P>;

    fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<ProjectedEllipsoid<P>> {
        self.project(camera)
    }

    #[inline(always)]
    fn project_lanes<N: Single, P: Projection>(
        lanes: Spheroids<N>,
        camera: &Camera<P>,
    ) -> <ProjectedEllipsoid<P> as Projected>::Fields<N> {
        lanes.ellipsoids().fields(camera)
    }
}
