//! Culling many lights against many tiles gives what the test of one light against one tile gives.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use stochastic_light_culling::{
    BoxTest, Camera, CullCounters, Culler, DepthInterval, Ellipsoid, Error, LightBatch, LightLists,
    PixelRectangle, ProjectedEllipsoid, ProjectedSphere, Sphere, TileDepths, TileRectangle,
    glam::{Mat3, Vec2, Vec3},
};
use support::generators::{self, cases};
use support::workload::{self, Depths, Subregion};

fn camera() -> Camera {
    Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.2, 1.5, 0.1..100.0).unwrap()
}

/// How many tiles, and what each of them sees.
#[derive(Clone, Debug)]
struct Grid {
    size: [u32; 2],
    depths: Vec<Vec<Option<DepthInterval>>>,
}

impl Grid {
    fn rectangle(&self, [x, y]: [u32; 2]) -> TileRectangle {
        let pixels = PixelRectangle {
            min: [x, y],
            max: [x + 1, y + 1],
        };
        camera().tile_rectangle(self.size, pixels)
    }

    fn tiles(&self) -> impl Iterator<Item = ([u32; 2], &Vec<Option<DepthInterval>>)> {
        let [width, height] = self.size;
        let positions = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        positions.zip(&self.depths)
    }

    fn tile_depths(&self) -> TileDepths {
        let intervals = self.depths[0].len() as u32;
        let mut tiles =
            TileDepths::from_rectangles(self.size, intervals, |tile| self.rectangle(tile)).unwrap();
        for (tile, depths) in self.tiles() {
            tiles.set(tile, depths.iter().copied());
        }
        tiles
    }
}

fn grid() -> impl Strategy<Value = Grid> {
    let interval = prop_oneof![
        1 => Just(None),
        1 => Just(DepthInterval::new(0.0, f32::MAX).ok()),
        6 => (0.01..60.0_f32, 1.0..4.0_f32)
            .prop_map(|(near, ratio)| DepthInterval::new(near, near * ratio).ok()),
    ];
    ([1..60_u32, 1..30_u32], 1..4_usize).prop_flat_map(move |(size, intervals)| {
        let depths = prop::collection::vec(interval.clone(), intervals);
        let depths = prop::collection::vec(depths, (size[0] * size[1]) as usize);
        depths.prop_map(move |depths| Grid { size, depths })
    })
}

/// In camera space, at all distances and sizes, and now and then everywhere.
fn stretch() -> impl Strategy<Value = ProjectedEllipsoid> {
    let center = (-30.0..30.0_f32, -20.0..20.0_f32, -50.0..5.0_f32);
    let ellipsoid = (center, generators::ellipsoid(), -3.0..0.5_f32);
    let anywhere = ellipsoid.prop_map(|((x, y, z), shape, size)| {
        let semi_axes = shape.semi_axes() / shape.semi_axes().max_element();
        let semi_axes = semi_axes * (10_f32.powf(size) * z.abs().max(0.1));
        Ellipsoid::new(Vec3::new(x, y, z), shape.rotation(), semi_axes).unwrap()
    });
    let huge = Just(Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::splat(1e38)).unwrap());
    let distant =
        Just(Ellipsoid::new(Vec3::splat(1e30), Mat3::IDENTITY, Vec3::splat(1.0)).unwrap());
    prop_oneof![30 => anywhere, 1 => huge, 1 => distant]
        .prop_map(|ellipsoid| ellipsoid.project(&camera()).unwrap())
}

fn sphere() -> impl Strategy<Value = ProjectedSphere> {
    let center = (-30.0..30.0_f32, -20.0..20.0_f32, -50.0..5.0_f32);
    let radius = prop_oneof![30 => generators::log_uniform(1e-2, 20.0), 1 => Just(1e38)];
    (center, radius).prop_map(|((x, y, z), radius)| {
        let sphere = Sphere::new(Vec3::new(x, y, z), radius as f32).unwrap();
        sphere.project(&camera()).unwrap()
    })
}

/// The parallel lists are the serial ones, to the last number.
#[cfg(feature = "rayon")]
fn culled_in_parallel_as_serially<T: BoxTest + Send + Sync>(
    grid: &Grid,
    shapes: &[T],
) -> Result<(), TestCaseError> {
    let tiles = grid.tile_depths();
    let mut batch = LightBatch::new();
    batch.extend((0..).zip(shapes.iter().copied()));
    for mut culler in [Culler::new(), Culler::new().with_exact_test()] {
        let [mut serial, mut parallel] = [LightLists::new(), LightLists::new()];
        let counters = culler.cull(&batch, &tiles, &mut serial).unwrap();
        let counted = culler.cull_in_parallel(&batch, &tiles, &mut parallel);
        prop_assert_eq!(serial.ranges(), parallel.ranges());
        prop_assert_eq!(serial.lights(), parallel.lights());
        prop_assert_eq!(counters.rejected_exactly, counted.unwrap().rejected_exactly);
    }
    Ok(())
}

/// All cullers, each of which must find the same.
fn cullers<T: BoxTest>() -> impl Iterator<Item = Culler<T>> {
    let flat_or_not = |lanes| {
        [
            Culler::with_lanes(lanes),
            Culler::with_lanes(lanes).without_blocks(),
        ]
    };
    [16, 8, 4].into_iter().flat_map(flat_or_not)
}

type Test<T> = fn(&T, &TileRectangle, &DepthInterval) -> bool;

fn culled_as_one_by_one<T: BoxTest + Send + Sync>(
    grid: &Grid,
    shapes: &[T],
) -> Result<(), TestCaseError> {
    #[cfg(feature = "rayon")]
    culled_in_parallel_as_serially(grid, shapes)?;
    for culler in cullers() {
        let boxes = culled_by(culler.clone(), T::touches, grid, shapes)?;
        let exact = culled_by(culler.with_exact_test(), T::touches_exactly, grid, shapes)?;
        prop_assert_eq!(boxes.rejected_exactly, 0);
        prop_assert_eq!(exact.rejected_exactly, boxes.pairs - exact.pairs);
    }
    Ok(())
}

fn culled_by<T: BoxTest>(
    mut culler: Culler<T>,
    test: Test<T>,
    grid: &Grid,
    shapes: &[T],
) -> Result<CullCounters, TestCaseError> {
    let tiles = grid.tile_depths();
    let mut batch = LightBatch::new();
    batch.extend((100..).zip(shapes.iter().copied()));
    let mut lists = LightLists::new();
    let counters = culler.cull(&batch, &tiles, &mut lists).unwrap();
    let mut pairs = 0;
    for (tile, depths) in grid.tiles() {
        for (interval, depths) in (0..).zip(depths) {
            let touches = |shape: &T| {
                depths.is_some_and(|depths| test(shape, &grid.rectangle(tile), &depths))
            };
            let touching = (100..).zip(shapes).filter(|(_, shape)| touches(shape));
            let expected: Vec<u32> = touching.map(|(number, _)| number).collect();
            let found = lists.of(tile, interval);
            prop_assert_eq!(found, &expected, "{:?} {:?}", tile, depths);
            pairs += expected.len();
        }
    }
    prop_assert_eq!(lists.len(), pairs);
    prop_assert_eq!(counters.pairs, pairs as u64);
    Ok(counters)
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn lists_of_ellipsoids_are_those_of_the_scalar_test(
        grid in grid(),
        shapes in prop::collection::vec(stretch(), 0..150),
    ) {
        culled_as_one_by_one(&grid, &shapes)?;
    }

    #[test]
    fn lists_of_spheres_are_those_of_the_scalar_test(
        grid in grid(),
        shapes in prop::collection::vec(sphere(), 0..150),
    ) {
        culled_as_one_by_one(&grid, &shapes)?;
    }
}

/// Of all rectangles that there can be, and of pixels as far outside the image as can be said.
#[test]
fn lists_of_extreme_tiles_are_those_of_the_scalar_test() {
    let mut rng = fastrand::Rng::with_seed(3);
    let slopes = [0.0, 1e-45, 1.0, 200.0, 1e6, 1e9, 1e18, 1e30, 3e38];
    let slopes = slopes.iter().flat_map(|slope| [-slope, *slope]);
    let slopes: Vec<f32> = slopes.collect();
    let depths = [0.0, 1e-45, 1e-20, 1.0, 2.0, 1e20, f32::MAX];
    for _ in 0..100 {
        let side = |rng: &mut fastrand::Rng| {
            let [a, b] = [(); 2].map(|()| slopes[rng.usize(0..slopes.len())]);
            TileRectangle::new(Vec2::splat(a.min(b)), Vec2::splat(a.max(b))).ok()
        };
        let [across, down] = [(); 2].map(|()| -> Vec<TileRectangle> {
            std::iter::repeat_with(|| side(&mut rng))
                .flatten()
                .take(12)
                .collect()
        });
        let of_pixels = rng.bool();
        let rectangle = |[x, y]: [u32; 2]| {
            if of_pixels {
                let min = [x, y].map(|n| if n == 0 { 0 } else { u32::MAX >> (2 * n) });
                let max = [x, y].map(|n| u32::MAX >> n);
                return camera().tile_rectangle([1, 1], PixelRectangle { min, max });
            }
            let [across, down] = [across[x as usize], down[y as usize]];
            let (x, y) = (
                [across.min().x, across.max().x],
                [down.min().y, down.max().y],
            );
            TileRectangle::new(Vec2::new(x[0], y[0]), Vec2::new(x[1], y[1])).unwrap()
        };
        let mut tiles = TileDepths::from_rectangles([12, 12], 1, rectangle).unwrap();
        let mut seen = Vec::new();
        for tile in (0..144).map(|i| [i % 12, i / 12]) {
            let [a, b] = [(); 2].map(|()| depths[rng.usize(0..depths.len())]);
            let interval = DepthInterval::new(a.min(b), a.max(b)).unwrap();
            tiles.set(tile, [interval]);
            seen.push((tile, interval));
        }
        let shapes: Vec<ProjectedEllipsoid> = (0..60)
            .map(|_| {
                let mut size =
                    |least: f32, most: f32| 10_f32.powf(least + (most - least) * rng.f32());
                let longest = size(-38.0, 38.0);
                let semi_axes = Vec3::new(1.0, size(-8.9, 0.0), size(-8.9, 0.0)) * longest;
                let semi_axes = semi_axes.max(Vec3::splat(f32::MIN_POSITIVE));
                let distance = size(-38.0, 38.0);
                let way = Vec3::new(size(-6.0, 0.0), -size(-6.0, 0.0), size(-6.0, 0.0) - 0.5);
                let rotation =
                    Mat3::from_rotation_y(size(-4.0, 1.0)) * Mat3::from_rotation_z(size(-4.0, 1.0));
                let ellipsoid = Ellipsoid::new(way * distance, rotation, semi_axes).unwrap();
                let stretch = ellipsoid.project(&camera()).unwrap();
                // What the limit of the slopes relies on.
                let elements = stretch.matrix().to_cols_array();
                assert!(elements.iter().all(|element| element.abs() <= 1e33));
                assert!(stretch.center().is_finite());
                stretch
            })
            .collect();
        let mut batch = LightBatch::new();
        batch.extend((0..).zip(shapes.iter().copied()));
        for exact in [false, true] {
            for culler in cullers() {
                let mut culler = if exact {
                    culler.with_exact_test()
                } else {
                    culler
                };
                let mut lists = LightLists::new();
                culler.cull(&batch, &tiles, &mut lists).unwrap();
                for (tile, depths) in &seen {
                    let rectangle = rectangle(*tile);
                    let touches = |shape: &ProjectedEllipsoid| {
                        if exact {
                            shape.touches_exactly(&rectangle, depths)
                        } else {
                            shape.touches(&rectangle, depths)
                        }
                    };
                    let touching = (0..).zip(&shapes).filter(|(_, shape)| touches(shape));
                    let expected: Vec<u32> = touching.map(|(number, _)| number).collect();
                    assert_eq!(lists.of(*tile, 0), expected, "{rectangle:?} {depths:?}");
                }
            }
        }
    }
}

#[test]
fn memory_is_reused_without_a_trace_of_earlier_frames() {
    let mut runner = TestRunner::deterministic();
    let mut draw = |lights: std::ops::Range<usize>| {
        let frame = (grid(), prop::collection::vec(stretch(), lights));
        frame.new_tree(&mut runner).unwrap().current()
    };
    let mut culler = Culler::new();
    let mut batch = LightBatch::new();
    let mut lists = LightLists::new();
    for lights in [300..301, 20..21, 0..1, 500..501, 3..4] {
        let (grid, shapes) = draw(lights);
        let tiles = grid.tile_depths();
        batch.clear();
        batch.extend((0..).zip(shapes));
        culler.cull(&batch, &tiles, &mut lists).unwrap();
        let mut fresh = LightLists::new();
        Culler::new()
            .cull(&batch.clone(), &tiles, &mut fresh)
            .unwrap();
        assert_eq!(lists.ranges(), fresh.ranges());
        assert_eq!(lists.lights(), fresh.lights());
    }
}

#[test]
fn nothing_is_found_where_there_is_nothing() {
    let camera = camera();
    let tiles = |intervals| {
        let rectangle = |_| {
            camera.tile_rectangle(
                [1, 1],
                PixelRectangle {
                    min: [0; 2],
                    max: [1; 2],
                },
            )
        };
        TileDepths::from_rectangles([3, 2], intervals, rectangle)
    };
    assert!(matches!(tiles(0), Err(Error::Size { .. })));
    assert!(tiles(u32::MAX).is_err());

    let everywhere = Sphere::new(Vec3::ZERO, 1e30).unwrap();
    let mut batch = LightBatch::new();
    let mut lists = LightLists::new();
    let mut tiles = tiles(2).unwrap();
    assert!(tiles.is_empty());
    let mut culler = Culler::new();
    culler.cull(&batch, &tiles, &mut lists).unwrap();
    assert!(lists.is_empty() && lists.of([0, 0], 0).is_empty());

    // Light, but no surfaces.
    batch.push(5, &everywhere.project(&camera).unwrap());
    let counters = culler.cull(&batch, &tiles, &mut lists).unwrap();
    assert_eq!((counters.tile_tests, counters.pairs), (0, 0));

    tiles.set([2, 1], [None, DepthInterval::new(1.0, 2.0).ok()]);
    culler.cull(&batch, &tiles, &mut lists).unwrap();
    assert_eq!(lists.lights(), [5]);
    assert_eq!(lists.of([2, 1], 1), [5]);
    for (tile, interval) in [
        ([2, 1], 0),
        ([2, 1], 2),
        ([3, 1], 0),
        ([0, 9], 0),
        ([1, 1], 1),
        ([2, 1], u32::MAX),
        ([2, u32::MAX], 1),
        ([u32::MAX, 1], 1),
    ] {
        assert!(lists.of(tile, interval).is_empty());
    }
    assert_eq!(tiles.interval_of([2, 1], 1.5), Some(1));
}

/// The product of these three is 0 modulo 2⁶⁴.
#[test]
fn grids_too_large_for_64_bits_are_refused() {
    let view = TileRectangle::new([-1.0; 2].into(), [1.0; 2].into()).unwrap();
    let tiles = TileDepths::from_rectangles([1 << 31, 1 << 31], 4, |_| view);
    assert!(matches!(tiles, Err(Error::Size { .. })));
}

/// Before anything is asked for or allocated.
#[test]
fn grids_too_large_for_memory_are_refused() {
    let never = |_| -> TileRectangle { unreachable!("there is no such tile") };
    for (size, intervals) in [
        ([1, u32::MAX], 1),
        ([1, 65_537], 1),
        ([65_537, 1], 1),
        ([u32::MAX, 1], 1),
        ([1 << 13, 1 << 14], 2),
        ([1 << 16, 1 << 16], 1),
        ([1, 1], (1 << 27) + 1),
    ] {
        let message = TileDepths::from_rectangles(size, intervals, never)
            .unwrap_err()
            .to_string();
        assert!(
            message.contains(&format!("{}×{}", size[0], size[1])),
            "{message}"
        );
    }
    let view = TileRectangle::new([-1.0; 2].into(), [1.0; 2].into()).unwrap();
    for size in [[1 << 16, 1], [1, 1 << 16], [1 << 10, 1 << 10]] {
        assert_eq!(
            TileDepths::from_rectangles(size, 2, |_| view)
                .unwrap()
                .size(),
            size
        );
    }
}

#[test]
#[should_panic(expected = "there is no tile (3, 0) of 3×2")]
fn depths_of_no_tile_are_no_ones() {
    let view = TileRectangle::new([-1.0; 2].into(), [1.0; 2].into()).unwrap();
    let tiles = TileDepths::from_rectangles([3, 2], 1, |_| view).unwrap();
    let _ = tiles.interval_of([3, 0], 1.0);
}

/// The lights in all near intervals together, and in all far ones.
fn hits(frame: &[Subregion], depths: Depths, mut culler: Culler<ProjectedEllipsoid>) -> [usize; 2] {
    let camera = workload::camera();
    let mut lists = LightLists::new();
    let mut hits = [0; 2];
    for subregion in frame {
        let stretches = subregion.lights.iter().map(|light| light.stretch(&camera));
        let mut batch = LightBatch::new();
        batch.extend((0..).zip(stretches));
        culler
            .cull(&batch, &subregion.tile_depths(depths), &mut lists)
            .unwrap();
        for (slot, [start, end]) in lists.ranges().iter().enumerate() {
            hits[slot % 2] += (end - start) as usize;
        }
    }
    hits
}

/// The numbers are those of the same test in `f64`. The paper's box test lists 189,187 and 11,364.
#[test]
fn finds_the_known_lights_of_the_fixed_workloads() {
    let frame = workload::frame();
    let kinds: [(Depths, [usize; 2]); 2] = [
        (|tile| tile.scattered, [16_251, 28_337]),
        (|tile| tile.coherent, [2_282, 3_039]),
    ];
    for (depths, known) in kinds {
        let found = hits(&frame, depths, Culler::new());
        for (found, known) in found.into_iter().zip(known) {
            assert!(
                known <= found && found <= known + known / 200,
                "{found}, known {known}"
            );
        }
    }
}

#[test]
fn later_frames_allocate_nothing() {
    let frame = workload::frame();
    let subregion = &frame[0];
    let tiles = subregion.tile_depths(|tile| tile.scattered);
    let camera = workload::camera();
    let (mut batch, mut culler, mut lists) = (LightBatch::new(), Culler::new(), LightLists::new());
    let mut draw_frame = || {
        batch.clear();
        for (number, light) in (0..).zip(&subregion.lights) {
            batch.push(number, &light.stretch(&camera));
        }
        culler.cull(&batch, &tiles, &mut lists).unwrap();
    };
    let first = allocation_counter::measure(&mut draw_frame);
    assert!(first.count_total > 0, "nothing is counted");
    let second = allocation_counter::measure(&mut draw_frame);
    assert_eq!(second.count_total, 0);
}

/// As parry3d decides too, but for three pairs: `benches/cull.rs` compares them.
#[test]
fn exact_test_finds_the_known_lights_of_the_fixed_workloads() {
    let frame = workload::frame();
    let kinds: [(Depths, usize); 2] = [
        (|tile| tile.scattered, 41_608),
        (|tile| tile.coherent, 4_866),
    ];
    for (depths, known) in kinds {
        let found: usize = hits(&frame, depths, Culler::new().with_exact_test())
            .iter()
            .sum();
        assert!(
            found.abs_diff(known) <= known / 1000,
            "{found}, known {known}"
        );
    }
}
