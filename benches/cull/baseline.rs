//! The paper's loop as one would write it without any of this crate: scalar, an array of structures,
//! each light against each tile, a list for each depth interval.

use stochastic_light_culling::glam::{Mat3, Vec2, Vec3};
use support::workload::{self, Depths, halves};

/// M and Mc′.
struct Light {
    matrix: Mat3,
    center: Vec3,
}

struct Tile {
    min: Vec2,
    max: Vec2,
    depths: [[f32; 2]; 2],
}

pub struct Subregion {
    lights: Vec<Light>,
    tiles: Vec<Tile>,
    lists: Vec<[Vec<u32>; 2]>,
}

pub fn frame(frame: &[workload::Subregion], depths: Depths) -> Vec<Subregion> {
    let camera = workload::camera();
    let tile = |tile: &workload::Tile| Tile {
        min: tile.rectangle().min(),
        max: tile.rectangle().max(),
        depths: halves(depths(tile)).map(|interval| [interval.near(), interval.far()]),
    };
    let light = |light: &workload::Light| {
        let stretch = light.stretch(&camera);
        Light {
            matrix: stretch.matrix(),
            center: stretch.center(),
        }
    };
    let ready = |subregion: &workload::Subregion| Subregion {
        lights: subregion.lights.iter().map(light).collect(),
        tiles: subregion.tiles.iter().map(tile).collect(),
        lists: vec![[Vec::new(), Vec::new()]; subregion.tiles.len()],
    };
    frame.iter().map(ready).collect()
}

impl Subregion {
    pub fn cull(&mut self) {
        for (tile, lists) in self.tiles.iter().zip(&mut self.lists) {
            lists.iter_mut().for_each(Vec::clear);
            for (i, light) in (0..).zip(&self.lights) {
                let [low, high] = light.bounds(tile);
                for (list, depths) in lists.iter_mut().zip(tile.depths) {
                    if light.touches(low, high, depths) {
                        list.push(i);
                    }
                }
            }
        }
    }
}

impl Light {
    /// The box of the tile at depth 1 after stretching.
    fn bounds(&self, tile: &Tile) -> [Vec2; 2] {
        let m = &self.matrix;
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(Vec3::truncate);
        let (left, right) = (x * tile.min.x, x * tile.max.x);
        let (top, bottom) = (y * tile.min.y, y * tile.max.y);
        let ends = |[a, b]: [f32; 2], [c, d]: [f32; 2], z| {
            let low = lesser(a, b) + lesser(c, d) + z;
            [low, greater(a, b) + greater(c, d) + z]
        };
        let [low_x, high_x] = ends([left.x, right.x], [top.x, bottom.x], z.x);
        let [low_y, high_y] = ends([left.y, right.y], [top.y, bottom.y], z.y);
        [Vec2::new(low_x, low_y), Vec2::new(high_x, high_y)]
    }

    fn touches(&self, low: Vec2, high: Vec2, [near, far]: [f32; 2]) -> bool {
        let (m, center) = (self.matrix.z_axis.z, self.center);
        let apart = |center: f32, low: f32, high: f32| center - lesser(greater(center, low), high);
        let at_depths = |center, low: f32, high: f32| {
            let low = lesser(low * near, low * far);
            apart(center, low, greater(high * near, high * far))
        };
        let x = at_depths(center.x, low.x, high.x);
        let y = at_depths(center.y, low.y, high.y);
        let z = apart(center.z, m * near, m * far);
        x * x + y * y + z * z <= 1.0
    }
}

/// One instruction, which `f32::min` is not, since it takes care of NaN.
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
