//! Grids of tiles and lights at random.

use proptest::prelude::*;
use stochastic_light_culling::{
    Camera, DepthInterval, Ellipsoid, Orthographic, PixelRectangle, Projection, Sphere, TileDepths,
    TileRectangle,
    glam::{Mat3, Vec3},
};
use support::generators::{self};

pub fn camera() -> Camera {
    Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.2, 1.5, 0.1..100.0).unwrap()
}

/// The same, but for parallel rays. Depths are distances too.
pub fn parallel_camera() -> Camera<Orthographic> {
    Camera::orthographic_look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 30.0, 1.5, 50.0..75.0).unwrap()
}

/// How many tiles, and what each of them sees.
#[derive(Clone, Debug)]
pub struct Grid {
    pub size: [u32; 2],
    pub depths: Vec<Vec<Option<DepthInterval>>>,
}

impl Grid {
    pub fn rectangle<P: Projection>(&self, camera: &Camera<P>, [x, y]: [u32; 2]) -> TileRectangle {
        let pixels = PixelRectangle {
            min: [x, y],
            max: [x + 1, y + 1],
        };
        camera.tile_rectangle(self.size, pixels)
    }

    pub fn tiles(&self) -> impl Iterator<Item = ([u32; 2], &Vec<Option<DepthInterval>>)> {
        let [width, height] = self.size;
        let positions = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        positions.zip(&self.depths)
    }

    pub fn tile_depths<P: Projection>(&self, camera: &Camera<P>) -> TileDepths {
        let intervals = self.depths[0].len() as u32;
        let rectangle = |tile| self.rectangle(camera, tile);
        let mut tiles = TileDepths::from_rectangles(self.size, intervals, rectangle).unwrap();
        for (tile, depths) in self.tiles() {
            tiles.set(tile, depths.iter().copied());
        }
        tiles
    }
}

pub fn grid() -> impl Strategy<Value = Grid> {
    let interval = prop_oneof![
        1 => Just(None),
        1 => Just(DepthInterval::new(0.0, f32::MAX).ok()),
        // Of proptest, a lower end that is no multiple of the steps of `f32` below 60 fails one sample in 1e7.
        6 => (0.015_625..60.0_f32, 1.0..4.0_f32)
            .prop_map(|(near, ratio)| DepthInterval::new(near, near * ratio).ok()),
    ];
    ([1..60_u32, 1..30_u32], 1..4_usize).prop_flat_map(move |(size, intervals)| {
        let depths = prop::collection::vec(interval.clone(), intervals);
        let depths = prop::collection::vec(depths, (size[0] * size[1]) as usize);
        depths.prop_map(move |depths| Grid { size, depths })
    })
}

/// In camera space, at all distances and sizes, and now and then everywhere.
pub fn ellipsoid() -> impl Strategy<Value = Ellipsoid> {
    let center = (-30.0..30.0_f32, -20.0..20.0_f32, -50.0..5.0_f32);
    let ellipsoid = (center, generators::ellipsoid(), -3.0..0.5_f32);
    let anywhere = ellipsoid.prop_map(|((x, y, z), shape, size)| {
        let semi_axes = shape.semi_axes() / shape.semi_axes().max_element();
        let semi_axes = semi_axes * (10_f32.powf(size) * z.abs().max(0.1));
        Ellipsoid::new(Vec3::new(x, y, z), shape.rotation(), semi_axes).unwrap()
    });
    let huge = Just(Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::splat(1e38)).unwrap());
    let distant =
        Just(Ellipsoid::new(Vec3::splat(1e30), Mat3::IDENTITY, Vec3::splat(1.0)).unwrap());
    prop_oneof![30 => anywhere, 1 => huge, 1 => distant]
}

pub fn sphere() -> impl Strategy<Value = Sphere> {
    let center = (-30.0..30.0_f32, -20.0..20.0_f32, -50.0..5.0_f32);
    let radius = prop_oneof![30 => generators::log_uniform(1e-2, 20.0), 1 => Just(1e38)];
    (center, radius)
        .prop_map(|((x, y, z), radius)| Sphere::new(Vec3::new(x, y, z), radius as f32).unwrap())
}
