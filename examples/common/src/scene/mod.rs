//! What is lit: geometry and materials, the lamps and the eye, and the steps from them to lit points.

mod beam;
mod cornell;
mod emitters;
mod file;
mod framing;
mod gltf;
mod gltf_lights;
mod indoors;
mod lamp;
mod lit_point;
mod mesh;
mod obj;
mod photon;
mod random;
mod ring;
mod smooth;
mod spot;
mod surface;
mod tracer;
mod viewpoint;

pub use lamp::{Arriving, Lamp};
pub use lit_point::{LitPoint, LitPoints};
pub use mesh::{Extent, Gloss, Material, Mesh};
pub use photon::{Texel, trace_photons};
pub use random::{Purpose, uniform};
pub use surface::{Surface, SurfaceBuffer};
pub use tracer::{Hit, Tracer};
pub use viewpoint::{Fov, Viewpoint};

use spot::Spot;
use stochastic_light_culling::{Ggx, Schlick, glam::Vec3};

/// A scene that can be lit and looked at.
pub struct Scene {
    pub mesh: Mesh,
    pub lamps: Vec<Lamp>,
    pub viewpoint: Viewpoint,
    /// What its file did not say, and what was taken instead.
    pub note: Option<String>,
}

/// A sphere that is worth lighting.
#[derive(Clone, Copy, Debug)]
struct Focus {
    center: Vec3,
    radius: f32,
    irradiance: Vec3,
}

impl Focus {
    /// A light at `position` that is aimed at the sphere.
    fn lamp_at(&self, position: Vec3) -> Lamp {
        let spot = Spot::aimed_at(position, self.center, self.radius, self.irradiance);
        Lamp::Window(spot)
    }

    /// The lights that are asked for, or one at `position`.
    fn lamps(&self, wanted: &Wanted, position: Vec3) -> Vec<Lamp> {
        if wanted.lights.is_empty() {
            return vec![self.lamp_at(position)];
        }
        let share = 1.0 / wanted.lights.len() as f32;
        let lamps = wanted.lights.iter().map(|light| self.lamp_at(*light));
        lamps.map(|lamp| lamp.brighter(share)).collect()
    }
}

/// What is asked for of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted<'a> {
    /// The names of the materials of a file that reflect as GGX, if not those that the file says.
    pub glossy: &'a [String],
    /// In place of what the scene has.
    pub eye: Option<Vec3>,
    pub target: Option<Vec3>,
    /// Across the shorter side of the picture.
    pub fov_radians: Option<f32>,
    pub lights: &'a [Vec3],
}

impl Scene {
    /// The built-in scene called `name`, or the one in the file of that name.
    pub fn load(name: &str, wanted: &Wanted) -> Result<Self, String> {
        let built_in: fn(&Wanted) -> Self = match name {
            "ring" => ring::scene,
            "cornell" => cornell::scene,
            path => return framing::frame(path, file::load(path.as_ref(), wanted.glossy)?, wanted),
        };
        if let Some(material) = wanted.glossy.first() {
            return Err(format!(
                "scene {name} has no named materials, so none called {material}"
            ));
        }
        Ok(built_in(wanted))
    }

    /// Whether materials have a roughness and a reflectance of their own.
    pub fn has_own_gloss(&self) -> bool {
        self.mesh.materials.iter().any(|m| m.gloss.is_some())
    }

    /// Gives materials with a roughness and a reflectance of their own these in their place.
    pub fn with_gloss(mut self, ggx: Option<Ggx>, fresnel: Option<Schlick>) -> Self {
        for gloss in self
            .mesh
            .materials
            .iter_mut()
            .filter_map(|m| m.gloss.as_mut())
        {
            gloss.fresnel = fresnel.unwrap_or(gloss.fresnel);
            if let Some(ggx) = ggx {
                *gloss = Gloss::new(ggx, gloss.fresnel);
            }
        }
        self
    }
}
