//! Culling: making lights ready, per light, and the two fixed workloads.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

#[path = "cull/baseline.rs"]
mod baseline;
#[path = "../tests/workload/mod.rs"]
mod workload;

use std::hint::black_box;

use criterion::{
    BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main, measurement::WallTime,
};
use stochastic_light_culling::{
    BatchBuilder, BatchLobe, BatchShape, Bounded, Camera, CameraSphere, Culler, DepthOrder,
    Direction, Fresnel, Ggx, GgxLobe, LambertLobe, LightBatch, LightLists, NoFresnel, Roulette,
    Schlick, Stretch, TileDepths, Vpl, Xi, glam::Vec3,
};
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

/// Lights in a ball before the camera.
fn lights<L: BatchLobe>(lobe: impl Fn(u32, Direction, Direction) -> L) -> Vec<(Vpl<L>, Xi)> {
    let light = |i| {
        let random = |k| 2.0 * Xi::hashed(i, k, 1).get() - 1.0;
        let vector = |k| Vec3::new(random(k), random(k + 1), random(k + 2));
        let normal = Direction::new(vector(0)).expect("not zero");
        let incoming = Direction::new(*normal + 0.9 * vector(3)).expect("not zero");
        let position = 10.0 * vector(6) - 25.0 * Vec3::Z;
        let light = Vpl::new(position, 1.0, lobe(i, normal, incoming)).expect("in range");
        (light, Xi::hashed(i, 0, 0))
    };
    (0..workload::LIGHTS as u32).map(light).collect()
}

fn glossy_lights<F: Fresnel>(fresnel: F) -> Vec<(Vpl<GgxLobe<F>>, Xi)> {
    lights(|i, normal, incoming| {
        let roughness = [0.05, 0.1, 0.2, 0.4][i as usize % 4];
        let ggx = Ggx::new(roughness).expect("in range");
        GgxLobe::new(ggx, fresnel, normal, incoming)
    })
}

/// Times making a batch of `lights`, one by one and sixteen by sixteen.
fn build<L: Bounded, T: BatchShape>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    lights: &[(Vpl<L>, Xi)],
    one: impl Fn(&Vpl<L>, Xi) -> Option<T>,
    many: impl Fn(&[(Vpl<L>, Xi)], &mut LightBatch<T>),
) {
    let mut batch = LightBatch::new();
    group.bench_function(format!("{name}, one by one"), |bencher| {
        bencher.iter(|| {
            batch.clear();
            let shapes = (0..).zip(black_box(lights));
            batch.extend(shapes.filter_map(|(i, (light, xi))| Some((i, one(light, *xi)?))));
        });
    });
    group.bench_function(format!("{name}, batched"), |bencher| {
        bencher.iter(|| {
            batch.clear();
            many(black_box(lights), &mut batch);
        });
    });
}

fn numbered<L>(lights: &[(Vpl<L>, Xi)]) -> impl Iterator<Item = (u32, &Vpl<L>, Xi)> {
    (0..).zip(lights).map(|(i, (light, xi))| (i, light, *xi))
}

fn glossy<F: Fresnel>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    fresnel: F,
    roulette: &Roulette,
    camera: &Camera,
) {
    let lights = glossy_lights(fresnel);
    let builder = BatchBuilder::new(roulette, camera);
    build(
        group,
        &format!("spheroid, {name}"),
        &lights,
        |light, xi| Stretch::new(&light.bound(roulette, xi).into(), camera),
        |lights, batch| builder.add(numbered(lights), batch),
    );
    build(
        group,
        &format!("tight, {name}"),
        &lights,
        |light, xi| Stretch::new(&light.tight_bound(roulette, xi), camera),
        |lights, batch| builder.add_tight(numbered(lights), batch),
    );
}

fn building(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("building");
    group.throughput(Throughput::Elements(workload::LIGHTS as u64));
    let (roulette, camera) = (Roulette::new(0.001).expect("in range"), workload::camera());
    glossy(&mut group, "no Fresnel", NoFresnel, &roulette, &camera);
    let schlick = Schlick::new(0.9).expect("in range");
    glossy(&mut group, "Schlick", schlick, &roulette, &camera);

    let diffuse = lights(|_, normal, _| LambertLobe::new(0.8, normal).expect("in range"));
    let builder = BatchBuilder::new(&roulette, &camera);
    build(
        &mut group,
        "diffuse",
        &diffuse,
        |light, xi| CameraSphere::new(&light.bound(&roulette, xi), &camera),
        |lights, batch| builder.add(numbered(lights), batch),
    );

    let mut order = DepthOrder::new();
    group.bench_function("depth order", |bencher| {
        bencher.iter(|| {
            let positions = diffuse.iter().map(|(light, _)| light.position());
            black_box(order.of(positions, &camera));
        });
    });
}

criterion_group!(benches, building, workloads);
criterion_main!(benches);
