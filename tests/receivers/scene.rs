//! Random surfaces and lights.

use fastrand::Rng;
use stochastic_light_culling::{
    Direction, Incidence, Lobe, Seed, ShadingBatch, TileGrid, Vpl, Xi, glam::Vec3,
};

/// The surface points of an image, row by row. Some pixels see nothing.
pub struct Surfaces {
    pub grid: TileGrid,
    pub pixels: Vec<Option<Pixel>>,
}

/// A surface point, and the direction to the eye.
#[derive(Clone, Copy)]
pub struct Pixel {
    pub position: Vec3,
    pub incidence: Incidence,
    /// Near or far surfaces of a tile.
    pub interval: u32,
}

pub const EYE: Vec3 = Vec3::new(0.0, 0.0, 12.0);

pub fn direction(rng: &mut Rng) -> Direction {
    loop {
        let v = Vec3::from_array([(); 3].map(|()| 2.0 * rng.f32() - 1.0));
        if (0.01..1.0).contains(&v.length_squared()) {
            return Direction::new(v).expect("not zero");
        }
    }
}

impl Surfaces {
    /// An image of any size.
    pub fn new(rng: &mut Rng, tile_size: u32) -> Self {
        let size = [1 + rng.u32(..40), 1 + rng.u32(..24)];
        Self::of_size(rng, size, tile_size)
    }

    /// A floor with waves, and in front of it some balls.
    pub fn of_size(rng: &mut Rng, size: [u32; 2], tile_size: u32) -> Self {
        let grid = TileGrid::new(size, tile_size).expect("positive");
        let wave = 0.5 * rng.f32();
        let holes = if rng.bool() { 0.1 } else { 0.0 };
        let pixels = (0..size[0] * size[1]).map(|pixel| {
            let [x, y] = [pixel % size[0], pixel / size[0]].map(|n| n as f32 * 0.25 - 3.0);
            if rng.f32() < holes {
                return None;
            }
            let is_near = (2.0 * x).sin() * (1.5 * y).cos() > 0.6;
            let (height, slope) = if is_near {
                (3.0, Vec3::new(x, y, 2.0))
            } else {
                let slope = Vec3::new(-wave * x.cos(), -wave * y.cos(), 1.0);
                (wave * (x.sin() + y.sin()), slope)
            };
            let position = Vec3::new(x, y, height);
            let incidence = Incidence {
                normal: Direction::new(slope).expect("not zero"),
                incoming: Direction::new(EYE - position).expect("apart"),
            };
            Some(Pixel {
                position,
                incidence,
                interval: u32::from(!is_near),
            })
        });
        Self {
            grid,
            pixels: pixels.collect(),
        }
    }
}

/// Lights near the surfaces with these lobes, and their batch.
pub fn lights<L: Lobe + Clone>(
    rng: &mut Rng,
    count: usize,
    lobe: fn(&mut Rng) -> L,
) -> (Vec<(Vpl<L>, Xi)>, ShadingBatch<L>) {
    let seed = Seed(rng.u32(..)).frame(0);
    let lights = (0..count).map(|index| {
        let position = Vec3::new(rng.f32() * 10.0, rng.f32() * 6.0, rng.f32() * 6.0) - 3.0;
        let light = Vpl::new(position, rng.f32(), lobe(rng)).expect("in range");
        (light, seed.xi(index as u32))
    });
    let lights: Vec<_> = lights.collect();
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));
    (lights, batch)
}
