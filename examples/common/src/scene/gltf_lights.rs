//! The lights and the camera of a glTF file.

use gltf::camera::Projection;
use gltf::khr_lights_punctual::{Kind, Light};
use stochastic_light_culling::glam::{Mat4, Vec3};

use super::lamp::Cosines;
use super::{Fov, Lamp, Viewpoint};

/// The `light` [KHR_lights_punctual] of a node; none if it emits nothing. Its range is not looked at, for light does
/// not end.
pub fn lamp(light: &Light, to_world: Mat4) -> Result<Option<Lamp>, String> {
    let intensity = Vec3::from(light.color()) * light.intensity();
    let fault = |what: &str| Err(format!("has a light {} with {what}", light.index()));
    if !intensity.is_finite() || intensity.min_element() < 0.0 {
        return fault(&format!("an intensity of {intensity}"));
    }
    if intensity.max_element() == 0.0 {
        return Ok(None);
    }
    let Some((position, axis, _)) = placed(to_world) else {
        return fault("no place or no direction");
    };
    Ok(Some(match light.kind() {
        Kind::Directional => Lamp::Parallel {
            to_light: -axis,
            irradiance: intensity,
        },
        Kind::Point => Lamp::Point {
            position,
            intensity,
        },
        Kind::Spot {
            inner_cone_angle: inner,
            outer_cone_angle: outer,
        } => {
            let is_valid =
                0.0 <= inner && inner < outer && outer <= 1.000_001 * std::f32::consts::FRAC_PI_2;
            if !is_valid {
                return fault(&format!("a cone from {inner} to {outer} rad"));
            }
            Lamp::Cone {
                position,
                axis,
                cosines: Cosines {
                    inner: inner.cos(),
                    outer: outer.cos().max(0.0),
                },
                intensity,
            }
        }
    }))
}

/// The view of a node's `camera`; none if it is not a perspective.
pub fn viewpoint(camera: &gltf::Camera, to_world: Mat4) -> Result<Option<Viewpoint>, String> {
    let Projection::Perspective(perspective) = camera.projection() else {
        return Ok(None);
    };
    let (yfov, near) = (perspective.yfov(), perspective.znear());
    let is_valid = 0.0 < yfov && yfov < 3.1 && 0.0 < near && near.is_finite();
    let placed = placed(to_world).filter(|_| is_valid);
    let Some((eye, axis, up)) = placed else {
        let index = camera.index();
        return Err(format!(
            "has a camera {index} that cannot see: {yfov} rad from {near} on, at {}",
            to_world.w_axis.truncate()
        ));
    };
    Ok(Some(Viewpoint {
        eye,
        target: eye + axis,
        up,
        fov: Fov::Vertical(yfov),
        near,
    }))
}

/// Where a node is, where its −z points to and where its y does; none if that is no direction.
fn placed(to_world: Mat4) -> Option<(Vec3, Vec3, Vec3)> {
    // Beyond, products of four coordinates leave the range of f32.
    const FARTHEST: f32 = 1e9;
    let position = to_world.w_axis.truncate();
    let axis = -to_world.z_axis.truncate().try_normalize()?;
    let up = to_world.y_axis.truncate().try_normalize()?;
    (position.abs().max_element() <= FARTHEST).then_some((position, axis, up))
}
