//! How a lamp is parted into rays: squares of directions, and of parallel rays.

use stochastic_light_culling::glam::Vec3;

use super::mesh::Extent;
use super::{Lamp, Spot};

/// A square \[−1, 1\]² of rays from a lamp.
pub struct Beam {
    lamp: Lamp,
    rays: Rays,
}

enum Rays {
    /// From a point through a square window.
    Diverging(Spot),
    /// From a square of this half width around `middle`.
    Parallel { middle: Vec3, half_width: f32 },
}

/// One ray, and what it stands for.
pub struct Ray {
    pub origin: Vec3,
    /// Not of unit length.
    pub direction: Vec3,
    pub flux: Vec3,
    /// In sr, of a diverging ray.
    pub solid_angle: f32,
    /// Across a parallel ray.
    pub area: f32,
}

impl Beam {
    /// The beams that hold all rays from `lamp` to what is in `extent`.
    pub fn of(lamp: &Lamp, extent: &Extent) -> Vec<Self> {
        let beam = |rays| Self { lamp: *lamp, rays };
        let window = |position, intensity, axis, half_width| {
            beam(Rays::Diverging(Spot {
                position,
                axis,
                half_width,
                intensity,
            }))
        };
        match *lamp {
            Lamp::Window(spot) => vec![beam(Rays::Diverging(spot))],
            Lamp::Point {
                position,
                intensity,
            } => AXES
                .map(|axis| window(position, intensity, axis, 1.0))
                .into(),
            Lamp::Cone {
                position,
                axis,
                cosines,
                intensity,
            } => {
                let angle = cosines.outer.acos();
                // A window wider than 140° would be mostly stretched edges.
                if angle < 1.22 {
                    return vec![window(position, intensity, axis, angle.tan())];
                }
                // To the corner of a cube's face it is 54.7°.
                let meets = |face: &Vec3| face.dot(axis).clamp(-1.0, 1.0).acos() < angle + 0.956;
                let faces = AXES.into_iter().filter(meets);
                faces
                    .map(|face| window(position, intensity, face, 1.0))
                    .collect()
            }
            Lamp::Parallel { to_light, .. } => {
                let half_width = extent.radius();
                vec![beam(Rays::Parallel {
                    middle: extent.center() + 1.01 * half_width * to_light,
                    half_width,
                })]
            }
        }
    }

    /// The ray through (`x`, `y`) for a part of the square of this `area`.
    pub fn ray(&self, x: f32, y: f32, area: f32) -> Ray {
        match &self.rays {
            Rays::Diverging(spot) => {
                let (direction, density) = spot.ray(x, y);
                let solid_angle = density * area;
                let flux = spot.intensity * solid_angle;
                Ray {
                    origin: spot.position,
                    direction,
                    flux: flux * self.lamp.share(direction.normalize()),
                    solid_angle,
                    area: 0.0,
                }
            }
            Rays::Parallel { middle, half_width } => {
                let (to_light, irradiance) = match self.lamp {
                    Lamp::Parallel {
                        to_light,
                        irradiance,
                    } => (to_light, irradiance),
                    _ => (Vec3::Y, Vec3::ZERO),
                };
                let (right, up) = to_light.any_orthonormal_pair();
                let area = area * half_width * half_width;
                Ray {
                    origin: middle + *half_width * (x * right + y * up),
                    direction: -to_light,
                    flux: irradiance * area,
                    solid_angle: 0.0,
                    area,
                }
            }
        }
    }

    /// The flux through the square, of the brightest channel.
    pub fn power(&self) -> f32 {
        const CELLS: u16 = 16;
        let width = 2.0 / f32::from(CELLS);
        let at = |cell: u16| (f32::from(cell) + 0.5) * width - 1.0;
        let flux = |x: u16, y: u16| (self.ray(at(x), at(y), width * width).flux).max_element();
        (0..CELLS)
            .flat_map(|y| (0..CELLS).map(move |x| flux(x, y)))
            .sum()
    }
}

const AXES: [Vec3; 6] = [
    Vec3::X,
    Vec3::NEG_X,
    Vec3::Y,
    Vec3::NEG_Y,
    Vec3::Z,
    Vec3::NEG_Z,
];
