//! The pictures of a stage by the GPU.

use common::frame::Light;
use gpu::{Caller, Compiled, Error, Frame, Gpu, Method, Time};
use stochastic_light_culling::{GpuFrame, GpuLight, Lobe, Seed, Vpl, glam::Vec3, wgsl};
use wgpu::Buffer;

use super::comparison::Picture;
use super::stage::Stage;

/// Of glossy lights: bound, and lobe.
const GLOSSY: [&str; 2] = [
    "@group(0) @binding(16) var<storage, read> slc_table: array<vec4f>;
    fn slc_unit_bound(light: SlcLight) -> SlcBound { return slc_tight_ggx(light, slc_max_schlick(light)); }",
    "fn lobe(light: SlcLight, direction: vec3f) -> f32 { return slc_ggx_schlick(light, direction); }",
];

/// The same of diffuse ones.
const DIFFUSE: [&str; 2] = [
    "fn slc_unit_bound(light: SlcLight) -> SlcBound { return slc_paper_lambert(light.fresnel.x, light.normal); }",
    "fn lobe(light: SlcLight, direction: vec3f) -> f32 {
        return slc_lambert(light.fresnel.x, light.normal, direction);
    }",
];

/// The irradiance of a pixel in three channels, and the number of lights that it accepts.
const SHADING: &str = "
struct SlcSurface { position: vec3f, depth: f32, normal: vec3f, unused: f32 }
@group(0) @binding(16) var<storage, read> surfaces: array<SlcSurface>;
@group(0) @binding(17) var<storage, read> tints: array<vec4f>;
@group(0) @binding(18) var<storage, read_write> picture: array<vec4f>;

fn place(pixel: vec2u) -> u32 { return pixel.y * slc_this.image_size.x + pixel.x; }
fn slc_surface(pixel: vec2u) -> SlcSurface { return surfaces[place(pixel)]; }
fn slc_depth(surface: SlcSurface) -> f32 { return surface.depth; }
fn slc_store(pixel: vec2u, surface: SlcSurface, sum: vec4f) { picture[place(pixel)] = sum; }

fn slc_reflected(surface: SlcSurface, light: SlcLight, index: u32, xi: f32) -> vec4f {
    let way = slc_way(slc_this, light, surface.position);
    let intensity = light.flux * lobe(light, way.direction);
    let radiance = slc_estimate(intensity, way.distance_squared, slc_this.delta, xi);
    let cosine = max(dot(surface.normal, -way.direction), 0.0);
    return vec4f(radiance * cosine * tints[index].rgb, select(0.0, 1.0, radiance > 0.0));
}";

/// What each pixel sees, for the GPU.
pub fn surfaces(stage: &Stage) -> Vec<[f32; 8]> {
    let surface = |surface: &common::scene::Surface| {
        let ([x, y, z], [a, b, c]) = (surface.position.to_array(), surface.normal.to_array());
        let depth = if surface.is_sky() { 0.0 } else { surface.depth };
        [x, y, z, depth, a, b, c, 0.0]
    };
    stage.surfaces.surfaces.iter().map(surface).collect()
}

/// One kind of lights, with its kernels' buffers.
pub struct Lighting<'a> {
    gpu: &'a Gpu,
    pub frame: Frame<'a>,
    pub record: GpuFrame,
    texts: [&'static str; 2],
    of_bounds: Vec<(u32, Buffer)>,
    of_shading: [(u32, Buffer); 3],
}

impl<'a> Lighting<'a> {
    /// The glossy lights of a stage.
    pub fn glossy(gpu: &'a Gpu, stage: &Stage) -> Result<Self, Error> {
        let table = gpu.upload(wgsl::TABLE)?;
        let seed = Seed(stage.request.seed);
        Self::new(
            gpu,
            stage,
            &stage.lights.glossy,
            GLOSSY,
            (vec![(16, table)], seed),
        )
    }

    /// The diffuse lights of a stage. Their ξ are not those of the glossy ones.
    pub fn diffuse(gpu: &'a Gpu, stage: &Stage) -> Result<Self, Error> {
        let seed = Seed(!stage.request.seed);
        Self::new(gpu, stage, &stage.lights.diffuse, DIFFUSE, (vec![], seed))
    }

    fn new<L: Lobe + Copy>(
        gpu: &'a Gpu,
        stage: &Stage,
        lights: &[Light<L>],
        texts: [&'static str; 2],
        (of_bounds, seed): (Vec<(u32, Buffer)>, Seed),
    ) -> Result<Self, Error>
    where
        GpuLight: for<'v> From<&'v Vpl<L>>,
    {
        let (camera, interleave) = (&stage.camera, &stage.interleave);
        let record = GpuFrame::new(camera, interleave, &stage.roulette, lights.len() as u32)?
            .seeded(seed, 0)
            .with_least_distance_squared(stage.least_distance_squared)?;
        // The kernels multiply the flux by this weight, which is a power of two.
        let weight = interleave.weight();
        let records: Vec<GpuLight> = lights
            .iter()
            .map(|light| GpuLight {
                flux: light.vpl.flux() / weight,
                ..(&light.vpl).into()
            })
            .collect();
        let tints: Vec<[f32; 4]> = lights
            .iter()
            .map(|light| light.tint.extend(0.0).into())
            .collect();
        let pixels = stage.surfaces.surfaces.len();
        Ok(Self {
            gpu,
            frame: Frame::new(gpu, record, &records, (camera, interleave))?,
            record,
            texts,
            of_bounds,
            of_shading: [
                (16, gpu.upload(&surfaces(stage))?),
                (17, gpu.upload(&tints)?),
                (18, gpu.zeroed::<[f32; 4]>(pixels)?),
            ],
        })
    }

    /// Calls `work` with compiled kernels.
    pub fn compiled<T>(
        &self,
        method: Method,
        work: impl FnOnce(&Compiled) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let of_bounds: Vec<_> = self
            .of_bounds
            .iter()
            .map(|(i, buffer)| (*i, buffer))
            .collect();
        let of_shading = self.of_shading.each_ref().map(|(i, buffer)| (*i, buffer));
        let [bound, lobe] = self.texts;
        let bounds = [bound, wgsl::TIGHT];
        let bounds = Caller {
            texts: if of_bounds.is_empty() {
                &bounds[..1]
            } else {
                &bounds
            },
            buffers: &of_bounds,
            of_surface: 0,
        };
        let shading = Caller {
            texts: &[SHADING, lobe],
            buffers: &of_shading,
            of_surface: 1,
        };
        work(&self.frame.compile(method, [bounds, shading])?)
    }

    /// The picture: irradiance, and the number of lights that each pixel accepts.
    pub fn picture(&self, compiled: &Compiled) -> Result<(Picture, Vec<Time>), Error> {
        let times = self.frame.run(compiled)?;
        let sums: Vec<[f32; 4]> = self.gpu.read(&self.of_shading[2].1)?;
        let pixels = sums
            .iter()
            .map(|[r, g, b, count]| (Vec3::new(*r, *g, *b), *count as u32));
        Ok((pixels.collect(), times))
    }

    /// Gives the lights the random numbers of another seed.
    #[allow(dead_code, reason = "for the tests")]
    pub fn reseed(&self, seed: Seed) -> Result<(), Error> {
        self.frame.set_record(&self.record.seeded(seed, 0))
    }
}
