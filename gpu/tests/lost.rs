//! No light is lost on a GPU: a tile with a point in it that a light reaches in exact arithmetic is touched.
//!
//! `CASES=10000000 cargo test --release --test lost -- --nocapture` is the long run.

use bytemuck::{Pod, Zeroable};
use fastrand::Rng;
use gpu::{Dispatch, Gpu, Kernel};
use stochastic_light_culling::{
    Conductor, ConstantLobe, Dielectric, Ggx, GgxLobe, GpuCamera, GpuLight, GpuTile, Incidence,
    LambertLobe, Lobe, NoFresnel, Schlick, Vpl, wgsl,
};
use support::adversary::{Light, Tile};
use support::reference::{Brdf, Fresnel, Masking};

/// A light, and a tile with a point in it that the light reaches.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Case {
    light: GpuLight,
    camera: GpuCamera,
    tile: GpuTile,
    depths: [f32; 2],
    delta: f32,
    xi: f32,
    kind: Kind,
    unused: [u32; 3],
}

/// Which functions bound a light.
#[derive(Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(transparent)]
struct Kind(u32);

impl Kind {
    const CONSTANT: Self = Self(0);
    const LAMBERT: Self = Self(1);
    const GGX: Self = Self(2);
    const SCHLICK: Self = Self(3);
    const DIELECTRIC: Self = Self(4);
    const CONDUCTOR: Self = Self(5);
    const SPOT: Self = Self(6);
    const GAUSSIAN: Self = Self(7);
}

/// Writes a bit for each bound that touches the tile: the paper's, and the tight one.
const TEXT: &str = "
struct Case {
    light: SlcLight, camera: SlcCamera, tile: SlcTile, depths: vec2f, delta: f32, xi: f32, kind: u32,
}
@group(0) @binding(0) var<storage, read> slc_table: array<vec4f>;
@group(0) @binding(1) var<storage, read> cases: array<Case>;
@group(0) @binding(2) var<storage, read_write> touched: array<u32>;

fn bounds(case_: Case) -> array<SlcBound, 2> {
    let light = case_.light;
    var most = 1.0;
    switch case_.kind {
        case 0u: {
            let bound = slc_paper_constant();
            return array<SlcBound, 2>(bound, bound);
        }
        case 1u: {
            let bound = slc_paper_lambert(light.fresnel.x, light.normal);
            return array<SlcBound, 2>(bound, bound);
        }
        case 3u: { most = slc_max_schlick(light); }
        case 4u: { most = slc_max_dielectric(light); }
        case 5u: { most = slc_max_conductor(light); }
        case 6u: {
            let bound = slc_tight_spot(light.normal, light.fresnel);
            return array<SlcBound, 2>(bound, bound);
        }
        case 7u: {
            let bound = slc_tight_gaussian(light.normal, light.fresnel.x, light.fresnel.y);
            return array<SlcBound, 2>(bound, bound);
        }
        default: {}
    }
    return array<SlcBound, 2>(slc_paper_ggx(light, most), slc_tight_ggx(light, most));
}

@compute @workgroup_size(64)
fn touch(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= arrayLength(&cases) { return; }
    let it = cases[i];
    let units = bounds(it);
    let scale = slc_scale(it.light.flux, it.delta, it.xi);
    let paper = slc_project(slc_placed(units[0], it.light.position, scale), it.camera);
    let tight = slc_project(slc_placed(units[1], it.light.position, scale), it.camera);
    touched[i] = u32(slc_touches(paper, it.tile, it.depths)) + 2u * u32(slc_touches(tight, it.tile, it.depths));
}";

/// The functions, with all margins times `share`.
fn functions(share: f32) -> String {
    let texts = [
        wgsl::NUM,
        wgsl::LOBE,
        wgsl::LIGHT,
        wgsl::BOUND,
        wgsl::TIGHT,
        wgsl::SPOT,
        wgsl::GAUSSIAN,
        wgsl::PROJECT,
        wgsl::TOUCH,
    ]
    .concat();
    let line = |line: &str| match line.split_once("_ULPS: f32 = ") {
        Some((name, value)) => {
            let ulps: f32 = value.trim_end_matches(';').parse().unwrap();
            format!("{name}_ULPS: f32 = {:?};\n", ulps * share)
        }
        None => format!("{line}\n"),
    };
    texts.lines().map(line).collect()
}

fn record_of<L: Lobe>(light: &Light, lobe: L) -> GpuLight
where
    for<'a> GpuLight: From<&'a Vpl<L>>,
{
    GpuLight::from(&Vpl::new(light.position, light.flux, lobe).unwrap())
}

/// The record of a light with α ≥ 10⁻⁴ or without, and how it is bounded.
fn record(light: &Light) -> Option<(GpuLight, Kind)> {
    let incidence = Incidence {
        normal: light.normal,
        incoming: light.incoming,
    };
    Some(match light.brdf {
        Brdf::Spot { versines, .. } => (about(light, versines), Kind::SPOT),
        Brdf::SphericalGaussian {
            amplitude,
            sharpness,
        } => (about(light, [sharpness, amplitude]), Kind::GAUSSIAN),
        Brdf::Constant => (record_of(light, ConstantLobe), Kind::CONSTANT),
        Brdf::Lambert { albedo } => {
            let lobe = LambertLobe::new(albedo, light.normal).unwrap();
            (record_of(light, lobe), Kind::LAMBERT)
        }
        Brdf::Ggx {
            roughness,
            fresnel,
            masking,
        } if roughness >= 1e-4 && masking != Masking::MaskedAlone => {
            let ggx = Ggx::new(roughness).unwrap();
            match fresnel {
                Fresnel::None => (
                    record_of(light, GgxLobe::new(ggx, NoFresnel, incidence)),
                    Kind::GGX,
                ),
                Fresnel::Schlick(f0) => {
                    let schlick = Schlick::new(f0).unwrap();
                    (
                        record_of(light, GgxLobe::new(ggx, schlick, incidence)),
                        Kind::SCHLICK,
                    )
                }
                Fresnel::Dielectric(eta) => {
                    let dielectric = Dielectric::new(eta).unwrap();
                    (
                        record_of(light, GgxLobe::new(ggx, dielectric, incidence)),
                        Kind::DIELECTRIC,
                    )
                }
                Fresnel::Conductor(eta, kappa) => {
                    let conductor = Conductor::new(eta, kappa).unwrap();
                    (
                        record_of(light, GgxLobe::new(ggx, conductor, incidence)),
                        Kind::CONDUCTOR,
                    )
                }
            }
        }
        _ => return None,
    })
}

/// The record of a light about an axis, with the parameters of its lobe in the place of those of a Fresnel factor.
fn about(light: &Light, parameters: [f32; 2]) -> GpuLight {
    GpuLight {
        position: light.position.to_array(),
        flux: light.flux,
        normal: light.normal.to_array(),
        fresnel: parameters,
        ..GpuLight::zeroed()
    }
}

/// Draws about `count` cases with this seed.
fn draw(seed: u64, count: usize) -> Vec<(Light, Tile, Case)> {
    let mut rng = Rng::with_seed(seed);
    let mut cases = Vec::with_capacity(count);
    while cases.len() < count {
        let light = Light::draw(&mut rng);
        let Some((record, kind)) = record(&light) else {
            continue;
        };
        for tile in (0..8).filter_map(|_| Tile::draw(&mut rng, &light)) {
            cases.push((
                light,
                tile,
                Case {
                    light: record,
                    camera: GpuCamera::from(&tile.camera),
                    tile: GpuTile::from(&tile.rectangle),
                    depths: [tile.depths.near(), tile.depths.far()],
                    delta: light.delta,
                    xi: light.xi,
                    kind,
                    unused: [0; 3],
                },
            ));
        }
    }
    cases
}

/// For each case the bits of the bounds that touch.
fn touched(gpu: &Gpu, kernel: &Kernel, cases: &[Case]) -> Vec<u32> {
    let table = gpu.upload(wgsl::TABLE).unwrap();
    let buffers = (
        gpu.upload(cases).unwrap(),
        gpu.zeroed::<u32>(cases.len()).unwrap(),
    );
    gpu.run(&[Dispatch {
        kernel,
        buffers: &[(0, &table), (1, &buffers.0), (2, &buffers.1)],
        workgroups: [cases.len().div_ceil(64) as u32, 1, 1],
    }])
    .unwrap();
    gpu.read(&buffers.1).unwrap()
}

const BATCH: usize = 1 << 16;

/// Searches `batches` of cases, half of them on each of two threads, and returns how many there were and what is lost.
fn search(batches: u64, share: f32) -> (usize, Vec<String>) {
    let of_thread = |first: u64| {
        let gpu = Gpu::new().unwrap();
        let kernel = gpu.kernel(&[&functions(share), TEXT], "touch").unwrap();
        let (mut count, mut lost) = (0, Vec::new());
        for seed in (first..batches).step_by(2) {
            let drawn = draw(seed, BATCH);
            let cases: Vec<Case> = drawn.iter().map(|(_, _, case)| *case).collect();
            count += cases.len();
            for ((light, tile, _), bits) in drawn.iter().zip(touched(&gpu, &kernel, &cases)) {
                if bits != 3 {
                    lost.push(format!(
                        "bounds {bits:02b} of {light:?} in {tile:?}, seed {seed}"
                    ));
                }
            }
        }
        (count, lost)
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(|| of_thread(1));
        let (count, lost) = of_thread(0);
        let (other_count, other_lost) = other.join().unwrap();
        (count + other_count, [lost, other_lost].concat())
    })
}

#[test]
fn no_light_is_lost() {
    let wanted = std::env::var("CASES").map_or(250_000, |cases| cases.parse().expect("a number"));
    let (count, lost) = search(wanted / BATCH as u64 + 1, 1.0);
    println!("{count} tiles that lights reach, {} lost", lost.len());
    assert!(lost.is_empty(), "{} lost: {}", lost.len(), lost[0]);
}

/// A GPU that rounds as well as a CPU loses some lights without margins; `tests/wgsl` errs as badly as is allowed.
#[test]
fn without_margins_lights_are_lost() {
    let (count, lost) = search(2, 0.0);
    println!(
        "{count} tiles that lights reach, {} lost without margins",
        lost.len()
    );
    assert!(lost.len() > count / 1000, "{} of {count}", lost.len());
}
