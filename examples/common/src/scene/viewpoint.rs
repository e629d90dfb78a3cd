//! Where the eye is.

use stochastic_light_culling::{Camera, Error, glam::Vec3};

/// An eye that sees a sphere whole, whatever the shape of the picture.
#[derive(Clone, Copy, Debug)]
pub struct Viewpoint {
    /// The sphere's centre and radius.
    pub target: Vec3,
    pub radius: f32,
    /// The unit direction from the sphere to the eye.
    pub to_eye: Vec3,
    /// The field of view across the shorter side of the picture.
    pub fov_radians: f32,
}

impl Viewpoint {
    /// The camera of this eye for a picture of `image_size`.
    pub fn camera(&self, image_size: [u32; 2]) -> Result<Camera, Error> {
        let aspect = image_size[0] as f32 / image_size[1] as f32;
        let slope = (0.5 * self.fov_radians).tan();
        let vertical = 2.0 * (slope / aspect.min(1.0)).atan();
        let distance = self.radius / (0.5 * self.fov_radians).sin();
        let eye = self.target + distance * self.to_eye;
        let depths = 0.01 * self.radius..f32::INFINITY;
        Camera::look_at(eye, self.target, Vec3::Y, vertical, aspect, depths)
    }
}
