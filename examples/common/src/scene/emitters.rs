//! Lamps in the place of what shines by itself.

use stochastic_light_culling::glam::Vec3;

use super::Lamp;
use super::lamp::Cosines;
use super::mesh::{Extent, Mesh, Triangle, twice_area};

/// Emissive triangles side by side.
struct Emitter<'a> {
    triangles: Vec<&'a Triangle>,
    extent: Extent,
}

/// A lamp for each group of emissive triangles of `mesh`, which is in `whole`. If they are flat, it shines to that side
/// of them which `target` is on.
pub fn lamps(mesh: &Mesh, whole: &Extent, target: Vec3) -> Vec<Lamp> {
    let reach = 0.05 * whole.radius();
    let mut emitters: Vec<Emitter> = Vec::new();
    let is_emissive = |triangle: &&Triangle| mesh.material_of(triangle).is_emissive();
    for triangle in mesh.triangles.iter().filter(is_emissive) {
        let Some(extent) = Extent::around([triangle]) else {
            continue;
        };
        let near = |emitter: &&mut Emitter| emitter.extent.is_near(&extent, reach);
        if let Some(emitter) = emitters.iter_mut().find(near) {
            emitter.extent = emitter.extent.with(&extent);
            emitter.triangles.push(triangle);
        } else {
            emitters.push(Emitter {
                triangles: vec![triangle],
                extent,
            });
        }
    }
    let lamps = emitters.iter();
    lamps.map(|emitter| emitter.lamp(mesh, target)).collect()
}

impl Emitter<'_> {
    fn lamp(&self, mesh: &Mesh, target: Vec3) -> Lamp {
        let areas = || {
            self.triangles
                .iter()
                .map(|triangle| 0.5 * twice_area(triangle.corners))
        };
        let sum: Vec3 = areas().sum();
        let whole: f32 = areas().map(Vec3::length).sum();
        let radiant = self.triangles.iter().zip(areas());
        let radiant = radiant.map(|(t, area)| mesh.material_of(t).emission * area.length());
        let intensity: Vec3 = radiant.sum();
        let position = self.extent.center();
        // What is round, or a box.
        if sum.length() < 0.5 * whole {
            return Lamp::Point {
                position,
                intensity: 0.25 * intensity,
            };
        }
        Lamp::Cone {
            position,
            axis: sum.normalize() * sum.dot(target - position).signum(),
            cosines: Cosines {
                inner: 1.0,
                outer: 0.0,
            },
            intensity,
        }
    }
}
