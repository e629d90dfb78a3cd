//! The ring, ready to be lit: as the example `render` has it.

use common::frame::{Frame, Lights, Slicing, Tiles};
use common::scene::{LitPoints, Scene, SurfaceBuffer, Tracer, Wanted, trace_photons};
use stochastic_light_culling::{Camera, Error, Ggx, Interleave, Roulette, Schlick};

pub const VPLS: u32 = 16384;
pub const SEED: u32 = 1;

/// The built-in ring.
pub fn ring() -> Result<Scene, String> {
    Scene::load("ring", &Wanted::default())
}

pub struct Stage<'a> {
    pub tracer: Tracer<'a>,
    pub camera: Camera,
    pub surfaces: SurfaceBuffer,
    pub interleave: Interleave,
    pub roulette: Roulette,
    pub lights: Lights,
    least_distance_squared: f32,
}

impl<'a> Stage<'a> {
    pub fn new(
        scene: &'a Scene,
        size: [u32; 2],
        interleave: u32,
        delta: f32,
    ) -> Result<Self, Error> {
        let interleave = Interleave::new(size, interleave)?;
        let camera = scene.viewpoint.camera(size)?;
        let tracer = Tracer::new(&scene.mesh);
        let photons = trace_photons(&tracer, &scene.lamps, VPLS, SEED);
        let (ggx, fresnel) = (Ggx::new(0.1)?, Schlick::new(0.9)?);
        let points = LitPoints::new(&photons, &scene.mesh.materials, ggx, fresnel)?;
        let roulette = Roulette::new(delta)?;
        Ok(Self {
            surfaces: SurfaceBuffer::new(&tracer, &camera, size),
            tracer,
            camera,
            lights: Lights::new(&points, &interleave, &roulette, SEED)?,
            interleave,
            roulette,
            least_distance_squared: 4.0 * points.footprint,
        })
    }

    pub fn frame(&self) -> Frame<'_> {
        Frame {
            surfaces: &self.surfaces,
            interleave: self.interleave,
            roulette: self.roulette,
            least_distance_squared: self.least_distance_squared,
        }
    }

    pub fn tiles(&self, size: u32) -> Result<Tiles, Error> {
        let slicing = Slicing::ModifiedHalfZ;
        Tiles::new(
            &self.surfaces,
            &self.camera,
            &self.interleave,
            size,
            slicing,
        )
    }
}
