use core::marker::PhantomData;

use glam::Vec3;

use super::projected::{Field, Projected, outward};
use super::slopes::TangentPlanes;
use super::{Project, margin};
use crate::bound::{Sphere, Spheres};
use crate::num::{Single, UNIT_ROUNDOFF, Vector3};
use crate::view::{Camera, Perspective, Projection, ViewBounds};

/// Budget for the centre, in units of the sum of its coordinates.
const CENTER_ROUNDINGS: f32 = 9.0;
/// Budget for the box of a tile, in units of s z: s is the secant of the corner of the view, z the depth. With parallel
/// rays, in units of the distance from the origin of camera space.
const BOX_ROUNDINGS: f32 = 2.0;
/// Budget for the stretch of the radius by a view that is not orthonormal, in units of its deviation δ.
const RADIUS_DEVIATIONS: f32 = 3.0;
/// Budget for the radius: its own sums, those of the box test, and a measured δ that is short.
const RADIUS_ROUNDINGS: u16 = 10;
/// Budget for both ends of the range of depths, in units of the depth of the centre and the radius.
const DEPTH_ROUNDINGS: f32 = 8.0;
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
pub struct ProjectedSphere<P = Perspective> {
    fields: [f32; FIELDS],
    projection: PhantomData<P>,
}

/// The centre, the radius, the bounds of x/z and of y/z; the bounds of z and the square of the radius, which follow.
const FIELDS: usize = 11;
/// The number of fields from which the others follow.
const STORED: usize = 8;

impl<P> ProjectedSphere<P> {
    /// The centre in camera space. Zero for a sphere too large to be finite.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        let [x, y, z, ..] = self.fields;
        Vec3::new(x, y, z)
    }

    /// The square of the radius, enlarged for rounding. Infinite for a sphere too large to be finite, which
    /// touches every tile.
    #[must_use]
    pub fn radius_squared(&self) -> f32 {
        let [.., squared] = self.fields;
        squared
    }
}

impl Sphere {
    /// Projects the sphere to the space of `camera`. `None` if the sphere is empty.
    #[inline]
    #[must_use]
    pub fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<ProjectedSphere<P>> {
        if self.is_empty() {
            return None;
        }
        Some(ProjectedSphere::from_fields(self.lanes().fields(camera)))
    }
}

impl Project for Sphere {
    type Projected<P: Projection> = ProjectedSphere<P>;

    fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<ProjectedSphere<P>> {
        self.project(camera)
    }

    #[inline(always)]
    fn project_lanes<N: Single, P: Projection>(
        lanes: Spheres<N>,
        camera: &Camera<P>,
    ) -> [N; FIELDS] {
        lanes.fields(camera)
    }
}

impl<N: Single> Spheres<N> {
    /// The fields of the projected spheres, none of which is empty.
    #[inline(always)]
    fn fields<P: Projection>(self, camera: &Camera<P>) -> [N; FIELDS] {
        let view = camera.view();
        let origin = Vector3::zero(self.radius);
        let center = view.relative_to_anchor(self.center.unwrap_or(origin));
        let rounding = margin(camera, center, self.radius, CENTER_ROUNDINGS, BOX_ROUNDINGS)
            + view.rounding_of_anchor();
        let stretch = self.radius * (RADIUS_DEVIATIONS * view.rotation_deviation());
        let enlarged = (self.radius + rounding + stretch).round_up(RADIUS_ROUNDINGS);
        // If the centre is not finite, the margin is not either.
        let is_finite = (enlarged * enlarged).is_finite();
        let zero = enlarged.zero();
        let radius = enlarged.max(zero.splat(LEAST_RADIUS));
        // The bounds of an infinite radius hold everything.
        let [x, y, z, radius] = N::select_all(
            is_finite,
            [center.x, center.y, center.z, radius],
            [zero, zero, zero, zero.splat(f32::INFINITY)],
        );
        let [[left, right], [bottom, top]] = if P::IS_PERSPECTIVE {
            let planes = TangentPlanes::new(z, radius);
            [
                planes.slopes_of_sphere(x, radius),
                planes.slopes_of_sphere(y, radius),
            ]
        } else {
            [around(x, radius), around(y, radius)]
        };
        let mut fields = [x, y, z, radius, left, right, bottom, top, zero, zero, zero];
        ProjectedSphere::<P>::complete(&mut fields);
        fields
    }
}

/// Bounds of one coordinate of the points of a sphere, with parallel rays.
#[inline(always)]
fn around<N: Single>(center: N, radius: N) -> [N; 2] {
    outward([center - radius, center + radius])
}

/// Bounds of the depths of a sphere.
#[inline(always)]
fn depths<N: Single, P: Projection>(center: N, radius: N) -> [N; 2] {
    if !P::IS_PERSPECTIVE {
        return around(center, radius);
    }
    let reach = radius + (center.abs() + radius) * (DEPTH_ROUNDINGS * UNIT_ROUNDOFF);
    [center - reach, center + reach]
}

impl<P: Projection> Projected for ProjectedSphere<P> {
    type Fields<T: Field> = [T; FIELDS];

    const STORED: usize = STORED;

    /// The bounds hold nothing.
    const NOWHERE: [f32; FIELDS] = {
        const FAR: f32 = f32::INFINITY;
        [0.0, 0.0, 0.0, 0.0, FAR, -FAR, FAR, -FAR, 0.0, 0.0, 0.0]
    };

    fn fields_of<T: Field>(value: T) -> [T; FIELDS] {
        [value; FIELDS]
    }

    #[inline(always)]
    fn complete<N: Single>(fields: &mut [N; FIELDS]) {
        let [_, _, z, radius, ..] = *fields;
        let [near, far] = depths::<N, P>(z, radius);
        [fields[STORED], fields[STORED + 1], fields[STORED + 2]] = [near, far, radius * radius];
    }

    #[inline(always)]
    fn to_fields(&self) -> [f32; FIELDS] {
        self.fields
    }

    #[inline(always)]
    fn from_fields(fields: [f32; FIELDS]) -> Self {
        Self {
            fields,
            projection: PhantomData,
        }
    }

    #[inline(always)]
    fn bounds_of<N: Single>(fields: &[N; FIELDS]) -> ViewBounds<N> {
        let [_, _, _, _, left, right, bottom, top, near, far, _] = *fields;
        ViewBounds {
            across: [left, right],
            down: [bottom, top],
            depths: [near, far],
        }
    }
}
