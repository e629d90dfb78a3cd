//! Lights that pixels draw in the examples: exact in the mean, by a light tree and by resampling.
//!
//! Fixed seeds; an error of four standard errors has a chance of 6·10⁻⁵ per comparison.

use common::frame::{Frame, GlossyLight, Lights};
use common::reflect::receivers_of;
use common::sampling::{LightTrees, Profiled, shade_by_tree, shade_resampled};
use common::scene::{LitPoints, Scene, SurfaceBuffer, Tracer, Wanted, trace_photons};
use stochastic_light_culling::{
    Camera, Ggx, GgxLobe, Incidence, Interleave, LambertLobe, Receiver, Roulette, Schlick, Seed,
    glam::{DVec3, Vec3},
};

const SIZE: [u32; 2] = [40, 24];
const SEEDS: u32 = 200;

struct Stage {
    surfaces: SurfaceBuffer,
    camera: Camera,
    points: LitPoints,
}

impl Stage {
    fn new(scene: &str) -> Self {
        let scene = Scene::load(scene, &Wanted::default()).expect("a built-in scene");
        let camera = scene.viewpoint.camera(SIZE).expect("a size");
        let tracer = Tracer::new(&scene.mesh);
        let photons = trace_photons(&tracer, &scene.lamps, 3000, 1);
        let (ggx, fresnel) = (Ggx::new(0.2).unwrap(), Schlick::new(0.9).unwrap());
        Self {
            surfaces: SurfaceBuffer::new(&tracer, &camera, SIZE),
            points: LitPoints::new(&photons, &scene.mesh.materials, ggx, fresnel).unwrap(),
            camera,
        }
    }

    fn lights(&self, interleave: &Interleave) -> Vec<GlossyLight> {
        let roulette = Roulette::new(0.001).unwrap();
        let lights = Lights::new(&self.points, interleave, &roulette, 1).unwrap();
        lights.glossy
    }

    fn frame(&self, interleave: Interleave) -> Frame<'_> {
        Frame {
            surfaces: &self.surfaces,
            interleave,
            roulette: Roulette::new(0.001).unwrap(),
            least_distance_squared: 4.0 * self.points.footprint,
        }
    }
}

/// What each pixel reflects of all lights of its subregion, light by light.
fn all_lights<R: Profiled>(
    frame: &Frame,
    lights: &[GlossyLight],
    receivers: &[Option<Receiver<R>>],
) -> Vec<DVec3> {
    let at_pixel = |(i, receiver): (usize, &Option<Receiver<R>>)| {
        let Some(receiver) = receiver else {
            return DVec3::ZERO;
        };
        let pixel = [i as u32 % SIZE[0], i as u32 / SIZE[0]];
        let (subregion, _) = frame.interleave.split_pixel(pixel);
        let count = frame.interleave.lights_in(subregion, lights.len() as u32);
        let of_light = |local| {
            let light = &lights[frame.interleave.join_light(subregion, local) as usize];
            let (direction, squared) = light.vpl.direction_to(receiver.position);
            let radiance =
                light.vpl.radiant_intensity(direction) / squared.max(frame.least_distance_squared);
            (radiance * receiver.lobe.value(-direction) * light.tint).as_dvec3()
        };
        (0..count).map(of_light).sum()
    };
    receivers.iter().enumerate().map(at_pixel).collect()
}

/// A name, and what lights a picture.
type Way<'a> = (String, Box<dyn Fn(Seed) -> Vec<Vec3> + 'a>);

fn check<R: Profiled>(
    name: &str,
    frame: &Frame,
    lights: &[GlossyLight],
    receivers: &[Option<Receiver<R>>],
) {
    let exact = all_lights(frame, lights, receivers);
    let brightness = |image: &[DVec3]| image.iter().map(|pixel| pixel.element_sum()).sum::<f64>();
    let total = brightness(&exact);
    assert!(total > 0.0, "{name}");
    let trees = LightTrees::new(frame, lights);
    let mean = (total / (3.0 * exact.len() as f64)) as f32;

    // For a tiny δ nothing is left to chance.
    let all = shade_by_tree(frame, lights, &trees, receivers, 1e-30, Seed(1));
    for (pixel, exact) in all.iter().zip(&exact) {
        let error = (pixel.as_dvec3() - *exact).abs().max_element();
        // At the horizon a light may be just above it, or just below.
        let most = 1e-4 * exact.max_element() + 1e-9 * f64::from(mean);
        assert!(error <= most, "{name}: {pixel} {exact}");
    }

    let trees = &trees;
    let by_tree = |share: f32| -> Way {
        let delta = share * mean;
        let shade = move |seed| shade_by_tree(frame, lights, trees, receivers, delta, seed);
        (format!("{name}, tree, δ = {share}"), Box::new(shade))
    };
    let resampled = |samples: usize| -> Way {
        let shade = move |seed| shade_resampled(frame, lights, receivers, samples, seed);
        (format!("{name}, {samples} resampled"), Box::new(shade))
    };
    for (name, shade) in [by_tree(0.1), by_tree(0.01), resampled(1), resampled(3)] {
        let relative = |seed: u32| {
            let image = shade(Seed(seed));
            let image: Vec<DVec3> = image.iter().map(|pixel| pixel.as_dvec3()).collect();
            brightness(&image) / total - 1.0
        };
        let errors: Vec<f64> = (0..SEEDS).map(relative).collect();
        let count = f64::from(SEEDS);
        let mean = errors.iter().sum::<f64>() / count;
        let variance = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let standard_error = (variance / count).sqrt();
        assert!(
            mean.abs() <= 4.0 * standard_error + 1e-5,
            "{name}: {mean} ± {standard_error}"
        );
        // Else it would say nothing.
        assert!(standard_error < 0.03, "{name}: {standard_error}");
    }
}

#[test]
fn draws_are_exact_in_the_mean() {
    for scene in ["ring", "cornell"] {
        let stage = Stage::new(scene);
        for width in [1, 2] {
            let interleave = Interleave::new(SIZE, width).unwrap();
            let (frame, lights) = (stage.frame(interleave), stage.lights(&interleave));
            let name = |lobe: &str| format!("{scene}, {width}×{width}, {lobe}");
            let (surfaces, camera) = (&stage.surfaces, &stage.camera);
            let lambert =
                |_, incidence: Incidence| LambertLobe::new(0.8, incidence.normal).unwrap();
            let receivers = receivers_of(surfaces, camera, lambert);
            check(&name("Lambert"), &frame, &lights, &receivers);
            let (ggx, fresnel) = (Ggx::new(0.3).unwrap(), Schlick::new(0.04).unwrap());
            let glossy = |_, incidence| GgxLobe::new(ggx, fresnel, incidence);
            let receivers = receivers_of(surfaces, camera, glossy);
            check(&name("GGX"), &frame, &lights, &receivers);
        }
    }
}
