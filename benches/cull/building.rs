//! Making lights ready: one by one, and batched.

use std::hint::black_box;

use criterion::{BenchmarkGroup, Criterion, Throughput, measurement::WallTime};
use stochastic_light_culling::{
    BatchBuilder, BatchLobe, BatchShape, Bounded, Camera, CameraSphere, DepthOrder, Direction,
    Fresnel, Ggx, GgxLobe, LambertLobe, LightBatch, NoFresnel, Roulette, Schlick, Stretch, Vpl, Xi,
    glam::Vec3,
};

use crate::workload;

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

/// Times are per light.
pub fn building(criterion: &mut Criterion) {
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
