//! Which triangle a ray meets first.

use std::time::Duration;

use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray, RayHit};
use stochastic_light_culling::glam::Vec3;

use super::mesh::{Extent, Material, Mesh, Triangle, twice_area};

/// A mesh made ready for rays.
pub struct Tracer<'a> {
    mesh: &'a Mesh,
    shapes: Vec<obvhs::triangle::Triangle>,
    bvh: CwBvh,
}

/// Where a ray meets a triangle. Both normals are on the side that the ray came from.
pub struct Hit {
    /// In lengths of the ray's direction.
    pub distance: f32,
    pub position: Vec3,
    /// The smooth normal, if the ray comes from above it, else that of the plane.
    pub normal: Vec3,
    pub plane_normal: Vec3,
    pub material: usize,
}

impl Hit {
    /// Where a ray away from the surface starts, so that rounding does not put it behind the surface.
    pub fn off_surface(&self) -> Vec3 {
        let rounding = 2e-5 * (self.position.abs().max_element() + self.distance);
        self.position + rounding * self.plane_normal
    }
}

impl<'a> Tracer<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        // By way of arrays, since the BVH's glam may be another version than the library's.
        let shape = |triangle: &Triangle| {
            let [v0, v1, v2] = triangle.corners.map(|corner| corner.to_array().into());
            obvhs::triangle::Triangle { v0, v1, v2 }
        };
        let shapes: Vec<_> = mesh.triangles.iter().map(shape).collect();
        let effort = BvhBuildParams::medium_build();
        let bvh = build_cwbvh_from_tris(&shapes, effort, &mut Duration::default());
        Self { mesh, shapes, bvh }
    }

    /// The diffuse albedo of what a ray met.
    pub fn albedo(&self, hit: &Hit) -> Vec3 {
        self.mesh.materials[hit.material].albedo
    }

    /// The material of what a ray met.
    pub fn material(&self, hit: &Hit) -> &Material {
        &self.mesh.materials[hit.material]
    }

    /// The box around all triangles; empty at the origin without any.
    pub fn extent(&self) -> Extent {
        self.mesh.extent().unwrap_or(Extent {
            min: Vec3::ZERO,
            max: Vec3::ZERO,
        })
    }

    /// What the ray from `origin` along `direction` meets first.
    pub fn nearest(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        self.nearest_of(origin, direction, f32::INFINITY, |_| true)
    }

    /// As [`Self::nearest`], but through whatever shines by itself: the bulb around a light does not shade it.
    pub fn nearest_unlit(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        self.nearest_of(origin, direction, f32::INFINITY, |m| !m.is_emissive())
    }

    /// Whether light comes to `point` on a surface from `distance` away along `direction`, of unit length.
    pub fn is_lit(&self, point: &Hit, direction: Vec3, distance: f32) -> bool {
        let start = point.off_surface();
        let reach = distance - 2.0 * start.distance(point.position);
        let shade = self.nearest_of(start, direction, reach, |m| !m.is_emissive());
        shade.is_none()
    }

    fn nearest_of(
        &self,
        origin: Vec3,
        direction: Vec3,
        reach: f32,
        is_met: impl Fn(&Material) -> bool,
    ) -> Option<Hit> {
        let [from, along] = [origin, direction].map(|v| v.to_array().into());
        let ray = Ray::new(from, along, 0.0, reach);
        let mut nearest = RayHit::none();
        let index = |primitive: usize| self.bvh.primitive_indices[primitive] as usize;
        let met = self.bvh.ray_traverse(ray, &mut nearest, |ray, primitive| {
            let primitive = index(primitive);
            if is_met(self.mesh.material_of(&self.mesh.triangles[primitive])) {
                self.shapes[primitive].intersect(ray)
            } else {
                f32::INFINITY
            }
        });
        if !met {
            return None;
        }
        let triangle = &self.mesh.triangles[index(nearest.primitive_id as usize)];
        let position = origin + nearest.t * direction;
        let facing = |normal: Vec3| normal * -normal.dot(direction).signum();
        let plane_normal = facing(triangle.plane_normal());
        let smooth = smooth_normal(triangle, position);
        let smooth = smooth * smooth.dot(plane_normal).signum();
        Some(Hit {
            distance: nearest.t,
            position,
            normal: if smooth.dot(direction) < 0.0 {
                smooth
            } else {
                plane_normal
            },
            plane_normal,
            material: triangle.material,
        })
    }
}

/// The mean of the corners' normals, weighted by the areas that `position` cuts off.
fn smooth_normal(triangle: &Triangle, position: Vec3) -> Vec3 {
    let [a, b, c] = triangle.corners;
    let whole = twice_area([a, b, c]);
    let share = |p, q| twice_area([position, p, q]).dot(whole).max(0.0);
    let [at_a, at_b, at_c] = triangle.normals;
    let sum = at_a * share(b, c) + at_b * share(c, a) + at_c * share(a, b);
    sum.try_normalize()
        .unwrap_or_else(|| triangle.plane_normal())
}
