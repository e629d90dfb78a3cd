//! What is lit: geometry and materials, the spot and the eye, and the steps from them to lit points.

mod cornell;
mod file;
mod framing;
mod gltf;
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

pub use lit_point::{LitPoint, LitPoints};
pub use photon::trace_photons;
pub use surface::{Surface, SurfaceBuffer};
pub use tracer::Tracer;

use mesh::Mesh;
use spot::Spot;
use viewpoint::Viewpoint;

/// A scene that can be lit and looked at.
pub struct Scene {
    pub mesh: Mesh,
    pub spot: Spot,
    pub viewpoint: Viewpoint,
}

impl Scene {
    /// The built-in scene called `name`, or the one in the file of that name, whose materials named
    /// in `glossy` reflect as GGX.
    pub fn load(name: &str, glossy: &[String]) -> Result<Self, String> {
        let built_in = match name {
            "ring" => ring::scene,
            "cornell" => cornell::scene,
            path => return framing::frame(file::load(path.as_ref(), glossy)?),
        };
        if let Some(material) = glossy.first() {
            return Err(format!(
                "scene {name} has no named materials, so none called {material}"
            ));
        }
        Ok(built_in())
    }
}
