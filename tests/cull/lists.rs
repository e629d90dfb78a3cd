//! Lists are those of the scalar test, light by light, in every width and on many cores.

use proptest::prelude::*;
use stochastic_light_culling::{
    BoxTest, Camera, CullCounters, Culler, DepthInterval, Ellipsoid, LightBatch, LightLists,
    Orthographic, Perspective, PixelRectangle, Project, ProjectedEllipsoid, ProjectedSphere,
    Projection, Sphere, TileDepths, TileGrid, TileRectangle, TileTest,
    glam::{Mat3, Vec2, Vec3},
};
use support::generators::cases;

use super::grid::{Grid, camera, ellipsoid, grid, parallel_camera, sphere};

/// The parallel lists are the serial ones, to the last number.
#[cfg(feature = "rayon")]
fn culled_in_parallel_as_serially<T: BoxTest + Send + Sync>(
    tiles: &TileDepths,
    shapes: &[T],
) -> Result<(), TestCaseError> {
    let mut batch = LightBatch::new();
    batch.extend((0..).zip(shapes.iter().copied()));
    for mut culler in [Culler::new(), Culler::new().with_exact_test()] {
        let [mut serial, mut parallel] = [LightLists::new(), LightLists::new()];
        let counters = culler.cull(&batch, tiles, &mut serial).unwrap();
        let counted = culler.cull_in_parallel(&batch, tiles, &mut parallel);
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

/// Before cameras of both projections.
fn culled_as_one_by_one<B: Project>(grid: &Grid, shapes: &[B]) -> Result<(), TestCaseError>
where
    B::Projected<Perspective>: BoxTest + Send + Sync,
    B::Projected<Orthographic>: BoxTest + Send + Sync,
{
    culled_in_view(grid, &camera(), shapes)?;
    culled_in_view(grid, &parallel_camera(), shapes)
}

fn culled_in_view<P: Projection, B: Project>(
    grid: &Grid,
    camera: &Camera<P>,
    shapes: &[B],
) -> Result<(), TestCaseError>
where
    B::Projected<P>: BoxTest + Send + Sync,
{
    let projected = shapes.iter().map(|shape| shape.project(camera));
    let shapes: Vec<B::Projected<P>> = projected.map(|shape| shape.expect("not empty")).collect();
    #[cfg(feature = "rayon")]
    culled_in_parallel_as_serially(&grid.tile_depths(camera), &shapes)?;
    for culler in cullers() {
        let boxes = culled_by(culler.clone(), TileTest::touches, grid, camera, &shapes)?;
        let exact = culler.with_exact_test();
        let exact = culled_by(exact, TileTest::touches_exactly, grid, camera, &shapes)?;
        prop_assert_eq!(boxes.rejected_exactly, 0);
        prop_assert_eq!(exact.rejected_exactly, boxes.pairs - exact.pairs);
    }
    Ok(())
}

fn culled_by<P: Projection, T: BoxTest>(
    mut culler: Culler<T>,
    test: Test<T>,
    grid: &Grid,
    camera: &Camera<P>,
    shapes: &[T],
) -> Result<CullCounters, TestCaseError> {
    let tiles = grid.tile_depths(camera);
    let mut batch = LightBatch::new();
    batch.extend((100..).zip(shapes.iter().copied()));
    let mut lists = LightLists::new();
    let counters = culler.cull(&batch, &tiles, &mut lists).unwrap();
    let mut pairs = 0;
    for (tile, depths) in grid.tiles() {
        for (interval, depths) in (0..).zip(depths) {
            let touches = |shape: &T| {
                depths.is_some_and(|depths| test(shape, &grid.rectangle(camera, tile), &depths))
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
        shapes in prop::collection::vec(ellipsoid(), 0..150),
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
    extreme_tiles(&camera());
    extreme_tiles(&parallel_camera());
}

fn extreme_tiles<P: Projection>(camera: &Camera<P>) {
    let mut rng = fastrand::Rng::with_seed(3);
    let slopes = [0.0, 1e-45, 1.0, 200.0, 1e6, 1e9, 1e12, 1e18, 1e30, 3e38];
    let slopes = slopes.iter().flat_map(|slope| [-slope, *slope]);
    let slopes: Vec<f32> = slopes.collect();
    let depths = [0.0, 1e-45, 1e-20, 1.0, 2.0, 1e20, f32::MAX];
    for round in 0..100 {
        // One block, or many, whose columns and rows are in no order.
        let count = if round % 5 == 0 { 43 } else { 12 };
        let side = |rng: &mut fastrand::Rng| {
            let [a, b] = [(); 2].map(|()| slopes[rng.usize(0..slopes.len())]);
            TileRectangle::new(Vec2::splat(a.min(b)), Vec2::splat(a.max(b))).ok()
        };
        let [across, down] = [(); 2].map(|()| -> Vec<TileRectangle> {
            std::iter::repeat_with(|| side(&mut rng))
                .flatten()
                .take(count as usize)
                .collect()
        });
        let of_pixels = rng.bool();
        let rectangle = |[x, y]: [u32; 2]| {
            if of_pixels {
                let min = [x, y].map(|n| {
                    if n % 12 == 0 {
                        0
                    } else {
                        u32::MAX >> (2 * (n % 12))
                    }
                });
                let max = [x, y].map(|n| u32::MAX >> (n % 12));
                return camera.tile_rectangle([1, 1], PixelRectangle { min, max });
            }
            let [across, down] = [across[x as usize], down[y as usize]];
            let (x, y) = (
                [across.min().x, across.max().x],
                [down.min().y, down.max().y],
            );
            TileRectangle::new(Vec2::new(x[0], y[0]), Vec2::new(x[1], y[1])).unwrap()
        };
        let mut tiles = TileDepths::from_rectangles([count; 2], 1, rectangle).unwrap();
        let mut seen = Vec::new();
        for tile in (0..count * count).map(|i| [i % count, i / count]) {
            let [a, b] = [(); 2].map(|()| depths[rng.usize(0..depths.len())]);
            let interval = DepthInterval::new(a.min(b), a.max(b)).unwrap();
            tiles.set(tile, [interval]);
            seen.push((tile, interval));
        }
        let shapes: Vec<ProjectedEllipsoid<P>> = (0..60)
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
                let stretch = ellipsoid.project(camera).unwrap();
                // What the limit of the slopes relies on.
                let elements = stretch.matrix().to_cols_array();
                assert!(elements.iter().all(|element| element.abs() <= 2e24));
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
                    let touches = |shape: &ProjectedEllipsoid<P>| {
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

/// Lights as small as tiles, in scenes whose depths differ from block to block: each light reaches the depths of a
/// few tiles, and of none beside these.
#[test]
fn lists_of_small_lights_are_those_of_the_scalar_test() {
    small_lights(&camera());
    small_lights(&parallel_camera());
}

fn small_lights<P: Projection>(camera: &Camera<P>) {
    let mut rng = fastrand::Rng::with_seed(5);
    let grid = TileGrid::new([1040, 720], 16).unwrap();
    // With the second, each block of the culler has depths of its own.
    for steps in [[5, 4], [17, 15], [23, 9]] {
        let mut tiles = TileDepths::new(&grid, camera, 1).unwrap();
        let near = |[x, y]: [u32; 2]| 5.0 + (9 * (x / steps[0]) + 2 * (y / steps[1])) as f32 % 40.0;
        let depths = |tile| DepthInterval::new(near(tile), near(tile) + 0.5).unwrap();
        for tile in grid.tiles() {
            tiles.set(tile, [depths(tile)]);
        }
        let shapes: Vec<_> = std::iter::repeat_with(|| {
            // At the depth of one tile, and at slopes up to a few tiles beside it.
            let tile = [rng.u32(0..65), rng.u32(0..45)];
            let [x, y] = tile.map(|n| 16.0 * (n as f32 + 8.0 * rng.f32() - 4.0));
            let depth = near(tile) + 0.25;
            let place = [x.clamp(0.0, 1039.0) as u32, y.clamp(0.0, 719.0) as u32];
            let center = camera.point_in_pixel([1040, 720], place, depth);
            let radius = depth * 10_f32.powf(rng.f32() - 2.2);
            let center = camera.to_world_space(center);
            Sphere::new(center, radius)
                .unwrap()
                .project(camera)
                .unwrap()
        })
        .take(600)
        .collect();
        let mut batch = LightBatch::new();
        batch.extend((0..).zip(shapes.iter().copied()));
        let mut lists = LightLists::new();
        for lanes in [16, 8, 4] {
            Culler::with_lanes(lanes)
                .cull(&batch, &tiles, &mut lists)
                .unwrap();
            assert!(lists.len() > 500);
            for tile in grid.tiles() {
                let rectangle = camera.tile(&grid, tile);
                let touches = |shape: &ProjectedSphere<P>| shape.touches(&rectangle, &depths(tile));
                let touching = (0..).zip(&shapes).filter(|(_, shape)| touches(shape));
                let expected: Vec<u32> = touching.map(|(number, _)| number).collect();
                assert_eq!(lists.of(tile, 0), expected, "{tile:?}");
            }
        }
    }
}
