//! The kernel of lists on the two fixed workloads: no light of the exact test is lost, and the lists are hardly longer
//! than those of the crate.

use gpu::{Caller, Frame, Gpu, Map, Method};
use stochastic_light_culling::{
    Camera, Culler, DepthInterval, GpuBound, GpuBuffer, GpuFrame, GpuProjected, Interleave,
    LightBatch, LightLists, Roulette, TileDepths, wgsl,
};
use support::workload::{self, Depths, LIGHTS, SUBREGIONS, Subregion, TILES, Tile, halves};

/// Projects a bound on the GPU.
const PROJECT: Map = Map {
    sources: &[
        wgsl::FUNCTIONS,
        "struct Bounded { bound: SlcBound, camera: SlcCamera }",
    ],
    input: "Bounded",
    output: "SlcProjected",
    body: "return slc_project(input.bound, input.camera);",
};

#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Bounded {
    bound: GpuBound,
    camera: stochastic_light_culling::GpuCamera,
}

/// The depth intervals of a tile.
type Parts = dyn Fn(&Tile) -> Vec<DepthInterval>;

/// The frame of the workloads on the GPU.
struct Workload<'a> {
    frame: Frame<'a>,
    record: GpuFrame,
}

impl<'a> Workload<'a> {
    fn new(gpu: &'a Gpu, subregions: &[Subregion], intervals: u32) -> Self {
        let camera = workload::camera();
        let interleave = Interleave::new([1920, 1080], 8).unwrap();
        let lights = (SUBREGIONS * LIGHTS) as u32;
        let roulette = Roulette::new(1.0).unwrap();
        let record = GpuFrame::new(&camera, &interleave, &roulette, lights).unwrap();
        let record = record.with_lists(intervals, record.room).unwrap();
        let unlit = vec![bytemuck::Zeroable::zeroed(); lights as usize];
        let mut frame = Frame::new(gpu, record, &unlit, (&camera, &interleave)).unwrap();
        let projected = projected(gpu, &camera, subregions);
        frame.replace(GpuBuffer::Projected, &projected).unwrap();
        let edges = edges(subregions);
        frame.replace(GpuBuffer::Edges, &edges).unwrap();
        // Those of the crate are the same, but for rounding; its rows are numbered from above.
        let own = record.edges(&camera, &interleave).flatten();
        let columns = edges.as_flattened()[..8 * 2 * TILES[0] as usize].iter();
        for (given, own) in columns.zip(own) {
            assert!((given - own).abs() < 1e-6, "{given} {own}");
        }
        Self { frame, record }
    }

    /// The lists of each interval of each tile, in the order of subregions, tiles and intervals.
    fn lists(&mut self, gpu: &Gpu, subregions: &[Subregion], parts: &Parts) -> Vec<Vec<u32>> {
        let tiles = subregions.iter().flat_map(|subregion| &subregion.tiles);
        let intervals = tiles.flat_map(parts);
        let intervals: Vec<[f32; 2]> = intervals.map(|d| [d.near(), d.far()]).collect();
        self.frame
            .replace(GpuBuffer::Intervals, &intervals)
            .unwrap();
        let compiled = self
            .frame
            .compile(Method::ListsAlone, [Caller::NONE; 2])
            .unwrap();
        self.frame.run(&compiled).unwrap();
        let ranges: Vec<[u32; 2]> = gpu.read(self.frame.buffer(GpuBuffer::Ranges)).unwrap();
        let lights: Vec<u32> = gpu.read(self.frame.buffer(GpuBuffer::Lists)).unwrap();
        let needed: Vec<u32> = gpu.read(self.frame.buffer(GpuBuffer::Needed)).unwrap();
        assert_eq!(ranges.len() as u64, self.record.lists());
        let list = |[start, end]: &[u32; 2]| lights[*start as usize..*end as usize].to_vec();
        let lists: Vec<Vec<u32>> = ranges.iter().map(list).collect();
        assert_eq!(
            needed[0] as usize,
            lists.iter().map(Vec::len).sum::<usize>()
        );
        assert!(lists.iter().all(|list| list.is_sorted()));
        lists
    }
}

/// Light `i` of subregion `s` has the index 64 i + s.
fn projected(gpu: &Gpu, camera: &Camera, subregions: &[Subregion]) -> Vec<GpuProjected> {
    let light = |i: usize| &subregions[i % SUBREGIONS].lights[i / SUBREGIONS];
    let bounded = (0..SUBREGIONS * LIGHTS).map(|i| Bounded {
        bound: GpuBound::from(&light(i).ellipsoid()),
        camera: camera.into(),
    });
    gpu.map(&PROJECT, &bounded.collect::<Vec<_>>()).unwrap()
}

/// The slopes of columns, from the first row of subregions, and of rows, from the first column.
fn edges(subregions: &[Subregion]) -> Vec<[f32; 2]> {
    let [columns, rows] = TILES.map(|n| n as usize);
    let across = (0..8).flat_map(|s| {
        (0..columns)
            .map(move |x| subregions[s].tiles[x].rectangle())
            .map(|r| [r.min().x, r.max().x])
    });
    let down = (0..8).flat_map(|s| {
        let tiles = &subregions[8 * s].tiles;
        (0..rows)
            .map(move |y| tiles[y * columns].rectangle())
            .map(|r| [r.min().y, r.max().y])
    });
    across.chain(down).collect()
}

/// The lists of the crate, with or without the exact test.
fn lists_of_cpu(subregions: &[Subregion], parts: &Parts, exactly: bool) -> Vec<Vec<u32>> {
    let camera = workload::camera();
    let mut culler = Culler::new();
    if exactly {
        culler = culler.with_exact_test();
    }
    let mut found = Vec::new();
    for (s, subregion) in (0..).zip(subregions) {
        let mut batch = LightBatch::new();
        let stretches = subregion.lights.iter().map(|light| light.stretch(&camera));
        batch.extend((0..).map(|i| 64 * i + s).zip(stretches));
        let mut lists = LightLists::new();
        let at = |[x, y]: [u32; 2]| &subregion.tiles[(y * TILES[0] + x) as usize];
        let count = parts(at([0, 0])).len() as u32;
        let mut depths =
            TileDepths::from_rectangles(TILES, count, |tile| at(tile).rectangle()).unwrap();
        let tiles = (0..TILES[1]).flat_map(|y| (0..TILES[0]).map(move |x| [x, y]));
        for tile in tiles.clone() {
            depths.set(tile, parts(at(tile)));
        }
        culler.cull(&batch, &depths, &mut lists).unwrap();
        let of_tile = |tile| (0..count).map(move |interval| (tile, interval));
        found.extend(
            tiles
                .flat_map(of_tile)
                .map(|(tile, k)| lists.of(tile, k).to_vec()),
        );
    }
    found
}

fn pairs(lists: &[Vec<u32>]) -> usize {
    lists.iter().map(Vec::len).sum()
}

/// How many lights of the exact test are not listed.
fn lost(exact: &[Vec<u32>], lists: &[Vec<u32>]) -> usize {
    let of_tile = |(exact, listed): (&Vec<u32>, &Vec<u32>)| {
        exact
            .iter()
            .filter(|light| listed.binary_search(light).is_err())
            .count()
    };
    exact.iter().zip(lists).map(of_tile).sum()
}

#[test]
fn lists_hold_all_lights_of_the_exact_test_and_hardly_more_than_those_of_the_crate() {
    let gpu = Gpu::new().unwrap();
    let subregions = workload::frame();
    let mut workload = Workload::new(&gpu, &subregions, 2);
    // What the box test with bounds finds in `f64`, in near intervals and in far ones.
    let kinds: [(Depths, [usize; 2]); 2] = [
        (|tile| tile.scattered, [16_251, 28_337]),
        (|tile| tile.coherent, [2_282, 3_039]),
    ];
    for (depths, known) in kinds {
        let parts = move |tile: &Tile| halves(depths(tile)).to_vec();
        let lists = workload.lists(&gpu, &subregions, &parts);
        for (part, known) in known.into_iter().enumerate() {
            let found: usize = lists.iter().skip(part).step_by(2).map(Vec::len).sum();
            println!("{found} lights, known {known}");
            assert!(
                known <= found && found <= known + known / 200,
                "{found}, known {known}"
            );
        }
        let exact = lists_of_cpu(&subregions, &parts, true);
        assert_eq!(lost(&exact, &lists), 0);
        let boxes = lists_of_cpu(&subregions, &parts, false);
        assert!(pairs(&lists) <= pairs(&boxes) + pairs(&boxes) / 200);
        println!(
            "{} by the box test of the crate, {} by its exact test",
            pairs(&boxes),
            pairs(&exact)
        );
    }
}

/// As clustered shading has them.
#[test]
fn a_tile_may_have_any_number_of_intervals() {
    let gpu = Gpu::new().unwrap();
    let subregions = workload::frame();
    for count in [1, 9] {
        let parts = move |tile: &Tile| -> Vec<DepthInterval> {
            let [near, far] = tile.coherent.map(|depth| depth as f32);
            let whole = DepthInterval::new(near, far).unwrap();
            whole.exponential_slices(count).collect()
        };
        let lists = Workload::new(&gpu, &subregions, count).lists(&gpu, &subregions, &parts);
        let exact = lists_of_cpu(&subregions, &parts, true);
        assert_eq!(lists.len(), exact.len());
        assert_eq!(lost(&exact, &lists), 0);
        let (found, boxes) = (
            pairs(&lists),
            pairs(&lists_of_cpu(&subregions, &parts, false)),
        );
        println!("{count} intervals: {found} lights, {boxes} by the crate");
        assert!(found <= boxes + boxes / 100);
    }
}
