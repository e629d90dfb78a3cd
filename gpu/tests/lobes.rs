//! Lobes on a GPU are those of the exact model to 8 units in the last place, and what one unit of each input makes.

use bytemuck::{Pod, Zeroable};
use fastrand::Rng;
use gpu::{Gpu, Map};
use stochastic_light_culling::{
    Conductor, Dielectric, Direction, Ggx, GgxLobe, GpuLight, Incidence, LambertLobe, Lobe,
    NoFresnel, Schlick, Vpl, glam::Vec3, wgsl,
};
use support::adversary::{Light, Reach};
use support::reference::exact::{Exact, reflectance, value};
use support::reference::{Brdf, Fresnel, Masking};
use twofloat::TwoFloat as Real;

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Case {
    light: GpuLight,
    outgoing: [f32; 3],
    kind: u32,
    tangent: [f32; 3],
    unused: u32,
    roughness: [f32; 2],
    unused_too: [u32; 2],
}

const CASE: &str = "struct Case {
    light: SlcLight, outgoing: vec3f, kind: u32, tangent: vec3f, unused: u32, roughness: vec2f, unused_too: vec2u,
}";

fn record_of<L: Lobe>(light: &Light, lobe: L) -> GpuLight
where
    for<'a> GpuLight: From<&'a Vpl<L>>,
{
    GpuLight::from(&Vpl::new(light.position, light.flux, lobe).unwrap())
}

/// The record of a light, and the case of the function that evaluates its lobe.
fn record(light: &Light) -> Option<(GpuLight, u32)> {
    let incidence = Incidence {
        normal: light.normal,
        incoming: light.incoming,
    };
    Some(match light.brdf {
        Brdf::Lambert { albedo } => (
            record_of(light, LambertLobe::new(albedo, light.normal).unwrap()),
            0,
        ),
        Brdf::Ggx {
            roughness,
            fresnel,
            masking: Masking::HeightCorrelated,
        } => {
            let ggx = Ggx::new(roughness).unwrap();
            match fresnel {
                Fresnel::None => (record_of(light, GgxLobe::new(ggx, NoFresnel, incidence)), 1),
                Fresnel::Schlick(f0) => {
                    let schlick = Schlick::new(f0).unwrap();
                    (record_of(light, GgxLobe::new(ggx, schlick, incidence)), 2)
                }
                Fresnel::Dielectric(eta) => {
                    let dielectric = Dielectric::new(eta).unwrap();
                    (
                        record_of(light, GgxLobe::new(ggx, dielectric, incidence)),
                        3,
                    )
                }
                Fresnel::Conductor(eta, kappa) => {
                    let conductor = Conductor::new(eta, kappa).unwrap();
                    (record_of(light, GgxLobe::new(ggx, conductor, incidence)), 4)
                }
            }
        }
        // At a hard edge, rounding decides between zero and the peak.
        Brdf::Spot { versines, .. } if versines[1] - versines[0] > 1e-5 => {
            (about(light, versines), 5)
        }
        Brdf::SphericalGaussian {
            amplitude,
            sharpness,
        } => (about(light, [sharpness, amplitude]), 6),
        // Narrower lobes are mostly rounding, of which more than the first order counts.
        Brdf::Anisotropic {
            roughness: [along, across],
            fresnel: Fresnel::None,
            masking: Masking::HeightCorrelated,
            ..
        } if along.min(across) > 1e-3 => {
            let ggx = Ggx::new(1.0).unwrap();
            (record_of(light, GgxLobe::new(ggx, NoFresnel, incidence)), 7)
        }
        _ => return None,
    })
}

/// The record of a light about an axis, with the parameters of its lobe in the place of those of a Fresnel factor.
fn about(light: &Light, parameters: [f32; 2]) -> GpuLight {
    GpuLight {
        normal: light.normal.to_array(),
        fresnel: parameters,
        ..GpuLight::zeroed()
    }
}

/// The exact value of a lobe of directions that are unit vectors, or nearly so.
fn exact(brdf: Brdf, [normal, incoming, outgoing]: [Exact; 3]) -> f64 {
    value(brdf, normal, incoming, outgoing).hi()
}

fn units(vectors: [Vec3; 3]) -> [Exact; 3] {
    vectors.map(|v| Exact::from(v).unit())
}

/// By how much the value changes for 2⁻²³ in each component of its directions, which are off by as much as vectors, for
/// their lengths, which are off from 1 as well, and for what F and exponential functions are functions of.
fn of_inputs(light: &Light, vectors: [Vec3; 3]) -> f64 {
    let value = exact(light.brdf, units(vectors));
    let mut sum = 0.0;
    for vector in 0..3 {
        for i in 0..3 {
            let mut moved = vectors;
            moved[vector][i] += f32::EPSILON;
            sum += (exact(light.brdf, units(moved)) - value).abs();
        }
    }
    if let Brdf::Spot { angles, versines } = light.brdf {
        // Twice a unit, since 1 − cosγ, which they are compared with, has as much.
        for (i, ulps) in [(0, 2.0), (0, -2.0), (1, 2.0), (1, -2.0)] {
            let mut versines = versines;
            versines[i] += ulps * f32::EPSILON * versines[1];
            let brdf = Brdf::Spot { angles, versines };
            sum += (exact(brdf, units(vectors)) - value).abs();
        }
        return sum;
    }
    if let Brdf::SphericalGaussian { amplitude, .. } = light.brdf {
        // The exponent is a number in single precision: four roundings of its own.
        let exponent = (value / f64::from(amplitude)).max(1e-38).ln().abs();
        return sum + 4.0 * f64::from(f32::EPSILON) * exponent * value;
    }
    if let Brdf::Anisotropic {
        roughness,
        tangent,
        fresnel,
        masking,
    } = light.brdf
    {
        for i in 0..3 {
            let mut moved = *tangent;
            // Three units, for the two products and the length that make an axis of the surface of it.
            moved[i] += 3.0 * f32::EPSILON;
            let tangent = Direction::new(moved).unwrap();
            let brdf = Brdf::Anisotropic {
                roughness,
                tangent,
                fresnel,
                masking,
            };
            sum += (exact(brdf, units(vectors)) - value).abs();
        }
        return sum + (exact(light.brdf, vectors.map(Exact::from)) - value).abs();
    }
    let Brdf::Ggx {
        roughness,
        fresnel,
        masking,
    } = light.brdf
    else {
        return sum;
    };
    let without = Brdf::Ggx {
        roughness,
        fresnel: Fresnel::None,
        masking,
    };
    let rest = exact(without, units(vectors));
    let of_lengths = (exact(without, vectors.map(Exact::from)) - rest).abs();
    let [_, incoming, outgoing] = units(vectors);
    let both = incoming + outgoing;
    let cosine = both.dot(both).sqrt().hi() * 0.5;
    let at = |cosine: f64| reflectance(fresnel, Real::from(cosine)).hi();
    let of_cosine = (at(cosine - 2.0 * f64::from(f32::EPSILON)) - at(cosine)).abs();
    sum + of_lengths * at(cosine) + of_cosine * rest
}

#[test]
fn lobes_are_exact_to_eight_units_and_their_inputs() {
    let gpu = Gpu::new().unwrap();
    let map = Map {
        sources: &[wgsl::NUM, wgsl::LOBE, wgsl::BOUND, wgsl::SPOT, wgsl::GAUSSIAN, wgsl::ANISOTROPIC, CASE],
        input: "Case",
        output: "f32",
        body: "
            switch input.kind {
                case 0u: { return slc_lambert(input.light.fresnel.x, input.light.normal, input.outgoing); }
                case 1u: { return slc_ggx(input.light, input.outgoing); }
                case 2u: { return slc_ggx_schlick(input.light, input.outgoing); }
                case 3u: { return slc_ggx_dielectric(input.light, input.outgoing); }
                case 4u: { return slc_ggx_conductor(input.light, input.outgoing); }
                case 5u: { return slc_spot(input.light.normal, input.light.fresnel, input.outgoing); }
                case 6u: {
                    let parameters = input.light.fresnel;
                    return slc_gaussian(input.light.normal, parameters.x, parameters.y, input.outgoing);
                }
                default: { return slc_anisotropic_ggx(input.light, input.tangent, input.roughness, input.outgoing); }
            }",
    };
    let mut rng = Rng::with_seed(3);
    let mut lights = Vec::new();
    let mut cases = Vec::new();
    while cases.len() < 60_000 {
        let light = Light::draw(&mut rng);
        let Some((record, kind)) = record(&light) else {
            continue;
        };
        for _ in 0..4 {
            let [x, y, z] = light.outgoing(&mut rng).0.map(|x| x.hi() as f32);
            let Ok(outgoing) = Direction::new(Vec3::new(x, y, z)) else {
                continue;
            };
            if kind == 7 && (*light.incoming + *outgoing).length() < 0.1 {
                continue;
            }
            let (tangent, roughness) = match light.brdf {
                Brdf::Anisotropic {
                    tangent, roughness, ..
                } => (tangent.to_array(), roughness),
                _ => ([0.0; 3], [0.0; 2]),
            };
            lights.push(light);
            cases.push(Case {
                light: record,
                outgoing: outgoing.to_array(),
                kind,
                tangent,
                roughness,
                ..Case::zeroed()
            });
        }
    }
    let found: Vec<f32> = gpu.map(&map, &cases).unwrap();
    let mut greatest = [0.0_f64; 8];
    for ((light, case), found) in lights.iter().zip(&cases).zip(found) {
        let vectors = [*light.normal, *light.incoming, Vec3::from(case.outgoing)];
        let value = exact(light.brdf, units(vectors));
        let off = (f64::from(found) - value).abs();
        // Products on the way may be subnormal, and then zero.
        let allowed = 8.0 * f64::from(f32::EPSILON) * value.max(f64::from(found))
            + of_inputs(light, vectors)
            + 1e-30;
        assert!(
            off <= allowed,
            "{found} and not {value} ± {allowed}: {light:?} to {:?}",
            case.outgoing
        );
        greatest[case.kind as usize] = greatest[case.kind as usize].max(off / allowed);
    }
    println!("of what is allowed, by lobe, at most {greatest:.2?}");
}
