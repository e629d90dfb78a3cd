//! The paper's loop as one would write it without any of this crate: scalar, an array of structures, each light
//! against each tile, a list for each depth interval. Compiled for this processor, with its fused multiply-add.

use fearless_simd::{Level, dispatch};
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
    pub fn cull(&mut self, level: Level) {
        // What is inlined here may take all instructions of the processor.
        dispatch!(level, _simd => self.cull_here());
    }

    #[inline(always)]
    fn cull_here(&mut self) {
        for (tile, lists) in self.tiles.iter().zip(&mut self.lists) {
            lists.iter_mut().for_each(Vec::clear);
            for (i, light) in (0..).zip(&self.lights) {
                let rectangle = light.rectangle(tile);
                for (list, depths) in lists.iter_mut().zip(tile.depths) {
                    if light.touches(rectangle, depths) {
                        list.push(i);
                    }
                }
            }
        }
    }
}

impl Light {
    /// The bounding rectangle of the tile at depth 1 after stretching.
    #[inline(always)]
    fn rectangle(&self, tile: &Tile) -> [[f32; 2]; 2] {
        let m = &self.matrix;
        let range = |[a, b, c]: [f32; 3]| {
            let (left, right) = (a * tile.min.x, a * tile.max.x);
            let (top, bottom) = (b.mul_add(tile.min.y, c), b.mul_add(tile.max.y, c));
            let low = lesser(left, right) + lesser(top, bottom);
            [low, greater(left, right) + greater(top, bottom)]
        };
        [
            range([m.x_axis.x, m.y_axis.x, m.z_axis.x]),
            range([m.x_axis.y, m.y_axis.y, m.z_axis.y]),
        ]
    }

    #[inline(always)]
    fn touches(&self, [across, down]: [[f32; 2]; 2], [near, far]: [f32; 2]) -> bool {
        let (m, center) = (self.matrix.z_axis.z, self.center);
        let apart = |center: f32, low: f32, high: f32| center - lesser(greater(center, low), high);
        let at_depths = |center, [low, high]: [f32; 2]| {
            let low = lesser(low * near, low * far);
            apart(center, low, greater(high * near, high * far))
        };
        let (x, y) = (at_depths(center.x, across), at_depths(center.y, down));
        let z = apart(center.z, m * near, m * far);
        x.mul_add(x, y.mul_add(y, z * z)) <= 1.0
    }
}

/// One instruction, which `f32::min` is not, since it takes care of NaN.
#[inline(always)]
fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
