//! Evaluation of lists of lights: for tiles whose 256 points share a list of 48, and for points with lists of
//! 30 or of 4 of their own. About half of the lights of a list face the points, and are accepted. Times are
//! per light and point.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use fearless_simd::{Level, dispatch};
use stochastic_light_culling::{
    Conductor, Dielectric, Direction, Estimate, Fresnel, Ggx, GgxLobe, Incidence, LambertLobe,
    Lobe, LtcLobe, NoFresnel, PointBlock, PointDecision, RadianceEstimator, Roulette, Schlick,
    Seed, ShadedPoint, ShadingBatch, Vpl, WeightedList, Xi, glam::Vec3,
};

const LIGHTS: u32 = 16_384;
const TILES: u32 = 16;
const POINTS: usize = 256;
/// Weights of lists.
const ONES: [f32; 48] = [1.0; 48];
const TINT: Vec3 = Vec3::new(1.0, 0.5, 0.25);

type Group<'a> = BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// The random number of `light` in `frame`, in [−1, 1].
fn random(light: u32, frame: u32) -> f32 {
    2.0 * Seed(77).frame(frame).hashed_xi(light).get() - 1.0
}

fn random_vector(light: u32, first: u32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|i| random(light, first + i)))
}

fn direction(vector: Vec3) -> Direction {
    Direction::new(vector).expect("random vectors are not zero")
}

fn ggx<F: Fresnel>(fresnel: F) -> impl Fn(u32) -> GgxLobe<F> {
    move |i| {
        let (normal, incoming) = (direction(random_vector(i, 0)), random_vector(i, 3));
        let incoming = direction(incoming * incoming.dot(*normal).signum());
        let ggx = Ggx::new([0.05, 0.1, 0.2, 0.4][i as usize % 4]).expect("in range");
        GgxLobe::new(ggx, fresnel, Incidence { normal, incoming })
    }
}

/// A tile: points of a plane, and a list for all of them.
struct Tile {
    points: Vec<ShadedPoint>,
    list: Vec<u32>,
}

struct Scene<L> {
    roulette: Roulette,
    lights: Vec<(Vpl<L>, Xi)>,
    batch: ShadingBatch<L>,
    tiles: Vec<Tile>,
}

impl<L: Lobe + Copy> Scene<L> {
    fn new(list: usize, lobe: impl Fn(u32) -> L) -> Self {
        let roulette = Roulette::new(0.01).expect("in range");
        let light = |i: u32| {
            let position = 4.0 * random_vector(i, 6);
            let vpl = Vpl::new(position, 1.0, lobe(i)).expect("in range");
            (vpl, Seed(3).frame(9).hashed_xi(i))
        };
        let lights: Vec<_> = (0..LIGHTS).map(light).collect();
        let mut batch = ShadingBatch::new();
        batch.extend(lights.iter().map(|(vpl, xi)| (vpl, *xi)));
        let tile = |tile| {
            let normal = *direction(random_vector(tile, 20));
            let (across, down) = normal.any_orthonormal_pair();
            let center = 3.0 * random_vector(tile, 23);
            let point = |k: usize| ShadedPoint {
                position: center
                    + across * ((k % 16) as f32 * 0.02)
                    + down * ((k / 16) as f32 * 0.02),
                normal: Vec3::ZERO,
            };
            let points: Vec<_> = (0..POINTS).map(point).collect();
            let order = (0..LIGHTS).map(|i| (i * 977 + tile * 131) % LIGHTS);
            let (mut accepted, mut rejected) = (Vec::new(), Vec::new());
            for i in order {
                let (vpl, xi) = &lights[i as usize];
                let (direction, squared) = vpl.direction_to(points[120].position);
                if roulette.accepts(vpl.radiant_intensity(direction), squared, *xi) {
                    accepted.push(i);
                } else if squared < 4.0 {
                    rejected.push(i);
                }
            }
            accepted.truncate(list / 2);
            rejected.truncate(list - accepted.len());
            let mut list = [accepted, rejected].concat();
            list.sort_unstable();
            Tile { points, list }
        };
        let tiles = (0..TILES).map(tile).collect();
        Self {
            roulette,
            lights,
            batch,
            tiles,
        }
    }

    fn pairs(&self) -> u64 {
        let pairs = |tile: &Tile| (tile.list.len() * tile.points.len()) as u64;
        self.tiles.iter().map(pairs).sum()
    }

    /// One light at a time, compiled for this processor.
    fn scalar(&self, facing: impl Fn(&L, Vec3) -> bool) -> Vec3 {
        // What is inlined here may take all instructions of the processor.
        dispatch!(Level::new(), _simd => self.scalar_here(&facing))
    }

    #[inline(always)]
    fn scalar_here(&self, facing: &impl Fn(&L, Vec3) -> bool) -> Vec3 {
        let mut total = Vec3::ZERO;
        for tile in &self.tiles {
            for point in &tile.points {
                let mut sum = Vec3::ZERO;
                for i in &tile.list {
                    let (vpl, xi) = &self.lights[*i as usize];
                    if !facing(vpl.lobe(), point.position - vpl.position()) {
                        continue;
                    }
                    let (direction, squared) = vpl.direction_to(point.position);
                    let intensity = vpl.radiant_intensity(direction);
                    let radiance = self.roulette.estimate(intensity, squared, *xi);
                    sum += radiance * direction.x.abs() * TINT;
                }
                total += black_box(sum);
            }
        }
        total
    }

    fn by_points(&self, lanes: usize) -> Vec3 {
        let estimator = RadianceEstimator::new(&self.roulette).with_lanes(lanes);
        self.by_points_with(&estimator, |tile| &*tile.list)
    }

    /// Without roulette, and so without a look at which lights are too faint: what takes time is the lobe.
    fn all_by_points(&self) -> Vec3 {
        self.by_points_with(&RadianceEstimator::listed(), |tile| {
            let (lights, weights) = (&*tile.list, &ONES[..tile.list.len()]);
            WeightedList { lights, weights }
        })
    }

    fn by_points_with<'a, D: PointDecision>(
        &'a self,
        estimator: &RadianceEstimator<D>,
        list_of: impl Fn(&'a Tile) -> D::List<'a>,
    ) -> Vec3 {
        let mut total = Vec3::ZERO;
        for tile in &self.tiles {
            let mut points = tile.points.iter().copied();
            while let Some(block) = PointBlock::take(&mut points) {
                let mut sums = [[0.0; PointBlock::LEN]; 3];
                estimator.at_block(&self.batch, list_of(tile), &block, |estimates| {
                    for (sums, tint) in sums.iter_mut().zip(TINT.to_array()) {
                        for (i, sum) in sums.iter_mut().enumerate() {
                            let cosine = estimates.direction[0][i].abs();
                            *sum += estimates.radiance[i] * cosine * tint;
                        }
                    }
                });
                let [x, y, z] = black_box(sums);
                for i in 0..block.len() {
                    total += Vec3::new(x[i], y[i], z[i]);
                }
            }
        }
        total
    }

    fn by_lists(&self, lanes: usize, sums: &mut Vec<Vec3>) -> Vec3 {
        let estimator = RadianceEstimator::new(&self.roulette).with_lanes(lanes);
        let lists = self.tiles.iter().flat_map(|tile| {
            let list = &*tile.list;
            tile.points.iter().map(move |point| (*point, list))
        });
        sums.clear();
        sums.resize(self.tiles.len() * POINTS, Vec3::ZERO);
        let add = |(mut last, mut sum), i, estimate: &Estimate| {
            if i != last {
                sums[last] = sum;
                (last, sum) = (i, Vec3::ZERO);
            }
            (
                last,
                sum + estimate.radiance * estimate.direction.x.abs() * TINT,
            )
        };
        let first = (0, Vec3::ZERO);
        let (last, sum) = estimator.fold_at_points(&self.batch, lists, first, add);
        if let Some(last) = sums.get_mut(last) {
            *last = sum;
        }
        sums.iter().sum()
    }
}

fn evaluate<L: Lobe + Copy>(
    group: &mut Group,
    name: &str,
    scene: &Scene<L>,
    widths: &[usize],
    facing: impl Fn(&L, Vec3) -> bool,
) {
    group.throughput(Throughput::Elements(scene.pairs()));
    let expected = scene.scalar(|_, _| true);
    assert_eq!(expected, scene.scalar(&facing));
    group.bench_function(format!("{name}, scalar"), |bencher| {
        bencher.iter(|| scene.scalar(|_, _| true));
    });
    group.bench_function(format!("{name}, scalar, facing first"), |bencher| {
        bencher.iter(|| scene.scalar(&facing));
    });
    group.bench_function(format!("{name}, all at points"), |bencher| {
        bencher.iter(|| scene.all_by_points());
    });
    let mut sums = Vec::new();
    for lanes in widths {
        assert_eq!(expected, scene.by_points(*lanes));
        group.bench_function(format!("{name}, {lanes} points"), |bencher| {
            bencher.iter(|| scene.by_points(*lanes));
        });
    }
    for lanes in widths {
        assert_eq!(expected, scene.by_lists(*lanes, &mut sums));
        group.bench_function(format!("{name}, {lanes} lights"), |bencher| {
            bencher.iter(|| scene.by_lists(*lanes, &mut sums));
        });
    }
}

fn is_lit<F: Fresnel>(lobe: &GgxLobe<F>, way: Vec3) -> bool {
    lobe.normal().dot(way) > 0.0
}

fn shading(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("shading");
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    let schlick = ggx(Schlick::new(0.5).expect("in range"));
    for list in [48, 30, 4] {
        let name = format!("lists of {list}");
        evaluate(
            &mut group,
            &name,
            &Scene::new(list, &schlick),
            &[16, 8, 4],
            is_lit,
        );
    }
    let glass = Dielectric::new(1.5).expect("in range");
    let gold = Conductor::new(0.16, 3.5).expect("in range");
    evaluate(
        &mut group,
        "no Fresnel factor",
        &Scene::new(30, ggx(NoFresnel)),
        &[16],
        is_lit,
    );
    evaluate(
        &mut group,
        "dielectric",
        &Scene::new(30, ggx(glass)),
        &[16],
        is_lit,
    );
    evaluate(
        &mut group,
        "conductor",
        &Scene::new(30, ggx(gold)),
        &[16],
        is_lit,
    );
    let transformed = |i| {
        let lobe = ggx(NoFresnel)(i);
        LtcLobe::new(
            lobe.ggx(),
            Schlick::new(0.5).expect("in range"),
            lobe.incidence(),
        )
    };
    evaluate(
        &mut group,
        "transformed cosine",
        &Scene::new(30, transformed),
        &[16, 8, 4],
        |lobe, way| lobe.normal().dot(way) > 0.0,
    );
    let lambert = |i| LambertLobe::new(0.5, direction(random_vector(i, 0))).expect("in range");
    evaluate(
        &mut group,
        "Lambert",
        &Scene::new(30, lambert),
        &[16],
        |lobe, way| lobe.normal().dot(way) > 0.0,
    );
    group.finish();
}

criterion_group!(benches, shading);
criterion_main!(benches);
