//! What is lit, and its picture by the CPU.

use common::frame::{
    self, BoundKind, Frame, Light, Lights, Path, Shaded, Slicing, Tiles, Tiling, timed,
};
use common::scene::{self, Gloss, LitPoints, Scene, SurfaceBuffer, Tracer, Wanted};
use stochastic_light_culling::{
    Camera, Error, Ggx, Interleave, Lobe, Roulette, Schlick, glam::Vec3,
};

/// What is asked for; the options of the example `render` of the same names.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    pub alpha: f32,
    pub f0: f32,
    pub vpls: u32,
    pub delta: f32,
    pub size: [u32; 2],
    pub seed: u32,
    pub interleave: u32,
}

/// The ring, seen by a camera and lit by its own lights.
pub struct Stage {
    pub request: Request,
    pub camera: Camera,
    pub surfaces: SurfaceBuffer,
    pub interleave: Interleave,
    pub roulette: Roulette,
    pub lights: Lights,
    pub least_distance_squared: f32,
}

/// The irradiance of all pixels by glossy lights and by diffuse ones.
pub type Pictures = [Vec<Vec3>; 2];

impl Stage {
    pub fn new(request: Request) -> Result<Self, Error> {
        let gloss = Gloss::new(Ggx::new(request.alpha)?, Schlick::new(request.f0)?);
        let interleave = Interleave::new(request.size, request.interleave)?;
        let roulette = Roulette::new(request.delta)?;
        let scene = Scene::load("ring", &Wanted::default()).expect("it is built in");
        let camera = scene.viewpoint.camera(request.size)?;
        let tracer = Tracer::new(&scene.mesh);
        let photons = scene::trace_photons(&tracer, &scene.lamps, request.vpls, request.seed);
        let materials = &scene.mesh.materials;
        let points = LitPoints::new(&photons, materials, gloss.light_ggx, gloss.fresnel)?;
        Ok(Self {
            request,
            surfaces: SurfaceBuffer::new(&tracer, &camera, request.size),
            lights: Lights::new(&points, &interleave, &roulette, request.seed)?,
            least_distance_squared: 4.0 * points.footprint,
            camera,
            interleave,
            roulette,
        })
    }

    fn frame(&self) -> Frame<'_> {
        Frame {
            surfaces: &self.surfaces,
            interleave: self.interleave,
            roulette: self.roulette,
            least_distance_squared: self.least_distance_squared,
        }
    }

    /// Both pictures by the CPU, with what each pixel accepted, and the milliseconds of all.
    pub fn by_cpu(&self) -> Result<([Shaded; 2], f64), Error> {
        let (frame, camera) = (self.frame(), &self.camera);
        let (shaded, ms) = timed(|| {
            let slicing = Slicing::ModifiedHalfZ;
            let tiles = Tiles::new(&self.surfaces, camera, &self.interleave, 16, slicing)?;
            let tiling = [Tiling {
                tiles: &tiles,
                refined: false,
            }];
            let (glossy, diffuse) = (&self.lights.glossy, &self.lights.diffuse);
            let bound = BoundKind::Tight;
            let glossy = frame::measure_glossy(&frame, &tiling, camera, glossy, bound, || ())?;
            let diffuse = frame::measure_diffuse(&frame, &tiling, camera, diffuse, || ())?;
            let [mut glossy, mut diffuse] = [glossy, diffuse];
            Ok([glossy.remove(0).shaded, diffuse.remove(0).shaded])
        });
        Ok((shaded?, ms))
    }

    /// What the pictures are on average over seeds: each pixel by all lights of its subregion.
    #[allow(dead_code, reason = "for the tests")]
    pub fn expected(&self) -> Pictures {
        [
            self.all(&self.lights.glossy),
            self.all(&self.lights.diffuse),
        ]
    }

    fn all<L: Lobe>(&self, lights: &[Light<L>]) -> Vec<Vec3> {
        let [width, _] = self.request.size;
        let pixel = |i: usize| {
            let surface = &self.surfaces.surfaces[i];
            let (subregion, _) = self
                .interleave
                .split_pixel([i as u32 % width, i as u32 / width]);
            let every = self.interleave.subregions() as usize;
            let own = lights.iter().skip(subregion as usize).step_by(every);
            own.filter(|_| !surface.is_sky())
                .map(|light| {
                    let path = Path::new(light, surface, self.least_distance_squared);
                    path.irradiance() * light.tint
                })
                .sum()
        };
        (0..self.surfaces.surfaces.len()).map(pixel).collect()
    }
}
