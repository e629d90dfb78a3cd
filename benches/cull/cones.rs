//! Spot lights in clusters: how many each test lists, and how long it takes, on the same lights and ranges.
//!
//! Engines bound a spot light by a sphere of its range, and test its cone against the sphere around each cluster
//! that this leaves [Wronski 2017]. Here that test is written anew, in scalar code as theirs.

use std::hint::black_box;

use criterion::{Criterion, Throughput};
use stochastic_light_culling::{
    BatchBuilder, Bounded, Camera, ConstantLobe, Culler, DepthInterval, Direction, LightBatch,
    LightLists, Lobe, Roulette, Seed, SpotLobe, TileDepths, TileGrid, Vpl, Xi, glam::Vec3,
};

const LIGHTS: u32 = 10_000;
const SLICES: u32 = 24;
const NEAR: f32 = 0.2;
const FAR: f32 = 150.0;

/// Lamps over a street: downward within 60°, of any angle up to 100°.
fn lamps() -> Vec<(Vpl<SpotLobe>, Xi)> {
    let lamp = |i| {
        let random = |frame| Seed(7).frame(frame).hashed_xi(i).get();
        let signed = |frame| 2.0 * random(frame) - 1.0;
        let position = Vec3::new(60.0 * signed(0), 8.0 * random(1), -150.0 * random(2));
        let axis = Vec3::new(1.7 * signed(3), -1.0, 1.7 * signed(4));
        let outer = [20.0_f32, 30.0, 45.0, 60.0, 80.0, 100.0][i as usize % 6].to_radians();
        let axis = Direction::new(axis).expect("not zero");
        let lobe = SpotLobe::new(random(5) * outer, outer, axis).expect("in order");
        let lamp = Vpl::spot(position, 10.0 + 190.0 * random(6), lobe).expect("in range");
        (lamp, Seed(0).frame(0).xi(i))
    };
    (0..LIGHTS).map(lamp).collect()
}

fn camera() -> Camera {
    let eye = Vec3::new(0.0, 3.0, 0.0);
    Camera::look_at(eye, eye - Vec3::Z, Vec3::Y, 1.0, 16.0 / 9.0, NEAR..FAR).expect("a view")
}

/// A cluster as an engine has it: its box in camera space, and the sphere around that.
struct Cluster {
    min: Vec3,
    max: Vec3,
    center: Vec3,
    radius: f32,
}

struct Clusters {
    size: [usize; 2],
    columns: Vec<[f32; 2]>,
    rows: Vec<[f32; 2]>,
    slices: Vec<[f32; 2]>,
    all: Vec<Cluster>,
    lists: Vec<Vec<u32>>,
}

impl Clusters {
    fn new(tiles: &TileDepths, slices: &[DepthInterval]) -> Self {
        let size = tiles.size().map(|n| n as usize);
        let (columns, rows) = (tiles.columns().to_vec(), tiles.rows().to_vec());
        let slices: Vec<_> = slices.iter().map(|z| [z.near(), z.far()]).collect();
        let mut all = Vec::new();
        for [near, far] in &slices {
            for [low, high] in &rows {
                for [left, right] in &columns {
                    let min = Vec3::new(
                        (left * near).min(left * far),
                        (low * near).min(low * far),
                        *near,
                    );
                    let max = Vec3::new(
                        (right * near).max(right * far),
                        (high * near).max(high * far),
                        *far,
                    );
                    all.push(Cluster {
                        min,
                        max,
                        center: 0.5 * (min + max),
                        radius: 0.5 * (max - min).length(),
                    });
                }
            }
        }
        let lists = all.iter().map(|_| Vec::new()).collect();
        Self {
            size,
            columns,
            rows,
            slices,
            all,
            lists,
        }
    }

    fn entries(&self) -> usize {
        self.lists.iter().map(Vec::len).sum()
    }

    /// Lists what touches the sphere of a light's range and, if `with_cones`, its cone.
    fn assign(
        &mut self,
        lamps: &[(Vpl<SpotLobe>, Xi)],
        roulette: &Roulette,
        camera: &Camera,
        with_cones: bool,
    ) {
        for list in &mut self.lists {
            list.clear();
        }
        for (index, (lamp, xi)) in (0..).zip(lamps) {
            let range = roulette.radius(lamp.flux() * SpotLobe::PEAK, *xi);
            let center = camera.to_camera_space(lamp.position());
            let end = camera.to_camera_space(lamp.position() + *lamp.lobe().axis());
            let axis = end - center;
            let (sine, cosine) = lamp.lobe().outer_angle().sin_cos();
            let slices = touched(&self.slices, [center.z - range, center.z + range]);
            let columns = touched(&self.columns, slopes(center.x, center.z, range));
            let rows = touched_downward(&self.rows, slopes(center.y, center.z, range));
            for z in slices {
                for y in rows.clone() {
                    for x in columns.clone() {
                        let place = (z * self.size[1] + y) * self.size[0] + x;
                        let cluster = &self.all[place];
                        let nearest = center.clamp(cluster.min, cluster.max);
                        if nearest.distance_squared(center) > range * range {
                            continue;
                        }
                        if with_cones {
                            let way = cluster.center - center;
                            let along = way.dot(axis);
                            let across = (way.length_squared() - along * along).max(0.0).sqrt();
                            let is_beside = cosine * across - sine * along > cluster.radius;
                            let is_beyond = along > cluster.radius + range;
                            let is_behind = along < -cluster.radius;
                            if is_beside || is_beyond || is_behind {
                                continue;
                            }
                        }
                        self.lists[place].push(index);
                    }
                }
            }
        }
    }
}

/// The slopes that a circle spans as seen from the origin, all of them if it is around the eye's plane.
fn slopes(center: f32, depth: f32, radius: f32) -> [f32; 2] {
    let squared = depth * depth - radius * radius;
    if depth <= radius {
        return [f32::NEG_INFINITY, f32::INFINITY];
    }
    let root = radius * (squared + center * center).max(0.0).sqrt();
    [
        (center * depth - root) / squared,
        (center * depth + root) / squared,
    ]
}

/// The indices of intervals, in rising order, that meet `span`.
fn touched(intervals: &[[f32; 2]], [low, high]: [f32; 2]) -> std::ops::Range<usize> {
    let first = intervals.partition_point(|interval| interval[1] < low);
    let end = intervals.partition_point(|interval| interval[0] <= high);
    first..end.max(first)
}

/// The same of intervals in falling order: rows from the top.
fn touched_downward(intervals: &[[f32; 2]], [low, high]: [f32; 2]) -> std::ops::Range<usize> {
    let first = intervals.partition_point(|interval| interval[0] > high);
    let end = intervals.partition_point(|interval| interval[1] >= low);
    first..end.max(first)
}

/// Spheres, cones and ellipsoids on one frame of 16×9×24 clusters. Times are per light.
pub fn cones(criterion: &mut Criterion) {
    let (lamps, camera) = (lamps(), camera());
    // 1 lx: the range is 3 to 14 m at ξ = 1, and more for most.
    let roulette = Roulette::new(1.0).expect("in range");
    let grid = TileGrid::new([1280, 720], 80).expect("a size");
    let view = DepthInterval::new(NEAR, FAR).expect("in order");
    let slices: Vec<_> = view.exponential_slices(SLICES).collect();
    let mut tiles = TileDepths::new(&grid, &camera, SLICES).expect("few enough");
    for tile in grid.tiles() {
        tiles.set(tile, slices.iter().map(|slice| Some(*slice)));
    }

    let mut group = criterion.benchmark_group("clusters");
    group.throughput(Throughput::Elements(u64::from(LIGHTS)));
    group.sample_size(20);
    let mut clusters = Clusters::new(&tiles, &slices);
    for (name, with_cones) in [
        ("scalar spheres", false),
        ("scalar spheres and cones", true),
    ] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| clusters.assign(black_box(&lamps), &roulette, &camera, with_cones));
        });
        // Not timed, in case this one is not among those that are run.
        clusters.assign(&lamps, &roulette, &camera, with_cones);
        println!(
            "{name}: {} entries in {} clusters",
            clusters.entries(),
            clusters.lists.len()
        );
    }
    let lost = lost(&clusters, &lamps, &roulette, &camera);
    println!(
        "of lights beyond 90°, a cone test loses {lost} clusters that hold points lit from behind"
    );

    let builder = BatchBuilder::new(&roulette, &camera);
    let mut lists = LightLists::new();
    let spheres: Vec<_> = lamps.iter().map(|_| ConstantLobe.unit_bound()).collect();
    let mut batch = LightBatch::new();
    let mut culler = Culler::new();
    group.bench_function("spheres, batched and culled", |bencher| {
        bencher.iter(|| {
            batch.clear();
            let placed = (0..).zip(black_box(&lamps)).zip(&spheres);
            let placed = placed.map(|((i, (lamp, xi)), sphere)| {
                (i, sphere, lamp.position(), roulette.scale(lamp.flux(), *xi))
            });
            builder.add_placed(placed, &mut batch);
            culler.cull(&batch, &tiles, &mut lists).expect("few enough");
        });
    });
    println!("spheres: {} entries", lists.lights().len());

    for (name, mut culler) in [
        ("ellipsoids, batched and culled", Culler::new()),
        (
            "ellipsoids, batched and culled, exact",
            Culler::new().with_exact_test(),
        ),
    ] {
        let mut batch = LightBatch::new();
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                batch.clear();
                let indexed = (0..).zip(black_box(&lamps));
                builder.add(indexed.map(|(i, (lamp, xi))| (i, lamp, *xi)), &mut batch);
                culler.cull(&batch, &tiles, &mut lists).expect("few enough");
            });
        });
        println!("{name}: {} entries", lists.lights().len());
    }
}

/// Clusters whose centre accepts a light that is not in their list.
fn lost(
    clusters: &Clusters,
    lamps: &[(Vpl<SpotLobe>, Xi)],
    roulette: &Roulette,
    camera: &Camera,
) -> usize {
    let mut lost = 0;
    for (cluster, list) in clusters.all.iter().zip(&clusters.lists) {
        let point = camera.to_world_space(cluster.center);
        for (index, (lamp, xi)) in (0..).zip(lamps) {
            let (direction, squared) = lamp.direction_to(point);
            // Most are too far, or dark.
            let is_lit = lamp.lobe().value(direction) > 0.0
                && roulette.accepts(lamp.radiant_intensity(direction), squared, *xi);
            if is_lit && !list.contains(&index) {
                assert!(lamp.lobe().outer_angle() > std::f32::consts::FRAC_PI_2);
                lost += 1;
            }
        }
    }
    lost
}
