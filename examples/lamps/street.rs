//! A street at night: what each pixel shows, and the lamps.

use stochastic_light_culling::{
    Camera, ConstantLobe, Direction, Error, Lobe, Seed, SpotLobe, Vpl, glam::Vec3, rank_along_curve,
};

/// What a pixel shows.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub depth: f32,
    pub position: Vec3,
    pub normal: Vec3,
    pub albedo: f32,
}

/// Lights, their colours of luminance 1, and their ranks along a curve, for ξ that are spread.
pub struct Lamps<L> {
    pub lights: Vec<Vpl<L>>,
    pub colours: Vec<Vec3>,
    pub ranks: Vec<u32>,
}

impl<L: Lobe> Lamps<L> {
    fn new() -> Self {
        Self {
            lights: Vec::new(),
            colours: Vec::new(),
            ranks: Vec::new(),
        }
    }

    fn ranked(mut self) -> Result<Self, Error> {
        let positions: Vec<Vec3> = self.lights.iter().map(Vpl::position).collect();
        let mut scratch = vec![0; 2 * positions.len()];
        self.ranks = vec![0; positions.len()];
        rank_along_curve(&positions, &mut self.ranks, &mut scratch)?;
        Ok(self)
    }
}

const HALF_WIDTH: f32 = 14.0;
const LENGTH: f32 = 70.0;
const HEIGHT: f32 = 9.0;
const PILLAR_RADIUS: f32 = 0.5;
const EYE: Vec3 = Vec3::new(0.0, 3.2, 12.0);

pub fn camera(size: [u32; 2]) -> Result<Camera, Error> {
    let aspect = size[0] as f32 / size[1] as f32;
    Camera::look_at(
        EYE,
        Vec3::new(0.0, 1.6, -20.0),
        Vec3::Y,
        0.9,
        aspect,
        0.1..200.0,
    )
}

/// The nearest surface in the direction of a pixel, `None` for the sky.
pub fn seen(camera: &Camera, size: [u32; 2], pixel: [u32; 2]) -> Option<Surface> {
    let ray = camera.to_world_space(camera.point_in_pixel(size, pixel, 1.0)) - EYE;
    // (distance in depths, normal, albedo) of all planes and pillars.
    let plane = |normal: Vec3, offset: f32| {
        let depth = (offset - normal.dot(EYE)) / normal.dot(ray);
        (depth, normal, 0.6)
    };
    let planes = [
        plane(Vec3::Y, 0.0),
        plane(Vec3::X, -HALF_WIDTH),
        plane(-Vec3::X, -HALF_WIDTH),
        plane(Vec3::Z, -LENGTH),
    ];
    let pillars = (0..16).filter_map(|i| {
        let axis = Vec3::new([-7.0, 7.0][i % 2], 0.0, -9.0 * (i / 2) as f32);
        let flat = |v: Vec3| Vec3::new(v.x, 0.0, v.z);
        let (start, way) = (flat(EYE - axis), flat(ray));
        let (a, b) = (way.length_squared(), way.dot(start));
        let root = b * b - a * (start.length_squared() - PILLAR_RADIUS * PILLAR_RADIUS);
        let depth = (root > 0.0).then(|| (-b - root.sqrt()) / a)?;
        let normal = (start + way * depth).normalize();
        (EYE.y + depth * ray.y < 6.0).then_some((depth, normal, 0.75))
    });
    let in_front = |(depth, normal, albedo): (f32, Vec3, f32)| {
        let position = EYE + ray * depth;
        let is_here = depth > 0.0 && position.y > -1e-3 && position.y < HEIGHT;
        let slab = (position.x.floor() + position.z.floor()).rem_euclid(2.0);
        let albedo = if normal == Vec3::Y {
            0.35 + 0.25 * slab
        } else {
            albedo
        };
        is_here.then_some(Surface {
            depth,
            position,
            normal,
            albedo,
        })
    };
    let all = planes.into_iter().chain(pillars).filter_map(in_front);
    all.min_by(|a, b| a.depth.total_cmp(&b.depth))
}

/// `count` lamps that emit the same in all, however many: half of them pendants, a quarter lanterns on the walls
/// that shine back along these, and a quarter small coloured bulbs near the ground.
pub fn lamps(count: u32, seed: u32) -> Result<(Lamps<SpotLobe>, Lamps<ConstantLobe>), Error> {
    let (mut spots, mut bulbs) = (Lamps::new(), Lamps::new());
    let share = 1000.0 / count.max(1) as f32;
    for i in 0..count {
        let random = |frame| Seed(seed).frame(frame).hashed_xi(i).get();
        let x = HALF_WIDTH * (1.9 * random(0) - 0.95);
        let z = -(LENGTH - 1.0) * random(1) + 6.0 * random(2);
        match i % 4 {
            0 | 1 => {
                let outer = (30.0 + 30.0 * random(3)).to_radians();
                let axis = Vec3::new(random(4) - 0.5, -2.0, random(5) - 0.5);
                let lobe = SpotLobe::new(0.5 * outer, outer, Direction::new(axis)?)?;
                let position = Vec3::new(x, 4.0 + 2.0 * random(6), z);
                spots.lights.push(Vpl::spot(position, 60.0 * share, lobe)?);
                spots.colours.push(colour(Vec3::new(1.0, 0.62, 0.3)));
            }
            2 => {
                // Beyond 90°, so that the wall behind is lit.
                let side = if random(3) < 0.5 { -1.0 } else { 1.0 };
                let axis = Vec3::new(-side, -0.6, 0.0);
                let angles = [60.0, 115.0].map(f32::to_radians);
                let lobe = SpotLobe::new(angles[0], angles[1], Direction::new(axis)?)?;
                let position = Vec3::new(side * (HALF_WIDTH - 0.4), 2.0 + 3.0 * random(4), z);
                spots.lights.push(Vpl::spot(position, 25.0 * share, lobe)?);
                spots.colours.push(colour(Vec3::new(0.55, 0.75, 1.0)));
            }
            _ => {
                let position = Vec3::new(x, 0.3 + 1.2 * random(3), z);
                bulbs.lights.push(Vpl::point(position, 12.0 * share)?);
                let hue = std::f32::consts::TAU * random(4);
                let shade = |shift: f32| 0.5 + 0.45 * (hue + shift).cos();
                bulbs
                    .colours
                    .push(colour(Vec3::new(shade(0.0), shade(2.1), shade(4.2))));
            }
        }
    }
    Ok((spots.ranked()?, bulbs.ranked()?))
}

/// `rgb` over its luminance.
fn colour(rgb: Vec3) -> Vec3 {
    rgb / luminance(rgb)
}

/// Of linear sRGB [IEC 61966-2-1].
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}
