//! Culling: making lights ready, the two fixed workloads, and how the time grows with lights and tiles.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

#[path = "cull/baseline.rs"]
mod baseline;
#[path = "cull/building.rs"]
mod building;
#[path = "cull/growth.rs"]
mod growth;
#[path = "../tests/workload/mod.rs"]
mod workload;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use stochastic_light_culling::{Culler, LightBatch, LightLists, Stretch, TileDepths};
use workload::{Depths, Subregion};

/// A subregion, made ready.
struct Ready {
    batch: LightBatch<Stretch>,
    tiles: TileDepths,
    lists: LightLists,
}

fn ready(frame: &[Subregion], depths: Depths) -> Vec<Ready> {
    let camera = workload::camera();
    let ready = |subregion: &Subregion| {
        let mut lights: Vec<_> = (0..).zip(&subregion.lights).collect();
        lights.sort_by(|(_, a), (_, b)| a.center[2].total_cmp(&b.center[2]));
        let mut batch = LightBatch::new();
        batch.extend(lights.iter().map(|(i, light)| (*i, light.stretch(&camera))));
        Ready {
            batch,
            tiles: subregion.tile_depths(depths),
            lists: LightLists::new(),
        }
    };
    frame.iter().map(ready).collect()
}

fn cull_all(culler: &mut Culler<Stretch>, frame: &mut [Ready]) {
    for Ready {
        batch,
        tiles,
        lists,
    } in frame
    {
        culler.cull(batch, tiles, lists).expect("few enough");
    }
}

fn workloads(criterion: &mut Criterion) {
    let frame = workload::frame();
    let kinds: [(&str, Depths); 2] = [("W1", |tile| tile.scattered), ("W1c", |tile| tile.coherent)];
    for (name, depths) in kinds {
        let mut group = criterion.benchmark_group(name);
        let tests = workload::SUBREGIONS
            * workload::LIGHTS
            * (workload::TILES[0] * workload::TILES[1]) as usize;
        group.throughput(Throughput::Elements(tests as u64));
        group.sample_size(20);
        let mut baseline = baseline::frame(&frame, depths);
        group.bench_function("scalar baseline", |bencher| {
            bencher.iter(|| baseline.iter_mut().for_each(baseline::Subregion::cull));
        });
        let mut ready = ready(&frame, depths);
        for lanes in [16, 8, 4] {
            let mut flat = Culler::with_lanes(lanes).without_blocks();
            group.bench_function(format!("one level, {lanes} lanes"), |bencher| {
                bencher.iter(|| cull_all(&mut flat, &mut ready));
            });
            let mut culler = Culler::with_lanes(lanes);
            group.bench_function(format!("blocks, {lanes} lanes"), |bencher| {
                bencher.iter(|| cull_all(&mut culler, &mut ready));
            });
        }
    }
}

/// Times are per light of all lists.
fn growth(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("growth");
    group.sample_size(10);
    for scale in [1, 3, 10, 31] {
        let (batch, tiles) = growth::frame(scale);
        let (mut culler, mut lists) = (Culler::new(), LightLists::new());
        let mut cull = || culler.cull(&batch, &tiles, &mut lists).expect("few enough");
        group.throughput(Throughput::Elements(cull().pairs));
        let [width, height] = tiles.size();
        let name = format!("{} lights, {} tiles", batch.len(), width * height);
        group.bench_function(name, |bencher| bencher.iter(&mut cull));
    }
}

criterion_group!(benches, building::building, workloads, growth);
criterion_main!(benches);
