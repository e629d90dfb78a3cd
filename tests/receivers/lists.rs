//! Lists through blocks and in lanes are those of the scalar test, and hold every light that a receiver accepts.

use std::marker::PhantomData;

use fastrand::Rng;
use stochastic_light_culling::{
    Blind, ConstantLobe, Dielectric, Ggx, GgxLobe, Incidence, LambertLobe, LightLists, Lobe,
    LobeFamily, ReceiverCluster, ReceiverCuller, ReceiverLobe, Roulette, Schlick, ShadingBatch,
    TileGrid, TileProbability, TileReceivers, Vpl, WeightedLists, glam::Vec3,
};

use crate::scene::{Pixel, Surfaces, direction, lights};

/// The kinds of receivers: the family of a pixel, and its value towards a light.
struct Receivers<F, M, V> {
    family: M,
    value: fn(&V, Vec3) -> f32,
    kinds: PhantomData<F>,
}

/// The family of a pixel, and what its value is computed from.
trait Family<F, V>: Fn(&Pixel, &mut Rng) -> (F, V) {}

impl<F, V, M: Fn(&Pixel, &mut Rng) -> (F, V)> Family<F, V> for M {}

fn blind() -> Receivers<Blind, impl Family<Blind, ()>, ()> {
    Receivers {
        family: |_: &Pixel, _: &mut Rng| (Blind, ()),
        value: |(), _| 1.0,
        kinds: PhantomData,
    }
}

/// Compares the lists of random scenes. Returns how many pairs were accepted, and how many pairs lists held.
fn check<L: Lobe + Clone + Sync, F: LobeFamily, M: Family<F, V>, V: Sync>(
    lobe: fn(&mut Rng) -> L,
    receivers: &Receivers<F, M, V>,
    seed: u64,
    scenes: u32,
) -> [u64; 2] {
    let mut rng = Rng::with_seed(seed);
    let mut counts = [0; 2];
    for _ in 0..scenes {
        let tile_size = [1, 2, 4, 8, 16][rng.usize(..5)];
        let surfaces = Surfaces::new(&mut rng, tile_size);
        let grid = surfaces.grid;
        let intervals = 1 + rng.u32(..2);
        let delta = 10_f32.powf(-4.0 * rng.f32() - 1.0);
        let roulette = Roulette::new(delta).expect("positive");
        let (lights, batch) = lights(&mut rng, 200, lobe);
        let lobes: Vec<_> = surfaces.pixels.iter().flatten().collect();
        let lobes: Vec<(F, V)> = lobes
            .iter()
            .map(|p| (receivers.family)(p, &mut rng))
            .collect();
        // The lobes of the pixels that see something, in their order.
        let mut lobes = lobes.into_iter();
        let lobes: Vec<Option<(F, V)>> = surfaces
            .pixels
            .iter()
            .map(|pixel| pixel.as_ref().and_then(|_| lobes.next()))
            .collect();
        let columns = grid.image_size()[0];
        let points = |grid: TileGrid, tile, interval| {
            let pixels = grid
                .pixels(tile)
                .pixels()
                .map(move |[x, y]| (y * columns + x) as usize);
            let points =
                pixels.filter_map(|i| Some((surfaces.pixels[i].as_ref()?, lobes[i].as_ref()?)));
            points.filter(move |(pixel, _)| intervals == 1 || pixel.interval == interval)
        };
        let parts = [1, tile_size.min(2), tile_size][rng.usize(..3)];
        let mut tiles = TileReceivers::new(&grid, parts, intervals).expect("few");
        let parts_grid = tiles.parts_grid();
        let cluster = |part: [u32; 2], interval| {
            let points = points(parts_grid, part, interval);
            let scale = 1.0 + (part[0] / parts % 3) as f32;
            ReceiverCluster::of(points.map(|(pixel, (family, _))| (pixel.position, *family)))
                .map(|cluster| cluster.with_delta_scale(scale).expect("in range"))
        };
        tiles.fill(cluster);
        #[cfg(feature = "rayon")]
        {
            let mut filled_by_many = TileReceivers::new(&grid, parts, intervals).expect("few");
            filled_by_many.fill_in_parallel(cluster);
            for tile in grid.tiles() {
                assert_eq!(filled_by_many.of(tile, 0), tiles.of(tile, 0));
            }
        }

        let least = 1e-3;
        let (mut lists, mut drawn) = (LightLists::new(), WeightedLists::new());
        let probability = [
            TileProbability::bound(),
            TileProbability::root_mean_square(8.0).expect("in range"),
        ][rng.usize(..2)];
        for lanes in [4, 8, 16] {
            let culler = ReceiverCuller::new(&roulette).with_lanes(lanes);
            let mut culler = culler.with_least_distance_squared(least).expect("positive");
            let [before, drawn_before] = [lists.clone(), drawn.lists().clone()];
            let weights = drawn.weights().to_vec();
            culler.cull(&batch, &tiles, &mut lists).expect("few");
            culler
                .draw(probability, &batch, &tiles, &mut drawn)
                .expect("few");
            #[cfg(feature = "rayon")]
            {
                let (mut many, mut drawn_by_many) = (LightLists::new(), WeightedLists::new());
                let of_many = culler.cull_in_parallel(&batch, &tiles, &mut many);
                of_many.expect("few");
                let of_many =
                    culler.draw_in_parallel(probability, &batch, &tiles, &mut drawn_by_many);
                of_many.expect("few");
                for tile in grid.tiles() {
                    for interval in 0..intervals {
                        assert_eq!(many.of(tile, interval), lists.of(tile, interval));
                        let drawn = drawn.of(tile, interval);
                        assert_eq!(drawn_by_many.of(tile, interval), drawn);
                    }
                }
            }
            if lanes > 4 {
                assert!(before == lists && drawn_before == *drawn.lists());
                assert!(weights == drawn.weights());
            }
        }

        for tile in grid.tiles() {
            for interval in 0..intervals {
                let list = lists.of(tile, interval);
                let cluster = tiles.of(tile, interval);
                let bound = |light: &Vpl<L>| {
                    tiles.greatest_radiance(tile, interval, light, &roulette, least)
                };
                // Of the scalar test.
                let expected = (0..).zip(&lights).filter(|(_, (light, xi))| {
                    let bound = bound(light);
                    bound > 0.0 && xi.get() <= bound
                });
                let expected: Vec<u32> = expected.map(|(light, _)| light).collect();
                assert_eq!(list, expected, "tile {tile:?}");
                counts[1] += list.len() as u64;

                // Of brute force.
                let delta = delta * cluster.map_or(1.0, ReceiverCluster::delta_scale);
                let roulette = Roulette::new(delta).expect("positive");
                for (pixel, (_, lobe)) in points(grid, tile, interval) {
                    for (light, (vpl, xi)) in (0..).zip(&lights) {
                        let (direction, squared) = vpl.direction_to(pixel.position);
                        let reflected =
                            vpl.radiant_intensity(direction) * (receivers.value)(lobe, -direction);
                        if roulette.accepts(reflected, squared.max(least), *xi) {
                            counts[0] += 1;
                            assert!(list.contains(&light), "light {light}, tile {tile:?}");
                        }
                    }
                }

                // A drawn light is listed, and its weight is at least 1 and that of the bound.
                let drawn = drawn.of(tile, interval);
                assert_eq!(drawn.lights.len(), drawn.weights.len());
                for (light, weight) in drawn.lights.iter().zip(drawn.weights) {
                    let (light, xi) = &lights[*light as usize];
                    let least = (1.0 / bound(light)).max(1.0);
                    assert!(*weight >= least * 0.99999, "{weight} {least}");
                    assert!(xi.get() <= 1.00001 / weight);
                }
            }
        }
    }
    counts
}

fn roughness(rng: &mut Rng, least: f32) -> Ggx {
    let exponent = least.log10() * rng.f32();
    Ggx::new(10_f32.powf(exponent).clamp(least, 1.0)).expect("in range")
}

fn glossy_light(rng: &mut Rng) -> GgxLobe<Schlick> {
    let incidence = Incidence {
        normal: direction(rng),
        incoming: direction(rng),
    };
    let fresnel = Schlick::new(rng.f32()).expect("in range");
    GgxLobe::new(roughness(rng, 1e-3), fresnel, incidence)
}

/// Receivers with lobes of one kind, `lobe` of a pixel's incidence.
fn receivers_of<R: ReceiverLobe>(
    lobe: fn(Incidence, &mut Rng) -> R,
) -> Receivers<R::Family, impl Family<R::Family, R>, R> {
    Receivers {
        family: move |pixel: &Pixel, rng: &mut Rng| {
            let lobe = lobe(pixel.incidence, rng);
            (lobe.family(), lobe)
        },
        value: R::value,
        kinds: PhantomData,
    }
}

#[test]
fn glossy_lights_on_blind_and_diffuse_receivers() {
    let [accepted, _] = check(glossy_light, &blind(), 7, cases(20));
    assert!(accepted > 1_000, "{accepted}");
    let lambert = |incidence: Incidence, rng: &mut Rng| {
        // One in four is black.
        let albedo = (rng.f32() - 0.25).max(0.0);
        LambertLobe::new(albedo, incidence.normal).expect("in range")
    };
    let [accepted, listed] = check(glossy_light, &receivers_of(lambert), 8, cases(20));
    println!("{accepted} accepted, {listed} listed");
    assert!(accepted > 1_000, "{accepted}");
}

#[test]
fn glossy_lights_on_glossy_receivers() {
    let metal = |incidence: Incidence, rng: &mut Rng| {
        let fresnel = Schlick::new(rng.f32()).expect("in range");
        GgxLobe::new(roughness(rng, 3e-3), fresnel, incidence)
    };
    let [accepted, listed] = check(glossy_light, &receivers_of(metal), 9, cases(20));
    println!("{accepted} accepted, {listed} listed");
    assert!(accepted > 1_000, "{accepted}");
    let plastic = |incidence: Incidence, rng: &mut Rng| {
        let fresnel = Dielectric::new(1.1 + rng.f32()).expect("in range");
        GgxLobe::new(roughness(rng, 3e-3), fresnel, incidence).separable()
    };
    let [accepted, _] = check(glossy_light, &receivers_of(plastic), 10, cases(20));
    assert!(accepted > 200, "{accepted}");
}

/// So many scenes, or as many as `SCENES` says.
fn cases(scenes: u32) -> u32 {
    let wanted = std::env::var("SCENES").ok();
    wanted.map_or(scenes, |wanted| wanted.parse().expect("a number"))
}

#[test]
fn blind_lists_are_those_of_the_scalar_test() {
    let [accepted, listed] = check(|_| ConstantLobe, &blind(), 1, 40);
    println!("{accepted} accepted, {listed} listed");
    assert!(accepted > 50_000);
}

#[test]
fn a_single_tile_and_empty_tiles_have_their_lists() {
    let mut rng = Rng::with_seed(3);
    let (_, batch) = lights(&mut rng, 50, |_| ConstantLobe);
    let roulette = Roulette::new(1e-6).expect("positive");
    let mut culler = ReceiverCuller::new(&roulette);
    for (size, intervals) in [([1, 1], 1), ([1, 1], 3), ([5, 1], 1), ([1, 7], 2)] {
        let grid = TileGrid::new(size, 1).expect("positive");
        let mut tiles = TileReceivers::new(&grid, 1, intervals).expect("few");
        let mut lists = LightLists::new();
        culler.cull(&batch, &tiles, &mut lists).expect("few");
        assert!(lists.is_empty() && tiles.of([0; 2], 0).is_none());
        let last = (size.map(|n| n - 1), intervals - 1);
        tiles.fill(|tile, interval| {
            let is_last = (tile, interval) == last;
            let points = is_last.then_some((Vec3::splat(0.5), Blind));
            ReceiverCluster::of(points.into_iter())
        });
        culler.cull(&batch, &tiles, &mut lists).expect("few");
        assert!(!lists.is_empty());
        assert_eq!(lists.of(last.0, last.1), lists.lights());
        // No lights.
        let none = ShadingBatch::<ConstantLobe>::new();
        culler.cull(&none, &tiles, &mut lists).expect("few");
        assert!(lists.is_empty());
    }
    for parts in [0, 3, 5, u32::MAX] {
        let grid = TileGrid::new([9, 9], 4).expect("positive");
        assert!(TileReceivers::<Blind>::new(&grid, parts, 1).is_err());
    }
    assert!(
        TileReceivers::<Blind>::new(&TileGrid::new([9, 9], 4).expect("positive"), 1, 0).is_err()
    );
}

#[test]
fn receivers_that_are_nowhere_need_no_light() {
    let positions = [
        Vec3::NAN,
        Vec3::INFINITY,
        Vec3::new(1.0, f32::NEG_INFINITY, 0.0),
    ];
    assert!(ReceiverCluster::of(positions.iter().map(|p| (*p, Blind))).is_none());
    let positions = [Vec3::NAN, Vec3::ONE];
    let cluster = ReceiverCluster::of(positions.iter().map(|p| (*p, Blind)));
    assert_eq!(cluster.map(|cluster| cluster.center()), Some(Vec3::ONE));
    let far = [Vec3::splat(f32::MAX), Vec3::splat(f32::MIN)];
    let cluster = ReceiverCluster::of(far.iter().map(|p| (*p, Blind))).expect("finite");
    assert_eq!(cluster.radius(), f32::INFINITY);
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(cluster.with_delta_scale(scale).is_err());
    }
    // Whatever the light, it may light them.
    let mut rng = Rng::with_seed(5);
    let (lights, _) = lights(&mut rng, 50, |_| ConstantLobe);
    let roulette = Roulette::new(1.0).expect("positive");
    for (light, _) in lights {
        let bound = cluster.greatest_radiance(&light, &roulette, 0.0);
        assert!(bound == f32::INFINITY || light.flux() == 0.0, "{bound}");
    }
}
