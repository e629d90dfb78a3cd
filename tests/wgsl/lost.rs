//! No light is lost, however badly WGSL allows the operations of the shaders to be done: they run on a machine that errs
//! in each operation by what is allowed, takes sums and products in any order, and knows no infinity.

use std::ops::Range;

use bytemuck::{Pod, bytes_of};
use fastrand::Rng;
use naga::{Handle, Module, ScalarKind, Type, TypeInner};
use rayon::prelude::*;
use stochastic_light_culling::wgsl::{
    BOUND, GAUSSIAN, LIGHT, LOBE, NUM, PROJECT, SPOT, TABLE, TIGHT, TOUCH,
};
use stochastic_light_culling::{
    Conductor, ConstantLobe, Dielectric, Ellipsoid, Ggx, GgxLobe, GpuCamera, GpuLight, Incidence,
    LambertLobe, Lobe, NoFresnel, Schlick, Vpl,
};
use support::adversary::{Bound, Light, Reach, Tile, log_uniform};
use support::reference::{Brdf, Fresnel, Masking};

use super::arithmetic::Arithmetic;
use super::machine::Machine;
use super::valid::{DECLARED, module};
use super::value::Value;

/// A record as a value of the type with this name, by the offsets of its members.
fn record(module: &Module, name: &str, record: &impl Pod) -> Value {
    let mut types = module.types.iter();
    let (ty, _) = types
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .expect("a type");
    value_of_bytes(module, ty, bytes_of(record))
}

fn value_of_bytes(module: &Module, ty: Handle<Type>, bytes: &[u8]) -> Value {
    let scalar = |kind, bytes: &[u8]| {
        let word: [u8; 4] = bytes[..4].try_into().expect("four bytes");
        match kind {
            ScalarKind::Float => Value::F32(f32::from_ne_bytes(word)),
            _ => Value::U32(u32::from_ne_bytes(word)),
        }
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(of) => scalar(of.kind, bytes),
        TypeInner::Vector { size, scalar: of } => Value::Many(
            (0..*size as usize)
                .map(|i| scalar(of.kind, &bytes[4 * i..]))
                .collect(),
        ),
        TypeInner::Struct { members, span } => {
            assert_eq!(*span as usize, bytes.len(), "the size of the record");
            let size = |ty: Handle<Type>| module.types[ty].inner.size(module.to_ctx()) as usize;
            let member = |member: &naga::StructMember| {
                let start = member.offset as usize;
                value_of_bytes(module, member.ty, &bytes[start..start + size(member.ty)])
            };
            Value::Many(members.iter().map(member).collect())
        }
        other => panic!("{other:?} is in no record"),
    }
}

/// A light whose bounds the shaders know, α from `least_roughness`.
fn draw(rng: &mut Rng, least_roughness: f64) -> Light {
    loop {
        let light = Light::draw(rng);
        match light.brdf {
            Brdf::Lambert { .. }
            | Brdf::Constant
            | Brdf::Spot { .. }
            | Brdf::SphericalGaussian { .. } => return light,
            Brdf::Ggx {
                roughness,
                masking: Masking::HeightCorrelated | Masking::Separable,
                ..
            } if f64::from(roughness) >= least_roughness => {
                return light;
            }
            _ => {}
        }
    }
}

fn record_of<L: Lobe>(light: &Light, lobe: L) -> GpuLight
where
    for<'a> GpuLight: From<&'a Vpl<L>>,
{
    GpuLight::from(&Vpl::new(light.position, light.flux, lobe).expect("in the domain"))
}

/// The record of a light.
fn gpu_light(light: &Light) -> GpuLight {
    match light.brdf {
        Brdf::Ggx {
            roughness, fresnel, ..
        } => {
            let ggx = Ggx::new(roughness).expect("in the domain");
            let given = "in the domain";
            let incidence = Incidence {
                normal: light.normal,
                incoming: light.incoming,
            };
            match fresnel {
                Fresnel::None => record_of(light, GgxLobe::new(ggx, NoFresnel, incidence)),
                Fresnel::Schlick(f0) => {
                    let schlick = Schlick::new(f0).expect(given);
                    record_of(light, GgxLobe::new(ggx, schlick, incidence))
                }
                Fresnel::Dielectric(eta) => {
                    let dielectric = Dielectric::new(eta).expect(given);
                    record_of(light, GgxLobe::new(ggx, dielectric, incidence))
                }
                Fresnel::Conductor(eta, kappa) => {
                    let conductor = Conductor::new(eta, kappa).expect(given);
                    record_of(light, GgxLobe::new(ggx, conductor, incidence))
                }
            }
        }
        Brdf::Lambert { albedo } => record_of(
            light,
            LambertLobe::new(albedo, light.normal).expect("in the domain"),
        ),
        _ => record_of(light, ConstantLobe),
    }
}

/// The bounds of a light that the shaders know, placed, by name.
fn bounds(machine: &mut Machine, light: &Light) -> Vec<(&'static str, Value)> {
    let lit = record(machine.module, "SlcLight", &gpu_light(light));
    let axis = Value::from(light.normal.to_array());
    let unit = match light.brdf {
        Brdf::Ggx { fresnel, .. } => {
            let name = match fresnel {
                Fresnel::None => None,
                Fresnel::Schlick(_) => Some("slc_max_schlick"),
                Fresnel::Dielectric(_) => Some("slc_max_dielectric"),
                Fresnel::Conductor(..) => Some("slc_max_conductor"),
            };
            let most = name.map(|name| machine.call(name, std::slice::from_ref(&lit)));
            let most = most.unwrap_or(Value::F32(1.0));
            ["slc_paper_ggx", "slc_tight_ggx"]
                .map(|name| (name, machine.call(name, &[lit.clone(), most.clone()])))
                .to_vec()
        }
        Brdf::Lambert { albedo } => {
            let name = "slc_paper_lambert";
            vec![(name, machine.call(name, &[albedo.into(), axis]))]
        }
        Brdf::Spot { versines, .. } => {
            let name = "slc_tight_spot";
            vec![(name, machine.call(name, &[axis, versines.into()]))]
        }
        Brdf::SphericalGaussian {
            amplitude,
            sharpness,
        } => {
            let name = "slc_tight_gaussian";
            vec![(
                name,
                machine.call(name, &[axis, sharpness.into(), amplitude.into()]),
            )]
        }
        _ => {
            let name = "slc_paper_constant";
            vec![(name, machine.call(name, &[]))]
        }
    };
    let frame = [light.flux, light.delta, light.xi].map(Value::F32);
    let scale = machine.call("slc_scale", &frame);
    let position = Value::from(light.position.to_array());
    let placed = unit.into_iter().map(|(name, unit)| {
        (
            name,
            machine.call("slc_placed", &[unit, position.clone(), scale.clone()]),
        )
    });
    placed.collect()
}

/// Which of the bounds touch the tile.
fn touched(machine: &mut Machine, bounds: &[(&'static str, Value)], tile: &Tile) -> Vec<bool> {
    let camera = record(machine.module, "SlcCamera", &GpuCamera::from(&tile.camera));
    let (min, max) = (tile.rectangle.min(), tile.rectangle.max());
    let rectangle = Value::from(vec![min.to_array().into(), max.to_array().into()]);
    let depths = Value::from([tile.depths.near(), tile.depths.far()]);
    let touches = |(_, bound): &(&str, Value)| {
        let projected = machine.call("slc_project", &[bound.clone(), camera.clone()]);
        machine
            .call(
                "slc_touches",
                &[projected, rectangle.clone(), depths.clone()],
            )
            .bool()
    };
    bounds.iter().map(touches).collect()
}

/// The shaders with all margins times `share`.
fn shaders(share: f32) -> Module {
    let texts = [
        DECLARED, NUM, LOBE, LIGHT, BOUND, TIGHT, SPOT, GAUSSIAN, PROJECT, TOUCH,
    ]
    .concat();
    let line = |line: &str| match line.split_once("_ULPS: f32 = ") {
        Some((name, value)) => {
            let ulps: f32 = value.trim_end_matches(';').parse().expect("a number");
            format!("{name}_ULPS: f32 = {:?};\n", ulps * share)
        }
        None => format!("{line}\n"),
    };
    module(&[&texts.lines().map(line).collect::<String>()])
}

fn table() -> Value {
    let knots = TABLE
        .iter()
        .flatten()
        .copied()
        .map(Value::F32)
        .collect::<Vec<_>>();
    Value::Many(
        knots
            .chunks(4)
            .map(|four| Value::Many(four.to_vec()))
            .collect(),
    )
}

/// The names of the bounds that touch the tile by the exact test of the CPU, in the order of `bounds`.
fn that_keep_on_the_cpu(light: &Light, tile: &Tile) -> Vec<bool> {
    let ellipsoid = |bound: Ellipsoid| {
        bound
            .project(&tile.camera)
            .is_some_and(|shape| shape.touches_exactly(&tile.rectangle, &tile.depths))
    };
    match light.bound() {
        Bound::Spot(tight) | Bound::SphericalGaussian { tight, .. } => vec![ellipsoid(tight)],
        Bound::Ggx {
            spheroid, tight, ..
        } => vec![ellipsoid(spheroid.into()), ellipsoid(tight)],
        // Spheres grow by what the sum of position and offset rounds, which the shaders keep apart.
        Bound::Lambert { .. } | Bound::Sphere(_) => vec![false],
        other => panic!("{other:?} is unknown to the shaders"),
    }
}

/// What a search found.
#[derive(Debug, Default)]
struct Found {
    /// Tiles with a point that the light reaches.
    reached: usize,
    /// Tiles close to such points that the exact test of the CPU keeps.
    kept: usize,
    /// What the shaders lose of both.
    lost: Vec<String>,
}

/// Draws lights, tiles with a point in them that the light reaches, and tiles around points just outside of its reach.
fn search(module: &Module, lights: Range<u64>) -> Found {
    let of_light = |seed: u64| {
        let mut rng = Rng::with_seed(seed);
        let least_roughness = [1e-6, 1e-4][rng.usize(0..2)];
        let light = draw(&mut rng, least_roughness);
        let arithmetic = Arithmetic::drawn(rng.fork());
        let mut machine = Machine {
            module,
            arithmetic,
            global: table(),
        };
        let bounds = bounds(&mut machine, &light);
        let mut found = Found::default();
        for i in 0..12 {
            let tile = if i < 8 {
                Tile::draw(&mut rng, &light)
            } else {
                let outgoing = light.outgoing(&mut rng);
                let [outside, distance] =
                    [(1e-9, 0.1), (1e-3, 1e6)].map(|(low, high)| log_uniform(&mut rng, low, high));
                Tile::thin(&mut rng, &light, outgoing, -outside, distance).map(|(tile, _)| tile)
            };
            let Some(tile) = tile else { continue };
            let is_kept = if i < 8 {
                vec![true; bounds.len()]
            } else {
                that_keep_on_the_cpu(&light, &tile)
            };
            *(if i < 8 {
                &mut found.reached
            } else {
                &mut found.kept
            }) += usize::from(is_kept.contains(&true));
            let touches = touched(&mut machine, &bounds, &tile);
            for (((name, _), touches), is_kept) in bounds.iter().zip(touches).zip(is_kept) {
                if is_kept && !touches {
                    found.lost.push(format!(
                        "seed {seed}, tile {i}: {name} of {light:?} in {tile:?}"
                    ));
                }
            }
        }
        found
    };
    lights
        .into_par_iter()
        .map(of_light)
        .reduce(Found::default, |a, b| Found {
            reached: a.reached + b.reached,
            kept: a.kept + b.kept,
            lost: [a.lost, b.lost].concat(),
        })
}

#[test]
fn no_light_is_lost_by_any_arithmetic_that_is_allowed() {
    let lights = std::env::var("CASES").map_or(1500, |cases| cases.parse().expect("a number"));
    let Found {
        reached,
        kept,
        lost,
    } = search(&shaders(1.0), 0..lights);
    println!(
        "{reached} tiles of {lights} lights, and {kept} that the CPU keeps besides: {} lost",
        lost.len()
    );
    assert!(lost.is_empty(), "{} lost: {}", lost.len(), lost[0]);
    assert!(
        kept as u64 > lights / 10,
        "{kept} tiles just outside are kept by the CPU"
    );
}

/// The errors are as large as WGSL allows: without margins one of ten lights is lost.
#[test]
fn without_margins_lights_are_lost() {
    let Found { reached, lost, .. } = search(&shaders(0.0), 0..200);
    assert!(
        lost.len() > reached / 20,
        "{} of {reached} are lost",
        lost.len()
    );
}
