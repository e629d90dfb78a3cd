//! Every public constructor, with arguments from bits.

use std::hint::black_box;

use fastrand::Rng;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, AnyCamera, Camera, Conductor, Dielectric, Direction,
    Ellipsoid, Ggx, GgxLobe, Incidence, Interleave, LambertLobe, LtcLobe, NoFresnel, Orthographic,
    Perspective, PhongLobe, PixelRectangle, Roulette, Schlick, Sphere, SphericalGaussian, SpotLobe,
    TileGrid, Xi,
    glam::{Mat3, Mat4, Vec3, Vec4},
};
use support::adversary::{Bound, Drawn, Light, Reach, Tile};
use support::reference::{self, Brdf, Masking, Vector};

use crate::bits::Bits;
use crate::culling;
use crate::families;
use crate::other_lobes;
use crate::probe::{self, Probed};

pub fn everything(bits: &mut Bits) {
    let cameras = cameras(bits);
    for camera in &cameras {
        probe::any_camera(camera);
    }
    match bits.byte() % 8 {
        0 => glossy(bits, &cameras),
        1 => shapes(bits, &cameras),
        2 => fresnel(bits),
        3 => sizes(bits),
        4 => culling::everything(bits, &cameras),
        5 => other_lobes::foreign(bits, &cameras),
        6 => families::families(bits),
        _ => other_lobes::others(bits, &cameras),
    }
}

pub fn directions(bits: &mut Bits) -> Option<[Direction; 2]> {
    let [a, b] = [(); 2].map(|()| Direction::new(bits.vector()).ok());
    let directions = [a?, b?];
    let _ = directions.map(probe::direction);
    Some(directions)
}

fn glossy(bits: &mut Bits, cameras: &[AnyCamera]) {
    let (Ok(ggx), Some([normal, incoming])) = (Ggx::new(bits.number()), directions(bits)) else {
        return;
    };
    let incidence = Incidence { normal, incoming };
    let lobe = LtcLobe::new(ggx, NoFresnel, incidence);
    assert_eq!(
        LtcLobe::many([(ggx, NoFresnel, incidence)]).next(),
        Some(lobe)
    );
    probe::light(lobe, cameras);
    let elements = [(); 4].map(|()| bits.number());
    if let Ok(lobe) = LtcLobe::with_matrix(elements, bits.number(), incidence) {
        probe::light(lobe, cameras);
    }
    let tag = bits.byte();
    if let Ok(schlick) = Schlick::new(bits.number()) {
        let lobe = GgxLobe::new(ggx, schlick, Incidence { normal, incoming });
        probe::ggx_lobe(&lobe, cameras);
        probe::ggx_lobe(&lobe.separable(), cameras);
    }
    if tag < 64 {
        probe::ggx_lobe(
            &GgxLobe::new(ggx, NoFresnel, Incidence { normal, incoming }),
            cameras,
        );
    }
    if let Ok(dielectric) = Dielectric::new(bits.number()) {
        probe::ggx_lobe(
            &GgxLobe::new(ggx, dielectric, Incidence { normal, incoming }),
            cameras,
        );
    }
    if let Ok(conductor) = Conductor::new(bits.number(), bits.number()) {
        probe::ggx_lobe(
            &GgxLobe::new(ggx, conductor, Incidence { normal, incoming }),
            cameras,
        );
    }
    if let (Ok(grain), Ok(tangent)) = (
        AnisotropicGgx::new(ggx.roughness(), bits.number()),
        Direction::new(bits.vector()),
    ) {
        if let Ok(lobe) =
            AnisotropicGgxLobe::new(grain, NoFresnel, Incidence { normal, incoming }, tangent)
        {
            probe::grained_lobe(&lobe, cameras);
        }
    }
}

fn shapes(bits: &mut Bits, cameras: &[AnyCamera]) {
    if let Ok(sphere) = Sphere::new(bits.vector(), bits.number()) {
        sphere.probe(cameras);
    }
    let rotation = match Direction::new(bits.vector()) {
        Ok(axis) if bits.byte() < 200 => {
            let (v, w) = axis.any_orthonormal_pair();
            Mat3::from_cols(*axis, v, w)
        }
        _ => bits.matrix(),
    };
    if let Ok(ellipsoid) = Ellipsoid::new(bits.vector(), rotation, bits.vector()) {
        probe::ellipsoid(&ellipsoid, cameras);
    }
}

fn fresnel(bits: &mut Bits) {
    let _ = Schlick::new(bits.number()).map(|f| probe::fresnel(&f));
    let _ = Dielectric::new(bits.number()).map(|f| probe::fresnel(&f));
    let _ = Conductor::new(bits.number(), bits.number()).map(|f| probe::fresnel(&f));
}

fn sizes(bits: &mut Bits) {
    let image = [bits.size(), bits.size()];
    if let Ok(grid) = TileGrid::new(image, bits.size()) {
        black_box((grid.size(), grid.tiles().next()));
        let tile = [bits.size(), bits.size()];
        let PixelRectangle { min, max } = grid.pixels(tile);
        assert!((0..2).all(|i| min[i] <= max[i] && max[i] <= image[i]));
        black_box(grid.tile_of(tile));
    }
    if let Ok(interleave) = Interleave::new(image, bits.size()) {
        let pixel = [0, 1].map(|i| bits.size() % image[i]);
        let (subregion, local) = interleave.split_pixel(pixel);
        assert_eq!(interleave.join_pixel(subregion, local), pixel);
        black_box((interleave.weight(), interleave.subregion_size(subregion)));
        let light = bits.size();
        let (subregion, local) = interleave.split_light(light);
        assert_eq!(interleave.join_light(subregion, local), light);
        black_box(interleave.lights_in(subregion, light));
        let [min, max] = [(); 2].map(|()| [bits.size(), bits.size()]);
        black_box(interleave.join_pixels(bits.size(), PixelRectangle { min, max }));
    }
}

/// A camera that always is, and those that the bits make.
fn cameras(bits: &mut Bits) -> Vec<AnyCamera> {
    let usual = Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Y, 1.0, 1.5, 0.1..100.0);
    let looking = Camera::look_at(
        bits.vector(),
        bits.vector(),
        bits.vector(),
        bits.number(),
        bits.number(),
        bits.number()..bits.number(),
    );
    let view = match &looking {
        Ok(camera) if bits.byte() < 200 => {
            let mut view = Mat4::from_mat3(camera.rotation());
            view.w_axis = bits.vector().extend(1.0);
            view
        }
        _ => bits.matrix4(),
    };
    let parallel = Camera::orthographic_look_at(
        bits.vector(),
        bits.vector(),
        bits.vector(),
        bits.number(),
        bits.number(),
        bits.number()..bits.number(),
    );
    let is_perspective = bits.byte() < 128;
    let [w_of_z, w_of_w] = if is_perspective {
        [1.0, 0.0]
    } else {
        [0.0, 1.0]
    };
    let mut projection = Mat4::from_cols(
        Vec4::new(bits.number(), 0.0, 0.0, 0.0),
        Vec4::new(0.0, bits.number(), 0.0, 0.0),
        if is_perspective {
            bits.vector()
        } else {
            bits.number() * Vec3::Z
        }
        .extend(w_of_z),
        if is_perspective {
            bits.number() * Vec3::Z
        } else {
            bits.vector()
        }
        .extend(w_of_w),
    );
    if bits.byte() < 32 {
        projection = bits.matrix4();
    }
    let given = AnyCamera::new(view, projection).ok();
    let looking = [usual, looking].into_iter().flatten().map(AnyCamera::from);
    let parallel = parallel.into_iter().map(AnyCamera::from);
    looking.chain(parallel).chain(given).collect()
}

/// A light with its parameters from bits, where they lie in the domain, against a tile that it
/// reaches.
pub fn light_in_domain(bits: &mut Bits) {
    let (roughness, albedo, f0) = (bits.number(), bits.number(), bits.number());
    let (eta, kappa) = (bits.number(), bits.number());
    let fresnel = match bits.byte() % 6 {
        0 if Schlick::new(f0).is_ok() => reference::Fresnel::Schlick(f0),
        1 if Dielectric::new(eta).is_ok() => reference::Fresnel::Dielectric(eta),
        2 if Conductor::new(eta, kappa).is_ok() => reference::Fresnel::Conductor(eta, kappa),
        _ => reference::Fresnel::None,
    };
    let masking = if bits.byte() < 128 {
        Masking::HeightCorrelated
    } else {
        Masking::Separable
    };
    let brdf = match bits.byte() % 8 {
        0 if LambertLobe::new(albedo, Direction::Z).is_ok() => Brdf::Lambert { albedo },
        1 => Brdf::Constant,
        2 if SpotLobe::new(roughness, albedo, Direction::Z).is_ok() => {
            Brdf::spot([roughness, albedo])
        }
        2..5 => {
            let [along, across] = [roughness, bits.number()];
            let Ok(tangent) = Direction::new(bits.vector()) else {
                return;
            };
            if AnisotropicGgx::new(along, across).is_err() {
                return;
            }
            Brdf::Anisotropic {
                roughness: [along, across],
                tangent,
                fresnel,
                masking,
            }
        }
        5 => {
            // As the exact model needs it.
            let exponent = (16.0 * bits.number()).round() / 16.0;
            if PhongLobe::new(
                albedo,
                exponent,
                Incidence {
                    normal: Direction::Z,
                    incoming: Direction::Z,
                },
            )
            .is_err()
            {
                return;
            }
            Brdf::Phong { albedo, exponent }
        }
        6 => {
            let [amplitude, sharpness] = [albedo, bits.number()];
            if SphericalGaussian::new(Direction::Z, sharpness, amplitude).is_err() {
                return;
            }
            Brdf::SphericalGaussian {
                amplitude,
                sharpness,
            }
        }
        _ if Ggx::new(roughness).is_ok() => Brdf::Ggx {
            roughness,
            fresnel,
            masking,
        },
        _ => return,
    };
    let Some([normal, incoming]) = directions(bits) else {
        return;
    };
    let light = Light {
        brdf: brdf.laid_on(Vector::from(*normal)),
        normal,
        incoming,
        position: bits.vector(),
        flux: bits.number(),
        delta: bits.number(),
        xi: bits.number(),
    };
    let valid = light.position.is_finite()
        && light.flux.is_finite()
        && light.flux >= 0.0
        && Roulette::new(light.delta).is_ok()
        && Xi::new(light.xi).is_ok();
    if !valid {
        return;
    }
    let range = light.reach(light.peak().unit()).hi();
    let distance = Vector::from(light.position).length();
    if !(1e-12..1e12).contains(&range) || distance > 1e6 * range {
        return;
    }
    let bound = light.bound();
    let mut rng = Rng::with_seed(bits.seed());
    for _ in 0..8 {
        touched::<Perspective>(&mut rng, &light, &bound);
        touched::<Orthographic>(&mut rng, &light, &bound);
    }
}

fn touched<P: Drawn>(rng: &mut Rng, light: &Light, bound: &Bound) {
    if let Some(tile) = Tile::<P>::draw(rng, light) {
        let lost = bound.that_lose_exactly(&tile);
        assert!(lost.is_empty(), "{lost:?} of {light:?} in {tile:?}");
    }
}
