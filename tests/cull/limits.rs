//! Frame after frame in the same memory, nothing to cull, and grids that are too large.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use stochastic_light_culling::{
    Culler, DepthInterval, Error, LightBatch, LightLists, PixelRectangle, Sphere, TileDepths,
    TileRectangle, glam::Vec3,
};

use super::grid::{camera, ellipsoid, grid};

#[test]
fn memory_is_reused_without_a_trace_of_earlier_frames() {
    let mut runner = TestRunner::deterministic();
    let mut draw = |lights: std::ops::Range<usize>| {
        let frame = (grid(), prop::collection::vec(ellipsoid(), lights));
        frame.new_tree(&mut runner).unwrap().current()
    };
    let mut culler = Culler::new();
    let mut batch = LightBatch::new();
    let mut lists = LightLists::new();
    for lights in [300..301, 20..21, 0..1, 500..501, 3..4] {
        let (grid, shapes) = draw(lights);
        let tiles = grid.tile_depths(&camera());
        batch.clear();
        let shapes = shapes.iter().map(|shape| shape.project(&camera()).unwrap());
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
