//! Clusters of lights, culled and evaluated many at a time: bit by bit the estimates of those evaluated one by one,
//! none lost, and the mean of all.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use stochastic_light_culling::{
    BatchBuilder, Camera, Culler, DepthInterval, Direction, Estimate, Ggx, GgxLobe, Incidence,
    LambertLobe, LightBatch, LightLists, Lobe, NoFresnel, PointBlock, RadianceEstimator, Receiver,
    ReceiverBlock, Roulette, Schlick, Seed, ShadedPoint, ShadingBatch, SphericalGaussian,
    TileDepths, TileGrid, Vpl, Vsgl, Xi,
    glam::{DVec2, Vec3},
};
use support::generators::{self, cases, log_uniform};
use support::reference::Vector;

fn bits(estimate: &Estimate) -> (u32, [u32; 7]) {
    let [x, y, z] = estimate.direction.to_array();
    let numbers = [
        estimate.radiance,
        estimate.intensity,
        estimate.distance_squared,
        estimate.sharpness,
        x,
        y,
        z,
    ];
    (estimate.light, numbers.map(f32::to_bits))
}

/// What a point accepts of the lights of a list, one by one.
fn one_by_one(
    roulette: &Roulette,
    lights: &[(Vsgl, Xi)],
    list: &[u32],
    point: ShadedPoint,
) -> Vec<(u32, [u32; 7])> {
    let estimates = list.iter().filter_map(|i| {
        let (light, xi) = &lights[*i as usize];
        let irradiance = light.scalar_irradiance(point.position);
        let incoming = light.incoming(point.position);
        let direction = -*incoming.axis();
        let faces_away = point.normal.dot(direction) > 0.0;
        let accepted = !faces_away && roulette.accepts(irradiance, 1.0, *xi);
        let numbers = [
            roulette.estimate(irradiance, 1.0, *xi),
            irradiance,
            1.0,
            incoming.sharpness(),
            direction.x,
            direction.y,
            direction.z,
        ];
        accepted.then(|| (*i, numbers.map(f32::to_bits)))
    });
    estimates.collect()
}

fn lights() -> impl Strategy<Value = Vec<(Vsgl, Xi)>> {
    let sharpness =
        prop_oneof![1 => Just(0.0), 1 => Just(4_194_304.0), 6 => log_uniform(1e-3, 1e4)];
    let spread =
        prop_oneof![1 => Just(0.0), 6 => log_uniform(1e-3, 1e1), 1 => log_uniform(1e-30, 1e15)];
    let amplitude = prop_oneof![1 => Just(0.0), 8 => log_uniform(1e-3, 1e3)];
    let light = (
        generators::unit_vector(),
        (sharpness, spread, amplitude),
        [-2.0..2.0_f32, -2.0..2.0, -2.0..2.0],
        generators::up_to_one(1e-6),
    );
    let light = light.prop_map(|(axis, (sharpness, spread, amplitude), position, xi)| {
        let axis = Direction::new(axis.to_f32()).unwrap();
        let lobe = SphericalGaussian::new(axis, sharpness as f32, amplitude as f32).unwrap();
        let light = Vsgl::new(Vec3::from_array(position), spread as f32, lobe).unwrap();
        (light, Xi::new(xi).unwrap())
    });
    prop::collection::vec(light, 1..12)
}

fn points() -> impl Strategy<Value = Vec<ShadedPoint>> {
    let number = prop_oneof![
        20 => -4.0..4.0_f32,
        1 => Just(f32::NAN),
        1 => Just(f32::INFINITY),
        1 => Just(-3e38_f32),
        1 => Just(0.0_f32),
    ];
    let position = [number.clone(), number.clone(), number].prop_map(Vec3::from_array);
    let normal = prop_oneof![
        Just(Vec3::ZERO),
        generators::unit_vector().prop_map(Vector::to_f32),
    ];
    let point = (position, normal);
    let point = point.prop_map(|(position, normal)| ShadedPoint { position, normal });
    prop::collection::vec(point, 1..40)
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn estimates_are_those_one_by_one(
        lights in lights(),
        points in points(),
        turns in prop::collection::vec(any::<u32>(), 0..40),
        delta in log_uniform(1e-6, 1e2),
    ) {
        let roulette = Roulette::new(delta as f32).unwrap();
        // At a light too.
        let points: Vec<_> = points.into_iter().chain([lights[0].0.position().into()]).collect();
        let list: Vec<_> = turns.iter().map(|turn| turn % lights.len() as u32).collect();
        let mut batch = ShadingBatch::new();
        batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));
        prop_assert_eq!(batch.len(), lights.len());
        let expected: Vec<_> = points.iter().map(|point| one_by_one(&roulette, &lights, &list, *point)).collect();
        for lanes in [16, 8, 4] {
            let estimator = RadianceEstimator::new(&roulette).with_lanes(lanes);
            let mut found = vec![Vec::new(); points.len()];
            let lists = points.iter().map(|point| (*point, &list[..]));
            estimator.at_points(&batch, lists, |i, estimate| found[i].push(bits(estimate)));
            prop_assert_eq!(&found, &expected);

            let mut found = vec![Vec::new(); points.len()];
            let (mut rest, mut first) = (points.iter().copied(), 0);
            while let Some(block) = PointBlock::take(&mut rest) {
                estimator.at_block(&batch, &list, &block, |estimates| {
                    for (i, estimate) in estimates.iter() {
                        found[first + i].push(bits(&estimate));
                    }
                });
                first += block.len();
            }
            prop_assert_eq!(&found, &expected);
        }
    }

    /// An estimate's light is what arrives, times what the roulette makes of it.
    #[test]
    fn estimates_give_the_arriving_light(lights in lights(), points in points()) {
        let roulette = Roulette::new(1e-3).unwrap();
        let mut batch = ShadingBatch::new();
        batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));
        let list: Vec<_> = (0..lights.len() as u32).collect();
        let lists = points.iter().map(|point| (*point, &list[..]));
        RadianceEstimator::new(&roulette).at_points(&batch, lists, |i, estimate| {
            let (light, xi) = &lights[estimate.light as usize];
            let (incoming, exact) = (estimate.incoming(), light.incoming(points[i].position));
            assert_eq!((incoming.axis(), incoming.sharpness()), (exact.axis(), exact.sharpness()));
            let weight = roulette.weight(estimate.intensity, 1.0, *xi);
            let expected = f64::from(exact.amplitude()) * f64::from(weight);
            let error = f64::from(incoming.amplitude()) - expected.min(f32::MAX.into());
            assert!(error.abs() <= 1e-6 * expected.max(1e-30), "{incoming:?} {exact:?}");
        });
    }
}

/// Whether receivers with `lobe` reflect in lanes what `product_integral` makes of the arriving light one by one, but
/// for the order of a few products; and the same bits for either way and any width.
fn reflect_alike<R: Lobe + Copy>(
    lights: &[(Vsgl, Xi)],
    points: &[ShadedPoint],
    lobe: R,
    product_integral: impl Fn(&SphericalGaussian) -> f32,
) -> Result<(), TestCaseError> {
    let at = |point: &ShadedPoint| Receiver {
        position: point.position,
        lobe,
    };
    let roulette = Roulette::new(1e-3).unwrap();
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));
    let list: Vec<_> = (0..lights.len() as u32).collect();
    let mut expected = Vec::new();
    for lanes in [16, 8, 4] {
        let estimator = RadianceEstimator::new(&roulette).with_lanes(lanes);
        let lists = points.iter().map(|point| (at(point), &list[..]));
        let add = |mut all: Vec<_>, i, estimate: &Estimate, reflected: f32| {
            let incoming = estimate.incoming();
            let exact = f64::from(product_integral(&incoming));
            let error = (f64::from(reflected) - exact).abs();
            // The amplitude of a light without spread is clamped where it is met.
            let is_clamped = incoming.amplitude() == f32::MAX || reflected.is_infinite();
            assert!(
                is_clamped || error <= 1e-5 * exact + 1e-30,
                "{reflected} {exact}"
            );
            all.push((i, estimate.light, reflected.to_bits()));
            all
        };
        let found = estimator.fold_reflected_at_points(&batch, lists, Vec::new(), add);
        if expected.is_empty() {
            expected.clone_from(&found);
        }
        prop_assert_eq!(&found, &expected);
        let (mut rest, mut first, mut found) = (points.iter().map(at), 0, Vec::new());
        while let Some(block) = ReceiverBlock::take(&mut rest) {
            estimator.reflected_at_block(&batch, &list, &block, |estimates, reflected| {
                for (i, _) in estimates.iter() {
                    found.push((first + i, estimates.light, reflected[i].to_bits()));
                }
            });
            first += block.points().len();
        }
        found.sort_by_key(|(i, light, _)| (*i, *light));
        prop_assert_eq!(&found, &expected);
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(128))]

    #[test]
    fn receivers_reflect_the_arriving_light(
        lights in lights(),
        points in points(),
        lit in generators::lit(),
        roughness in generators::roughness(),
    ) {
        let incidence = Incidence { normal: lit.normal, incoming: lit.incoming };
        let schlick = Schlick::new(0.1).unwrap();
        let glossy = GgxLobe::new(Ggx::new(roughness).unwrap(), schlick, incidence);
        reflect_alike(&lights, &points, glossy, |light| glossy.product_integral(light))?;
        let dull = LambertLobe::new(0.7, lit.normal).unwrap();
        reflect_alike(&lights, &points, dull, |light| dull.product_integral(light))?;
        let gaussian = SphericalGaussian::new(lit.normal, 30.0 * roughness, 0.4).unwrap();
        reflect_alike(&lights, &points, gaussian, |light| gaussian.product_integral(light))?;
    }
}

/// An estimate of a point light arrives from one direction.
#[test]
fn point_lights_arrive_sharp() {
    let mut batch = ShadingBatch::new();
    let lamp = Vpl::point(Vec3::new(0.0, 2.0, 0.0), 4.0).unwrap();
    batch.push(&lamp, Xi::new(1.0).unwrap());
    let estimator = RadianceEstimator::new(&Roulette::new(0.01).unwrap());
    let mut found = Vec::new();
    let points = [Vec3::ZERO, lamp.position()].map(|point| (point.into(), &[0][..]));
    estimator.at_points(&batch, points, |_, estimate| found.push(*estimate));
    let incoming = found[0].incoming();
    assert_eq!(found[0].sharpness, f32::INFINITY);
    assert_eq!(incoming.sharpness(), SphericalGaussian::MAX_SHARPNESS);
    assert_eq!(*incoming.axis(), Vec3::Y);
    assert!((incoming.integral() - 1.0).abs() < 1e-6);
    // At the light itself it is as bright as can be.
    assert_eq!(found[1].incoming().amplitude(), f32::MAX);
}

const IMAGE: [u32; 2] = [24, 16];

/// A floor seen at a slant, and clusters about it: dull and glossy, narrow and wide.
struct Scene {
    camera: Camera,
    clusters: Vec<Vsgl>,
    points: Vec<Vec3>,
}

impl Scene {
    fn new() -> Self {
        let eye = Vec3::new(0.0, 3.0, 6.0);
        let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 0.9, 1.5, 0.1..100.0).unwrap();
        let clusters = (0..200_u32).map(|i| {
            let random = |k: u32| 2.0 * Seed(7).frame(k).hashed_xi(i).get() - 1.0;
            let axis = Direction::new(Vec3::new(random(0), random(1) - 1.0, random(2))).unwrap();
            let sharpness = [2.0, 8.0, 60.0, 800.0][i as usize % 4];
            let lobe = SphericalGaussian::with_integral(axis, sharpness, 0.3).unwrap();
            let position = Vec3::new(4.0 * random(3), 1.2 + random(4), 4.0 * random(5));
            Vsgl::new(position, 0.4 * (1.0 + random(6)), lobe).unwrap()
        });
        let pixels = (0..IMAGE[0] * IMAGE[1]).map(|i| [i % IMAGE[0], i / IMAGE[0]]);
        let points = pixels.map(|pixel| {
            let along = camera.to_world_space(camera.point_in_pixel(IMAGE, pixel, 1.0)) - eye;
            eye - along * (eye.y / along.y.min(-0.05))
        });
        Self {
            clusters: clusters.collect(),
            points: points.collect(),
            camera,
        }
    }
}

/// What a point reflects of arriving light: all of it, diffuse, and glossy towards the eye.
fn reflected(incoming: &SphericalGaussian, receivers: &(LambertLobe, GgxLobe)) -> [f64; 3] {
    let (diffuse, glossy) = receivers;
    [
        incoming.integral(),
        diffuse.product_integral(incoming),
        glossy.product_integral(incoming),
    ]
    .map(f64::from)
}

/// The tiles of a grid, with the depths of its pixels.
fn tiles(grid: &TileGrid, camera: &Camera, depth: impl Fn(usize) -> f32) -> TileDepths {
    let mut tiles = TileDepths::new(grid, camera, 2).unwrap();
    for tile in grid.tiles() {
        let pixels = grid.pixels(tile).pixels();
        let depths = pixels.map(|[x, y]| depth((y * IMAGE[0] + x) as usize));
        tiles.set(tile, DepthInterval::modified_half_z(depths));
    }
    tiles
}

/// A dull and a glossy floor, seen from the direction `view`.
fn receivers(view: Vec3) -> (LambertLobe, GgxLobe) {
    let incidence = Incidence {
        normal: Direction::Y,
        incoming: Direction::new(view).unwrap(),
    };
    let diffuse = LambertLobe::new(0.8, Direction::Y).unwrap();
    (
        diffuse,
        GgxLobe::new(Ggx::new(0.15).unwrap(), NoFresnel, incidence),
    )
}

/// The mean over 64 seeds of what culled clusters give is that of all, within three standard errors; and in each
/// frame the lists hold every cluster that a point accepts.
#[test]
fn culled_clusters_have_the_mean_of_all() {
    const SEEDS: u32 = 64;
    let Scene {
        camera,
        clusters,
        points,
    } = Scene::new();
    let roulette = Roulette::new(0.2).unwrap();
    let grid = TileGrid::new(IMAGE, 8).unwrap();
    let depth = |i: usize| camera.to_camera_space(points[i]).z;
    let tiles = tiles(&grid, &camera, depth);
    let eye = camera.to_world_space(Vec3::ZERO);
    let receivers: Vec<_> = points.iter().map(|point| receivers(eye - *point)).collect();
    let mut exact = [0.0; 3];
    for (point, receivers) in points.iter().zip(&receivers) {
        for cluster in &clusters {
            let all = reflected(&cluster.incoming(*point), receivers);
            exact = std::array::from_fn(|k| exact[k] + all[k]);
        }
    }

    let (mut batch, mut lists) = (LightBatch::new(), LightLists::new());
    let (mut shaded, mut culler) = (ShadingBatch::new(), Culler::new());
    let estimator = RadianceEstimator::new(&roulette);
    let mut sums = [DVec2::ZERO; 3];
    let (mut listed, mut accepted) = (0, 0);
    for seed in 0..SEEDS {
        let xi = |i: u32| Seed(seed).frame(0).xi(i);
        batch.clear();
        shaded.clear();
        let with_xi = || (0..).zip(&clusters).map(|(i, cluster)| (i, cluster, xi(i)));
        BatchBuilder::new(&roulette, &camera).add_vsgls(with_xi(), &mut batch);
        shaded.extend(with_xi().map(|(_, cluster, xi)| (cluster, xi)));
        culler.cull(&batch, &tiles, &mut lists).unwrap();
        let lists_of_points: Vec<_> = (0..points.len())
            .map(|i| {
                let pixel = [i as u32 % IMAGE[0], i as u32 / IMAGE[0]];
                let interval = tiles.interval_of(grid.tile_of(pixel), depth(i));
                interval.map_or(&[][..], |interval| lists.of(grid.tile_of(pixel), interval))
            })
            .collect();
        listed += lists_of_points.iter().map(|list| list.len()).sum::<usize>();
        let mut found = vec![Vec::new(); points.len()];
        let mut total = [0.0; 3];
        let with_lists = points
            .iter()
            .zip(&lists_of_points)
            .map(|(point, list)| ((*point).into(), *list));
        estimator.at_points(&shaded, with_lists, |i, estimate| {
            found[i].push(estimate.light);
            let more = reflected(&estimate.incoming(), &receivers[i]);
            total = std::array::from_fn(|k| total[k] + more[k]);
        });
        for (sum, total) in sums.iter_mut().zip(total) {
            *sum += DVec2::new(total, total * total);
        }
        // No light is lost.
        for (point, found) in points.iter().zip(&found) {
            accepted += found.len();
            for (i, cluster) in (0..).zip(&clusters) {
                let irradiance = cluster.scalar_irradiance(*point);
                let is_accepted = roulette.accepts(irradiance, 1.0, xi(i));
                assert_eq!(
                    is_accepted,
                    found.contains(&i),
                    "seed {seed}: {cluster:?} at {point}"
                );
            }
        }
    }
    let count = f64::from(SEEDS) * points.len() as f64;
    println!(
        "of {} clusters a point has {:.1} listed, {:.1} accepted",
        clusters.len(),
        listed as f64 / count,
        accepted as f64 / count
    );
    assert!(accepted > 0 && (listed as f64) < 0.5 * count * clusters.len() as f64);
    for (sum, exact) in sums.into_iter().zip(exact) {
        let mean = sum / f64::from(SEEDS);
        let variance = (mean.y - mean.x * mean.x) / f64::from(SEEDS - 1);
        let error = (mean.x - exact) / variance.sqrt();
        println!(
            "mean {:.3} of {exact:.3}: {error:.2} standard errors of {:.4}",
            mean.x,
            variance.sqrt() / exact
        );
        assert!(error.abs() < 3.0 && variance.sqrt() < 0.05 * exact);
    }
}
