//! Which triangle a ray meets first.

use std::time::Duration;

use obvhs::BvhBuildParams;
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray, RayHit};
use stochastic_light_culling::glam::Vec3;

use super::mesh::{Mesh, Triangle, twice_area};

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

    /// What the ray from `origin` along `direction` meets first.
    pub fn nearest(&self, origin: Vec3, direction: Vec3) -> Option<Hit> {
        let ray = Ray::new_inf(origin.to_array().into(), direction.to_array().into());
        let mut nearest = RayHit::none();
        let index = |primitive: usize| self.bvh.primitive_indices[primitive] as usize;
        let met = self.bvh.ray_traverse(ray, &mut nearest, |ray, primitive| {
            self.shapes[index(primitive)].intersect(ray)
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
