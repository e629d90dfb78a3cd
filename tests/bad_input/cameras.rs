//! Cameras from numbers and from an engine's matrices.

use stochastic_light_culling::{
    AnyCamera, Camera, Error,
    glam::{Mat4, Vec3, Vec4},
};

fn look_at(fov: f32, aspect: f32, near: f32, far: f32) -> Result<Camera, Error> {
    Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Y, fov, aspect, near..far)
}

#[test]
fn cameras_that_see_nothing() {
    let all_but = |value: f32| [f32::NAN, value, f32::NEG_INFINITY];
    for value in all_but(0.0).into_iter().chain([3.2]) {
        assert!(
            look_at(value, 1.0, 0.1, 10.0)
                .unwrap_err()
                .to_string()
                .contains(&value.to_string())
        );
    }
    for value in all_but(0.0) {
        assert!(
            look_at(1.0, value, 0.1, 10.0)
                .unwrap_err()
                .to_string()
                .contains(&value.to_string())
        );
    }
    for value in all_but(0.0).into_iter().chain([f32::INFINITY]) {
        assert!(
            look_at(1.0, 1.0, value, 10.0)
                .unwrap_err()
                .to_string()
                .contains(&value.to_string())
        );
    }
    for value in all_but(0.5).into_iter().chain([1.0]) {
        assert!(
            look_at(1.0, 1.0, 1.0, value)
                .unwrap_err()
                .to_string()
                .contains(&value.to_string())
        );
    }
    assert!(look_at(1.0, 1.0, 1.0, f32::INFINITY).is_ok());
    // Each in its range, but both together too wide.
    let wide = look_at(3.1, 100.0, 0.1, 10.0).unwrap_err().to_string();
    assert!(wide.contains("within 89.7°"), "{wide}");
    assert!(look_at(3.1, 1.0, 0.1, 10.0).is_ok());
    for (eye, up, quantity) in [
        (Vec3::X, Vec3::Y, "way from the eye to its target"),
        (Vec3::NAN, Vec3::Y, "eye"),
        (Vec3::ZERO, Vec3::X, "viewing direction × up"),
        (Vec3::ZERO, Vec3::ZERO, "viewing direction × up"),
    ] {
        let error = Camera::look_at(eye, Vec3::X, up, 1.0, 1.0, 0.1..10.0).unwrap_err();
        assert!(error.to_string().starts_with(quantity), "{error}");
    }
}

#[test]
fn matrices_of_another_kind() {
    let projection = Mat4::from_cols(
        Vec4::X,
        Vec4::Y,
        Vec4::new(0.0, 0.0, -1.01, -1.0),
        Vec4::new(0.0, 0.0, -0.101, 0.0),
    );
    assert!(Camera::new(Mat4::IDENTITY, projection).is_ok());
    let scaled = Mat4::from_scale(Vec3::splat(1.01));
    let mut perspective_view = Mat4::IDENTITY;
    perspective_view.x_axis.w = 0.1;
    for view in [scaled, Mat4::ZERO, Mat4::NAN, perspective_view] {
        assert!(Camera::new(view, projection).is_err(), "{view}");
    }
    let mut same_planes = projection;
    same_planes.w_axis.z = 0.0;
    let mut infinite_planes = projection;
    infinite_planes.w_axis.z = f32::INFINITY;
    let mut wide = projection;
    wide.x_axis.x = 1e-3;
    let mut sheared = projection;
    sheared.y_axis.x = 0.1;
    for wrong in [
        Mat4::IDENTITY,
        Mat4::ZERO,
        Mat4::NAN,
        same_planes,
        infinite_planes,
        wide,
        sheared,
    ] {
        assert!(Camera::new(Mat4::IDENTITY, wrong).is_err(), "{wrong}");
    }
}

fn orthographic(edges: [f32; 4], planes: [f32; 2]) -> Mat4 {
    let ([left, right, bottom, top], [near, far]) = (edges, planes);
    Mat4::from_cols(
        Vec4::new(2.0 / (right - left), 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / (top - bottom), 0.0, 0.0),
        Vec4::new(0.0, 0.0, 1.0 / (near - far), 0.0),
        Vec4::new(
            (left + right) / (left - right),
            (bottom + top) / (bottom - top),
            near / (near - far),
            1.0,
        ),
    )
}

#[test]
fn orthographic_matrices_that_see_nothing() {
    let refused = |projection: Mat4, reason: &str| {
        for error in [
            Camera::orthographic(Mat4::IDENTITY, projection).unwrap_err(),
            AnyCamera::new(Mat4::IDENTITY, projection).unwrap_err(),
        ] {
            let message = error.to_string();
            assert!(message.contains("projection matrix"), "{message}");
            assert!(message.contains(reason), "{message}, not {reason}");
        }
    };
    let edges = [-4.0, 4.0, -2.0, 3.0];
    let usual = orthographic(edges, [-1.0, 9.0]);
    for valid in [
        usual,
        // Mirrored, upside down, and with exchanged planes, which is reversed z.
        orthographic([4.0, -4.0, 3.0, -2.0], [9.0, -1.0]),
        orthographic([-1e12, 1e12, -1e-30, 1e-30], [0.0, 1e12]),
        Mat4::IDENTITY,
    ] {
        assert!(
            Camera::orthographic(Mat4::IDENTITY, valid).is_ok(),
            "{valid}"
        );
        assert!(AnyCamera::new(Mat4::IDENTITY, valid).is_ok(), "{valid}");
    }
    let size = "width and height must be positive";
    let mut flat = usual;
    flat.y_axis.y = 0.0;
    refused(flat, size);
    refused(orthographic([-1e12, 2e12, -1.0, 1.0], [0.0, 1.0]), size);
    refused(
        orthographic([1e10, 1e10 + 2e4, -1.0, 1.0], [0.0, 1e13]),
        "near and far planes",
    );
    // Of no width, or between planes that are one.
    refused(orthographic([4.0, 4.0, -2.0, 3.0], [0.0, 1.0]), "finite");
    refused(orthographic(edges, [1.0, 1.0]), "finite");
    refused(orthographic(edges, [f32::NAN, 1.0]), "finite");
    let mut same_planes = usual;
    same_planes.z_axis.z = f32::MAX;
    refused(same_planes, "near and far planes");
    same_planes.z_axis.z = 0.0;
    refused(same_planes, "near and far planes");
    for element in 0..16 {
        let mut broken = usual.to_cols_array();
        broken[element] = f32::NAN;
        let broken = Mat4::from_cols_array(&broken);
        assert!(AnyCamera::new(Mat4::IDENTITY, broken).is_err());
        assert!(Camera::orthographic(Mat4::IDENTITY, broken).is_err());
    }
    for (column, row) in [(0, 1), (1, 0), (2, 0), (2, 1), (0, 2), (1, 2)] {
        let mut sheared = usual;
        sheared.col_mut(column)[row] = 0.1;
        refused(sheared, "zeros off its pattern");
    }
    let transposed = Camera::orthographic(Mat4::IDENTITY, usual.transpose()).unwrap_err();
    assert!(
        transposed.to_string().contains("stored by columns"),
        "{transposed}"
    );
    assert!(AnyCamera::new(Mat4::IDENTITY, usual.transpose()).is_err());
    refused(Mat4::ZERO, "last row");
    let perspective = Mat4::from_cols(Vec4::X, Vec4::Y, -Vec4::W - Vec4::Z, -0.1 * Vec4::Z);
    assert!(Camera::orthographic(Mat4::IDENTITY, perspective).is_err());
    assert!(AnyCamera::new(Mat4::IDENTITY, perspective).is_ok());
    // What takes a perspective says what takes this.
    let error = Camera::new(Mat4::IDENTITY, usual).unwrap_err().to_string();
    assert!(error.contains("`Camera::orthographic` takes"), "{error}");
    // As for a perspective, the view is checked too.
    for view in [Mat4::from_scale(Vec3::splat(1.01)), Mat4::ZERO, Mat4::NAN] {
        assert!(Camera::orthographic(view, usual).is_err());
    }
    let far = Mat4::from_translation(Vec3::new(0.0, 0.0, f32::INFINITY));
    assert!(Camera::orthographic(far, usual).is_err());
}

#[test]
fn orthographic_cameras_that_see_nothing() {
    let look_at = |height: f32, aspect: f32, near: f32, far: f32| {
        Camera::orthographic_look_at(Vec3::ZERO, Vec3::X, Vec3::Y, height, aspect, near..far)
    };
    assert!(look_at(10.0, 1.0, -5.0, 5.0).is_ok());
    for (camera, reason) in [
        (look_at(0.0, 1.0, 0.0, 1.0), "height of the view is 0"),
        (look_at(-1.0, 1.0, 0.0, 1.0), "height of the view is -1"),
        (
            look_at(f32::NAN, 1.0, 0.0, 1.0),
            "height of the view is NaN",
        ),
        (
            look_at(f32::INFINITY, 1.0, 0.0, 1.0),
            "height of the view is inf",
        ),
        (look_at(1.0, 0.0, 0.0, 1.0), "aspect ratio is 0"),
        (look_at(1.0, f32::NAN, 0.0, 1.0), "aspect ratio is NaN"),
        (look_at(1.0, 1.0, f32::NAN, 1.0), "near plane is NaN"),
        (
            look_at(1.0, 1.0, f32::NEG_INFINITY, 1.0),
            "near plane is -inf",
        ),
        (look_at(1.0, 1.0, 1.0, 1.0), "far plane is 1"),
        (look_at(1.0, 1.0, 2.0, 1.0), "far plane is 1"),
        (look_at(1.0, 1.0, 0.0, f32::INFINITY), "far plane is inf"),
        (look_at(1.0, 1.0, 0.0, f32::NAN), "far plane is NaN"),
        (look_at(1e13, 1.0, 0.0, 1.0), "width and height"),
        (look_at(1.0, 1.0, 0.0, 1e13), "near and far planes"),
    ] {
        let message = camera.unwrap_err().to_string();
        assert!(message.contains(reason), "{message}, not {reason}");
    }
}

#[test]
fn jitter_that_leaves_no_view() {
    let perspective = look_at(1.0, 1.0, 0.1, 10.0).unwrap();
    let parallel = Camera::orthographic_look_at(Vec3::ZERO, Vec3::X, Vec3::Y, 2.0, 1.0, 0.0..1.0);
    let parallel = parallel.unwrap();
    let size = [640, 480];
    for (size, pixels) in [
        (size, [f32::NAN, 0.0]),
        (size, [0.0, f32::INFINITY]),
        (size, [f32::MAX, 0.0]),
        ([0, 480], [0.5, 0.5]),
    ] {
        assert!(
            perspective.jittered(size, pixels).is_err(),
            "{size:?} {pixels:?}"
        );
        assert!(
            parallel.jittered(size, pixels).is_err(),
            "{size:?} {pixels:?}"
        );
    }
    assert!(perspective.jittered(size, [0.5, -0.5]).is_ok());
    assert_eq!(parallel.jittered(size, [0.0, 0.0]), Ok(parallel));
}

/// Perspective matrices of each kind are accepted, and refused if they are stored by rows.
#[test]
fn transposed_projections() {
    let clip_depths = |near: f32, far: f32| {
        let depth = far - near;
        [
            [far / depth, -far * near / depth],
            [-near / depth, far * near / depth],
            [(far + near) / depth, -2.0 * far * near / depth],
            [1.0, -near],
            [0.0, near],
            [1.0, -2.0 * near],
        ]
    };
    let planes = [
        [1e-3, 1e4],
        [0.1, 100.0],
        [0.3, 2.0],
        [5.0, 6.0],
        [1e3, 1e9],
    ];
    let edges = [[-0.5, 0.5], [-0.5, 0.8], [0.1, 0.9]];
    let shapes = edges.map(|x| edges.map(|y| (x, y))).concat();
    for [a, b] in planes.map(|[near, far]| clip_depths(near, far)).concat() {
        for ((horizontal, vertical), (forward, flip)) in shapes.iter().flat_map(|shape| {
            [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|way| (*shape, way))
        }) {
            let scale = |[low, high]: [f32; 2]| 2.0 / (high - low);
            let shift = |[low, high]: [f32; 2]| -forward * (high + low) / (high - low);
            let projection = Mat4::from_cols(
                Vec4::new(scale(horizontal), 0.0, 0.0, 0.0),
                Vec4::new(0.0, flip * scale(vertical), 0.0, 0.0),
                Vec4::new(
                    shift(horizontal),
                    flip * shift(vertical),
                    forward * a,
                    forward,
                ),
                Vec4::new(0.0, 0.0, b, 0.0),
            );
            assert!(
                Camera::new(Mat4::IDENTITY, projection).is_ok(),
                "{projection}"
            );
            let transposed = Camera::new(Mat4::IDENTITY, projection.transpose());
            let Err(error) = transposed else {
                panic!("{projection} is accepted transposed");
            };
            let centred = [horizontal, vertical]
                .into_iter()
                .all(|[low, high]| low == -high);
            let message = error.to_string();
            if centred {
                let element = format!("element (3, 2), found {b}");
                assert!(message.contains(&element), "{message}");
            }
            assert!(message.contains("projection matrix"), "{message}");
        }
    }
    let doubled = Mat4::from_cols(
        Vec4::X,
        Vec4::Y,
        Vec4::new(0.0, 0.0, -2.0, -2.0),
        Vec4::new(0.0, 0.0, -0.2, 0.0),
    );
    let message = Camera::new(Mat4::IDENTITY, doubled)
        .unwrap_err()
        .to_string();
    assert!(message.contains("found -2"), "{message}");
}
