//! Where the eye is.

use stochastic_light_culling::{Camera, Error, glam::Vec3};

use super::Wanted;

/// An eye, and what it looks at.
#[derive(Clone, Copy, Debug)]
pub struct Viewpoint {
    pub eye: Vec3,
    pub target: Vec3,
    /// What is upright, unless it is along the view.
    pub up: Vec3,
    pub fov: Fov,
    /// The least depth that the depth buffer tells.
    pub near: f32,
}

/// A field of view in radians.
#[derive(Clone, Copy, Debug)]
pub enum Fov {
    /// Across the shorter side of the picture.
    Shorter(f32),
    Vertical(f32),
}

impl Viewpoint {
    /// An eye in the unit direction `to_eye` from a sphere that it sees whole, whatever the shape of the picture.
    pub fn around(target: Vec3, radius: f32, to_eye: Vec3, fov_radians: f32) -> Self {
        let distance = radius / (0.5 * fov_radians).sin();
        Self {
            eye: target + distance * to_eye,
            target,
            up: Vec3::Y,
            fov: Fov::Shorter(fov_radians),
            near: 0.01 * radius,
        }
    }

    /// With what is asked for in place of what it has.
    pub fn changed(self, wanted: &Wanted) -> Self {
        let turned = wanted.eye.is_some() || wanted.target.is_some();
        Self {
            eye: wanted.eye.unwrap_or(self.eye),
            target: wanted.target.unwrap_or(self.target),
            up: if turned { Vec3::Y } else { self.up },
            fov: wanted.fov_radians.map_or(self.fov, Fov::Shorter),
            near: self.near,
        }
    }

    /// The camera of this eye for a picture of `image_size`.
    pub fn camera(&self, image_size: [u32; 2]) -> Result<Camera, Error> {
        let aspect = image_size[0] as f32 / image_size[1] as f32;
        let vertical = match self.fov {
            Fov::Vertical(fov) => fov,
            Fov::Shorter(fov) => {
                let slope = (0.5 * fov).tan();
                2.0 * (slope / aspect.min(1.0)).atan()
            }
        };
        let depths = self.near..f32::INFINITY;
        // A direction that is upright for any view: that of the most upright one that is not along it.
        let along = (self.target - self.eye).normalize_or_zero();
        let is_along = along.cross(self.up).length_squared() < 1e-6;
        let up = if is_along { Vec3::NEG_Z } else { self.up };
        Camera::look_at(self.eye, self.target, up, vertical, aspect, depths)
    }
}
