//! A camera made of an engine's two matrices sees what they see.

use approx::assert_relative_eq;
use proptest::prelude::*;
use stochastic_light_culling::{
    AnyCamera, Camera, PixelRectangle, Sphere,
    glam::{Mat4, Vec3},
};
use support::reference::{self, Vector};
use support::{generators, with_camera};

/// Of `f32`.
const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 / 2.0;

const IMAGE: [u32; 2] = [1920, 1080];

proptest! {
    #![proptest_config(generators::cases(2000))]

    #[test]
    fn points_pixels_and_depths_agree_with_the_matrices(
        view in generators::any_view(),
        direction in generators::unit_vector(),
        distance in generators::log_uniform(1e-2, 1e4),
        pixel in (0..1920_u32, 0..1080_u32),
    ) {
        let camera = AnyCamera::new(view.from_world, view.projection).unwrap();
        with_camera!(&camera, camera => {
            let point = direction * distance;
            let exact = view.to_camera_space(Vector::from(point.to_f32()));
            let seen = Vector::from(camera.to_camera_space(point.to_f32()));
            let [.., [_, _, _, depth_of_origin]] = view.rows();
            let [x, y, _, _] = view.from_world.w_axis.to_array().map(f64::from);
            let magnitude = distance + Vector([x, y, depth_of_origin]).length();
            prop_assert!((seen - exact).length() < 1e-6 * magnitude);
            let back = Vector::from(camera.to_world_space(seen.to_f32()));
            prop_assert!((back - Vector::from(point.to_f32())).length() < 2e-6 * magnitude);

            // Depths of what lies between the near and the far plane, or nearly. Of a perspective, depth buffers hold
            // f32, which resolves large depths poorly.
            let (depth, resolution) = if view.is_orthographic() {
                let per_ndc = 1.0 / f64::from(view.projection.z_axis.z).abs();
                ((1.0 + distance % 2.0) * per_ndc, 1e-6 * (per_ndc + depth_of_origin.abs()))
            } else {
                let depth = distance.min(50.0);
                (depth, 1e-4 * depth + 4e-6 * depth * depth / 0.1)
            };

            // The corners of a pixel, taken to that depth, project back onto its edges.
            let (x, y) = pixel;
            let pixels = PixelRectangle { min: [x, y], max: [x + 1, y + 1] };
            let tile = camera.tile_rectangle(IMAGE, pixels);
            let spread = if view.is_orthographic() { 1.0 } else { depth };
            for (corner, edges) in [(tile.min(), [x, y + 1]), (tile.max(), [x + 1, y])] {
                let [u, v] = corner.to_array().map(f64::from);
                let ndc = view.ndc(Vector([spread * u, spread * v, depth]));
                let edge = [0.5 * (ndc[0] + 1.0) * 1920.0, 0.5 * (1.0 - ndc[1]) * 1080.0];
                prop_assert!((edge[0] - f64::from(edges[0])).abs() < 0.02, "{edge:?} {edges:?}");
                prop_assert!((edge[1] - f64::from(edges[1])).abs() < 0.02, "{edge:?} {edges:?}");
            }
            let middle = Vector::from(camera.point_in_pixel(IMAGE, [x, y], depth as f32));
            let [u, v, z] = middle.0;
            let [u, v] = [u, v].map(|x| x / spread);
            let rim = 1e-6 * (1.0 + u.abs() + v.abs());
            prop_assert_eq!(z, f64::from(depth as f32));
            prop_assert!(f64::from(tile.min().x) - rim <= u && u <= f64::from(tile.max().x) + rim);
            prop_assert!(f64::from(tile.min().y) - rim <= v && v <= f64::from(tile.max().y) + rim);

            let ndc_depth = view.ndc(Vector([0.0, 0.0, depth]))[2] as f32;
            prop_assert!((f64::from(camera.depth(ndc_depth)) - depth).abs() < resolution);
        });
    }
}

proptest! {
    #![proptest_config(generators::cases(2000))]

    /// Where the world's origin is far, nothing of a near sphere is lost.
    #[test]
    fn spheres_are_seen_to_rounding_of_their_distance(
        view in generators::view(),
        direction in generators::unit_vector(),
        distance in generators::log_uniform(1e-4, 1e4),
        far in generators::log_uniform(1.0, 1e5),
    ) {
        let mut view = view;
        view.from_world.w_axis *= Vec3::splat(far as f32).extend(1.0);
        let camera = Camera::new(view.from_world, view.projection).unwrap();
        let eye = Vector::from(camera.to_world_space(Vec3::ZERO));

        let center = (eye + direction * distance).to_f32();
        let sphere = Sphere::new(center, 1.0).unwrap();
        let shape = sphere.project(&camera).unwrap();
        let seen = Vector::from(shape.center());
        let exact = view.to_camera_space(Vector::from(center));
        let of_origin = f64::from(view.from_world.w_axis.truncate().length());
        let rounding = UNIT_ROUNDOFF * (9.0 * exact.length() + 64.0 * UNIT_ROUNDOFF * of_origin);
        prop_assert!((seen - exact).length() <= rounding);

        // It grows by that and by what a tile's box rounds, no more; 20 is the widest secant drawn, and
        // the sum of coordinates is √3 times a length at most.
        let distance = exact.length();
        let of_origin = 64.0 * UNIT_ROUNDOFF * of_origin;
        let margin = UNIT_ROUNDOFF * (20.0 + 16.0 * distance + 40.0 * (distance + 1.0) + of_origin);
        let radius = f64::from(shape.radius_squared()).sqrt();
        prop_assert!(1.0 <= radius && radius <= 1.0 + margin, "{radius}, {margin}");
    }
}

/// Vulkan's NDC y points down, and its first row of pixels is at −1: the picture is the same.
#[test]
fn pixels_of_a_projection_that_turns_y_are_where_they_were() {
    let up = reference::camera::off_centre(false, [-0.5, 0.8], [-0.3, 0.4], [-0.001, 0.1]);
    let down = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * up;
    let [up, down] = [up, down].map(|projection| Camera::new(Mat4::IDENTITY, projection).unwrap());
    for pixel in [[0, 0], [1900, 10], [960, 540], [3, 1079]] {
        let pixels = PixelRectangle {
            min: pixel,
            max: pixel.map(|n| n + 1),
        };
        assert_eq!(
            up.tile_rectangle(IMAGE, pixels),
            down.tile_rectangle(IMAGE, pixels)
        );
        assert_eq!(
            up.point_in_pixel(IMAGE, pixel, 2.0),
            down.point_in_pixel(IMAGE, pixel, 2.0)
        );
    }
    assert!(down.point_in_pixel(IMAGE, [0, 0], 1.0).y > 0.39);
    assert!(down.point_in_pixel(IMAGE, [0, 1079], 1.0).y < -0.29);
}

proptest! {
    #![proptest_config(generators::cases(2000))]

    /// As a translation of clip space after the projection does.
    #[test]
    fn jitter_moves_the_image(
        view in generators::any_view(),
        (right, down) in (-8.0..8.0_f32, -8.0..8.0_f32),
        pixel in (0..1920_u32, 0..1080_u32),
    ) {
        let (x, y) = pixel;
        let [width, height] = IMAGE.map(|n| n as f32);
        let moved = Vec3::new(2.0 * right / width, -2.0 * down / height, 0.0);
        let matrix = Mat4::from_translation(moved) * view.projection;
        let camera = AnyCamera::new(view.from_world, view.projection).unwrap();
        let expected = AnyCamera::new(view.from_world, matrix).unwrap();
        let of_matrix = with_camera!(&expected, camera => camera.point_in_pixel(IMAGE, [x, y], 3.0));
        let [jittered, before] = with_camera!(&camera, camera => {
            [camera.jittered(IMAGE, [right, down]).unwrap(), *camera]
                .map(|camera| camera.point_in_pixel(IMAGE, [x, y], 3.0))
        });
        let view_of = with_camera!(&camera, camera => {
            let all = camera.tile_rectangle(IMAGE, PixelRectangle { min: [0; 2], max: IMAGE });
            3.0 * (all.max().abs().max(all.min().abs())).max_element()
        });
        prop_assert!((jittered - of_matrix).length() < 1e-5 * (1.0 + view_of), "{jittered} {of_matrix}");
        // To the right is what was further left.
        let is_left = jittered.x < before.x;
        prop_assert!(right.abs() < 0.1 || is_left == (right > 0.0));
    }
}

#[test]
fn look_at_looks_at_its_target() {
    let (eye, target) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-2.0, 0.5, 7.0));
    let camera = Camera::look_at(eye, target, Vec3::Y, 1.2, 1.5, 0.1..f32::INFINITY).unwrap();
    let seen = camera.to_camera_space(target);
    assert_relative_eq!(seen.x, 0.0, epsilon = 1e-5);
    assert_relative_eq!(seen.y, 0.0, epsilon = 1e-5);
    assert_relative_eq!(seen.z, (target - eye).length(), max_relative = 1e-6);
    assert!(camera.to_camera_space(target + Vec3::Y).y > 0.0);
    assert_relative_eq!(camera.rotation().determinant(), -1.0, epsilon = 1e-5);
}

#[test]
fn look_at_spans_its_field_of_view_and_its_depths() {
    let camera = Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Z, 1.2, 1.5, 0.5..20.0).unwrap();
    let all = PixelRectangle {
        min: [0, 0],
        max: IMAGE,
    };
    let view = camera.tile_rectangle(IMAGE, all);
    let slope = 0.6_f32.tan();
    assert_relative_eq!(view.max().y, slope, max_relative = 1e-6);
    assert_relative_eq!(view.min().x, -1.5 * slope, max_relative = 1e-6);
    assert_relative_eq!(camera.depth(0.0), 0.5, max_relative = 1e-6);
    assert_relative_eq!(camera.depth(1.0), 20.0, max_relative = 1e-5);
    assert!(camera.depth(f32::NAN).is_nan());
}

/// The near plane is behind the eye.
#[test]
fn orthographic_look_at_spans_its_height_and_its_depths() {
    let (eye, target) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-2.0, 0.5, 7.0));
    let camera = Camera::orthographic_look_at(eye, target, Vec3::Y, 6.0, 1.5, -4.0..16.0).unwrap();
    let all = PixelRectangle {
        min: [0, 0],
        max: IMAGE,
    };
    let view = camera.tile_rectangle(IMAGE, all);
    assert_eq!(
        (view.min().to_array(), view.max().to_array()),
        ([-4.5, -3.0], [4.5, 3.0])
    );
    let [near, far] = [0.0, 1.0].map(|value| camera.depth(value));
    assert_eq!((near, far), (40.0, 60.0));
    for (point, [x, y, depth]) in [
        (eye, [0.0, 0.0, near + 4.0]),
        (target, [0.0, 0.0, near + 4.0 + (target - eye).length()]),
    ] {
        let seen = camera.to_camera_space(point);
        assert!((seen - Vec3::new(x, y, depth)).length() < 2e-5, "{seen}");
    }
    assert!(camera.to_camera_space(target + Vec3::Y).y > 0.0);
    assert!(camera.depth(f32::NAN).is_nan());
    let middle = camera.point_in_pixel([3, 3], [1, 1], near + 4.0);
    assert!((camera.to_world_space(middle) - eye).length() < 2e-5);
}
