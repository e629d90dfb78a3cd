//! Clusters of lights beside point lights with the same lobes: their bounds, one by one and batched, and the evaluation
//! of lists, one by one and in lanes. Times are per light, and per light and point.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fearless_simd::{Level, dispatch};
use stochastic_light_culling::{
    BatchBuilder, Camera, Direction, LightBatch, PointBlock, RadianceEstimator, Roulette, Seed,
    ShadedLight, ShadedPoint, ShadingBatch, SphericalGaussian, Vpl, Vsgl, Xi, glam::Vec3,
};

const LIGHTS: u32 = 1024;
const POINTS: u32 = 256;

/// The random number of `light`, in [−1, 1].
fn random(light: u32, frame: u32) -> f32 {
    2.0 * Seed(77).frame(frame).hashed_xi(light).get() - 1.0
}

fn random_vector(light: u32, first: u32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|i| random(light, first + i)))
}

fn xi(light: u32) -> Xi {
    Seed(3).frame(9).hashed_xi(light)
}

/// Clusters of diffuse and of glossy light, and the point light of each.
fn lights() -> (Vec<Vsgl>, Vec<Vpl<SphericalGaussian>>) {
    let light = |i: u32| {
        let axis = Direction::new(random_vector(i, 0)).expect("random vectors are not zero");
        let sharpness = [2.0, 5.0, 40.0, 300.0][i as usize % 4];
        let lobe = SphericalGaussian::with_integral(axis, sharpness, 1.0).expect("in range");
        let position = 4.0 * random_vector(i, 3);
        let spread = 0.3 * (1.1 + random(i, 6));
        let cluster = Vsgl::new(position, spread, lobe).expect("in range");
        (cluster, Vpl::new(position, 1.0, lobe).expect("in range"))
    };
    (0..LIGHTS).map(light).unzip()
}

fn points() -> Vec<ShadedPoint> {
    let point = |i| (4.0 * random_vector(i, 10)).into();
    (0..POINTS).map(point).collect()
}

fn bounds(criterion: &mut Criterion) {
    let (clusters, vpls) = lights();
    let roulette = Roulette::new(0.01).expect("in range");
    let eye = Vec3::new(0.0, 0.0, 12.0);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 1.0, 1.0, 0.1..100.0).expect("a view");
    let builder = BatchBuilder::new(&roulette, &camera);
    let mut group = criterion.benchmark_group("bounds of clusters");
    group.throughput(Throughput::Elements(LIGHTS.into()));
    group.bench_function("point lights, one by one", |bencher| {
        bencher.iter(|| {
            for (i, light) in (0..).zip(black_box(&vpls)) {
                black_box(light.bound(&roulette, xi(i)));
            }
        });
    });
    group.bench_function("clusters, one by one", |bencher| {
        bencher.iter(|| {
            for (i, light) in (0..).zip(black_box(&clusters)) {
                black_box(light.bound(&roulette, xi(i)));
            }
        });
    });
    let mut batch = LightBatch::new();
    group.bench_function("point lights, batched", |bencher| {
        bencher.iter(|| {
            batch.clear();
            let lights = (0..).zip(black_box(&vpls));
            builder.add(lights.map(|(i, light)| (i, light, xi(i))), &mut batch);
        });
    });
    group.bench_function("clusters, batched", |bencher| {
        bencher.iter(|| {
            batch.clear();
            let lights = (0..).zip(black_box(&clusters));
            builder.add_vsgls(lights.map(|(i, light)| (i, light, xi(i))), &mut batch);
        });
    });
    group.finish();
}

/// The sum of what arrives at points that share a list.
fn by_blocks<L: ShadedLight>(
    estimator: &RadianceEstimator,
    lights: &ShadingBatch<L>,
    list: &[u32],
    points: &[ShadedPoint],
) -> f32 {
    let mut total = 0.0;
    let mut points = points.iter().copied();
    while let Some(block) = PointBlock::take(&mut points) {
        let mut sums = [0.0; PointBlock::LEN];
        estimator.at_block(lights, list, &block, |estimates| {
            for (sum, radiance) in sums.iter_mut().zip(&estimates.radiance) {
                *sum += radiance;
            }
        });
        total += sums.iter().sum::<f32>();
    }
    total
}

/// The same by pairs of a light and a point.
fn by_lists<L: ShadedLight>(
    estimator: &RadianceEstimator,
    lights: &ShadingBatch<L>,
    list: &[u32],
    points: &[ShadedPoint],
) -> f32 {
    let lists = points.iter().map(|point| (*point, list));
    estimator.fold_at_points(lights, lists, 0.0, |sum, _, estimate| {
        sum + estimate.radiance
    })
}

fn evaluation(criterion: &mut Criterion) {
    let (clusters, vpls) = lights();
    let (points, list): (_, Vec<u32>) = (points(), (0..64).collect());
    let roulette = Roulette::new(0.05).expect("in range");
    let estimator = RadianceEstimator::new(&roulette);
    let (mut of_vpls, mut of_clusters) = (ShadingBatch::new(), ShadingBatch::new());
    of_vpls.extend((0..).zip(&vpls).map(|(i, light)| (light, xi(i))));
    of_clusters.extend((0..).zip(&clusters).map(|(i, light)| (light, xi(i))));
    let mut group = criterion.benchmark_group("evaluation of clusters");
    group.throughput(Throughput::Elements((points.len() * list.len()) as u64));
    group.bench_function("clusters, one by one", |bencher| {
        bencher.iter(|| {
            let mut total = 0.0;
            // Compiled for this processor, as the lanes are.
            dispatch!(Level::new(), _simd => for point in black_box(&points) {
                for i in &list {
                    let light = &clusters[*i as usize];
                    total += roulette.estimate(light.scalar_irradiance(point.position), 1.0, xi(*i));
                }
            });
            total
        });
    });
    group.bench_function("point lights, a shared list", |bencher| {
        bencher.iter(|| by_blocks(&estimator, &of_vpls, &list, black_box(&points)));
    });
    group.bench_function("clusters, a shared list", |bencher| {
        bencher.iter(|| by_blocks(&estimator, &of_clusters, &list, black_box(&points)));
    });
    group.bench_function("point lights, lists of their own", |bencher| {
        bencher.iter(|| by_lists(&estimator, &of_vpls, &list, black_box(&points)));
    });
    group.bench_function("clusters, lists of their own", |bencher| {
        bencher.iter(|| by_lists(&estimator, &of_clusters, &list, black_box(&points)));
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = bounds, evaluation
}
criterion_main!(benches);
