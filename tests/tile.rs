//! A tile that holds a point of a light's bound is never rejected, and few others are accepted.

use proptest::prelude::*;
use stochastic_light_culling::{
    AnyCamera, Bounded, Camera, DepthInterval, Ellipsoid, Ggx, GgxLobe, HalfSpace, Incidence,
    NoFresnel, Paper, PixelRectangle, Sphere, TileGrid, TileRectangle, TileTest,
    glam::{DMat3, DVec3, Vec2, Vec3},
};
use support::reference::{Shape, Vector, camera::View, exact::outward};
use support::{generators, with_camera};

/// A camera of either projection, and what the tests need of it.
struct Seen {
    view: View,
    camera: AnyCamera,
}

impl Seen {
    fn new(view: View) -> Self {
        let camera = AnyCamera::new(view.from_world, view.projection).unwrap();
        Self { view, camera }
    }

    fn ellipsoid(&self, shape: &Ellipsoid) -> Box<dyn TileTest> {
        with_camera!(&self.camera, camera => Box::new(shape.project(camera).unwrap()))
    }

    fn sphere(&self, shape: &Sphere) -> Box<dyn TileTest> {
        with_camera!(&self.camera, camera => Box::new(shape.project(camera).unwrap()))
    }

    fn half_space(&self, shape: &HalfSpace) -> Box<dyn TileTest> {
        with_camera!(&self.camera, camera => Box::new(shape.project(camera)))
    }

    /// The thinnest tile that holds a point of the world, if it lies before the eye and in the view.
    fn tile_around(&self, point: Vector) -> Option<(TileRectangle, DepthInterval)> {
        let [x, y, depth] = self.view.to_camera_space(point).0;
        if depth <= 1e-30 {
            return None;
        }
        let per_slope = if self.view.is_orthographic() {
            1.0
        } else {
            depth
        };
        let [u, v] = [x, y].map(|x| outward((x / per_slope).into()));
        let tile = TileRectangle::new(Vec2::new(u[0], v[0]), Vec2::new(u[1], v[1])).ok()?;
        let [near, far] = outward(depth.into());
        let all = PixelRectangle {
            min: [0, 0],
            max: [1, 1],
        };
        let view = with_camera!(&self.camera, camera => camera.tile_rectangle([1, 1], all));
        let inside = tile.min().cmpge(view.min()).all() && tile.max().cmple(view.max()).all();
        inside.then(|| (tile, DepthInterval::new(near, far).unwrap()))
    }
}

/// A tile like that but with room to spare: the point is at its edge or within it.
fn widened(
    (tile, depths): (TileRectangle, DepthInterval),
    [left, right, below, above]: [f32; 4],
    [near, far]: [f32; 2],
) -> (TileRectangle, DepthInterval) {
    let tile = TileRectangle::new(
        tile.min() - Vec2::new(left, below),
        tile.max() + Vec2::new(right, above),
    )
    .unwrap();
    let depths = DepthInterval::new(depths.near() * near, depths.far() * far).unwrap();
    (tile, depths)
}

/// By how much a tile misses, in radii of the unit sphere: below 1 it is touched, above 1 it is not.
fn miss(matrix: DMat3, center: DVec3, tile: &TileRectangle, depths: &DepthInterval) -> f64 {
    let m = matrix.z_axis.z;
    let reach = [-1.0, 1.0].map(|side| (center.z + side) / m);
    let [near, far] = [depths.near(), depths.far()].map(f64::from);
    let apart_in_depth = (near * m - center.z).max(center.z - far * m);
    if apart_in_depth > 1.0 {
        return apart_in_depth;
    }

    // The planes through the eye and a side of the tile. The tile lies on their positive sides.
    let inverse = matrix.inverse().transpose();
    let plane = |x, y, z| {
        let normal = inverse * DVec3::new(x, y, z);
        -normal.dot(center) / normal.length()
    };
    let (min, max) = (tile.min().as_dvec2(), tile.max().as_dvec2());
    let sides = [
        plane(1.0, 0.0, -min.x),
        plane(-1.0, 0.0, max.x),
        plane(0.0, 1.0, -min.y),
        plane(0.0, -1.0, max.y),
    ];
    let box_distance = box_distance(
        matrix,
        center,
        tile,
        [near.max(reach[0]), far.min(reach[1])],
    );
    // Slopes bound nothing that reaches the plane of the camera.
    let sides = sides.into_iter().filter(|_| center.z > 1.0);
    sides.fold(box_distance, f64::max)
}

/// The distance of the box test: from `center` to the box around the tile's image at these depths.
fn box_distance(matrix: DMat3, center: DVec3, tile: &TileRectangle, depths: [f64; 2]) -> f64 {
    let (min, max) = (tile.min().as_dvec2(), tile.max().as_dvec2());
    let corners = [min.x, max.x].map(|x| [min.y, max.y].map(|y| DVec3::new(x, y, 1.0)));
    let images = corners.as_flattened().iter().flat_map(|corner| {
        let at_one = matrix * *corner;
        depths.map(|depth| at_one * depth)
    });
    let (low, high) = images.fold((DVec3::MAX, DVec3::MIN), |(low, high), image| {
        (low.min(image), high.max(image))
    });
    center.distance(center.clamp(low, high))
}

proptest! {
    #![proptest_config(generators::cases(4000))]

    #[test]
    fn tile_with_a_point_of_the_ellipsoid_is_touched(
        ellipsoid in generators::ellipsoid(),
        view in generators::any_view(),
        distance in generators::log_uniform(1e-2, 1e3),
        aim in any::<bool>(),
        points in prop::collection::vec((generators::unit_vector(), prop_oneof![3 => Just(1.0), 1 => 0.0..1.0]), 30),
        room in (prop::array::uniform4(0.0..0.3_f32), 0.1..1.0_f32, 1.0..10.0_f32),
    ) {
        let view = if aim { view.aimed_at(ellipsoid.center(), distance) } else { view };
        let seen = Seen::new(view);
        let stretch = seen.ellipsoid(&ellipsoid);
        let shape = Shape::from(ellipsoid);
        for (unit, depth) in points {
            let point = shape.point(unit * (depth * (1.0 - 1e-12)));
            let Some(thin) = seen.tile_around(point) else { continue };
            prop_assert!(stretch.touches_exactly(&thin.0, &thin.1), "{thin:?}");
            let (sides, near, far) = room;
            let wide = widened(thin, sides, [near, far]);
            prop_assert!(stretch.touches_exactly(&wide.0, &wide.1), "{wide:?}");
        }
    }

    #[test]
    fn tile_with_a_point_of_the_sphere_is_touched(
        center in generators::position(),
        radius in generators::log_uniform(1e-4, 1e4),
        view in generators::any_view(),
        aim in any::<bool>(),
        points in prop::collection::vec(generators::unit_vector(), 30),
    ) {
        let view = if aim { view.aimed_at(center, 2.0) } else { view };
        let seen = Seen::new(view);
        let sphere = Sphere::new(center, radius as f32).unwrap();
        let before_camera = seen.sphere(&sphere);
        let shape = Shape::from(sphere);
        for unit in points {
            let point = shape.point(unit * (1.0 - 1e-12));
            let Some((tile, depths)) = seen.tile_around(point) else { continue };
            prop_assert!(before_camera.touches_exactly(&tile, &depths), "{tile:?} {depths:?}");
        }
    }

    #[test]
    fn tile_with_a_point_on_the_lit_side_is_touched(
        lit in generators::lit(),
        position in generators::position(),
        view in generators::any_view(),
        aim in any::<bool>(),
        points in prop::collection::vec(
            (generators::unit_vector(), generators::log_uniform(1e-6, 1e3), generators::log_uniform(1e-12, 1.0)),
            30),
    ) {
        let view = if aim { view.aimed_at(position, 2.0) } else { view };
        let seen = Seen::new(view);
        let half_space = seen.half_space(&HalfSpace::new(position, lit.normal).unwrap());
        let normal = lit.surface.normal;
        for (way, distance, height) in points {
            // Along the surface, and a little or a lot above it.
            let above = normal.cross(way) + normal * height;
            let point = Vector::from(position) + above * distance;
            let Some((tile, depths)) = seen.tile_around(point) else { continue };
            prop_assert!(half_space.touches(&tile, &depths), "{tile:?} {depths:?}");

            // And well below it, seen through a thin tile, not.
            let below = normal.cross(way) * 0.1 - normal;
            let point = Vector::from(position) + below * distance;
            let far = position.length() + view.from_world.w_axis.truncate().length();
            let Some((tile, depths)) = seen.tile_around(point) else { continue };
            let resolved = distance > 1e-4 * f64::from(far) + 1e-3 * f64::from(depths.far());
            prop_assert!(!resolved || !half_space.touches(&tile, &depths), "{tile:?} {depths:?}");
        }
    }

    /// From the surface to the tile: every point of the lobe's spheroid, for α down to 0.01.
    #[test]
    fn tile_with_a_point_of_a_lobes_spheroid_is_touched(
        roughness in generators::up_to_one(0.01),
        lit in generators::lit(),
        position in generators::position(),
        scale in generators::log_uniform(1e-3, 1e3),
        view in generators::any_view(),
        points in prop::collection::vec(generators::unit_vector(), 30),
    ) {
        let view = view.aimed_at(position, 3.0);
        let seen = Seen::new(view);
        let lobe = GgxLobe::new(Ggx::new(roughness).unwrap(), NoFresnel, Incidence { normal: lit.normal, incoming: lit.incoming });
        let spheroid = lobe.unit_bound_by(Paper).placed(position, scale as f32);
        let stretch = seen.ellipsoid(&spheroid.into());
        let shape = Shape::from(spheroid);
        for unit in points {
            let point = shape.point(unit * (1.0 - 1e-12));
            let Some((tile, depths)) = seen.tile_around(point) else { continue };
            prop_assert!(stretch.touches_exactly(&tile, &depths), "{tile:?} {depths:?}");
        }
    }

    /// The test in f64 on the same M decides the same, but for a rim of rounding.
    #[test]
    fn test_is_no_looser_than_its_box_and_planes(
        ellipsoid in generators::ellipsoid(),
        view in generators::view(),
        distance in generators::log_uniform(1e-1, 1e2),
        tile in (0..64_u32, 0..64_u32),
        depths in (generators::log_uniform(1e-2, 1e3), 1.0..3.0),
    ) {
        let view = view.aimed_at(ellipsoid.center(), distance);
        let camera = Camera::new(view.from_world, view.projection).unwrap();
        let stretch = ellipsoid.project(&camera).unwrap();
        let pixels = PixelRectangle { min: [tile.0, tile.1], max: [tile.0 + 1, tile.1 + 1] };
        let rectangle = camera.tile_rectangle([64, 64], pixels);
        let interval = DepthInterval::new(depths.0 as f32, (depths.0 * depths.1) as f32).unwrap();
        let matrix = stretch.matrix().as_dmat3();
        let exact = miss(matrix, stretch.center().as_dvec3(), &rectangle, &interval);
        let touched = stretch.touches(&rectangle, &interval);
        let rim = 1e-4 * (1.0 + exact + f64::from(stretch.center().length()));
        prop_assert!(touched || exact > 1.0 - rim, "rejected at {exact}");
        prop_assert!(!touched || exact < 1.0 + rim, "accepted at {exact}");
    }

    /// A sphere is the ellipsoid with M = 1/r.
    #[test]
    fn test_of_a_sphere_is_no_looser_than_its_box_and_planes(
        center in generators::position(),
        radius in generators::log_uniform(1e-3, 1e3),
        view in generators::view(),
        distance in generators::log_uniform(1e-1, 1e2),
        tile in (0..64_u32, 0..64_u32),
        depths in (generators::log_uniform(1e-2, 1e3), 1.0..3.0),
    ) {
        let view = view.aimed_at(center, distance * radius);
        let camera = Camera::new(view.from_world, view.projection).unwrap();
        let sphere = Sphere::new(center, radius as f32).unwrap().project(&camera).unwrap();
        let pixels = PixelRectangle { min: [tile.0, tile.1], max: [tile.0 + 1, tile.1 + 1] };
        let rectangle = camera.tile_rectangle([64, 64], pixels);
        let near = depths.0 * distance * radius;
        let interval = DepthInterval::new(near as f32, (near * depths.1) as f32).unwrap();
        let touched = sphere.touches(&rectangle, &interval);
        let radius = f64::from(sphere.radius_squared()).sqrt();
        let unit = sphere.center().as_dvec3() / radius;
        let exact = miss(DMat3::from_diagonal(DVec3::splat(1.0 / radius)), unit, &rectangle, &interval);
        let rim = 1e-4 * (1.0 + exact + unit.length());
        prop_assert!(touched || exact > 1.0 - rim, "rejected at {exact}");
        prop_assert!(!touched || exact < 1.0 + rim, "accepted at {exact}");
    }

    #[test]
    fn depth_intervals_hold_every_surface_and_no_more(
        depths in prop::collection::vec(
            prop_oneof![
                5 => generators::log_uniform(1e-3, 1e6).prop_map(|d| d as f32),
                1 => Just(f32::INFINITY), 1 => Just(f32::NAN), 1 => Just(0.0), 1 => Just(-1.0),
                1 => Just(7.0_f32),
            ],
            0..40),
    ) {
        let surfaces: Vec<f32> = depths.iter().copied().filter(|d| *d > 0.0 && d.is_finite()).collect();
        let holds = |interval: &DepthInterval, d: f32| interval.near() <= d && d <= interval.far();

        let whole = DepthInterval::around(depths.iter().copied());
        let halves = DepthInterval::half_z(depths.iter().copied());
        let parts = DepthInterval::modified_half_z(depths.iter().copied());
        prop_assert_eq!(whole.is_none(), surfaces.is_empty());
        prop_assert_eq!(halves.is_none(), surfaces.is_empty());
        prop_assert_eq!(parts[0].is_none(), surfaces.is_empty());
        for d in &surfaces {
            prop_assert!(holds(&whole.unwrap(), *d));
            prop_assert!(halves.unwrap().iter().any(|half| holds(half, *d)));
            prop_assert!(parts.iter().flatten().filter(|part| holds(part, *d)).count() == 1);
        }
        for interval in parts.iter().flatten().chain(whole.iter()) {
            prop_assert!(surfaces.contains(&interval.near()) && surfaces.contains(&interval.far()));
        }
    }

    #[test]
    fn grid_holds_every_pixel_once(width in 1..200_u32, height in 1..200_u32, tile_size in 1..40_u32) {
        let grid = TileGrid::new([width, height], tile_size).unwrap();
        let mut seen = vec![0; (width * height) as usize];
        for tile in grid.tiles() {
            for pixel in grid.pixels(tile).pixels() {
                prop_assert_eq!(grid.tile_of(pixel), tile);
                seen[(pixel[1] * width + pixel[0]) as usize] += 1;
            }
        }
        prop_assert!(seen.into_iter().all(|count| count == 1));
    }
}

/// The light behind the eye whose bound reaches round it, and one that does not.
#[test]
fn lights_around_and_behind_the_camera() {
    let camera = Camera::look_at(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0).unwrap();
    let all = camera.tile_rectangle(
        [1, 1],
        PixelRectangle {
            min: [0, 0],
            max: [1, 1],
        },
    );
    let depths = DepthInterval::new(1.0, 2.0).unwrap();
    for (center, radius, touched) in [
        (3.0, 4.5, true),
        (3.0, 3.5, false),
        (-1.5, 0.1, true),
        (0.0, 50.0, true),
    ] {
        let center = Vec3::new(0.0, 0.0, center);
        let sphere = Sphere::new(center, radius)
            .unwrap()
            .project(&camera)
            .unwrap();
        assert_eq!(sphere.touches(&all, &depths), touched);
        let axes = stochastic_light_culling::glam::Mat3::IDENTITY;
        let ellipsoid = Ellipsoid::new(center, axes, Vec3::splat(radius)).unwrap();
        assert_eq!(
            ellipsoid.project(&camera).unwrap().touches(&all, &depths),
            touched
        );
    }
}

proptest! {
    #[test]
    fn exponential_slices_fill_the_interval(
        near in prop_oneof![Just(0.0_f32), any::<f32>().prop_map(f32::abs)],
        ratio in prop_oneof![Just(1.0_f32), 1.0..1.000_01_f32, 1.0..1e4_f32, Just(f32::MAX)],
        count in 0..70_u32,
    ) {
        prop_assume!(near.is_finite());
        let far = if near == 0.0 { ratio - 1.0 } else { (near * ratio).min(f32::MAX) };
        let interval = DepthInterval::new(near, far).unwrap();
        let slices: Vec<_> = interval.exponential_slices(count).collect();
        prop_assert_eq!(slices.len(), count as usize);
        if let (Some(first), Some(last)) = (slices.first(), slices.last()) {
            prop_assert_eq!((first.near(), last.far()), (near, far));
        }
        for slice in &slices {
            prop_assert!(near <= slice.near() && slice.near() <= slice.far() && slice.far() <= far);
        }
        for pair in slices.windows(2) {
            prop_assert!(pair[1].near() <= pair[0].far(), "{:?} leave a gap", pair);
        }
    }
}

#[test]
fn halves_of_the_least_depths_are_intervals() {
    let bits = (0..12).chain([8_388_606, 8_388_607, 8_388_608, 8_388_609]);
    let depths: Vec<f32> = bits.map(f32::from_bits).collect();
    for near in depths.iter().copied().filter(|depth| *depth > 0.0) {
        for far in depths.iter().copied().filter(|depth| *depth >= near) {
            let halves = DepthInterval::half_z([near, far]).unwrap();
            for half in halves {
                let [low, high] = [half.near(), half.far()];
                assert!(DepthInterval::new(low, high).is_ok(), "{low:e} {high:e}");
                assert!(near <= low && high <= far, "{low:e} {high:e}");
            }
            let ends = [halves[0].near(), halves[1].far()];
            assert_eq!(ends, [near, far]);
            assert_eq!(halves[0].far(), halves[1].near());
            // The nearer part holds the middle.
            let [nearer, farther] = DepthInterval::modified_half_z([near, far]);
            assert!(nearer.is_some(), "{near:e} {far:e}");
            assert!(farther.is_none() || near < far, "{near:e} {far:e}");
        }
    }
}
