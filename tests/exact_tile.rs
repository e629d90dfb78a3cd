//! The exact tile test decides as the distance between a ball and a polyhedron does.

use proptest::prelude::*;
use stochastic_light_culling::{
    AnyCamera, Camera, DepthInterval, Ellipsoid, HalfSpace, PixelRectangle, Sphere, TileRectangle,
    TileTest,
    glam::{Mat3, Vec2, Vec3},
};
use support::reference::{Frustum, Shape, Vector, camera::View};
use support::{generators, with_camera};

/// From round to needles as the least α makes them.
fn ellipsoid() -> impl Strategy<Value = Ellipsoid> {
    let axes = (generators::unit_vector(), generators::unit_vector());
    let ratio = || {
        prop_oneof![
            generators::log_uniform(0.02, 1.0),
            generators::log_uniform(2e-6, 1.0)
        ]
    };
    let needle = (axes, generators::log_uniform(1e-3, 1e3), ratio(), ratio()).prop_map(
        |(axes, longest, second, third)| {
            let semi_axes = [longest, longest * second, longest * third].map(|x| x as f32);
            generators::ellipsoid_with(Vec3::ZERO, axes, Vec3::from_array(semi_axes))
        },
    );
    prop_oneof![generators::ellipsoid(), needle]
}

/// Room on the sides of a point: none, from much less to more than the light takes, all to the eye.
fn room() -> impl Strategy<Value = f64> {
    prop_oneof![1 => Just(0.0), 8 => generators::log_uniform(1e-4, 1.0), 1 => Just(1.0)]
}

/// A tile about a point of camera space, with room in shares of its depth, or, of boxes, of `extent`.
fn tile_about(
    view: &View,
    point: Vector,
    extent: f64,
    [left, right, below, above, before, behind]: [f64; 6],
) -> Option<(TileRectangle, DepthInterval)> {
    let [x, y, depth] = point.0;
    if depth <= 0.0 {
        return None;
    }
    let (per_slope, extent) = if view.is_orthographic() {
        (extent, extent)
    } else {
        (depth, 1.0)
    };
    let [left, right, below, above] = [left, right, below, above].map(|room| room * extent);
    let [x, y] = [x, y].map(|x| x / per_slope * extent);
    let corner = |x: f64, y: f64| Vec2::new(x as f32, y as f32);
    let tile =
        TileRectangle::new(corner(x - left, y - below), corner(x + right, y + above)).ok()?;
    let depths = [depth * (1.0 - before), depth * (1.0 + behind)].map(|depth| depth as f32);
    Some((tile, DepthInterval::new(depths[0], depths[1]).ok()?))
}

fn decides_as_distance(
    view: &View,
    test: &dyn TileTest,
    (tile, depths): &(TileRectangle, DepthInterval),
    (matrix, center, radius): (Mat3, Vec3, f64),
) -> Result<(), TestCaseError> {
    let frustum = if view.is_orthographic() {
        Frustum::of_box(matrix, tile, depths)
    } else {
        Frustum::new(matrix, tile, depths)
    };
    let distance = frustum.distance(center.into());
    let rim = 1e-12 * (radius + f64::from(center.length()) + frustum.extent());
    let touched = test.touches_exactly(tile, depths);
    prop_assert!(
        !touched || distance < radius + rim,
        "accepted at {distance} of {radius}"
    );
    // The box test comes first, and has a rim of its own.
    let may_touch = test.touches(tile, depths);
    prop_assert!(may_touch || !touched);
    prop_assert!(
        touched || !may_touch || distance > radius - rim,
        "rejected at {distance} of {radius}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(generators::cases(40_000))]

    #[test]
    fn of_ellipsoids(
        ellipsoid in ellipsoid(),
        view in generators::any_view(),
        distance in generators::log_uniform(1e-1, 1e3),
        (unit, level) in (generators::unit_vector(), 0.3..3.0),
        room in prop::array::uniform6(room()),
    ) {
        let view = view.aimed_at(ellipsoid.center(), distance * f64::from(ellipsoid.semi_axes().max_element()));
        let camera = AnyCamera::new(view.from_world, view.projection).unwrap();
        let point = view.to_camera_space(Shape::from(ellipsoid).point(unit * level));
        let extent = 2.0 * f64::from(ellipsoid.semi_axes().max_element());
        if let Some(tile) = tile_about(&view, point, extent, room) {
            with_camera!(&camera, camera => {
                let stretch = ellipsoid.project(camera).unwrap();
                decides_as_distance(&view, &stretch, &tile, (stretch.matrix(), stretch.center(), 1.0))
            })?;
        }
    }

    #[test]
    fn of_spheres(
        radius in generators::log_uniform(1e-4, 1e4),
        view in generators::any_view(),
        distance in generators::log_uniform(1e-1, 1e3),
        (unit, level) in (generators::unit_vector(), 0.3..3.0),
        room in prop::array::uniform6(room()),
    ) {
        let view = view.aimed_at(Vec3::ZERO, distance * radius);
        let camera = AnyCamera::new(view.from_world, view.projection).unwrap();
        let sphere = Sphere::new(Vec3::ZERO, radius as f32).unwrap();
        let point = view.to_camera_space(unit * (level * radius));
        if let Some(tile) = tile_about(&view, point, 2.0 * radius, room) {
            with_camera!(&camera, camera => {
                let sphere = sphere.project(camera).unwrap();
                let radius = f64::from(sphere.radius_squared()).sqrt();
                decides_as_distance(&view, &sphere, &tile, (Mat3::IDENTITY, sphere.center(), radius))
            })?;
        }
    }
}

fn ahead() -> Camera {
    Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0).unwrap()
}

fn whole_view() -> TileRectangle {
    let (min, max) = ([0; 2], [1; 2]);
    ahead().tile_rectangle([1, 1], PixelRectangle { min, max })
}

#[test]
fn of_tiles_that_begin_at_the_eye() {
    let point = TileRectangle::new(Vec2::ZERO, Vec2::ZERO).unwrap();
    let sphere = |z: f32, radius: f32| {
        let sphere = Sphere::new(Vec3::new(0.0, 0.0, -z), radius).unwrap();
        sphere.project(&ahead()).unwrap()
    };
    for tile in [point, whole_view()] {
        for far in [0.0, 1.0, 1e30] {
            let depths = DepthInterval::new(0.0, far).unwrap();
            assert!(sphere(-2.0, 2.01).touches_exactly(&tile, &depths));
            assert!(!sphere(-2.0, 1.99).touches_exactly(&tile, &depths));
            assert_eq!(sphere(0.5, 0.1).touches_exactly(&tile, &depths), far > 0.0);
        }
    }
}

#[test]
fn of_lights_without_end() {
    let everywhere = Sphere::new(Vec3::ZERO, f32::MAX).unwrap();
    let sphere = everywhere.project(&ahead()).unwrap();
    let boundless = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::splat(f32::MAX)).unwrap();
    let stretch = boundless.project(&ahead()).unwrap();
    for (near, far) in [
        (0.0, 0.0),
        (0.0, f32::MAX),
        (1.0, 2.0),
        (f32::MAX, f32::MAX),
    ] {
        let depths = DepthInterval::new(near, far).unwrap();
        for test in [&sphere as &dyn TileTest, &stretch] {
            let touches = test.touches(&whole_view(), &depths);
            assert_eq!(test.touches_exactly(&whole_view(), &depths), touches);
        }
    }
}

/// A half-space is tested by the tile's corners, which is exact.
#[test]
fn of_half_spaces() {
    let above = HalfSpace::new(Vec3::ZERO, stochastic_light_culling::Direction::Y)
        .unwrap()
        .project(&ahead());
    let tile = |low: f32, high: f32| {
        TileRectangle::new(Vec2::new(-0.1, low), Vec2::new(0.1, high)).unwrap()
    };
    let depths = DepthInterval::new(1.0, 2.0).unwrap();
    assert!(above.touches_exactly(&tile(-0.2, 0.1), &depths));
    assert!(!above.touches_exactly(&tile(-0.2, -0.1), &depths));
}
