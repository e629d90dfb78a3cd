//! Culling: making lights ready, the two fixed workloads, and how the time grows with lights and tiles.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

mod baseline;
mod building;
mod cones;
mod growth;
mod polyhedron;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fearless_simd::Level;
use stochastic_light_culling::{
    Culler, DepthInterval, LightBatch, LightLists, ProjectedEllipsoid, TileDepths, TileRectangle,
};
use support::workload::{self, Depths, Subregion};

const KINDS: [(&str, Depths); 2] = [("W1", |tile| tile.scattered), ("W1c", |tile| tile.coherent)];

/// A subregion: its projected lights in no order, and its lists.
struct Ready {
    shapes: Vec<ProjectedEllipsoid>,
    tiles: TileDepths,
    lists: LightLists,
}

fn ready(frame: &[Subregion], depths: Depths) -> Vec<Ready> {
    let camera = workload::camera();
    let ready = |subregion: &Subregion| Ready {
        shapes: (subregion.lights.iter())
            .map(|light| light.stretch(&camera))
            .collect(),
        tiles: subregion.tile_depths(depths),
        lists: LightLists::new(),
    };
    frame.iter().map(ready).collect()
}

/// The batch that all subregions share, one after the other, and the culler.
struct Memory {
    batch: LightBatch<ProjectedEllipsoid>,
    culler: Culler<ProjectedEllipsoid>,
}

impl Memory {
    fn new(culler: Culler<ProjectedEllipsoid>) -> Self {
        let batch = LightBatch::new();
        Self { batch, culler }
    }

    /// From projected lights to lists, packing included.
    fn pack_and_cull(&mut self, frame: &mut [Ready]) {
        for ready in frame {
            self.batch.clear();
            self.batch.extend((0..).zip(&ready.shapes));
            let lists = self
                .culler
                .cull(&self.batch, &ready.tiles, &mut ready.lists);
            lists.expect("few enough");
        }
    }
}

/// Batches that are packed already, as a `BatchBuilder` packs them.
fn pack(frame: &[Ready]) -> Vec<LightBatch<ProjectedEllipsoid>> {
    let pack = |ready: &Ready| {
        let mut batch = LightBatch::new();
        batch.extend((0..).zip(&ready.shapes));
        batch
    };
    frame.iter().map(pack).collect()
}

fn workloads(criterion: &mut Criterion) {
    let frame = workload::frame();
    for (name, depths) in KINDS {
        let mut group = criterion.benchmark_group(name);
        let tests = workload::SUBREGIONS
            * workload::LIGHTS
            * (workload::TILES[0] * workload::TILES[1]) as usize;
        group.throughput(Throughput::Elements(tests as u64));
        group.sample_size(20);
        let mut baseline = baseline::frame(&frame, depths);
        group.bench_function("scalar baseline", |bencher| {
            let level = Level::new();
            bencher.iter(|| {
                for subregion in &mut baseline {
                    subregion.cull(level);
                }
            });
        });
        let mut ready = ready(&frame, depths);
        let batches = pack(&ready);
        for lanes in [16, 8, 4] {
            let mut flat = Memory::new(Culler::with_lanes(lanes).without_blocks());
            group.bench_function(format!("one level, {lanes} lanes"), |bencher| {
                bencher.iter(|| flat.pack_and_cull(&mut ready));
            });
            let mut memory = Memory::new(Culler::with_lanes(lanes));
            group.bench_function(format!("packed and culled, {lanes} lanes"), |bencher| {
                bencher.iter(|| memory.pack_and_cull(&mut ready));
            });
            let mut culler = Culler::with_lanes(lanes);
            group.bench_function(format!("culled, {lanes} lanes"), |bencher| {
                bencher.iter(|| {
                    for (ready, batch) in ready.iter_mut().zip(&batches) {
                        let counters = culler.cull(batch, &ready.tiles, &mut ready.lists);
                        counters.expect("few enough");
                    }
                });
            });
        }
        let mut exact = Memory::new(Culler::new().with_exact_test());
        group.bench_function("packed and culled, exact", |bencher| {
            bencher.iter(|| exact.pack_and_cull(&mut ready));
        });
    }
}

/// From projected lights in no order to lists. Times are per light.
fn growth(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("growth");
    group.sample_size(10);
    for scale in [1, 3, 10, 31] {
        let (shapes, tiles) = growth::frame(scale);
        let [width, height] = tiles.size();
        let name = format!("{} lights, {} tiles", shapes.len(), width * height);
        group.throughput(Throughput::Elements(shapes.len() as u64));
        let mut frame = [Ready {
            shapes,
            tiles,
            lists: LightLists::new(),
        }];
        let batches = pack(&frame);
        let mut culler = Culler::new();
        group.bench_function(format!("culled, {name}"), |bencher| {
            bencher.iter(|| {
                let [Ready { tiles, lists, .. }] = &mut frame;
                culler.cull(&batches[0], tiles, lists).expect("few enough");
            });
        });
        let mut memory = Memory::new(culler);
        group.bench_function(format!("packed and culled, {name}"), |bencher| {
            bencher.iter(|| memory.pack_and_cull(&mut frame));
        });
    }
}

/// All pairs of a light and a tile that pass the box test.
fn pairs(
    frame: &[Subregion],
    depths: Depths,
) -> Vec<(ProjectedEllipsoid, TileRectangle, DepthInterval)> {
    let camera = workload::camera();
    let mut pairs = Vec::new();
    for Subregion { lights, tiles } in frame {
        let lights: Vec<_> = lights.iter().map(|light| light.stretch(&camera)).collect();
        for tile in tiles {
            let rectangle = tile.rectangle();
            for depths in workload::halves(depths(tile)) {
                let touching = lights.iter().filter(|l| l.touches(&rectangle, &depths));
                pairs.extend(touching.map(|light| (*light, rectangle, depths)));
            }
        }
    }
    pairs
}

/// The exact test of what passes the box test, against that of a general polyhedron by parry3d, which
/// has to be built for each pair. Times are per pair.
fn exact(criterion: &mut Criterion) {
    let frame = workload::frame();
    for (name, depths) in KINDS {
        let pairs = pairs(&frame, depths);
        let (mut kept, mut differ) = (0, 0);
        for (light, rectangle, depths) in &pairs {
            let touched = light.touches_exactly(rectangle, depths);
            let polyhedron = polyhedron::of_tile(light, rectangle, depths);
            kept += usize::from(touched);
            differ += usize::from(touched != polyhedron::meets_ball(&polyhedron, light));
        }
        let all = pairs.len();
        println!("{name}: {kept} of {all} pairs touch; parry3d decides {differ} otherwise");

        let mut group = criterion.benchmark_group(format!("exact test, {name}"));
        group.sample_size(20);
        let some = &pairs[..pairs.len().min(8192)];
        group.throughput(Throughput::Elements(some.len() as u64));
        group.bench_function("box", |bencher| {
            bencher.iter(|| {
                count(some, |(light, rectangle, depths)| {
                    light.touches(rectangle, depths)
                })
            });
        });
        group.bench_function("box, then exact", |bencher| {
            bencher.iter(|| {
                count(some, |(light, rectangle, depths)| {
                    light.touches_exactly(rectangle, depths)
                })
            });
        });
        group.bench_function("parry3d, polyhedron built each time", |bencher| {
            bencher.iter(|| {
                count(some, |(light, rectangle, depths)| {
                    let polyhedron = polyhedron::of_tile(light, rectangle, depths);
                    polyhedron::meets_ball(&polyhedron, light)
                })
            });
        });
        let built = some.iter().map(|(light, rectangle, depths)| {
            (polyhedron::of_tile(light, rectangle, depths), *light)
        });
        let built: Vec<_> = built.collect();
        group.bench_function("parry3d, polyhedron built before", |bencher| {
            bencher.iter(|| {
                count(&built, |(polyhedron, light)| {
                    polyhedron::meets_ball(polyhedron, light)
                })
            });
        });
    }
}

fn count<T>(pairs: &[T], test: impl Fn(&T) -> bool) -> usize {
    pairs.iter().filter(|pair| test(black_box(pair))).count()
}

criterion_group!(
    benches,
    building::building,
    cones::cones,
    exact,
    workloads,
    growth
);
criterion_main!(benches);
