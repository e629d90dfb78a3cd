//! Scenes that grow: as many times more lights as tiles. Tiles become smaller in all three directions, and
//! lights in volume, so that each tile keeps its share of lights.

use std::f32::consts::{PI, TAU};

use stochastic_light_culling::{
    Camera, DepthInterval, Ellipsoid, ProjectedEllipsoid, TileDepths, TileRectangle,
    glam::{Mat3, Vec2, Vec3},
};
use support::workload::SplitMix64;

/// A frame of (15·`scale`)×(9·`scale`) tiles and 1024·`scale`² lights in no order.
pub fn frame(scale: u32) -> (Vec<ProjectedEllipsoid>, TileDepths) {
    let fov = PI / 3.0;
    let camera = Camera::look_at(
        Vec3::ZERO,
        Vec3::NEG_Z,
        Vec3::Y,
        fov,
        16.0 / 9.0,
        0.1..100.0,
    )
    .expect("in range");
    let slopes = Vec2::new(16.0 / 9.0, 1.0) * (0.5 * fov).tan();
    (lights(scale, slopes, &camera), tiles(scale, slopes))
}

fn lights(scale: u32, slopes: Vec2, camera: &Camera) -> Vec<ProjectedEllipsoid> {
    let mut random = SplitMix64(3);
    (0..1024 * scale * scale)
        .filter_map(|light| ellipsoid(&mut random, light, scale, slopes).project(camera))
        .collect()
}

fn ellipsoid(random: &mut SplitMix64, light: u32, scale: u32, slopes: Vec2) -> Ellipsoid {
    let mut unit = || random.unit() as f32;
    let depth = (1.0 + unit() * (50_f32.powi(3) - 1.0)).cbrt();
    let across = Vec2::new(2.0 * unit() - 1.0, 2.0 * unit() - 1.0) * slopes * depth;
    let short = 0.15 * 20_f32.powf(unit()) / (scale as f32).powf(0.55);
    let alpha = [0.05, 0.1, 0.2, 0.4][light as usize % 4];
    let long = short * (1.0 + alpha * alpha) / (2.0 * alpha);
    let (h, turn) = (2.0 * unit() - 1.0, TAU * unit());
    let flat = (1.0 - h * h).max(0.0).sqrt();
    let u = Vec3::new(flat * turn.cos(), flat * turn.sin(), h).normalize();
    let v = u.any_orthonormal_vector();
    let rotation = Mat3::from_cols(u, v, u.cross(v));
    Ellipsoid::new(
        across.extend(-depth),
        rotation,
        Vec3::new(long, short, short),
    )
    .expect("in range")
}

/// The depths of the second workload, drawn over as many tiles.
fn tiles(scale: u32, slopes: Vec2) -> TileDepths {
    let size = [15 * scale, 9 * scale];
    let whole = Vec2::new(size[0] as f32, size[1] as f32);
    let corner = |[x, y]: [u32; 2]| (Vec2::new(x as f32, y as f32) / whole * 2.0 - 1.0) * slopes;
    let rectangle = |[x, y]: [u32; 2]| {
        TileRectangle::new(corner([x, y]), corner([x + 1, y + 1])).expect("in order")
    };
    let mut tiles = TileDepths::from_rectangles(size, 2, rectangle).expect("not empty");
    let mut random = SplitMix64(4);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let (tx, ty) = (x as f32 / scale as f32, y as f32 / scale as f32);
            let waves = 0.3 * (0.45 * tx + 0.3).sin() * (0.6 * ty).cos();
            let f = 0.5 + waves + 0.15 * (0.9 * tx - 0.7 * ty).sin();
            let near = 1.5 * 20_f32.powf(f) * (1.0 + 0.05 * (random.unit() as f32 - 0.5));
            let far =
                (near * 2_f32.powf((0.07 + 0.93 * random.unit() as f32) / scale as f32)).min(50.0);
            let middle = 0.5 * (near + far);
            let halves = [[near, middle], [middle, far]];
            tiles.set(
                [x, y],
                halves.map(|[near, far]| DepthInterval::new(near, far).ok()),
            );
        }
    }
    tiles
}
