use super::{Project, Projected, ProjectedEllipsoid};
use crate::bound::{Ellipsoid, Spheroid, Spheroids};
use crate::num::Single;
use crate::view::Camera;

impl Spheroid {
    /// Projects the spheroid to a unit sphere in the space of `camera`. `None` if the spheroid is empty.
    #[must_use]
    pub fn project(&self, camera: &Camera) -> Option<ProjectedEllipsoid> {
        Ellipsoid::from(*self).project(camera)
    }
}

impl Project for Spheroid {
    type Projected = ProjectedEllipsoid;

    fn project(&self, camera: &Camera) -> Option<ProjectedEllipsoid> {
        self.project(camera)
    }

    #[inline(always)]
    fn project_lanes<N: Single>(
        lanes: Spheroids<N>,
        camera: &Camera,
    ) -> <ProjectedEllipsoid as Projected>::Fields<N> {
        lanes.ellipsoids().fields(camera)
    }
}
