//! Every field of every constructor in turn, with each special number.

use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, AnyCamera, Camera, Conductor, ConstantLobe, DepthInterval,
    Dielectric, Direction, Ellipsoid, Error, Ggx, GgxLobe, Incidence, LambertLobe, NoFresnel,
    Roulette, Schlick, Sphere, TileRectangle, Vpl, Xi,
    glam::{Mat3, Mat4, Vec2, Vec3},
};

use crate::bits::SPECIAL;
use crate::probe::{self, Probed};

/// `construct` from `valid`, and from that with each number in turn replaced by each special one: it
/// gives an error of one line, or something that passes `probe`.
fn each_field<T, const N: usize>(
    valid: [f32; N],
    construct: impl Fn([f32; N]) -> Result<T, Error>,
    probe: impl Fn(&T),
) {
    probe(&construct(valid).expect("valid"));
    for i in 0..N {
        for special in SPECIAL {
            let mut fields = valid;
            fields[i] = special;
            match construct(fields) {
                Ok(made) => probe(&made),
                Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{error}"),
            }
        }
    }
}

fn usual() -> [AnyCamera; 2] {
    let (eye, up) = (Vec3::ZERO, Vec3::Y);
    let perspective = Camera::look_at(eye, Vec3::X, up, 1.0, 1.5, 0.1..100.0);
    let parallel = Camera::orthographic_look_at(eye, Vec3::X, up, 9.0, 1.5, -9.0..9.0);
    [
        perspective.expect("valid").into(),
        parallel.expect("valid").into(),
    ]
}

fn ignore<T>(_: &T) {}

#[test]
fn of_lobes() {
    let cameras = usual();
    let incoming = Direction::new(Vec3::new(0.3, 0.2, 0.9)).expect("not zero");
    let lobe = |ggx| {
        GgxLobe::new(
            ggx,
            NoFresnel,
            Incidence {
                normal: Direction::Z,
                incoming,
            },
        )
    };
    each_field(
        [0.1],
        |[alpha]| Ggx::new(alpha),
        |ggx| probe::ggx_lobe(&lobe(*ggx), &cameras),
    );
    each_field(
        [0.1, 0.3, 1.0, 2.0, 3.0],
        |[along, across, x, y, z]| {
            let grain = AnisotropicGgx::new(along, across)?;
            let tangent = Direction::new(Vec3::new(x, y, z))?;
            AnisotropicGgxLobe::new(
                grain,
                NoFresnel,
                Incidence {
                    normal: Direction::Z,
                    incoming,
                },
                tangent,
            )
        },
        |lobe| probe::grained_lobe(lobe, &cameras),
    );
    each_field([0.5], |[f0]| Schlick::new(f0), probe::fresnel);
    each_field([1.5], |[eta]| Dielectric::new(eta), probe::fresnel);
    each_field(
        [0.2, 3.5],
        |[eta, kappa]| Conductor::new(eta, kappa),
        probe::fresnel,
    );
    each_field(
        [0.5],
        |[albedo]| LambertLobe::new(albedo, Direction::Z),
        |lobe| probe::lambert_lobe(lobe, &cameras),
    );
    let vector = |v: [f32; 3]| Direction::new(Vec3::from_array(v));
    each_field([1.0, 2.0, 3.0], vector, |direction| {
        probe::direction(*direction);
        let ggx = Ggx::new(0.01).expect("valid");
        probe::ggx_lobe(
            &GgxLobe::new(
                ggx,
                NoFresnel,
                Incidence {
                    normal: *direction,
                    incoming,
                },
            ),
            &cameras,
        );
        probe::ggx_lobe(
            &GgxLobe::new(
                ggx,
                NoFresnel,
                Incidence {
                    normal: incoming,
                    incoming: *direction,
                },
            ),
            &cameras,
        );
    });
}

#[test]
fn of_ranges_and_lights() {
    each_field(
        [0.001],
        |[delta]| Roulette::new(delta),
        |roulette| {
            probe::roulette(roulette, Xi::new(1e-45).expect("valid"));
        },
    );
    let roulette = Roulette::new(1e-45).expect("valid");
    each_field(
        [0.5],
        |[xi]| Xi::new(xi),
        |xi| probe::roulette(&roulette, *xi),
    );
    each_field(
        [1.0, 2.0, 3.0, 4.0],
        |[x, y, z, flux]| Vpl::new(Vec3::new(x, y, z), flux, ConstantLobe),
        |light| {
            light
                .bound(&roulette, Xi::new(1.0).expect("valid"))
                .probe(&usual());
        },
    );
}

#[test]
fn of_shapes_and_tiles() {
    let cameras = usual();
    each_field(
        [1.0, 2.0, 3.0, 4.0],
        |[x, y, z, radius]| Sphere::new(Vec3::new(x, y, z), radius),
        |sphere| sphere.probe(&cameras),
    );
    each_field(
        [
            1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 4.0, 5.0, 6.0,
        ],
        |f| {
            let rotation = Mat3::from_cols_slice(&f[3..12]);
            Ellipsoid::new(Vec3::from_slice(&f), rotation, Vec3::from_slice(&f[12..]))
        },
        |ellipsoid| probe::ellipsoid(ellipsoid, &cameras),
    );
    let rectangle = |[a, b, c, d]: [f32; 4]| TileRectangle::new(Vec2::new(a, b), Vec2::new(c, d));
    each_field([-1.0, -2.0, 3.0, 4.0], rectangle, ignore);
    each_field(
        [1.0, 2.0],
        |[near, far]| DepthInterval::new(near, far),
        ignore,
    );
}

#[test]
fn of_cameras() {
    let vector = |f: &[f32]| Vec3::from_slice(f);
    each_field(
        [
            1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 0.0, 1.0, 0.0, 1.0, 1.5, 0.1, 100.0,
        ],
        |f| {
            let [eye, target, up] = [0, 3, 6].map(|i| vector(&f[i..]));
            Camera::look_at(eye, target, up, f[9], f[10], f[11]..f[12])
        },
        probe::camera,
    );
    let projection = Mat4::from_cols_array(&[
        1.0, 0.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.1, 0.2, -1.01, -1.0, 0.0, 0.0, -0.1, 0.0,
    ]);
    let view = Mat4::from_translation(Vec3::new(1.0, 2.0, 3.0));
    each_field(
        view.to_cols_array(),
        |f| Camera::new(Mat4::from_cols_array(&f), projection),
        probe::camera,
    );
    each_field(
        projection.to_cols_array(),
        |f| AnyCamera::new(view, Mat4::from_cols_array(&f)),
        probe::any_camera,
    );
    each_field(
        [
            1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 0.0, 1.0, 0.0, 8.0, 1.5, -5.0, 100.0,
        ],
        |f| {
            let [eye, target, up] = [0, 3, 6].map(|i| vector(&f[i..]));
            Camera::orthographic_look_at(eye, target, up, f[9], f[10], f[11]..f[12])
        },
        probe::camera,
    );
    let projection = Mat4::from_cols_array(&[
        0.1, 0.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 0.0, -0.01, 0.0, 0.3, -0.4, 0.2, 1.0,
    ]);
    each_field(
        projection.to_cols_array(),
        |f| AnyCamera::new(view, Mat4::from_cols_array(&f)),
        probe::any_camera,
    );
}
