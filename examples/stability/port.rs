//! A light of the adversary's, as the direct port takes it.

use stochastic_light_culling::glam::Vec3;
use support::adversary::{Light, Tile};
use support::direct_port::{self, Stretched};
use support::reference::{Brdf, Fresnel};

/// `None` for a conductor, whose Fresnel factor the papers do not print, and for lobes other than GGX.
pub fn light(light: &Light) -> Option<direct_port::Light> {
    let Brdf::Ggx {
        roughness, fresnel, ..
    } = light.brdf
    else {
        return None;
    };
    let fresnel = match fresnel {
        Fresnel::None => direct_port::Fresnel::None,
        Fresnel::Schlick(f0) => direct_port::Fresnel::Schlick(f0),
        Fresnel::Dielectric(eta) => direct_port::Fresnel::Dielectric(eta),
        Fresnel::Conductor(..) => return None,
    };
    Some(direct_port::Light {
        position: light.position,
        normal: *light.normal,
        incoming: *light.incoming,
        alpha: roughness,
        fresnel,
        flux: light.flux,
        delta: light.delta,
        xi: light.xi,
    })
}

pub fn touches(light: &direct_port::Light, tile: &Tile) -> bool {
    let view = tile.camera.rotation();
    let offset = tile.camera.to_camera_space(Vec3::ZERO);
    let stretched = Stretched::new(&light.ellipsoid(), view, offset);
    let (rectangle, depths) = (tile.rectangle, tile.depths);
    stretched.touches(
        [rectangle.min(), rectangle.max()],
        [depths.near(), depths.far()],
    )
}
