//! All lights of a frame against all its tiles: what the exact test of the CPU keeps, the GPU keeps too, and its lists are
//! hardly longer than those of the CPU's box test.

use std::f32::consts::TAU;

use fastrand::Rng;
use gpu::{Dispatch, Gpu};
use stochastic_light_culling::{
    Camera, DepthInterval, Direction, Ggx, GgxLobe, GpuCamera, GpuLight, GpuTile, Incidence, Paper,
    ProjectedEllipsoid, Roulette, Schlick, Seed, TileGrid, TileRectangle, Vpl, glam::Vec3, wgsl,
};

const LIGHTS: usize = 2048;
const TILES: [u32; 2] = [64, 64];
const DELTA: f32 = 0.01;

/// Two bits for each tile, for its two intervals of depths, of 16 tiles in a word.
const TEXT: &str = "
struct Placed { light: SlcLight, xi: f32 }
struct Tile { rectangle: SlcTile, depths: vec4f }
@group(0) @binding(0) var<storage, read> slc_table: array<vec4f>;
@group(0) @binding(1) var<storage, read> lights: array<SlcLight>;
@group(0) @binding(2) var<storage, read> camera: SlcCamera;
@group(0) @binding(3) var<storage, read> tiles: array<Tile>;
@group(0) @binding(4) var<storage, read_write> projected: array<SlcProjected>;
@group(0) @binding(5) var<storage, read_write> touched: array<u32>;

const DELTA: f32 = 0.01;

fn project(i: u32, unit: SlcBound) {
    let scale = slc_scale(lights[i].flux, DELTA, slc_xi(slc_frame(1u, 2u), i));
    projected[i] = slc_project(slc_placed(unit, lights[i].position, scale), camera);
}

@compute @workgroup_size(64)
fn project_tight(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&lights) {
        project(id.x, slc_tight_ggx(lights[id.x], slc_max_schlick(lights[id.x])));
    }
}

@compute @workgroup_size(64)
fn project_paper(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&lights) {
        project(id.x, slc_paper_ggx(lights[id.x], slc_max_schlick(lights[id.x])));
    }
}

@compute @workgroup_size(64)
fn touch(@builtin(global_invocation_id) id: vec3u) {
    let words = arrayLength(&tiles) / 16u;
    let light = id.x / words;
    if light >= arrayLength(&lights) { return; }
    var bits = 0u;
    for (var i = 0u; i < 16u; i++) {
        let tile = tiles[id.x % words * 16u + i];
        let near = u32(slc_touches(projected[light], tile.rectangle, tile.depths.xy));
        let far = u32(slc_touches(projected[light], tile.rectangle, tile.depths.zw));
        bits |= (near + 2u * far) << (2u * i);
    }
    touched[id.x] = bits;
}";

struct Frame {
    camera: Camera,
    lights: Vec<Vpl<GgxLobe<Schlick>>>,
    tiles: Vec<(TileRectangle, [DepthInterval; 2])>,
}

/// Lights before a camera, and what its tiles see.
fn frame(rng: &mut Rng, least_roughness: f32) -> Frame {
    let camera = Camera::look_at(
        Vec3::new(1.0, 2.0, 3.0),
        Vec3::new(9.0, 1.0, -4.0),
        Vec3::Y,
        1.1,
        1.0,
        0.1..100.0,
    );
    let camera = camera.unwrap();
    let direction = |rng: &mut Rng| {
        let (height, angle) = (2.0 * rng.f32() - 1.0, TAU * rng.f32());
        let across = (1.0 - height * height).sqrt();
        Direction::new(Vec3::new(
            across * angle.cos(),
            height,
            across * angle.sin(),
        ))
        .unwrap()
    };
    let light = |rng: &mut Rng| {
        let roughness = least_roughness.powf(rng.f32());
        let normal = direction(rng);
        let incoming = Direction::new(*direction(rng) + 1.02 * *normal).unwrap();
        let lobe = GgxLobe::new(
            Ggx::new(roughness).unwrap(),
            Schlick::new(rng.f32()).unwrap(),
            Incidence { normal, incoming },
        );
        let seen = Vec3::new(rng.f32() - 0.5, rng.f32() - 0.5, 1.0) * (0.5 + 14.0 * rng.f32());
        // About the same range, whatever the roughness.
        let flux = 8.0 * roughness * roughness * rng.f32();
        Vpl::new(camera.to_world_space(seen), flux, lobe).unwrap()
    };
    let grid = TileGrid::new(TILES.map(|n| 16 * n), 16).unwrap();
    let tiles = grid.tiles().map(|tile| {
        let near = 1.0 + 8.0 * rng.f32();
        let ends = [
            near,
            near + rng.f32(),
            near + 1.0 + 2.0 * rng.f32(),
            near + 3.0 + rng.f32(),
        ];
        let interval = |i: usize| DepthInterval::new(ends[i], ends[i + 1]).unwrap();
        (camera.tile(&grid, tile), [interval(0), interval(2)])
    });
    let tiles = tiles.collect();
    Frame {
        camera,
        lights: (0..LIGHTS).map(|_| light(rng)).collect(),
        tiles,
    }
}

/// Whether each light touches each interval of each tile, on the GPU.
fn on_the_gpu(gpu: &Gpu, frame: &Frame, project: &str) -> Vec<[bool; 2]> {
    let texts = [
        wgsl::NUM,
        wgsl::LOBE,
        wgsl::LIGHT,
        wgsl::BOUND,
        wgsl::TIGHT,
        wgsl::PROJECT,
        wgsl::TOUCH,
        TEXT,
    ];
    let lights: Vec<_> = frame.lights.iter().map(GpuLight::from).collect();
    let tile = |(rectangle, depths): &(TileRectangle, [DepthInterval; 2])| {
        let GpuTile { min, max } = GpuTile::from(rectangle);
        let [a, b] = depths;
        [
            min[0],
            min[1],
            max[0],
            max[1],
            a.near(),
            a.far(),
            b.near(),
            b.far(),
        ]
    };
    let tiles: Vec<[f32; 8]> = frame.tiles.iter().map(tile).collect();
    let words = lights.len() * tiles.len() / 16;
    let table = gpu.upload(wgsl::TABLE).unwrap();
    let lights = gpu.upload(&lights).unwrap();
    let camera = gpu.upload(&[GpuCamera::from(&frame.camera)]).unwrap();
    let tiles = gpu.upload(&tiles).unwrap();
    let projected = gpu.zeroed::<[f32; 16]>(frame.lights.len()).unwrap();
    let touched = gpu.zeroed::<u32>(words).unwrap();
    let [first, second] = [project, "touch"].map(|entry| gpu.kernel(&texts, entry).unwrap());
    let projecting = [(1, &lights), (2, &camera), (4, &projected)];
    let with_table = [&[(0, &table)], &projecting[..]].concat();
    gpu.run(&[
        Dispatch {
            kernel: &first,
            buffers: if project == "project_tight" {
                &with_table
            } else {
                &projecting
            },
            workgroups: [LIGHTS.div_ceil(64) as u32, 1, 1],
        },
        Dispatch {
            kernel: &second,
            buffers: &[(1, &lights), (3, &tiles), (4, &projected), (5, &touched)],
            workgroups: [words.div_ceil(64) as u32, 1, 1],
        },
    ])
    .unwrap();
    let bits = gpu.read::<u32>(&touched).unwrap();
    let tiles = bits
        .iter()
        .flat_map(|word| (0..16).map(move |i| word >> (2 * i)));
    tiles.map(|bits| [bits & 1 == 1, bits & 2 == 2]).collect()
}

/// The number of pairs, of those that the box test of the CPU keeps, of those that the GPU keeps, and of those that the
/// exact test keeps and the GPU does not.
fn counts(frame: &Frame, shapes: &[Option<ProjectedEllipsoid>], found: &[[bool; 2]]) -> [usize; 4] {
    let mut counts = [0; 4];
    for (shape, row) in shapes.iter().zip(found.chunks(frame.tiles.len())) {
        for ((rectangle, depths), found) in frame.tiles.iter().zip(row) {
            for (depths, found) in depths.iter().zip(found) {
                let touches = shape.is_some_and(|shape| shape.touches(rectangle, depths));
                let exactly =
                    touches && shape.is_some_and(|shape| shape.touches_exactly(rectangle, depths));
                counts[0] += 1;
                counts[1] += usize::from(touches);
                counts[2] += usize::from(*found);
                counts[3] += usize::from(exactly && !found);
            }
        }
    }
    counts
}

#[test]
fn the_gpu_keeps_what_the_cpu_keeps_and_hardly_more() {
    let gpu = Gpu::new().unwrap();
    let (roulette, seed) = (Roulette::new(DELTA).unwrap(), Seed(1).frame(2));
    // The margins grow with the aspect ratio, which is about 1/(2α).
    for (least_roughness, most_longer) in [(0.01, 1.005), (1e-4, 1.02)] {
        let frame = frame(&mut Rng::with_seed(5), least_roughness);
        let lights = || (0..).zip(&frame.lights);
        let tight =
            lights().map(|(i, light)| light.bound(&roulette, seed.xi(i)).project(&frame.camera));
        let paper = lights().map(|(i, light)| {
            light
                .bound_by(Paper, &roulette, seed.xi(i))
                .project(&frame.camera)
        });
        let shapes: [(&str, Vec<_>); 2] = [
            ("project_tight", tight.collect()),
            ("project_paper", paper.collect()),
        ];
        for (project, shapes) in shapes {
            let found = on_the_gpu(&gpu, &frame, project);
            let [pairs, boxes, kept, lost] = counts(&frame, &shapes, &found);
            let longer = kept as f64 / boxes as f64;
            println!(
                "{project}, α ≥ {least_roughness}: {pairs} pairs, {boxes} in boxes, {kept} kept, {lost} lost"
            );
            assert_eq!(lost, 0, "{project}, α ≥ {least_roughness}");
            assert!(boxes > pairs / 200, "{boxes} of {pairs} are touched");
            assert!(longer < most_longer, "{longer} times as long");
        }
    }
}
