use glam::Vec3;

use super::projected::{Field, Projected, ProjectedLanes, outward};
use super::{Project, margin};
use crate::bound::{Sphere, Spheres};
use crate::num::Single;
use crate::view::Camera;

/// Budget for the centre, in units of the sum of its coordinates.
const CENTER_ROUNDINGS: f32 = 9.0;
/// Budget for the box of a tile, in units of s z: s is the secant of the corner of the view, z the depth.
const BOX_ROUNDINGS: f32 = 2.0;
/// Budget for the stretch of the radius by a view that is not orthonormal, in units of its deviation δ.
const RADIUS_DEVIATIONS: f32 = 3.0;
/// Budget for the radius: its own sums, those of the box test, and a measured δ that is short.
const RADIUS_ROUNDINGS: u16 = 10;
/// Budget for the radius in the range of depths that a sphere reaches.
const REACH_ROUNDINGS: u16 = 4;
/// Lower clamp of the radius. Its square, and the squares of distances as long, are normal numbers.
const LEAST_RADIUS: f32 = 1e-18;

/// A sphere projected to camera space, as tile tests take it. Nothing is stretched.
///
/// ```
/// use stochastic_light_culling::{Camera, Sphere, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let sphere = Sphere::new(Vec3::new(0.0, 0.0, -8.0), 3.0)?;
/// let projected = sphere.project(&camera).expect("not empty");
/// assert_eq!(projected.center(), Vec3::new(0.0, 0.0, 8.0));
/// assert!((9.0..9.001).contains(&projected.radius_squared()));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedSphere {
    center: Vec3,
    radius_squared: f32,
}

impl ProjectedSphere {
    /// The centre in camera space. Zero for a sphere too large to be finite.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The square of the radius, enlarged for rounding. Infinite for a sphere too large to be finite, which
    /// touches every tile.
    #[must_use]
    pub fn radius_squared(&self) -> f32 {
        self.radius_squared
    }
}

impl Sphere {
    /// Projects the sphere to the space of `camera`. `None` if the sphere is empty.
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

impl<N: Single> Spheres<N> {
    /// The fields of the projected spheres, none of which is empty, and their radii.
    #[inline(always)]
    fn fields_and_radius(self, camera: &Camera) -> ([N; 4], N) {
        let center = camera.relative_to_anchor(self.center);
        let rounding = margin(camera, center, self.radius, CENTER_ROUNDINGS, BOX_ROUNDINGS)
            + camera.rounding_of_anchor();
        let stretch = self.radius * (RADIUS_DEVIATIONS * camera.rotation_deviation());
        let enlarged = (self.radius + rounding + stretch).round_up(RADIUS_ROUNDINGS);
        // If the centre is not finite, the margin is not either.
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

/// The range of depths that spheres reach.
#[inline(always)]
fn reach_of<N: Single>(depth: N, radius: N) -> [N; 2] {
    let radius = radius.round_up(REACH_ROUNDINGS);
    outward([depth - radius, depth + radius])
}

impl Projected for ProjectedSphere {
    /// The centre and the square of the radius.
    type Fields<T: Field> = [T; 4];

    /// The squared radius is less than any squared distance.
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
