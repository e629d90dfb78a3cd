//! Where a plane cuts what encloses a lobe.

use std::f32::consts::TAU;

use stochastic_light_culling::Ellipsoid;
use stochastic_light_culling::glam::{Vec2, Vec3};

/// A plane with the origin and two unit vectors, at right angles, in it.
#[derive(Clone, Copy)]
pub struct Plane {
    pub right: Vec3,
    pub up: Vec3,
}

const POINTS: u16 = 180;

/// A closed curve of unit vectors.
pub fn circle() -> impl Iterator<Item = Vec2> {
    (0..=POINTS).map(|i| Vec2::from_angle(TAU * f32::from(i) / f32::from(POINTS)))
}

impl Plane {
    /// The ellipse in which it cuts `ellipsoid`; nothing if it does not.
    pub fn cut(&self, ellipsoid: &Ellipsoid) -> Vec<Vec2> {
        // To the space in which the ellipsoid is the unit sphere, where the plane is spanned by a and b from d.
        let to_sphere = |v: Vec3| ellipsoid.rotation().transpose() * v / ellipsoid.semi_axes();
        let [a, b, d] = [self.right, self.up, -ellipsoid.center()].map(to_sphere);
        let along = a.normalize();
        let across = b.reject_from_normalized(along);
        let (across, height) = (across.normalize(), across.length());
        let middle = Vec2::new(-d.dot(along), -d.dot(across));
        let off = d + middle.x * along + middle.y * across;
        let radius_squared = 1.0 - off.length_squared();
        if radius_squared <= 0.0 {
            return Vec::new();
        }
        let radius = radius_squared.sqrt();
        circle()
            .map(|unit| {
                let point = middle + radius * unit;
                let y = point.y / height;
                Vec2::new((point.x - y * b.dot(along)) / a.length(), y)
            })
            .collect()
    }
}
