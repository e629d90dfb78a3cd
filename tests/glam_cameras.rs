//! The projection matrices of the newer glam. The first release of the older one has other names for them.

use approx::assert_relative_eq;
use stochastic_light_culling::{
    AnyCamera, PixelRectangle,
    glam::{
        Mat4, Vec3,
        camera::{lh, rh},
    },
};

/// Of every convention of glam's: both hands, all three interfaces, and z reversed by exchanged planes.
#[test]
fn matrices_of_glam_are_recognised() {
    let orthographic = [
        (
            rh::proj::directx::orthographic as fn(f32, f32, f32, f32, f32, f32) -> Mat4,
            -1.0,
            0.0,
        ),
        (rh::proj::opengl::orthographic, -1.0, -1.0),
        (rh::proj::vulkan::orthographic, -1.0, 0.0),
        (lh::proj::directx::orthographic, 1.0, 0.0),
        (lh::proj::opengl::orthographic, 1.0, -1.0),
        (lh::proj::vulkan::orthographic, 1.0, 0.0),
    ];
    for (matrix, ahead, at_near) in orthographic {
        for is_reversed in [false, true] {
            let (near, far) = (-5.0, 20.0);
            let (first, last) = if is_reversed {
                (far, near)
            } else {
                (near, far)
            };
            let projection = matrix(-3.0, 5.0, -2.0, 1.0, first, last);
            let camera = AnyCamera::new(Mat4::IDENTITY, projection).unwrap();
            let AnyCamera::Orthographic(camera) = camera else {
                panic!("{projection} has no vanishing point");
            };
            let all = PixelRectangle {
                min: [0; 2],
                max: [8, 3],
            };
            let view = camera.tile_rectangle([8, 3], all);
            assert_relative_eq!(view.min().x, -3.0, epsilon = 1e-5);
            assert_relative_eq!(view.min().y, -2.0, epsilon = 1e-5);
            assert_relative_eq!(view.max().x, 5.0, epsilon = 1e-5);
            assert_relative_eq!(view.max().y, 1.0, epsilon = 1e-5);
            // What lies at a plane has the depth of that plane, and depths are positive.
            let (value_at_near, value_at_far) = if is_reversed {
                (1.0, at_near)
            } else {
                (at_near, 1.0)
            };
            for (distance, value) in [(near, value_at_near), (far, value_at_far)] {
                let point = Vec3::new(1.0, -1.0, ahead * distance);
                let seen = camera.to_camera_space(point);
                assert_relative_eq!(seen.z, camera.depth(value), max_relative = 1e-6);
                assert!(seen.z > 1.0 && seen.truncate() == point.truncate());
            }
        }
    }
    let perspective = [
        rh::proj::directx::perspective(1.0, 1.5, 0.1, 100.0),
        rh::proj::directx::perspective_infinite_reverse(1.0, 1.5, 0.1),
        rh::proj::opengl::perspective(1.0, 1.5, 0.1, 100.0),
        rh::proj::vulkan::perspective(1.0, 1.5, 0.1, 100.0),
        lh::proj::directx::perspective(1.0, 1.5, 0.1, 100.0),
        lh::proj::directx::perspective_infinite_reverse(1.0, 1.5, 0.1),
        lh::proj::vulkan::perspective(1.0, 1.5, 0.1, 100.0),
    ];
    for projection in perspective {
        let camera = AnyCamera::new(Mat4::IDENTITY, projection).unwrap();
        assert!(matches!(camera, AnyCamera::Perspective(_)), "{projection}");
    }
}
