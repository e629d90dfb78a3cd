//! Constructors refuse what they cannot use, and say what it was.

use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, AnisotropicSphericalGaussian, AnyCamera, Camera, Conductor,
    ConstantLobe, DepthInterval, Dielectric, Direction, DistanceWindow, Ellipsoid, Error, Ggx,
    Incidence, Interleave, LambertLobe, NoFresnel, PhongLobe, Roulette, Schlick, Sphere,
    SphericalGaussian, SpotLobe, TileGrid, TileRectangle, Vpl, Xi,
    glam::{Mat3, Mat4, Vec2, Vec3, Vec4},
};

const NOT_NUMBERS: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// All of `values` and everything that is no number are refused, by a message that names the value.
fn refuses<T>(values: &[f32], construct: impl Fn(f32) -> Result<T, Error>) {
    for value in values.iter().copied().chain(NOT_NUMBERS) {
        let error = construct(value)
            .err()
            .unwrap_or_else(|| panic!("{value} is accepted"));
        let message = error.to_string();
        assert!(
            message.contains(&value.to_string()),
            "{message} does not name {value}"
        );
        assert!(!message.contains('\n'));
    }
}

#[test]
fn numbers_out_of_range() {
    let one = Vec3::ONE;
    refuses(&[0.0, -0.1, 1.000_001, 1e-7, 1e-40], Ggx::new);
    let rough = [0.0, -0.1, 1.000_001, 1e-7, 1e-40];
    refuses(&rough, |alpha| AnisotropicGgx::new(alpha, 0.5));
    refuses(&rough, |alpha| AnisotropicGgx::new(0.5, alpha));
    refuses(&[-1e-9, 1.000_001, -1e-45], Schlick::new);
    refuses(&[0.0, -1.5, 1e-10, 1e10], Dielectric::new);
    refuses(&[0.0, -1.5, 1e10], |eta| Conductor::new(eta, 1.0));
    refuses(&[-1e-9, 1e-13, 1e10], |kappa| Conductor::new(1.0, kappa));
    refuses(&[-0.1, 1.1], |albedo| {
        LambertLobe::new(albedo, Direction::Z)
    });
    refuses(&[-0.1, 1.1], |albedo| {
        PhongLobe::new(
            albedo,
            20.0,
            Incidence {
                normal: Direction::Z,
                incoming: Direction::Z,
            },
        )
    });
    refuses(&[-1e-45, -1.0, 1_048_577.0, 1e10], |exponent| {
        PhongLobe::new(
            0.5,
            exponent,
            Incidence {
                normal: Direction::Z,
                incoming: Direction::Z,
            },
        )
    });
    refuses(&[-1.0, 1e10], |exponent| {
        PhongLobe::about(0.5, exponent, Direction::Z)
    });
    refuses(&[-1e-9, 1.000_001 * std::f32::consts::PI, 1e10], |outer| {
        SpotLobe::new(0.0, outer, Direction::Z)
    });
    refuses(&[-1e-9, 0.700_000_1, 1e10], |inner| {
        SpotLobe::new(inner, 0.7, Direction::Z)
    });
    refuses(&[0.0, -1.0, 1e-40], DistanceWindow::new);
    refuses(&[-1.0, -1e-45, 3e37], |intensity| {
        Vpl::point(one, intensity)
    });
    refuses(&[-1e-45, -1.0, 4_194_305.0, 1e10], |sharpness| {
        SphericalGaussian::new(Direction::Z, sharpness, 1.0)
    });
    refuses(&[-1e-45, -1.0], |amplitude| {
        SphericalGaussian::new(Direction::Z, 1.0, amplitude)
    });
    refuses(&[-1.0, 3e38], |integral| {
        SphericalGaussian::with_integral(Direction::Z, 4e6, integral)
    });
    let head_on = Incidence::head_on(Direction::Z);
    refuses(&[-0.1, 1.1], |share| {
        SphericalGaussian::diffuse(share, Direction::Z)
    });
    refuses(&[-0.1, 1.1], |share| {
        SphericalGaussian::specular(Ggx::new(0.5).unwrap(), share, head_on)
    });
    let flat = |bandwidths, amplitude| {
        AnisotropicSphericalGaussian::new(Direction::Z, Direction::X, bandwidths, amplitude)
    };
    refuses(&[-1.0, 1e12], |bandwidth| flat([bandwidth, 1.0], 1.0));
    refuses(&[-1.0, 1e12], |bandwidth| flat([1.0, bandwidth], 1.0));
    refuses(&[-1.0], |amplitude| flat([1.0, 1.0], amplitude));
    refuses(&[0.0, -0.001], Roulette::new);
    refuses(&[0.0, -0.5, 1.000_001], Xi::new);
    refuses(&[-1.0, -1e-45], |flux| Vpl::new(one, flux, ConstantLobe));
    refuses(&[-1.0], |radius| Sphere::new(one, radius));
    refuses(&[-1.0], |near| DepthInterval::new(near, 2.0));
    refuses(&[0.999, -1.0], |far| DepthInterval::new(1.0, far));
}

#[test]
fn edges_of_the_ranges_are_accepted() {
    for roughness in [1e-6, Ggx::MIN_ROUGHNESS, 1.0] {
        assert!(Ggx::new(roughness).is_ok());
    }
    assert!(Schlick::new(0.0).is_ok() && Schlick::new(1.0).is_ok());
    for exponent in [0.0, 1e-45, PhongLobe::MAX_EXPONENT] {
        assert!(PhongLobe::about(1.0, exponent, Direction::Z).is_ok());
    }
    for outer in [0.0, 1e-45, std::f32::consts::PI] {
        assert!(SpotLobe::new(0.0, outer, Direction::Z).is_ok());
        assert!(SpotLobe::new(outer, outer, Direction::Z).is_ok());
    }
    for sharpness in [0.0, 1e-45, SphericalGaussian::MAX_SHARPNESS] {
        assert!(SphericalGaussian::new(Direction::Z, sharpness, f32::MAX).is_ok());
    }
    assert!(Roulette::new(1e-45).is_ok() && Roulette::new(f32::MAX).is_ok());
    assert!(Xi::new(1.0).is_ok() && Xi::new(1e-45).is_ok());
    assert!(Vpl::new(Vec3::ZERO, 0.0, ConstantLobe).is_ok());
    assert!(DepthInterval::new(3.0, 3.0).is_ok());
}

#[test]
fn vectors_without_a_direction_or_a_place() {
    for value in [Vec3::ZERO, Vec3::NAN, Vec3::new(1.0, f32::INFINITY, 0.0)] {
        let message = Direction::new(value).unwrap_err().to_string();
        assert!(message.contains(&value.to_string()), "{message}");
    }
    for value in [Vec3::NAN, Vec3::new(1.0, f32::NEG_INFINITY, 0.0)] {
        for message in [
            Vpl::new(value, 1.0, ConstantLobe).unwrap_err().to_string(),
            Sphere::new(value, 1.0).unwrap_err().to_string(),
            Ellipsoid::new(value, Mat3::IDENTITY, Vec3::ONE)
                .unwrap_err()
                .to_string(),
        ] {
            assert!(message.contains(&value.to_string()), "{message}");
        }
    }
    for length in [1e-45, 1e-38, 1e-20, 1.0, 1e20, f32::MAX] {
        let direction = Direction::new(Vec3::new(length, 0.0, length)).unwrap();
        assert!((direction.length() - 1.0).abs() < 1e-6, "{length}");
    }
}

#[test]
fn roughness_is_named_by_its_axis() {
    for (along, across, name) in [(2.0, 0.5, "α_x"), (0.5, 2.0, "α_y")] {
        let message = AnisotropicGgx::new(along, across).unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
    }
}

#[test]
fn tangents_along_the_normal() {
    let ggx = AnisotropicGgx::new(0.1, 0.5).unwrap();
    let normal = Direction::new(Vec3::new(0.3, -0.2, 0.7)).unwrap();
    let lobe = |tangent| {
        AnisotropicGgxLobe::new(
            ggx,
            NoFresnel,
            Incidence {
                normal,
                incoming: Direction::Z,
            },
            tangent,
        )
    };
    // In any direction and length before it was a unit vector, and when nothing but rounding is left.
    for scale in [1.0, -1.0, 1e-20, 3.3] {
        let along = Direction::new(scale * *normal).unwrap();
        let nudged = Direction::new(*along + 1e-7 * Vec3::X).unwrap();
        for tangent in [along, nudged] {
            let message = lobe(tangent).unwrap_err().to_string();
            assert!(message.contains("tangent is"), "{message}");
            assert!(message.contains(&tangent.to_string()), "{message}");
        }
    }
    // At any other angle it is one.
    assert!(lobe(Direction::new(*normal + 1e-5 * Vec3::X).unwrap()).is_ok());
    assert!(lobe(Direction::X).is_ok());
}

#[test]
fn shapes_that_are_none() {
    for semi_axes in [
        Vec3::ZERO,
        Vec3::NAN,
        Vec3::new(1.0, -1.0, 1.0),
        Vec3::new(1.0, 1.0, f32::INFINITY),
        Vec3::new(1e-20, 1.0, 1.0),
    ] {
        let message = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, semi_axes)
            .unwrap_err()
            .to_string();
        assert!(message.contains(&semi_axes.to_string()), "{message}");
    }
    for rotation in [
        Mat3::ZERO,
        Mat3::from_diagonal(Vec3::splat(1.001)),
        Mat3::NAN,
    ] {
        assert!(Ellipsoid::new(Vec3::ZERO, rotation, Vec3::ONE).is_err());
    }
    let (low, high) = (Vec2::new(0.0, 0.0), Vec2::new(1.0, -0.1));
    assert!(TileRectangle::new(low, high).is_err());
    assert!(TileRectangle::new(low, Vec2::NAN).is_err());
    assert!(TileRectangle::new(Vec2::INFINITY, high).is_err());
    assert!(TileRectangle::new(low, Vec2::new(1.0, 1e12)).is_ok());
    let beyond = Vec2::new(1.0, 1.000_001e12);
    for rectangle in [
        TileRectangle::new(low, beyond),
        TileRectangle::new(-beyond, low),
    ] {
        assert!(rectangle.unwrap_err().to_string().contains("within ±10¹²"));
    }
}

#[test]
fn sizes_of_nothing() {
    for size in [[0, 5], [5, 0], [0, 0]] {
        let message = TileGrid::new(size, 16).unwrap_err().to_string();
        assert!(
            message.contains(&format!("{}×{}", size[0], size[1])),
            "{message}"
        );
        assert!(Interleave::new(size, 1).is_err());
    }
    assert!(
        TileGrid::new([5, 5], 0)
            .unwrap_err()
            .to_string()
            .contains("tile size is 0×0")
    );
    assert!(Interleave::new([5, 5], 0).is_err());
    assert!(
        Interleave::new([5, 5], 6)
            .unwrap_err()
            .to_string()
            .contains("6×6")
    );
}

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
