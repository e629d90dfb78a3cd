//! Where to look at a file's mesh from, and where to light it from.

use stochastic_light_culling::glam::Vec3;

use super::mesh::{Extent, Material, Mesh, Triangle};
use super::{Scene, Spot, Tracer, Viewpoint};

/// The irradiance of what the spot is aimed at.
const IRRADIANCE: Vec3 = Vec3::splat(0.08);

/// The scene of `mesh`: y is up, and what is glossy is in the middle.
pub fn frame(mut mesh: Mesh) -> Result<Scene, String> {
    let whole = mesh.extent().ok_or("scene has no triangles")?;
    if mesh
        .triangles
        .iter()
        .all(|triangle| mesh.material_of(triangle).glossy)
    {
        add_floor(&mut mesh, &whole);
    }
    let glossy = mesh.extent_of(|material| material.glossy);
    let focus = glossy.unwrap_or(whole);
    let tracer = Tracer::new(&mesh);
    let viewpoint = viewpoint(&tracer, &whole, &focus, glossy.is_some());
    let spot = spot(&mesh, &tracer, &whole, &focus);
    Ok(Scene {
        mesh,
        spot,
        viewpoint,
    })
}

/// A floor beneath `extent`, far larger than it.
fn add_floor(mesh: &mut Mesh, extent: &Extent) {
    let material = mesh.add_material(Material::diffuse(Vec3::splat(0.6)));
    // Not flush with the lowest triangle, which it would flicker through.
    let height = extent.min.y - 1e-3 * extent.radius();
    let middle = extent.center().with_y(height);
    let [x, z] = [Vec3::X, Vec3::Z].map(|axis| 12.0 * extent.radius() * axis);
    mesh.add_quad(
        [z - x, z + x, x - z, -x - z].map(|corner| middle + corner),
        material,
    );
}

/// From above at a slant, or level from +z where there is a ceiling.
fn viewpoint(tracer: &Tracer, whole: &Extent, focus: &Extent, is_glossy: bool) -> Viewpoint {
    // From the top of what is glossy, else from the middle of everything, straight up.
    let height = if is_glossy {
        focus.max.y + 0.01 * focus.radius()
    } else {
        focus.center().y
    };
    let has_ceiling = tracer
        .nearest(focus.center().with_y(height), Vec3::Y)
        .is_some();
    let (seen, to_eye) = if has_ceiling {
        (whole, Vec3::Z)
    } else {
        (focus, Vec3::new(0.0, 0.8, 1.0).normalize())
    };
    Viewpoint {
        target: seen.center(),
        // The sphere around a box is larger than it looks from most sides.
        radius: 0.75 * seen.radius(),
        to_eye,
        fov_radians: 0.6,
    }
}

/// From the middle of what is emissive, if anything is, else from the side above; towards `focus`.
fn spot(mesh: &Mesh, tracer: &Tracer, whole: &Extent, focus: &Extent) -> Spot {
    let emissive = |triangle: &&Triangle| mesh.material_of(triangle).emissive;
    if let Some(lamp) = Extent::around(mesh.triangles.iter().filter(emissive)) {
        // A little away from its own surface.
        let toward = (focus.center() - lamp.center()).normalize_or(Vec3::NEG_Y);
        let position = lamp.center() + 0.02 * whole.radius() * toward;
        return Spot::aimed_at(position, focus.center(), focus.radius(), IRRADIANCE);
    }
    let direction = Vec3::new(1.0, 0.9, -0.5).normalize();
    let distance = (4.0 * focus.radius()).min(0.9 * free_length(tracer, focus, direction));
    let position = focus.center() + distance * direction;
    Spot::aimed_at(position, focus.center(), focus.radius(), IRRADIANCE)
}

/// How far it is from the middle of `extent` to what is beyond it in the unit `direction`.
fn free_length(tracer: &Tracer, extent: &Extent, direction: Vec3) -> f32 {
    let start = extent.radius() * 1.01;
    tracer
        .nearest(extent.center() + start * direction, direction)
        .map_or(f32::INFINITY, |hit| start + hit.distance)
}
