//! Smooth normals for meshes that come without.

use stochastic_light_culling::glam::Vec3;

use super::mesh::{Triangle, twice_area};

/// Edges sharper than this stay sharp: cos 40°.
const CREASE_COSINE: f32 = 0.766;

/// Gives each corner the mean normal, weighted by area, of the triangles around its vertex that are
/// not beyond a crease. Each triangle comes with its three of `vertices`.
pub fn smooth(triangles: &mut [([u32; 3], Triangle)], vertices: usize) {
    let mut around: Vec<Vec<Vec3>> = vec![Vec::new(); vertices];
    for (indices, triangle) in triangles.iter() {
        let area = twice_area(triangle.corners);
        for index in indices {
            around[*index as usize].push(area);
        }
    }
    for (indices, triangle) in triangles {
        let plane = triangle.plane_normal();
        let smooth = |index: u32| {
            let neighbours = &around[index as usize];
            let sum: Vec3 = neighbours
                .iter()
                .filter(|area| area.dot(plane) > CREASE_COSINE * area.length())
                .sum();
            sum.try_normalize().unwrap_or(plane)
        };
        triangle.normals = indices.map(smooth);
    }
}
