//! The finished picture: what each pixel sees, by direct light, by the indirect light of the frame, and in what is
//! glossy by reflection.

mod gather;
mod material;
mod reflection;

use std::f32::consts::FRAC_1_PI;

use rayon::prelude::*;
use stochastic_light_culling::{Camera, Direction, Error, glam::Vec3};

use crate::frame::{Frame, Lights, cross_bilateral};
use crate::scene::{Gloss, Hit, Scene, Tracer};

use gather::{Gather, Gatherer};
use material::Reflector;

/// The rays through a pixel, in a grid of four by four places: one in each row and column.
const SUBPIXELS: [[u32; 2]; 4] = [[1, 0], [3, 1], [0, 2], [2, 3]];

/// What a finished picture is made of.
pub struct Finish<'a> {
    pub scene: &'a Scene,
    pub tracer: &'a Tracer<'a>,
    pub camera: &'a Camera,
    pub frame: &'a Frame<'a>,
    pub lights: &'a Lights,
    /// Of glossy materials without one of their own.
    pub gloss: Gloss,
    pub seed: u32,
}

/// What a pixel shows.
#[derive(Clone, Copy, Default)]
struct Pixel {
    /// By its own emission, direct light and diffuse indirect light.
    radiance: Vec3,
    /// By the light of the sky, over the albedo.
    sky: Vec3,
    albedo: Vec3,
    /// In reflection.
    reflected: Vec3,
    /// How much of the reflection may be blurred: it is as sharp as the surface is smooth.
    blur: f32,
}

impl Finish<'_> {
    /// The radiance that each pixel shows, where diffuse surfaces receive the indirect `irradiance`; calls `done`
    /// after each row.
    pub fn radiance(
        &self,
        irradiance: &[Vec3],
        done: impl Fn() + Sync,
    ) -> Result<Vec<Vec3>, Error> {
        let surfaces = self.frame.surfaces;
        let [width, height] = surfaces.image_size;
        let gatherer = Gatherer::new(self.frame, self.lights)?;
        let row = |y: u32| {
            let mut gathers = Vec::new();
            let pixel = |x: u32| self.pixel([x, y], irradiance, &mut gathers);
            let mut pixels: Vec<Pixel> = (0..width).map(pixel).collect();
            for (column, radiance) in gatherer.gather(&gathers, y) {
                pixels[column].reflected += radiance;
            }
            done();
            pixels
        };
        let pixels: Vec<Pixel> = (0..height).into_par_iter().flat_map_iter(row).collect();
        let reflected: Vec<Vec3> = pixels.iter().map(|pixel| pixel.reflected).collect();
        let sky: Vec<Vec3> = pixels.iter().map(|pixel| pixel.sky).collect();
        let [reflected, sky] = cross_bilateral(surfaces, [&reflected, &sky], || ());
        let shown = pixels.iter().zip(reflected.into_iter().zip(sky));
        let shown = shown.map(|(pixel, (reflected, sky))| {
            let reflected = pixel.reflected.lerp(reflected, pixel.blur);
            pixel.radiance + pixel.albedo * sky + reflected
        });
        Ok(shown.collect())
    }

    fn pixel(&self, pixel: [u32; 2], irradiance: &[Vec3], gathers: &mut Vec<Gather>) -> Pixel {
        let size = self.frame.surfaces.image_size.map(|side| 4 * side);
        let eye = self.camera.to_world_space(Vec3::ZERO);
        let to_world = self.camera.rotation().transpose();
        let mut sum = Pixel::default();
        let share = 1.0 / SUBPIXELS.len() as f32;
        for (i, [x, y]) in SUBPIXELS.into_iter().enumerate() {
            let at = [4 * pixel[0] + x, 4 * pixel[1] + y];
            let ray = to_world * self.camera.point_in_pixel(size, at, 1.0);
            let ray = ray.normalize_or(Vec3::NEG_Z);
            let Some(hit) = self.tracer.nearest(eye, ray) else {
                sum.radiance += share * backdrop(ray);
                continue;
            };
            let material = self.tracer.material(&hit);
            sum.radiance += share * material.emission;
            let (Ok(normal), Ok(to_eye)) = (Direction::new(hit.normal), Direction::new(-ray))
            else {
                continue;
            };
            let path = reflection::Path {
                pixel: self.frame.surfaces.index(pixel) as u32,
                column: pixel[0] as usize,
                sample: i as u32,
                share,
            };
            let reflector = Reflector::new(material, self.gloss, normal, to_eye);
            let indirect = irradiance[self.like(pixel, &hit)];
            let diffuse = reflector.albedo * FRAC_1_PI * indirect;
            sum.radiance += share * (diffuse + self.direct(&hit, &reflector));
            sum.albedo += share * reflector.albedo;
            if reflector.albedo.max_element() > 0.0 {
                sum.sky += share * FRAC_1_PI * self.sky(&path, &hit);
            }
            if let Some(lobe) = reflector.lobe {
                sum.reflected += self.reflection(&path, &hit, &reflector, gathers);
                let roughness = lobe.ggx().roughness();
                sum.blur += share * ((roughness - 0.03) / 0.07).clamp(0.0, 1.0);
            }
        }
        sum
    }

    /// The place of the pixel around `pixel` whose surface is most like that of `hit`: at an edge a pixel sees more than
    /// one.
    fn like(&self, [x, y]: [u32; 2], hit: &Hit) -> usize {
        let surfaces = self.frame.surfaces;
        let [width, height] = surfaces.image_size;
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let around =
            rows.flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| [x, y]));
        let unlike = |pixel: &[u32; 2]| {
            let surface = surfaces.at(*pixel);
            if surface.is_sky() {
                return f32::INFINITY;
            }
            let apart = surface.position.distance(hit.position) / hit.distance;
            apart + 0.1 * (1.0 - surface.normal.dot(hit.normal))
        };
        let nearest = around.min_by(|a, b| unlike(a).total_cmp(&unlike(b)));
        surfaces.index(nearest.unwrap_or([x, y]))
    }

    /// What `reflector` at `hit` reflects of the light that comes straight from the lamps.
    fn direct(&self, hit: &Hit, reflector: &Reflector) -> Vec3 {
        let lamps = self.scene.lamps.iter();
        let arriving = lamps.filter_map(|lamp| lamp.arriving(hit.position));
        let shining = arriving.filter(|light| {
            let faces = |normal: Vec3| normal.dot(light.to_light) > 0.0;
            faces(hit.normal)
                && faces(hit.plane_normal)
                && self.tracer.is_lit(hit, light.to_light, light.distance)
        });
        shining
            .map(|light| light.irradiance * reflector.value(light.to_light))
            .sum()
    }
}

/// What is seen beyond all surfaces: a dim sky, so that mirrors have something to show, and shadows are not black.
fn backdrop(direction: Vec3) -> Vec3 {
    let [below, level, above] = [
        Vec3::new(0.0020, 0.0020, 0.0021),
        Vec3::new(0.0040, 0.0043, 0.0047),
        Vec3::new(0.0016, 0.0020, 0.0028),
    ];
    let height = direction.y.clamp(-1.0, 1.0);
    let end = if height < 0.0 { below } else { above };
    level.lerp(end, height.abs().sqrt())
}
