//! Culling against the receivers of tiles, on a floor with waves: clusters from a G-buffer, per pixel; tests of pairs
//! of a light and a tile beside the box test; and whole frames.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use stochastic_light_culling::{
    BatchBuilder, Blind, Camera, Culler, DepthInterval, Direction, Ggx, GgxLobe, Incidence,
    LambertLobe, LightBatch, LightLists, LobeFamily, LobeSum, ProjectedEllipsoid, Receiver,
    ReceiverCluster, ReceiverCuller, ReceiverLobe, Roulette, Schlick, Seed, ShadingBatch,
    TileDepths, TileGrid, TileProbability, TileReceivers, Vpl, WeightedLists, Xi, glam::Vec3,
};

const SIZE: [u32; 2] = [960, 540];
const LIGHTS: u32 = 16_384;
const EYE: Vec3 = Vec3::new(0.0, 6.0, 8.0);

type Group<'a> = BenchmarkGroup<'a, criterion::measurement::WallTime>;
type Glossy = GgxLobe<Schlick>;

fn random(light: u32, frame: u32) -> f32 {
    2.0 * Seed(77).frame(frame).hashed_xi(light).get() - 1.0
}

fn random_vector(light: u32, first: u32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|i| random(light, first + i)))
}

fn direction(vector: Vec3) -> Direction {
    Direction::new(vector).expect("not zero")
}

fn glossy(alpha: f32, normal: Direction, incoming: Direction) -> Glossy {
    let (ggx, fresnel) = (Ggx::new(alpha), Schlick::new(0.9));
    let incidence = Incidence { normal, incoming };
    GgxLobe::new(
        ggx.expect("in range"),
        fresnel.expect("in range"),
        incidence,
    )
}

/// What the pixels of a frame see, and the lights.
struct Scene {
    camera: Camera,
    /// Positions and normals, row by row.
    points: Vec<(Vec3, Direction)>,
    lights: Vec<(Vpl<Glossy>, Xi)>,
    batch: ShadingBatch<Glossy>,
}

impl Scene {
    fn new() -> Self {
        let target = Vec3::ZERO;
        let camera = Camera::look_at(EYE, target, Vec3::Y, 0.9, 16.0 / 9.0, 0.1..100.0);
        let camera = camera.expect("in range");
        let to_world = camera.rotation().transpose();
        let grid = TileGrid::new(SIZE, SIZE[0]).expect("positive");
        let points = grid.pixels([0; 2]).pixels().map(|pixel| {
            let ray = to_world * camera.point_in_pixel(SIZE, pixel, 1.0);
            let position = EYE + ray * (-EYE.y / ray.y.min(-0.05));
            let slope = Vec3::new(0.2 * position.x.cos(), 1.0, 0.2 * position.z.cos());
            (position, direction(slope))
        });
        let light = |i: u32| {
            let (normal, incoming) = (random_vector(i, 0), random_vector(i, 3));
            let incoming = incoming * incoming.dot(normal).signum();
            let lobe = glossy(0.1, direction(normal), direction(incoming));
            let position = Vec3::new(8.0, 1.5, 6.0) * random_vector(i, 6) + Vec3::Y * 1.6;
            let vpl = Vpl::new(position, 1.0, lobe).expect("in range");
            (vpl, Seed(3).frame(9).hashed_xi(i))
        };
        let lights: Vec<_> = (0..LIGHTS).map(light).collect();
        let mut batch = ShadingBatch::new();
        batch.extend(lights.iter().map(|(vpl, xi)| (vpl, *xi)));
        Self {
            camera,
            points: points.collect(),
            lights,
            batch,
        }
    }

    fn receivers<R>(&self, lobe: impl Fn(Direction, Direction) -> R) -> Vec<Receiver<R>> {
        let receiver = |(position, normal): &(Vec3, Direction)| Receiver {
            position: *position,
            lobe: lobe(*normal, direction(EYE - *position)),
        };
        self.points.iter().map(receiver).collect()
    }
}

/// The index of a pixel.
fn whole([x, y]: [u32; 2]) -> usize {
    (y * SIZE[0] + x) as usize
}

/// The index of a pixel of the first tile, in place of those of all others: a G-buffer that the cache holds.
fn first_tile([x, y]: [u32; 2]) -> usize {
    whole([x % 16, y % 16])
}

/// Fills `tiles` from a G-buffer.
fn fill<R: ReceiverLobe>(
    tiles: &mut TileReceivers<R::Family>,
    receivers: &[Receiver<R>],
    index: impl Fn([u32; 2]) -> usize,
) {
    let grid = tiles.parts_grid();
    tiles.fill(|part, _| {
        let pixels = grid.pixels(part).pixels();
        let receivers = pixels.map(|pixel| &receivers[index(pixel)]);
        ReceiverCluster::of(receivers.map(|receiver| (receiver.position, receiver.lobe.family())))
    });
}

fn records<R: ReceiverLobe>(group: &mut Group, name: &str, receivers: &[Receiver<R>]) {
    let grid = TileGrid::new(SIZE, 16).expect("positive");
    for parts in [1, 2, 4] {
        let mut tiles = TileReceivers::new(&grid, parts, 1).expect("few");
        group.bench_function(format!("{name}, {parts}×{parts} parts"), |b| {
            b.iter(|| fill(black_box(&mut tiles), receivers, whole));
        });
    }
    let mut tiles = TileReceivers::new(&grid, 1, 1).expect("few");
    group.bench_function(format!("{name}, read from the cache"), |b| {
        b.iter(|| fill(black_box(&mut tiles), receivers, first_tile));
    });
}

/// All lights against one tile, or 64 of them.
fn pairs<F: LobeFamily>(
    group: &mut Group,
    name: &str,
    scene: &Scene,
    family: impl Fn(Vec3, Direction) -> F,
) {
    let grid = TileGrid::new(SIZE, 16).expect("positive");
    let one = TileGrid::new([16, 16], 16).expect("positive");
    let mut tiles = TileReceivers::new(&one, 1, 1).expect("few");
    tiles.fill(|_, _| {
        let pixels = grid.pixels([30, 20]).pixels();
        let points = pixels.map(|[x, y]| scene.points[(y * SIZE[0] + x) as usize]);
        ReceiverCluster::of(points.map(|(position, normal)| (position, family(position, normal))))
    });
    let (mut culler, mut lists) = (ReceiverCuller::new(&roulette()), LightLists::new());
    group.bench_function(name, |b| {
        b.iter(|| culler.cull(&scene.batch, black_box(&tiles), &mut lists));
    });
}

fn roulette() -> Roulette {
    Roulette::new(0.05).expect("positive")
}

fn box_batch(scene: &Scene) -> LightBatch<ProjectedEllipsoid> {
    let mut batch = LightBatch::new();
    let lights = (0..).zip(&scene.lights).map(|(i, (vpl, xi))| (i, vpl, *xi));
    BatchBuilder::new(&roulette(), &scene.camera).add(lights, &mut batch);
    batch
}

/// The box test of all lights against one tile: as many as a vector has lanes, whatever their bounds.
fn box_pairs(group: &mut Group, scene: &Scene) {
    let grid = TileGrid::new(SIZE, 16).expect("positive");
    let rectangle = scene.camera.tile(&grid, [30, 20]);
    let mut tiles = TileDepths::from_rectangles([1, 1], 1, |_| rectangle).expect("few");
    tiles.set([0, 0], [DepthInterval::new(8.0, 9.0).expect("in order")]);
    let (batch, mut lists) = (box_batch(scene), LightLists::new());
    let mut culler = Culler::new().without_blocks();
    group.throughput(Throughput::Elements(batch.len() as u64));
    group.bench_function("box", |b| {
        b.iter(|| culler.cull(black_box(&batch), &tiles, &mut lists));
    });
}

fn frames(group: &mut Group, scene: &Scene) {
    let grid = TileGrid::new(SIZE, 16).expect("positive");
    let depth = |point: &(Vec3, Direction)| scene.camera.to_camera_space(point.0).z;
    let mut depths = TileDepths::new(&grid, &scene.camera, 1).expect("few");
    for tile in grid.tiles() {
        let pixels = grid.pixels(tile).pixels();
        let points = pixels.map(|[x, y]| depth(&scene.points[(y * SIZE[0] + x) as usize]));
        depths.set(tile, [DepthInterval::around(points)]);
    }
    let (mut culler, mut lists) = (Culler::new(), LightLists::new());
    group.bench_function("boxes of tight bounds, with the batch", |b| {
        b.iter(|| culler.cull(&box_batch(scene), &depths, &mut lists));
    });
    println!("{} pairs", lists.len());

    let mut culler = ReceiverCuller::new(&roulette());
    let mut lists = WeightedLists::new();
    let mut tiles = TileReceivers::new(&grid, 1, 1).expect("few");
    tiles.fill(|tile, _| {
        let pixels = grid.pixels(tile).pixels();
        let points = pixels.map(|[x, y]| scene.points[(y * SIZE[0] + x) as usize].0);
        ReceiverCluster::of(points.map(|position| (position, Blind)))
    });
    group.bench_function("blind, drawn by the bound", |b| {
        b.iter(|| culler.draw(TileProbability::bound(), &scene.batch, &tiles, &mut lists));
    });
    println!(
        "{} pairs, {} tests",
        lists.weights().len(),
        culler.pair_tests()
    );

    for parts in [1, 2, 4] {
        let mut tiles = TileReceivers::new(&grid, parts, 1).expect("few");
        fill(
            &mut tiles,
            &scene.receivers(|normal, eye| glossy(0.12, normal, eye)),
            whole,
        );
        let name = format!("glossy, drawn by mean square, {parts}×{parts} parts");
        group.bench_function(name, |b| {
            b.iter(|| culler.draw(TileProbability::default(), &scene.batch, &tiles, &mut lists));
        });
        println!(
            "{} pairs, {} tests",
            lists.weights().len(),
            culler.pair_tests()
        );
    }
}

fn all(c: &mut Criterion) {
    let scene = Scene::new();
    let mut group = c.benchmark_group("clusters of receivers");
    group.measurement_time(Duration::from_secs(2));
    group.throughput(Throughput::Elements(scene.points.len() as u64));
    let lambert = |normal, _| LambertLobe::new(0.8, normal).expect("in range");
    records(&mut group, "diffuse", &scene.receivers(lambert));
    let shiny = |normal, eye| glossy(0.12, normal, eye);
    records(&mut group, "glossy", &scene.receivers(shiny));
    let varnished = |normal, eye| LobeSum::new(lambert(normal, eye), shiny(normal, eye));
    records(
        &mut group,
        "diffuse and glossy",
        &scene.receivers(varnished),
    );
    group.finish();

    let mut group = c.benchmark_group("pairs of a light and a tile");
    group.measurement_time(Duration::from_secs(2));
    box_pairs(&mut group, &scene);
    group.throughput(Throughput::Elements(LIGHTS.into()));
    pairs(&mut group, "blind", &scene, |_, _| Blind);
    pairs(&mut group, "diffuse", &scene, |_, normal| {
        lambert(normal, normal).family()
    });
    pairs(&mut group, "glossy", &scene, |position, normal| {
        shiny(normal, direction(EYE - position)).family()
    });
    group.finish();

    let mut group = c.benchmark_group("frame of 16,384 lights, 960×540");
    group
        .measurement_time(Duration::from_secs(2))
        .sample_size(20);
    frames(&mut group, &scene);
    group.finish();
}

criterion_group!(benches, all);
criterion_main!(benches);
