use glam::Vec3;

use super::projected::{Field, Projected, ProjectedLanes, outward};
use super::{Project, margin};
use crate::bound::{Sphere, Spheres};
use crate::num::Single;
use crate::view::Camera;

/// A sphere as a tile test wants it: in camera space, with nothing stretched.
///
/// ```
/// use stochastic_light_culling::{Camera, Sphere, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let sphere = Sphere::new(Vec3::new(0.0, 0.0, -8.0), 3.0)?;
/// let seen = sphere.project(&camera).expect("not empty");
/// assert_eq!(seen.center(), Vec3::new(0.0, 0.0, 8.0));
/// assert!(9.0 < seen.radius_squared() && seen.radius_squared() < 9.001);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedSphere {
    center: Vec3,
    radius_squared: f32,
}

impl ProjectedSphere {
    /// The centre in camera space.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The square of the radius, enlarged by what rounding can take.
    #[must_use]
    pub fn radius_squared(&self) -> f32 {
        self.radius_squared
    }
}

impl Sphere {
    /// The sphere in the space of `camera`; `None` if it is empty.
    #[inline]
    #[must_use]
    pub fn project(&self, camera: &Camera) -> Option<ProjectedSphere> {
        if self.is_empty() {
            return None;
        }
        let (fields, _) = self.lanes().fields_and_radius(camera);
        Some(ProjectedSphere::from_fields(fields))
    }
}

impl Project for Sphere {
    type Projected = ProjectedSphere;

    fn project(&self, camera: &Camera) -> Option<ProjectedSphere> {
        self.project(camera)
    }

    #[inline(always)]
    fn project_lanes<N: Single>(
        lanes: Spheres<N>,
        camera: &Camera,
    ) -> ProjectedLanes<N, ProjectedSphere> {
        let (fields, radius) = lanes.fields_and_radius(camera);
        ProjectedLanes {
            reach: reach_of(fields[2], radius),
            fields,
        }
    }
}

/// Roundings of the centre and of the box of a tile.
const ROUNDINGS: [f32; 2] = [9.0, 2.0];
/// Its square, and those of distances as long, are far above the subnormal numbers.
const LEAST_RADIUS: f32 = 1e-18;

impl<N: Single> Spheres<N> {
    /// The fields of projected spheres, none of which is empty, and their radii.
    #[inline(always)]
    fn fields_and_radius(self, camera: &Camera) -> ([N; 4], N) {
        let center = camera.relative_to_anchor(self.center);
        let rounding = margin(camera, center, self.radius, ROUNDINGS) + camera.rounding_of_anchor();
        let scaling = self.radius * (3.0 * camera.rotation_deviation());
        let enlarged = (self.radius + rounding + scaling).round_up(10);
        // Where the centre is not finite, nor is the radius by now.
        let is_finite = (enlarged * enlarged).is_finite();
        let (zero, infinite) = (enlarged.zero(), enlarged.splat(f32::INFINITY));
        if N::is_known_false(is_finite) {
            return ([zero, zero, zero, infinite], infinite);
        }
        let radius = enlarged.max(zero.splat(LEAST_RADIUS));
        let [x, y, z, squared, radius] = N::select_all(
            is_finite,
            [center.x, center.y, center.z, radius * radius, radius],
            [zero, zero, zero, infinite, infinite],
        );
        ([x, y, z, squared], radius)
    }
}

/// The depths that spheres reach.
#[inline(always)]
fn reach_of<N: Single>(depth: N, radius: N) -> [N; 2] {
    let radius = radius.round_up(4);
    outward([depth - radius, depth + radius])
}

impl Projected for ProjectedSphere {
    /// The centre, and the square of the radius.
    type Fields<T: Field> = [T; 4];

    // However large the tile, no distance is less than this.
    const NOWHERE: [f32; 4] = [0.0, 0.0, 0.0, -1.0];

    fn fields_of<T: Field>(value: T) -> [T; 4] {
        [value; 4]
    }

    #[inline(always)]
    fn to_fields(&self) -> [f32; 4] {
        let c = self.center;
        [c.x, c.y, c.z, self.radius_squared]
    }

    #[inline(always)]
    fn from_fields([x, y, z, radius_squared]: [f32; 4]) -> Self {
        Self {
            center: Vec3::new(x, y, z),
            radius_squared,
        }
    }

    #[inline(always)]
    fn reach_of_fields<N: Single>(fields: &[N; 4]) -> [N; 2] {
        let [_, _, depth, radius_squared] = *fields;
        reach_of(depth, radius_squared.sqrt())
    }
}
