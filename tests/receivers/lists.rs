//! Lists through blocks and in lanes are those of the scalar test, and hold every light that a receiver accepts.

use std::marker::PhantomData;

use fastrand::Rng;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Blind, ConstantLobe, Dielectric, Direction, Ggx, GgxLobe,
    Incidence, LambertLobe, LightLists, LobeSum, ReceiverCluster, ReceiverCuller, ReceiverLobe,
    Roulette, Schlick, ShadingBatch, TileGrid, TileReceivers, glam::Vec3,
};

use crate::case::{Family, Receivers, blind, check};
use crate::scene::{Pixel, direction, lights};

fn roughness(rng: &mut Rng, least: f32) -> Ggx {
    let exponent = least.log10() * rng.f32();
    Ggx::new(10_f32.powf(exponent).clamp(least, 1.0)).expect("in range")
}

pub fn glossy_light(rng: &mut Rng) -> GgxLobe<Schlick> {
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
    let accepted = check(glossy_light, &blind(), 7, cases(20));
    assert!(accepted > 1_000, "{accepted}");
    let lambert = |incidence: Incidence, rng: &mut Rng| {
        // One in four is black.
        let albedo = (rng.f32() - 0.25).max(0.0);
        LambertLobe::new(albedo, incidence.normal).expect("in range")
    };
    let accepted = check(glossy_light, &receivers_of(lambert), 8, cases(20));
    assert!(accepted > 1_000, "{accepted}");
}

#[test]
fn glossy_lights_on_glossy_receivers() {
    let metal = |incidence: Incidence, rng: &mut Rng| {
        let fresnel = Schlick::new(rng.f32()).expect("in range");
        GgxLobe::new(roughness(rng, 3e-3), fresnel, incidence)
    };
    let accepted = check(glossy_light, &receivers_of(metal), 9, cases(20));
    assert!(accepted > 1_000, "{accepted}");
    let plastic = |incidence: Incidence, rng: &mut Rng| {
        let fresnel = Dielectric::new(1.1 + rng.f32()).expect("in range");
        GgxLobe::new(roughness(rng, 3e-3), fresnel, incidence).separable()
    };
    let accepted = check(glossy_light, &receivers_of(plastic), 10, cases(20));
    assert!(accepted > 200, "{accepted}");
}

#[test]
fn glossy_lights_on_brushed_and_varnished_receivers() {
    let brushed = |incidence: Incidence, rng: &mut Rng| {
        let [along, across] = [(); 2].map(|()| roughness(rng, 3e-3).roughness());
        let ggx = AnisotropicGgx::new(along, across).expect("in range");
        let fresnel = Schlick::new(rng.f32()).expect("in range");
        let tangent =
            Direction::new(incidence.normal.any_orthonormal_pair().0).expect("a unit vector");
        AnisotropicGgxLobe::new(ggx, fresnel, incidence, tangent).expect("across the normal")
    };
    let accepted = check(glossy_light, &receivers_of(brushed), 11, cases(20));
    assert!(accepted > 200, "{accepted}");
    let varnished = |incidence: Incidence, rng: &mut Rng| {
        let paint = LambertLobe::new(rng.f32(), incidence.normal).expect("in range");
        let fresnel = Dielectric::new(1.1 + rng.f32()).expect("in range");
        let varnish = GgxLobe::new(roughness(rng, 3e-3), fresnel, incidence);
        LobeSum::new(paint, varnish)
    };
    let accepted = check(glossy_light, &receivers_of(varnished), 12, cases(20));
    assert!(accepted > 500, "{accepted}");
}

/// So many scenes, or as many as `SCENES` says.
fn cases(scenes: u32) -> u32 {
    let wanted = std::env::var("SCENES").ok();
    wanted.map_or(scenes, |wanted| wanted.parse().expect("a number"))
}

#[test]
fn blind_lists_are_those_of_the_scalar_test() {
    let accepted = check(|_| ConstantLobe, &blind(), 1, cases(40));
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
