//! The stretch takes ellipsoids to unit spheres and planes of constant depth to such planes.

use proptest::prelude::*;
use stochastic_light_culling::{
    Camera, Incidence,
    glam::{Mat3, Vec3},
    stretch_matrix, stretch_rotation,
};
use support::generators;
use support::reference::{Shape, Vector};

fn times(matrix: Mat3, v: Vector) -> Vector {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vector::from);
    x * v.0[0] + y * v.0[1] + z * v.0[2]
}

fn difference(a: Mat3, b: Mat3) -> f32 {
    let d = a - b;
    [d.x_axis, d.y_axis, d.z_axis]
        .map(|column| column.abs().max_element())
        .into_iter()
        .fold(0.0, f32::max)
}

proptest! {
    #![proptest_config(generators::cases(2000))]

    #[test]
    fn surface_goes_to_the_unit_sphere(
        ellipsoid in generators::ellipsoid(),
        view in generators::view(),
        points in prop::collection::vec(generators::unit_vector(), 20),
    ) {
        let camera = Camera::new(view.from_world, view.projection).unwrap();
        let stretch = ellipsoid.project(&camera).unwrap();
        let shape = Shape::from(ellipsoid);
        let [shortest, longest] = [ellipsoid.semi_axes().min_element(), ellipsoid.semi_axes().max_element()];
        let distance = ellipsoid.center().length() + view.from_world.w_axis.truncate().length();
        let tolerance = f64::from((longest + distance) / shortest) * 3e-5 + 1e-5;

        for unit in points {
            let seen = view.to_camera_space(shape.point(unit));
            let image = times(stretch.matrix(), seen) - Vector::from(stretch.center());
            prop_assert!((image.length() - 1.0).abs() < tolerance, "{}", image.length());

            // S alone does it too, about the centre.
            let s = stretch_matrix(&ellipsoid, &camera);
            let center = view.to_camera_space(ellipsoid.center().into());
            prop_assert!((times(s, seen - center).length() - 1.0).abs() < tolerance);
        }
    }

    #[test]
    fn rotation_keeps_depth_planes(ellipsoid in generators::ellipsoid(), view in generators::view()) {
        let camera = Camera::new(view.from_world, view.projection).unwrap();
        let s = stretch_matrix(&ellipsoid, &camera);
        let b = stretch_rotation(s);
        let m = ellipsoid.project(&camera).unwrap().matrix();

        prop_assert!(difference(b * b.transpose(), Mat3::IDENTITY) < 1e-5);
        prop_assert!(b.determinant() > 0.0);
        prop_assert_eq!([m.x_axis.z, m.y_axis.z], [0.0, 0.0]);
        prop_assert!(m.z_axis.z > 0.0);
        prop_assert!(m.x_axis.y == 0.0 || m.y_axis.x == 0.0);
    }

    /// M is B times S, to the accuracy that this product has in f32 and the enlargement for rounding.
    #[test]
    fn triangular_form_is_the_product(
        axes in (generators::unit_vector(), generators::unit_vector()),
        semi_axes in prop::array::uniform3(1.0..4.0_f32),
    ) {
        let ellipsoid = generators::ellipsoid_with(Vec3::ZERO, axes, Vec3::from_array(semi_axes));
        let camera = Camera::look_at(
            Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO, Vec3::Y, 1.0, 1.0, 0.1..10.0).unwrap();
        let s = stretch_matrix(&ellipsoid, &camera);
        let product = stretch_rotation(s) * s;
        let m = ellipsoid.project(&camera).unwrap().matrix();
        // Where ‖Se_x‖ = ‖Se_y‖ to rounding, either frame is right.
        let tie = (s.x_axis.length() / s.y_axis.length() - 1.0).abs() < 1e-5;
        prop_assert!(tie || difference(product, m) < 1e-4, "{product} {m}");
    }
}

#[test]
fn empty_ellipsoid_has_no_stretch_and_a_boundless_one_covers_all() {
    use stochastic_light_culling::{
        ConstantLobe, Direction, Ggx, GgxLobe, NoFresnel, Roulette, Vpl, Xi,
    };
    let camera = Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Y, 1.0, 1.0, 0.1..10.0).unwrap();
    let lobe = GgxLobe::new(
        Ggx::new(0.1).unwrap(),
        NoFresnel,
        Incidence::head_on(Direction::Z),
    );
    let (roulette, xi) = (Roulette::new(1e-38).unwrap(), Xi::new(1e-9).unwrap());
    let dark = Vpl::new(Vec3::ZERO, 0.0, lobe).unwrap();
    assert_eq!(dark.bound(&roulette, xi).project(&camera), None);

    let blinding = Vpl::new(Vec3::ONE, f32::MAX, lobe).unwrap();
    let stretch = blinding.bound(&roulette, xi).project(&camera).unwrap();
    assert!(stretch.center().length() <= 1.0 && stretch.matrix().is_finite());
    let point_light = Vpl::new(Vec3::ONE, f32::MAX, ConstantLobe).unwrap();
    assert!(point_light.bound(&roulette, xi).radius() > 1e20);
}
