//! Constructors refuse what they cannot use, and say what it was.

mod cameras;

use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, AnisotropicSphericalGaussian, Conductor, ConstantLobe,
    DepthInterval, Dielectric, Direction, DistanceWindow, Ellipsoid, Error, Ggx, Incidence,
    Interleave, LambertLobe, NoFresnel, PhongLobe, Roulette, Schlick, Sphere, SphericalGaussian,
    SpotLobe, TileGrid, TileRectangle, Vpl, Xi,
    glam::{Mat3, Vec2, Vec3},
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
