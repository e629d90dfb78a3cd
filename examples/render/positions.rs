//! Whether the positions of surfaces are fine enough for their pixels.

use common::scene::{Scene, Surface, SurfaceBuffer};
use stochastic_light_culling::{Camera, TileGrid, TileRectangle};

use crate::arguments::Arguments;

/// Refuses a scene so far from the origin that rounding moves surfaces out of their pixels: the lights of
/// their tiles are not theirs.
pub fn check(
    arguments: &Arguments,
    scene: &Scene,
    camera: &Camera,
    surfaces: &SurfaceBuffer,
) -> Result<(), String> {
    if surfaces.surfaces.iter().all(Surface::is_sky) {
        return Err(format!(
            "scene {}: nothing of it is in view; --eye and --target say where to look",
            arguments.scene
        ));
    }
    let pixels = TileGrid::new(surfaces.image_size, 1).map_err(|error| error.to_string())?;
    let is_outside = |pixel: &[u32; 2]| {
        let surface = surfaces.at(*pixel);
        !surface.is_sky() && !holds(&camera.tile(&pixels, *pixel), surface, camera)
    };
    let outside = pixels.tiles().filter(is_outside).count();
    if outside == 0 {
        return Ok(());
    }
    let corners = scene.mesh.triangles.iter().flat_map(|t| t.corners);
    let farthest = corners.fold(0.0, |most: f32, corner| {
        most.max(corner.abs().max_element())
    });
    let step = f32::from_bits(farthest.to_bits() + 1) - farthest;
    Err(format!(
        "scene {}: f32 positions are too coarse: at {farthest} they are {step} apart, and {outside} \
         surfaces are outside their pixels; move the scene to the origin",
        arguments.scene
    ))
}

/// Whether `camera` sees `surface` inside `pixel`.
fn holds(pixel: &TileRectangle, surface: &Surface, camera: &Camera) -> bool {
    let seen = camera.to_camera_space(surface.position);
    let slopes = seen.truncate() / seen.z;
    // False for NaN.
    slopes.cmpge(pixel.min()).all() && slopes.cmple(pixel.max()).all()
}
