//! The G-buffer: what each pixel sees.

use std::f32::consts::FRAC_1_PI;

use rayon::prelude::*;
use stochastic_light_culling::{Camera, PixelRectangle, glam::Vec3};

use super::Tracer;

/// What one pixel sees.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub position: Vec3,
    pub normal: Vec3,
    /// Infinite for sky.
    pub depth: f32,
    pub albedo: Vec3,
    /// The place of its material in [`Mesh::materials`](super::Mesh::materials). Any, for sky.
    pub material: usize,
}

impl Surface {
    const SKY: Self = Self {
        position: Vec3::ZERO,
        normal: Vec3::ZERO,
        depth: f32::INFINITY,
        albedo: Vec3::ZERO,
        material: 0,
    };

    pub fn is_sky(&self) -> bool {
        self.depth.is_infinite()
    }

    /// The radiance of a Lambertian surface under `irradiance`.
    pub fn reflected(&self, irradiance: Vec3) -> Vec3 {
        irradiance * self.albedo * FRAC_1_PI
    }
}

/// What all pixels of an image see, row by row.
pub struct SurfaceBuffer {
    pub image_size: [u32; 2],
    pub surfaces: Vec<Surface>,
}

impl SurfaceBuffer {
    /// What `camera` sees, one ray through the middle of each pixel.
    pub fn new(tracer: &Tracer, camera: &Camera, image_size: [u32; 2]) -> Self {
        let all = PixelRectangle {
            min: [0; 2],
            max: image_size,
        };
        let pixels: Vec<[u32; 2]> = all.pixels().collect();
        let eye = camera.to_world_space(Vec3::ZERO);
        let to_world = camera.rotation().transpose();
        let see = |pixel: &[u32; 2]| {
            let ray = to_world * camera.point_in_pixel(image_size, *pixel, 1.0);
            tracer
                .nearest(eye, ray)
                .map_or(Surface::SKY, |hit| Surface {
                    position: hit.position,
                    normal: hit.normal,
                    depth: camera.to_camera_space(hit.position).z,
                    albedo: tracer.albedo(&hit),
                    material: hit.material,
                })
        };
        Self {
            image_size,
            surfaces: pixels.par_iter().map(see).collect(),
        }
    }

    /// The place of `pixel` in [`surfaces`](Self::surfaces).
    pub fn index(&self, [x, y]: [u32; 2]) -> usize {
        y as usize * self.image_size[0] as usize + x as usize
    }

    pub fn at(&self, pixel: [u32; 2]) -> &Surface {
        &self.surfaces[self.index(pixel)]
    }
}
