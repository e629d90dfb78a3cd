//! The smallest cases of NaN and of lights lost that arbitrary bits have found.

use stochastic_light_culling::{
    BatchBuilder, Bounded, Camera, Cap, Conductor, Culler, DepthInterval, Direction, Ellipsoid,
    Error, Ggx, GgxLobe, Incidence, LambertLobe, LightBatch, LightLists, Lobe, LtcLobe, NoFresnel,
    Paper, Roulette, Sphere, Spheroid, Tight, TileDepths, TileRectangle,
    glam::{Mat3, Mat4, Vec2, Vec3},
};

/// A unit spheroid of roughness α about +z, at normal incidence.
fn spheroid(alpha: f32) -> Spheroid {
    let ggx = Ggx::new(alpha).expect("in range");
    GgxLobe::new(ggx, NoFresnel, Incidence::head_on(Direction::Z)).unit_bound_by(Paper)
}

fn camera_from(offset: Vec3) -> Camera {
    let projection = Mat4::from_cols_array(&[
        1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.01, -1.0, 0.0, 0.0, -0.1, 0.0,
    ]);
    Camera::new(Mat4::from_translation(offset), projection).expect("in range")
}

#[test]
fn subnormal_semi_axes_have_a_stretch_without_nan() {
    let ellipsoid = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::splat(1e-45));
    let stretch = ellipsoid
        .expect("positive")
        .project(&camera_from(Vec3::ZERO));
    assert!(!stretch.expect("not empty").matrix().is_nan());
}

#[test]
fn infinite_spheroid_has_an_enclosing_sphere_without_nan() {
    let sphere = spheroid(0.5)
        .placed(Vec3::ZERO, f32::MAX)
        .placed(Vec3::ZERO, 1e10)
        .enclosing_sphere();
    assert!(!sphere.center().is_nan());
}

#[test]
fn infinite_spheroid_has_an_ellipsoid_without_nan() {
    let ellipsoid = Ellipsoid::from(spheroid(1e-6).placed(Vec3::ZERO, f32::MAX));
    assert!(!ellipsoid.center().is_nan());
    assert!(!ellipsoid.semi_axes().is_nan());
}

#[test]
fn centre_beyond_f32_in_camera_space_has_a_stretch_without_nan() {
    let ellipsoid = Ellipsoid::new(Vec3::new(f32::MAX, 0.0, 0.0), Mat3::IDENTITY, Vec3::ONE);
    let camera = camera_from(Vec3::new(1e38, 0.0, 0.0));
    let stretch = ellipsoid.expect("finite").project(&camera);
    assert!(!stretch.expect("not empty").center().is_nan());
}

#[test]
fn eye_beyond_f32_in_camera_space_is_refused() {
    let eye = Vec3::new(3e38, 3e38, 0.0);
    let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 1.0, 1.0, 0.1..100.0);
    assert!(camera.is_err());
}

#[test]
fn light_a_hair_above_grazing_is_not_empty() {
    let lobe = |normal, incoming| {
        let [normal, incoming] = [normal, incoming].map(|v| Direction::new(v).expect("not zero"));
        let ggx = Ggx::new(1.0).expect("in range");
        GgxLobe::new(ggx, NoFresnel, Incidence { normal, incoming })
    };
    // μ = 10⁻⁵⁴ is no f32.
    let underflow = lobe(Vec3::new(1.0, 0.0, 1e-25), Vec3::new(0.0, -1.0, 1e-29));
    // μ = 2⁻⁶¹, and 2⁻⁶¹ + ½ − ½ = 0 in f64.
    let tiny = 2.0_f32.powi(-30);
    let absorbed = lobe(Vec3::new(tiny, 1.0, 1.0), Vec3::new(tiny, 1.0, -1.0));
    assert!(!underflow.unit_bound().is_empty());
    assert!(!absorbed.unit_bound().is_empty());
}

#[test]
fn dark_lambert_lobe_is_not_empty() {
    let lobe = LambertLobe::new(1e-45, Direction::Z).expect("in range");
    let exact = (f64::from(lobe.albedo()) / std::f64::consts::PI).sqrt();
    let reach = lobe.unit_bound().center().z + lobe.unit_bound().radius();
    assert!(f64::from(reach) >= exact);
}

#[test]
fn faint_conductor_is_refused_or_not_empty() {
    // κ² is no f32, yet at grazing incidence what counts is κ/cos²θ.
    assert!(Conductor::new(1.0, 1e-25).is_err());
    let ggx = Ggx::new(0.1).expect("in range");
    let conductor = Conductor::new(1.0, 1e-12).expect("in range");
    let lobe = GgxLobe::new(ggx, conductor, Incidence::head_on(Direction::Z));
    assert!(!lobe.unit_bound().is_empty());
    let grazing = Direction::new(Vec3::new(1.0, 0.0, 1e-19)).expect("not zero");
    let lobe = GgxLobe::new(
        ggx,
        conductor,
        Incidence {
            normal: Direction::Z,
            incoming: grazing,
        },
    );
    assert_eq!(lobe.max_fresnel(), 1.0);
}

#[test]
fn axes_a_hair_off_normal_incidence_are_orthonormal() {
    // sin²θ = 5·10⁻⁴⁶ is a subnormal f32, and its root far from sinθ.
    let normal = Direction::new(Vec3::new(0.0, -1.0, -2.25e-23)).expect("not zero");
    let incoming = Direction::new(Vec3::new(1.76e-23, -1.0, -4.4e-26)).expect("not zero");
    let ggx = Ggx::new(1.0).expect("in range");
    let rotation = GgxLobe::new(ggx, NoFresnel, Incidence { normal, incoming }).rotation();
    let deviation = rotation.transpose() * rotation - Mat3::IDENTITY;
    for column in [deviation.x_axis, deviation.y_axis, deviation.z_axis] {
        assert!(column.abs().max_element() < 1e-6, "{rotation}");
    }
}

#[test]
fn infinite_tight_ellipsoid_is_not_nan() {
    let ggx = Ggx::new(0.1).expect("in range");
    let lobe = GgxLobe::new(ggx, NoFresnel, Incidence::head_on(Direction::Z));
    let far = Vec3::new(f32::MAX, f32::MIN, 1e30);
    let ellipsoid = lobe.unit_bound_by(Tight).placed(far, f32::MAX);
    assert!(!ellipsoid.center().is_nan() && !ellipsoid.semi_axes().is_nan());
}

#[test]
fn brightest_light_reaches_everything() {
    let ellipsoid = Ellipsoid::from(spheroid(1e-6).placed(Vec3::ZERO, f32::MAX));
    let stretch = ellipsoid.project(&camera_from(Vec3::splat(1e30)));
    assert_eq!(stretch.expect("not empty").matrix(), Mat3::ZERO);
    let lobe = GgxLobe::new(
        Ggx::new(0.1).expect("in range"),
        NoFresnel,
        Incidence::head_on(Direction::Z),
    );
    assert!(lobe.value(Vec3::Z) > 0.0);
}

/// A sphere alone in a tile, as it is tested, pushed and built.
fn is_listed(center: Vec3, radius: f32, slope: f32, depth: f32) {
    let camera = camera_from(Vec3::ZERO);
    let sphere = Sphere::new(center, radius).expect("in range");
    let seen = sphere.project(&camera).expect("not empty");
    let rectangle = TileRectangle::new(Vec2::splat(-slope), Vec2::splat(slope)).expect("in order");
    let depths = DepthInterval::new(depth, depth).expect("in order");
    assert!(seen.touches(&rectangle, &depths) && seen.touches_exactly(&rectangle, &depths));

    let mut tiles = TileDepths::from_rectangles([1; 2], 1, |_| rectangle).expect("one");
    tiles.set([0; 2], [depths]);
    let (mut pushed, mut built) = (LightBatch::new(), LightBatch::new());
    pushed.push(7, &seen);
    let roulette = Roulette::new(1.0).expect("in range");
    BatchBuilder::new(&roulette, &camera).add_placed([(7, &sphere, Vec3::ZERO, 1.0)], &mut built);
    for batch in [pushed, built] {
        for mut culler in [Culler::new(), Culler::new().with_exact_test()] {
            let mut lists = LightLists::new();
            culler.cull(&batch, &tiles, &mut lists).expect("few enough");
            assert_eq!(lists.lights(), [7]);
        }
    }
}

#[test]
fn spheres_whose_squares_are_subnormal_are_listed() {
    is_listed(Vec3::new(0.0, 0.0, -1e-22), 2e-23, 0.1, 1.05e-22);
    is_listed(Vec3::new(0.0, 0.0, -1e-20), 6.7e-21, 0.1, 1.6e-20);
}

#[test]
fn spheres_whose_squares_are_infinite_are_listed() {
    is_listed(Vec3::ZERO, 1e20, 1.0, 1e19);
    is_listed(Vec3::ZERO, 1e20, 1.0, 1e30);
}

#[test]
fn smallest_ellipsoid_touches_a_tile_far_off_the_axis() {
    let ellipsoid = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::splat(1.2e-38));
    let stretch = ellipsoid
        .expect("positive")
        .project(&camera_from(Vec3::ZERO));
    let tile = TileRectangle::new(Vec2::new(20.0, -1.0), Vec2::new(40.0, 1.0)).expect("in order");
    let depths = DepthInterval::new(0.0, 1.0).expect("in order");
    let stretch = stretch.expect("not empty");
    assert!(stretch.touches(&tile, &depths) && stretch.touches_exactly(&tile, &depths));
}

#[test]
fn blocks_of_tiles_without_width_are_culled() {
    let line = |_| TileRectangle::new(Vec2::ZERO, Vec2::new(0.0, 1.0)).expect("in order");
    let mut tiles = TileDepths::from_rectangles([60, 1], 1, line).expect("few");
    for x in 0..60 {
        tiles.set([x, 0], [DepthInterval::new(1.0, 9.0).ok()]);
    }
    let sphere = Sphere::new(Vec3::new(0.0, 2.0, -4.0), 1.0).expect("positive");
    let mut batch = LightBatch::new();
    batch.extend(
        sphere
            .project(&camera_from(Vec3::ZERO))
            .map(|sphere| (3, sphere)),
    );
    let mut lists = LightLists::new();
    Culler::new()
        .cull(&batch, &tiles, &mut lists)
        .expect("few enough");
    assert_eq!(lists.lights(), [3; 60]);
}

/// The second row of the value is a cross product in single precision, of which little is left.
#[test]
fn rows_of_a_transformed_cosine_are_nearly_parallel() {
    let normal = Direction::new(Vec3::new(5e-6, 1.0, 0.0)).unwrap();
    for i in 0..200 {
        let turn = 0.03 * i as f32;
        let incoming = Direction::new(Vec3::new(turn.cos(), 0.4, turn.sin())).unwrap();
        let incidence = Incidence { normal, incoming };
        // Rounding would exceed its shortest image many times over.
        let refused = LtcLobe::with_matrix([0.039, 0.0, 0.0963, 2.79e-5], 1.0, incidence);
        assert!(matches!(refused, Err(Error::Matrix { .. })));
        let lobe = LtcLobe::with_matrix([3.9, 0.0, 9.63, 0.0279], 1.0, incidence).unwrap();
        let most = lobe.maximum_within(&Cap::new(Direction::Y, 0.0).unwrap());
        let value = lobe.value(Vec3::Y);
        assert!(value * 0.999 <= most, "{value} above {most}");
    }
}
