//! Two culling workloads, fixed so that results can be compared: one frame of 64 subregions of 15×9
//! tiles with 1024 lights each. In the first the depths that tiles see are scattered, in the second
//! coherent.

use std::f64::consts::PI;

use stochastic_light_culling::{
    Camera, DepthInterval, Ellipsoid, ProjectedEllipsoid, TileDepths, TileRectangle,
    glam::{Mat3, Vec2, Vec3},
};

pub const SUBREGIONS: usize = 64;
pub const LIGHTS: usize = 1024;
pub const TILES: [u32; 2] = [15, 9];

/// A subregion with what lights it.
pub struct Subregion {
    pub lights: Vec<Light>,
    /// Row by row.
    pub tiles: Vec<Tile>,
}

/// A spheroid in camera space.
#[derive(Clone, Copy)]
pub struct Light {
    pub center: [f64; 3],
    pub axis: [f64; 3],
    pub long: f64,
    pub short: f64,
}

#[derive(Clone, Copy)]
pub struct Tile {
    pub across: [f64; 2],
    pub down: [f64; 2],
    pub scattered: [f64; 2],
    pub coherent: [f64; 2],
}

/// Which of a tile's depths.
pub type Depths = fn(&Tile) -> [f64; 2];

/// The frame, which is the same each time.
pub fn frame() -> Vec<Subregion> {
    let mut random = SplitMix64(12345);
    let mut lights: Vec<Vec<Light>> = (0..SUBREGIONS)
        .map(|_| (0..LIGHTS).map(|_| light(&mut random)).collect())
        .collect();
    let tiles = |random: &mut SplitMix64, subregion| {
        let [width, height] = TILES;
        (0..height)
            .flat_map(|y| (0..width).map(move |x| [x, y]))
            .map(|position| tile(random, subregion, position))
            .collect()
    };
    (0..SUBREGIONS as u32)
        .map(|subregion| Subregion {
            lights: std::mem::take(&mut lights[subregion as usize]),
            tiles: tiles(&mut random, subregion),
        })
        .collect()
}

/// Half the width of the view at depth 1, and half its height.
fn slopes() -> [f64; 2] {
    let y = (PI / 6.0).tan();
    [y * 16.0 / 9.0, y]
}

fn light(random: &mut SplitMix64) -> Light {
    let z = (1.0 + random.unit() * (50f64.powi(3) - 1.0)).cbrt();
    let [x, y] = slopes().map(|slope| (2.0 * random.unit() - 1.0) * slope * z);
    let short = 0.05 * 20f64.powf(random.unit());
    let alpha = [0.05, 0.1, 0.2, 0.4][(random.bits() >> 62) as usize];
    let h = 2.0 * random.unit() - 1.0;
    let (sin, cos) = (2.0 * PI * random.unit()).sin_cos();
    let flat = (1.0 - h * h).sqrt();
    Light {
        center: [x, y, z],
        axis: [flat * cos, flat * sin, h],
        long: short * (1.0 + alpha * alpha) / (2.0 * alpha),
        short,
    }
}

fn tile(random: &mut SplitMix64, subregion: u32, [x, y]: [u32; 2]) -> Tile {
    let edges = |tile: u32, first: u32, pixels: u32, half: f64, slope: f64| {
        let last = 8 * ((16 * tile + 16).min(pixels) - 1) + first + 1;
        [128 * tile + first, last].map(|edge| (f64::from(edge) / half - 1.0) * slope)
    };
    let [slope_x, slope_y] = slopes();
    let mut scattered = [0, 1].map(|_| 1.0 + 49.0 * random.unit());
    scattered.sort_by(f64::total_cmp);
    let (tx, ty) = (f64::from(x), f64::from(y));
    let waves = 0.3 * (0.45 * tx + 0.3).sin() * (0.6 * ty).cos();
    let f = 0.5 + waves + 0.15 * (0.9 * tx - 0.7 * ty).sin();
    let near = 1.5 * 20f64.powf(f) * (1.0 + 0.05 * (random.unit() - 0.5));
    let far = (near * 2f64.powf(0.07 + 0.93 * random.unit())).min(50.0);
    Tile {
        across: edges(x, subregion % 8, 240, 960.0, slope_x),
        down: edges(y, subregion / 8, 135, 540.0, slope_y),
        scattered,
        coherent: [near, far],
    }
}

/// At the origin; the workloads are given in its space.
pub fn camera() -> Camera {
    let (fov, aspect) = ((PI / 3.0) as f32, 16.0 / 9.0);
    Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, fov, aspect, 0.1..100.0).expect("in range")
}

impl Subregion {
    /// The tiles, each with its depths cut in two.
    pub fn tile_depths(&self, depths: Depths) -> TileDepths {
        let tile = |[x, y]: [u32; 2]| &self.tiles[(y * TILES[0] + x) as usize];
        let mut tiles =
            TileDepths::from_rectangles(TILES, 2, |at| tile(at).rectangle()).expect("not empty");
        for y in 0..TILES[1] {
            for x in 0..TILES[0] {
                tiles.set([x, y], halves(depths(tile([x, y]))));
            }
        }
        tiles
    }
}

impl Light {
    pub fn stretch(&self, camera: &Camera) -> ProjectedEllipsoid {
        self.ellipsoid().project(camera).expect("not empty")
    }

    /// In world space, which looks along −z.
    pub fn ellipsoid(&self) -> Ellipsoid {
        let world = |[x, y, z]: [f64; 3]| Vec3::new(x as f32, y as f32, -z as f32);
        let u = world(self.axis).normalize();
        let v = u.any_orthonormal_vector();
        let rotation = Mat3::from_cols(u, v, u.cross(v));
        let semi_axes = Vec3::new(self.long as f32, self.short as f32, self.short as f32);
        Ellipsoid::new(world(self.center), rotation, semi_axes).expect("in range")
    }
}

impl Tile {
    pub fn rectangle(&self) -> TileRectangle {
        let corner = |i: usize| Vec2::new(self.across[i] as f32, self.down[i] as f32);
        TileRectangle::new(corner(0), corner(1)).expect("in order")
    }
}

/// [z₀, z₁], cut at its middle.
pub fn halves([near, far]: [f64; 2]) -> [DepthInterval; 2] {
    let middle = 0.5 * (near + far);
    [[near, middle], [middle, far]]
        .map(|[near, far]| DepthInterval::new(near as f32, far as f32).expect("in order"))
}

/// The generator of Steele, Lea & Flood 2014. No change of the crate changes its numbers.
pub struct SplitMix64(pub u64);

impl SplitMix64 {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (-53f64).exp2()
    }
}
