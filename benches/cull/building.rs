//! Making lights ready: one by one, and batched.

use std::hint::black_box;

use criterion::{BenchmarkGroup, Criterion, Throughput, measurement::WallTime};
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, BatchBuilder, Bounded, Camera, ConstantLobe, Direction,
    Fresnel, Ggx, GgxLobe, Incidence, LambertLobe, LightBatch, Lobe, NoFresnel, Paper, Projected,
    Roulette, Schlick, Seed, SpotLobe, Tight, Triaxial, Vpl, Xi, glam::Vec3,
};
use support::workload;

/// Lights in a ball in front of the camera.
fn lights<L: Lobe>(lobe: impl Fn(u32, Incidence) -> L) -> Vec<(Vpl<L>, Xi)> {
    let light = |i| {
        let random = |frame| 2.0 * Seed(1).frame(frame).hashed_xi(i).get() - 1.0;
        let vector = |k| Vec3::new(random(k), random(k + 1), random(k + 2));
        let normal = Direction::new(vector(0)).expect("not zero");
        let incoming = Direction::new(*normal + 0.9 * vector(3)).expect("not zero");
        let lobe = lobe(i, Incidence { normal, incoming });
        let position = 10.0 * vector(6) - 25.0 * Vec3::Z;
        let light = Vpl::new(position, 1.0, lobe).expect("in range");
        (light, Seed(0).frame(0).xi(i))
    };
    (0..workload::LIGHTS as u32).map(light).collect()
}

fn glossy_lights<F: Fresnel>(fresnel: F) -> Vec<(Vpl<GgxLobe<F>>, Xi)> {
    lights(|i, incidence| {
        let roughness = [0.05, 0.1, 0.2, 0.4][i as usize % 4];
        let ggx = Ggx::new(roughness).expect("in range");
        GgxLobe::new(ggx, fresnel, incidence)
    })
}

/// Times making a batch of `lights`, one by one and sixteen by sixteen.
fn build<L: Lobe, P: Projected>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    lights: &[(Vpl<L>, Xi)],
    one: impl Fn(&Vpl<L>, Xi) -> Option<P>,
    many: impl Fn(&[(Vpl<L>, Xi)], &mut LightBatch<P>),
) {
    let mut batch = LightBatch::new();
    group.bench_function(format!("{name}, one by one"), |bencher| {
        bencher.iter(|| {
            batch.clear();
            let shapes = (0..).zip(black_box(lights));
            batch.extend(shapes.filter_map(|(i, (light, xi))| Some((i, one(light, *xi)?))));
        });
    });
    group.bench_function(format!("{name}, batched"), |bencher| {
        bencher.iter(|| {
            batch.clear();
            many(black_box(lights), &mut batch);
        });
    });
}

fn indexed<L>(lights: &[(Vpl<L>, Xi)]) -> impl Iterator<Item = (u32, &Vpl<L>, Xi)> {
    (0..).zip(lights).map(|(i, (light, xi))| (i, light, *xi))
}

fn glossy<F: Fresnel>(
    group: &mut BenchmarkGroup<WallTime>,
    name: &str,
    fresnel: F,
    roulette: &Roulette,
    camera: &Camera,
) {
    let lights = glossy_lights(fresnel);
    let builder = BatchBuilder::new(roulette, camera);
    build(
        group,
        &format!("spheroid, {name}"),
        &lights,
        |light, xi| light.bound_by(Paper, roulette, xi).project(camera),
        |lights, batch| builder.add_by(Paper, indexed(lights), batch),
    );
    build(
        group,
        &format!("tight, {name}"),
        &lights,
        |light, xi| light.bound_by(Tight, roulette, xi).project(camera),
        |lights, batch| builder.add_by(Tight, indexed(lights), batch),
    );
    build(
        group,
        &format!("triaxial, {name}"),
        &lights,
        |light, xi| light.bound_by(Triaxial, roulette, xi).project(camera),
        |lights, batch| builder.add_by(Triaxial, indexed(lights), batch),
    );
}

/// Brushed metal, its grain along any tangent.
fn brushed_lights<F: Fresnel>(fresnel: F) -> Vec<(Vpl<AnisotropicGgxLobe<F>>, Xi)> {
    lights(|i, incidence| {
        let roughness = [0.05, 0.1, 0.2, 0.4];
        let [along, across] = [i, i / 4].map(|i| roughness[i as usize % 4]);
        let ggx = AnisotropicGgx::new(along, across).expect("in range");
        let tangent = Direction::new(incidence.normal.any_orthonormal_vector()).expect("unit");
        AnisotropicGgxLobe::new(ggx, fresnel, incidence, tangent).expect("at right angles")
    })
}

/// Times are per light.
pub fn building(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("building");
    group.throughput(Throughput::Elements(workload::LIGHTS as u64));
    let (roulette, camera) = (Roulette::new(0.001).expect("in range"), workload::camera());
    glossy(&mut group, "no Fresnel", NoFresnel, &roulette, &camera);
    let schlick = Schlick::new(0.9).expect("in range");
    glossy(&mut group, "Schlick", schlick, &roulette, &camera);

    let brushed = brushed_lights(schlick);
    let builder = BatchBuilder::new(&roulette, &camera);
    build(
        &mut group,
        "anisotropic, Schlick",
        &brushed,
        |light, xi| light.bound(&roulette, xi).project(&camera),
        |lights, batch| builder.add(indexed(lights), batch),
    );

    let lamps = lights(|_, _| ConstantLobe);
    build(
        &mut group,
        "point",
        &lamps,
        |light, xi| light.bound(&roulette, xi).project(&camera),
        |lights, batch| builder.add(indexed(lights), batch),
    );
    let spots = lights(|i, incidence| {
        // Every way to bound one, in each vector.
        let outer = [20.0_f32, 45.0, 60.0, 80.0, 110.0, 150.0][i as usize % 6].to_radians();
        let inner = [0.0, 0.3, 0.6, 0.8, 1.0][i as usize % 5] * outer;
        SpotLobe::new(inner, outer, incidence.normal).expect("in order")
    });
    build(
        &mut group,
        "spot",
        &spots,
        |light, xi| light.bound(&roulette, xi).project(&camera),
        |lights, batch| builder.add(indexed(lights), batch),
    );
    // As most scenes have them: of one kind.
    let narrow = lights(|i, incidence| {
        let outer = [20.0_f32, 30.0, 35.0, 40.0, 45.0][i as usize % 5].to_radians();
        let inner = [0.0, 0.3, 0.6, 0.8][i as usize % 4] * outer;
        SpotLobe::new(inner, outer, incidence.normal).expect("in order")
    });
    build(
        &mut group,
        "spot up to 45°",
        &narrow,
        |light, xi| light.bound(&roulette, xi).project(&camera),
        |lights, batch| builder.add(indexed(lights), batch),
    );
    let kept: Vec<_> = spots
        .iter()
        .map(|(light, _)| light.lobe().unit_bound())
        .collect();
    let mut batch = LightBatch::new();
    group.bench_function("spot, kept bounds, batched", |bencher| {
        bencher.iter(|| {
            batch.clear();
            let placed = (0..).zip(black_box(&spots)).zip(&kept);
            let placed = placed.map(|((i, (light, xi)), bound)| {
                (
                    i,
                    bound,
                    light.position(),
                    roulette.scale(light.flux(), *xi),
                )
            });
            builder.add_placed(placed, &mut batch);
        });
    });

    let diffuse = lights(|_, incidence| LambertLobe::new(0.8, incidence.normal).expect("in range"));
    build(
        &mut group,
        "diffuse",
        &diffuse,
        |light, xi| light.bound(&roulette, xi).project(&camera),
        |lights, batch| builder.add(indexed(lights), batch),
    );
}
