//! One group for each step of the pipeline, over 1024 lights that differ. Times are per light.
#![allow(
    missing_docs,
    reason = "criterion_group! makes a public function without any"
)]

use std::hint::black_box;

use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Bounded, Camera, Conductor, DepthInterval, Dielectric,
    Direction, Ellipsoid, Fresnel, Ggx, GgxLobe, Incidence, Interleave, LambertLobe, Lobe, LtcLobe,
    NoFresnel, Paper, PhongLobe, Proxy, Roulette, Schlick, Seed, Spheroid, Tight, TileGrid,
    Triaxial, Vpl, Xi,
    glam::{Mat3, Vec3},
    rank_along_curve, stretch_matrix, stretch_rotation,
};
use support::direct_port;

const LIGHTS: u32 = 1024;

type Group<'a> = BenchmarkGroup<'a, criterion::measurement::WallTime>;

/// The random number of `light` in `frame`, in [−1, 1].
fn random(light: u32, frame: u32) -> f32 {
    2.0 * Seed(1).frame(frame).hashed_xi(light).get() - 1.0
}

fn random_vector(light: u32, first: u32) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|i| random(light, first + i)))
}

fn direction(vector: Vec3) -> Direction {
    Direction::new(vector).expect("random vectors are not zero")
}

fn incidence(light: u32) -> Incidence {
    let normal = direction(random_vector(light, 0));
    let incoming = direction(*normal + 0.9 * random_vector(light, 3));
    Incidence { normal, incoming }
}

fn glossy_light<F: Fresnel>(light: u32, fresnel: F) -> Vpl<GgxLobe<F>> {
    let roughness = [0.05, 0.1, 0.2, 0.4][light as usize % 4];
    let ggx = Ggx::new(roughness).expect("in range");
    let lobe = GgxLobe::new(ggx, fresnel, incidence(light));
    Vpl::new(10.0 * random_vector(light, 6), 1.0, lobe).expect("in range")
}

fn glossy_lights<F: Fresnel>(fresnel: F) -> Vec<Vpl<GgxLobe<F>>> {
    (0..LIGHTS)
        .map(|light| glossy_light(light, fresnel))
        .collect()
}

fn brushed_lights() -> Vec<Vpl<AnisotropicGgxLobe<Schlick>>> {
    let fresnel = Schlick::new(0.9).expect("in range");
    let light = |light| {
        let like = glossy_light(light, fresnel);
        let along = like.lobe().ggx().roughness();
        let brushed = AnisotropicGgx::new(along, 0.3 * along).expect("in range");
        let tangent = direction(random_vector(light, 9));
        let lobe = AnisotropicGgxLobe::new(brushed, fresnel, incidence(light), tangent)
            .expect("random vectors are not parallel");
        Vpl::new(like.position(), 1.0, lobe).expect("in range")
    };
    (0..LIGHTS).map(light).collect()
}

fn diffuse_lights() -> Vec<Vpl<LambertLobe>> {
    let light = |i| {
        let lobe = LambertLobe::new(0.8, direction(random_vector(i, 0))).expect("in range");
        Vpl::new(10.0 * random_vector(i, 6), 1.0, lobe).expect("in range")
    };
    (0..LIGHTS).map(light).collect()
}

fn phong_lights(exponents: [f32; 4]) -> Vec<Vpl<PhongLobe>> {
    let light = |i| {
        let exponent = exponents[i as usize % 4];
        let lobe = PhongLobe::new(0.8, exponent, incidence(i)).expect("in range");
        Vpl::new(10.0 * random_vector(i, 6), 1.0, lobe).expect("in range")
    };
    (0..LIGHTS).map(light).collect()
}

fn camera() -> Camera {
    let eye = Vec3::new(0.0, 5.0, 25.0);
    Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 1.0, 16.0 / 9.0, 0.1..100.0).expect("in range")
}

fn roulette() -> Roulette {
    Roulette::new(0.001).expect("in range")
}

fn xi(light: u32) -> Xi {
    Seed(0).frame(0).xi(light)
}

fn spheroids() -> Vec<Spheroid> {
    let lights = glossy_lights(NoFresnel);
    let bound = |(light, i): (&Vpl<GgxLobe>, u32)| light.bound_by(Paper, &roulette(), xi(i));
    lights.iter().zip(0..).map(bound).collect()
}

/// Times `step` over all of `inputs`, per input.
fn per_item<T, U>(group: &mut Group, name: &str, inputs: &[T], step: impl Fn(&T) -> U) {
    group.throughput(Throughput::Elements(inputs.len() as u64));
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            for input in inputs {
                black_box(step(black_box(input)));
            }
        });
    });
}

fn lobe_value<F: Fresnel>(group: &mut Group, name: &str, fresnel: F) {
    let inputs: Vec<_> = glossy_lights(fresnel)
        .into_iter()
        .zip(0..)
        .map(|(light, i)| (light, *direction(random_vector(i, 9))))
        .collect();
    per_item(group, name, &inputs, |(light, outgoing)| {
        light.lobe().value(*outgoing)
    });
}

fn brdf(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("brdf");
    lobe_value(&mut group, "ggx, no Fresnel", NoFresnel);
    lobe_value(
        &mut group,
        "ggx, Schlick",
        Schlick::new(0.9).expect("in range"),
    );
    lobe_value(
        &mut group,
        "ggx, dielectric",
        Dielectric::new(1.5).expect("in range"),
    );
    lobe_value(
        &mut group,
        "ggx, conductor",
        Conductor::new(0.2, 3.5).expect("in range"),
    );
    let schlick = Schlick::new(0.9).expect("in range");
    let inputs: Vec<_> = glossy_lights(NoFresnel)
        .into_iter()
        .zip(0..)
        .map(|(light, i)| {
            let lobe = LtcLobe::new(light.lobe().ggx(), schlick, light.lobe().incidence());
            (lobe, *direction(random_vector(i, 9)))
        })
        .collect();
    per_item(
        &mut group,
        "transformed cosine",
        &inputs,
        |(lobe, outgoing)| lobe.value(*outgoing),
    );
    let inputs: Vec<_> = diffuse_lights()
        .into_iter()
        .zip(0..)
        .map(|(light, i)| (light, *direction(random_vector(i, 9))))
        .collect();
    per_item(&mut group, "lambert", &inputs, |(light, outgoing)| {
        light.lobe().value(*outgoing)
    });
    let inputs: Vec<_> = phong_lights([0.5, 10.0, 40.0, 1000.0])
        .into_iter()
        .zip(0..)
        .map(|(light, i)| (light, *light.lobe().axis() + 0.2 * random_vector(i, 9)))
        .map(|(light, off_axis)| (light, off_axis.normalize()))
        .collect();
    per_item(&mut group, "phong", &inputs, |(light, outgoing)| {
        light.lobe().value(*outgoing)
    });
}

fn range(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("range");
    let lights: Vec<u32> = (0..LIGHTS).collect();
    let seed = Seed(1).frame(7);
    per_item(&mut group, "hash", &lights, |light| seed.hashed_xi(*light));
    per_item(&mut group, "ξ of a light", &lights, |light| {
        seed.xi(*light)
    });
    per_item(&mut group, "ξ of a rank", &lights, |light| {
        seed.xi_of_rank(*light)
    });
    let xis: Vec<Xi> = lights.iter().map(|light| seed.xi(*light)).collect();
    let roulette = roulette();
    per_item(&mut group, "scale", &xis, |xi| roulette.scale(1.0, *xi));
    per_item(&mut group, "estimate", &xis, |xi| {
        roulette.estimate(0.001, 2.0, *xi)
    });
}

/// Ranks of 65,536 lights on a floor, two walls and in the air. Times are per light.
fn ranks(criterion: &mut Criterion) {
    const LIGHTS: u32 = 65_536;
    let point = |light| {
        let [x, y, z] = random_vector(light, 0).to_array();
        Vec3::from([[x, -1.0, z], [-1.0, y, z], [x, y, -1.0], [x, y, z]][light as usize % 4])
    };
    let points: Vec<Vec3> = (0..LIGHTS).map(point).collect();
    let mut ranks = vec![0; points.len()];
    let mut scratch = vec![0; 2 * points.len()];
    let mut group = criterion.benchmark_group("range");
    group.throughput(Throughput::Elements(u64::from(LIGHTS)));
    group.bench_function("ranks of 65536 points", |bencher| {
        bencher.iter(|| rank_along_curve(black_box(&points), &mut ranks, &mut scratch));
    });
}

fn bound(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("bound");
    let metal = glossy_lights(Schlick::new(0.9).expect("in range"));
    per_item(
        &mut group,
        "spheroid, no Fresnel",
        &glossy_lights(NoFresnel),
        |light| light.lobe().unit_bound_by(Paper),
    );
    per_item(&mut group, "spheroid, Schlick", &metal, |light| {
        light.lobe().unit_bound_by(Paper)
    });
    per_item(&mut group, "sphere, Lambert", &diffuse_lights(), |light| {
        light.lobe().unit_bound()
    });
    per_item(
        &mut group,
        "ellipsoid, Lambert",
        &diffuse_lights(),
        |light| light.lobe().unit_bound_by(Tight),
    );
    for (name, exponents) in [
        ("ellipsoid, Phong n < 2", [0.1, 0.5, 1.0, 1.9]),
        ("ellipsoid, Phong", [10.0, 40.0, 200.0, 1000.0]),
    ] {
        per_item(&mut group, name, &phong_lights(exponents), |light| {
            light.lobe().unit_bound()
        });
    }
    let tight: Vec<_> = diffuse_lights()
        .iter()
        .map(|light| light.lobe().unit_bound_by(Tight))
        .collect();
    for (name, proxy) in [
        ("proxy of 20 triangles", Proxy::Icosahedron),
        ("proxy of 80 triangles", Proxy::Icosphere),
    ] {
        per_item(&mut group, name, &tight, |ellipsoid| {
            proxy
                .vertices(ellipsoid)
                .fold(Vec3::ZERO, |sum, vertex| sum + vertex)
        });
    }
    per_item(
        &mut group,
        "tight ellipsoid, no Fresnel",
        &glossy_lights(NoFresnel),
        |light| light.lobe().unit_bound_by(Tight),
    );
    per_item(&mut group, "tight ellipsoid, Schlick", &metal, |light| {
        light.lobe().unit_bound_by(Tight)
    });
    per_item(
        &mut group,
        "triaxial ellipsoid, no Fresnel",
        &glossy_lights(NoFresnel),
        |light| light.lobe().unit_bound_by(Triaxial),
    );
    per_item(&mut group, "triaxial ellipsoid, Schlick", &metal, |light| {
        light.lobe().unit_bound_by(Triaxial)
    });
    per_item(
        &mut group,
        "anisotropic, Schlick",
        &brushed_lights(),
        |light| light.lobe().unit_bound(),
    );
    per_item(&mut group, "extent along a direction", &metal, |light| {
        light.lobe().extent(Direction::X)
    });
    let unit = metal[0].lobe().unit_bound_by(Paper);
    per_item(&mut group, "placing", &metal, |light| {
        unit.placed(light.position(), 3.0)
    });
    per_item(&mut group, "enclosing sphere", &spheroids(), |spheroid| {
        spheroid.enclosing_sphere()
    });
}

/// M as B times S, as the paper has it: what the triangular form replaces.
fn stretch_as_product(ellipsoid: &Ellipsoid, camera: &Camera) -> (Mat3, Vec3) {
    let s = stretch_matrix(ellipsoid, camera);
    let m = stretch_rotation(s) * s;
    (m, m * camera.to_camera_space(ellipsoid.center()))
}

fn stretch(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("stretch");
    let (camera, spheroids) = (camera(), spheroids());
    let ellipsoids: Vec<Ellipsoid> = spheroids.iter().copied().map(Ellipsoid::from).collect();
    per_item(&mut group, "ellipsoid of a spheroid", &spheroids, |s| {
        Ellipsoid::from(*s)
    });
    per_item(&mut group, "triangular form", &ellipsoids, |e| {
        e.project(&camera)
    });
    per_item(&mut group, "product of B and S", &ellipsoids, |e| {
        stretch_as_product(e, &camera)
    });
}

/// The same lights with the papers' formulas as printed.
fn stretches_of_the_direct_port(camera: &Camera, count: usize) -> Vec<direct_port::Stretched> {
    let (view, offset) = (camera.rotation(), camera.to_camera_space(Vec3::ZERO));
    let stretch = |(light, i): (&Vpl<GgxLobe>, u32)| {
        let light = direct_port::Light {
            position: light.position(),
            normal: *incidence(i).normal,
            incoming: *incidence(i).incoming,
            alpha: light.lobe().ggx().roughness(),
            fresnel: direct_port::Fresnel::None,
            flux: light.flux(),
            delta: roulette().delta(),
            xi: xi(i).get(),
        };
        direct_port::Stretched::new(&light.ellipsoid(), view, offset)
    };
    let lights = glossy_lights(NoFresnel);
    lights.iter().zip(0..).take(count).map(stretch).collect()
}

fn tile(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tile");
    let (camera, spheroids) = (camera(), spheroids());
    let grid = TileGrid::new([15, 9], 1).expect("not empty");
    let rectangle = camera.tile(&grid, [7, 5]);
    let depths = DepthInterval::new(20.0, 26.0).expect("in order");
    let stretches: Vec<_> = spheroids
        .iter()
        .filter_map(|spheroid| spheroid.project(&camera))
        .collect();
    let spheres: Vec<_> = spheroids
        .iter()
        .filter_map(|spheroid| spheroid.enclosing_sphere().project(&camera))
        .collect();
    per_item(&mut group, "ellipsoid", &stretches, |light| {
        light.touches(&rectangle, &depths)
    });
    let corners = [rectangle.min(), rectangle.max()];
    let ported = stretches_of_the_direct_port(&camera, spheroids.len());
    per_item(&mut group, "ellipsoid, direct port", &ported, |light| {
        light.touches(corners, [depths.near(), depths.far()])
    });
    per_item(&mut group, "sphere", &spheres, |light| {
        light.touches(&rectangle, &depths)
    });

    let grid = TileGrid::new([240, 135], 16).expect("not empty");
    let tiles: Vec<_> = grid.tiles().collect();
    per_item(&mut group, "rectangle", &tiles, |tile| {
        camera.tile(&grid, *tile)
    });
    let buffer: Vec<f32> = (0..256).map(|i| 20.0 + 3.0 * random(i, 0)).collect();
    per_item(
        &mut group,
        "Modified HalfZ of 256 pixels",
        &[buffer],
        |buffer| DepthInterval::modified_half_z(buffer.iter().copied()),
    );
}

fn interleave(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("interleave");
    let interleave = Interleave::new([1920, 1080], 8).expect("fits");
    let pixels: Vec<[u32; 2]> = (0..LIGHTS).map(|i| [i, i / 2]).collect();
    per_item(&mut group, "split pixel", &pixels, |pixel| {
        interleave.split_pixel(*pixel)
    });
    let split: Vec<_> = pixels
        .iter()
        .map(|pixel| interleave.split_pixel(*pixel))
        .collect();
    per_item(&mut group, "join pixel", &split, |(subregion, local)| {
        interleave.join_pixel(*subregion, *local)
    });
}

criterion_group!(steps, brdf, range, ranks, bound, stretch, tile, interleave);
criterion_main!(steps);
