//! A scene as the studies see it: what the eye sees, and lights made of it again and again.

use common::frame::{Frame, GlossyLight, Lights, Reference, Slicing, Tiles};
use common::scene::{Lamp, LitPoints, Scene, Surface, SurfaceBuffer, Tracer, trace_photons};
use stochastic_light_culling::{Camera, Error, Ggx, Interleave, Roulette, Schlick, glam::Vec3};

use crate::baseline::fewer;
use crate::statistics::Mean;
use crate::study::DELTA;

/// How much work the studies make of it.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    pub size: [u32; 2],
    pub vpls: u32,
    /// The size of pictures of receivers, and about how many lights they have.
    pub size_of_receivers: [u32; 2],
    pub lights_of_receivers: u32,
    /// How often a frame is repeated with other random numbers.
    pub seeds: u32,
    /// How often a time is taken.
    pub times: u32,
    /// How many sets of lights the truth is the mean of, and how many rays make each.
    pub truth: [u32; 2],
    pub is_quick: bool,
}

impl Effort {
    pub const FULL: Self = Self {
        size: [400, 224],
        vpls: 16384,
        size_of_receivers: [960, 540],
        lights_of_receivers: 16384,
        seeds: 64,
        times: 5,
        truth: [16, 65536],
        is_quick: false,
    };
    pub const QUICK: Self = Self {
        size: [128, 72],
        vpls: 2048,
        size_of_receivers: [128, 72],
        lights_of_receivers: 2048,
        seeds: 4,
        times: 1,
        truth: [4, 8192],
        is_quick: true,
    };
}

/// What glossy surfaces are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    pub ggx: Ggx,
    pub fresnel: Schlick,
}

impl Gloss {
    pub fn new(roughness: f32, f0: f32) -> Self {
        Self {
            ggx: Ggx::new(roughness).expect("the studies choose it in range"),
            fresnel: Schlick::new(f0).expect("the studies choose it in range"),
        }
    }
}

pub struct Subject<'a> {
    pub name: &'a str,
    pub effort: Effort,
    /// From this number on, seeds are of its own.
    pub seed: u32,
    pub camera: Camera,
    pub surfaces: SurfaceBuffer,
    scene: &'a Scene,
    tracer: Tracer<'a>,
    /// The same for any number of lights, so that all estimate the same.
    least_distance_squared: f32,
}

impl<'a> Subject<'a> {
    /// # Errors
    ///
    /// What the scene lacks for a study of glossy lights.
    pub fn new(name: &'a str, scene: &'a Scene, effort: Effort, seed: u32) -> Result<Self, String> {
        let said = |error: Error| error.to_string();
        let camera = scene.viewpoint.camera(effort.size).map_err(said)?;
        let tracer = Tracer::new(&scene.mesh);
        let surfaces = SurfaceBuffer::new(&tracer, &camera, effort.size);
        if surfaces.surfaces.iter().all(Surface::is_sky) {
            return Err(format!("scene {name} has no geometry in view"));
        }
        let subject = Self {
            name,
            effort,
            seed,
            camera,
            surfaces,
            scene,
            tracer,
            least_distance_squared: 0.0,
        };
        let points = subject.points(Gloss::new(0.1, 0.9), effort.vpls, seed);
        if points.glossy.is_empty() {
            return Err(format!("scene {name} has no glossy lights"));
        }
        Ok(Self {
            least_distance_squared: 4.0 * points.footprint,
            ..subject
        })
    }

    /// The same scene in a picture of half the width and height.
    pub fn half_as_large(&self) -> Self {
        self.with(Effort {
            size: self.effort.size.map(|n| n / 2),
            ..self.effort
        })
    }

    /// The same scene as the paper has it: of 65,536 lights at 1920×1080 a subregion of 8×8 has 1024, at 240×135 pixels.
    /// So has one of 4×4 here, of a quarter of both.
    pub fn as_in_paper(&self) -> Self {
        let effort = self.effort;
        let points = self.points(Gloss::new(0.1, 0.9), effort.vpls, self.seed_of(0));
        let rays_per_light = f64::from(effort.vpls) / points.glossy.len() as f64;
        self.with(Effort {
            size: effort.size_of_receivers,
            vpls: (rays_per_light * f64::from(effort.lights_of_receivers)) as u32,
            ..effort
        })
    }

    fn with(&self, effort: Effort) -> Self {
        Self::new(self.name, self.scene, effort, self.seed).expect("another size sees it, too")
    }

    /// The seed of a repetition, of which no two studies of one subject share any by chance.
    pub fn seed_of(&self, repetition: u32) -> u32 {
        self.seed.wrapping_mul(0x9e37_79b9).wrapping_add(repetition)
    }

    fn points(&self, gloss: Gloss, vpls: u32, seed: u32) -> LitPoints {
        self.points_moved(gloss, vpls, seed, 0.0)
    }

    /// What `vpls` rays light from lamps that are moved aside by `moved` times their distance from the view.
    pub fn points_moved(&self, gloss: Gloss, vpls: u32, seed: u32, moved: f32) -> LitPoints {
        let target = self.scene.viewpoint.target;
        let lamps: Vec<Lamp> = (self.scene.lamps.iter())
            .map(|lamp| lamp.moved_aside(target, moved))
            .collect();
        let photons = trace_photons(&self.tracer, &lamps, vpls, seed);
        LitPoints::new(
            &photons,
            &self.scene.mesh.materials,
            gloss.ggx,
            gloss.fresnel,
        )
        .expect("scenes are checked when they are loaded")
    }

    /// Lights from `vpls` rays for the subregions of `interleave`.
    pub fn lights(&self, gloss: Gloss, vpls: u32, interleave: &Interleave, seed: u32) -> Lights {
        let points = self.points(gloss, vpls, seed);
        Lights::new(&points, interleave, &roulette(DELTA), seed)
            .expect("scenes are checked when they are loaded")
    }

    pub fn interleave(&self, width: u32) -> Interleave {
        Interleave::new(self.effort.size, width).expect("the studies choose it in range")
    }

    pub fn frame(&self, interleave: Interleave, delta: f32) -> Frame<'_> {
        Frame {
            surfaces: &self.surfaces,
            interleave,
            roulette: roulette(delta),
            least_distance_squared: self.least_distance_squared,
        }
    }

    pub fn tiles(&self, interleave: &Interleave, size: u32, slicing: Slicing) -> Tiles {
        Tiles::new(&self.surfaces, &self.camera, interleave, size, slicing)
            .expect("the studies choose sizes in range")
    }

    /// What all frames with glossy lights of `gloss` estimate, from as many sets of lights as there is
    /// time for.
    pub fn truth(&self, gloss: Gloss) -> Truth {
        let whole = self.interleave(1);
        let frame = self.frame(whole, 1.0);
        let [sets, vpls] = self.effort.truth;
        let pixels = Reference::pixels(&frame, self.stride());
        let mut irradiance = vec![Vec3::ZERO; pixels.len()];
        let mut brightness = Vec::new();
        for set in 0..sets {
            let seed = self.seed_of(u32::MAX - set);
            let lights = Lights {
                diffuse: Vec::new(),
                ..self.lights(gloss, vpls, &whole, seed)
            };
            let one = Reference::new(&frame, &lights, self.stride(), || ());
            let one = one.expect("its roulette is in range").glossy;
            brightness.push(self.brightness(&pixels, &one));
            for (sum, one) in irradiance.iter_mut().zip(one) {
                *sum += one / sets as f32;
            }
        }
        Truth {
            pixels,
            irradiance,
            brightness: Mean::of(&brightness),
        }
    }

    /// The mean of a frame over roulette alone, shaded with all `lights`.
    pub fn truth_of(&self, frame: &Frame, lights: &[GlossyLight]) -> Truth {
        self.truth_in(frame, &fewer::light(frame, lights, 1, 0))
    }

    /// The truth that `all` pixels of a picture show.
    pub fn truth_in(&self, frame: &Frame, all: &[Vec3]) -> Truth {
        let pixels = Reference::pixels(frame, self.stride());
        let irradiance: Vec<Vec3> = pixels.iter().map(|pixel| all[*pixel]).collect();
        let brightness = self.brightness(&pixels, &irradiance);
        Truth {
            pixels,
            irradiance,
            brightness: Mean::of(&[brightness]),
        }
    }

    /// Between pixels that are compared, so that there are about six thousand; odd, so that all
    /// subregions of the usual widths are met alike.
    pub fn stride(&self) -> usize {
        let pixels = f64::from(self.effort.size[0] * self.effort.size[1]);
        (pixels / 6000.0).sqrt() as usize | 1
    }

    /// What the pixels show of their `irradiance`.
    pub fn radiance(&self, irradiance: &[Vec3]) -> Vec<Vec3> {
        let surfaces = self.surfaces.surfaces.iter().zip(irradiance);
        surfaces
            .map(|(surface, irradiance)| surface.reflected(*irradiance))
            .collect()
    }

    /// The mean over `pixels`, and over three channels, of the radiance that `irradiance` makes there.
    pub fn brightness(&self, pixels: &[usize], irradiance: &[Vec3]) -> f64 {
        let radiance = |(pixel, irradiance): (&usize, &Vec3)| {
            let surface = &self.surfaces.surfaces[*pixel];
            f64::from(surface.reflected(*irradiance).element_sum()) / 3.0
        };
        pixels.iter().zip(irradiance).map(radiance).sum::<f64>() / pixels.len().max(1) as f64
    }
}

fn roulette(delta: f32) -> Roulette {
    Roulette::new(delta).expect("the studies choose it in range")
}

/// The irradiance of glossy lights at some pixels.
pub struct Truth {
    pub pixels: Vec<usize>,
    pub irradiance: Vec<Vec3>,
    /// The mean over the pixels of the radiance that follows.
    pub brightness: Mean,
}
