//! Tests that majorants in lanes have the same bits as those of each lobe alone, and that the typical value is
//! positive where the greatest is, and never above it.

use core::array::from_fn;

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::lanes_tests::{MaskedAlone, Random, Squared, gathered, gathered_vector};
use super::{
    AnisotropicGgx, AnisotropicGgxLobe, Cap, Caps, Conductor, Dielectric, Fresnel, Ggx, GgxLobe,
    LambertLobe, Lobe, LobeFamily, LobeSum, Majorant, NoFresnel, PhongLobe, ReceiverLobe, Schlick,
    Separable, SphericalGaussian, SpotLobe,
};
use crate::base::Direction;
use crate::num::{F32Lanes, LaneTest, MAX_LANES, at_every_level, to_array};

fn random_cap(random: &mut Random) -> Cap {
    let share = random.number();
    match random.number() {
        x if x < 0.1 => Cap::all(),
        x if x < 0.2 => Cap::of_axis(random.direction()),
        _ => Cap::new(random.direction(), 2.0 * share * share * share).expect("in range"),
    }
}

fn caps_in_lanes<S: Simd>(simd: S, start: usize, caps: &[Cap; MAX_LANES]) -> Caps<F32Lanes<S>> {
    Caps {
        axis: gathered_vector(simd, start, |i| *caps[i].axis()),
        chord: gathered(simd, start, |i| caps[i].lanes().chord),
        must_nest: caps[start].lanes().must_nest,
    }
}

/// Compares with the bits of `expected`, the majorants of the lanes from `start` on.
fn compare<S: Simd>(
    found: Majorant<F32Lanes<S>>,
    start: usize,
    expected: impl Fn(usize) -> Majorant<f32>,
) {
    let [greatest, typical] = [found.greatest, found.typical].map(to_array);
    for i in 0..S::f32s::LEN {
        let found = [greatest[i], typical[i]];
        let Majorant { greatest, typical } = expected(start + i);
        let expected = [greatest, typical];
        assert_eq!(
            found.map(f32::to_bits),
            expected.map(f32::to_bits),
            "{found:?} {expected:?}"
        );
        assert!(typical <= greatest && (typical > 0.0) == (greatest > 0.0));
    }
}

/// A lobe for each lane, with a cap and a direction there.
struct OfLobes<L>([L; MAX_LANES], [Cap; MAX_LANES], [Vec3; MAX_LANES]);

impl<L: Lobe> LaneTest for OfLobes<L> {
    fn run<S: Simd>(&self, simd: S) {
        let Self(lobes, caps, outgoing) = self;
        for start in (0..MAX_LANES).step_by(S::f32s::LEN) {
            let numbers = from_fn(|k| gathered(simd, start, |i| lobes[i].numbers()[k]));
            let cap = caps_in_lanes(simd, start, caps);
            let found = L::majorant_in_lanes(&numbers, |i| lobes.get(start + i), &cap);
            compare(found, start, |i| {
                let (lobe, cap) = (&lobes[i], caps[i].lanes());
                let alone = L::majorant_in_lanes(&lobe.numbers(), |_| Some(lobe), &cap);
                let most = lobe.maximum_within(&caps[i]);
                if L::numbers_in_use() > 0 {
                    assert_eq!(most.to_bits(), alone.greatest.to_bits());
                }
                // Lane by lane, the cap is enlarged twice.
                assert!(most <= 1.0001 * alone.greatest);
                alone
            });
            let outgoing_lanes = gathered_vector(simd, start, |i| outgoing[i]);
            let values = L::value_in_lanes(&numbers, |i| lobes.get(start + i), outgoing_lanes);
            for (i, value) in (start..).zip(&to_array(values)[..S::f32s::LEN]) {
                assert_eq!(value.to_bits(), lobes[i].value(outgoing[i]).to_bits());
            }
        }
    }
}

/// A family, and a cap for each lane.
struct OfFamily<F>(F, [Cap; MAX_LANES]);

impl<F: LobeFamily> LaneTest for OfFamily<F> {
    fn run<S: Simd>(&self, simd: S) {
        let Self(family, caps) = self;
        for start in (0..MAX_LANES).step_by(S::f32s::LEN) {
            let found = family.majorant_in_lanes(&caps_in_lanes(simd, start, caps));
            compare(found, start, |i| {
                let alone = family.majorant_in_lanes(&caps[i].lanes());
                assert_eq!(
                    family.greatest_within(&caps[i]).to_bits(),
                    alone.greatest.to_bits()
                );
                alone
            });
        }
    }
}

fn check_lobes<L: Lobe>(lobe: impl Fn(&mut Random) -> L) {
    let mut random = Random(1);
    for _ in 0..200 {
        let lobes = from_fn(|_| lobe(&mut random));
        let caps = from_fn(|_| random_cap(&mut random));
        let outgoing = from_fn(|_| *random.direction());
        at_every_level(&OfLobes(lobes, caps, outgoing));
    }
}

fn check<L: ReceiverLobe>(lobe: impl Fn(&mut Random) -> L + Copy) {
    check_lobes(lobe);
    let mut random = Random(1);
    for _ in 0..200 {
        let members = 1 + (3.0 * random.number()) as usize;
        let lobes: [L; 3] = from_fn(|_| lobe(&mut random));
        let family = L::Family::union(lobes[..members].iter().map(L::family));
        let caps = from_fn(|_| random_cap(&mut random));
        at_every_level(&OfFamily(family.expect("of one at least"), caps));
    }
}

fn check_ggx<F: Fresnel>(fresnel: impl Fn(f32) -> F + Copy) {
    let lobe = |random: &mut Random| {
        let ggx = Ggx::new(random.roughness()).expect("in range");
        GgxLobe::new(ggx, fresnel(random.number()), random.incidence())
    };
    check(lobe);
    check(|random| lobe(random).with_masking::<Separable>());
    check(|random| lobe(random).with_masking::<MaskedAlone>());
}

#[test]
fn ggx_lobes_have_the_same_majorants() {
    check_ggx(|_| NoFresnel);
    check_ggx(|share| Schlick::new(share).expect("in range"));
    check_ggx(|share| Dielectric::new(0.4 + 2.0 * share).expect("in range"));
    check_ggx(|share| Conductor::new(0.1 + share, 4.0 * share).expect("in range"));
    check_ggx(Squared);
}

fn lambert(random: &mut Random) -> LambertLobe {
    let albedo = (1.2 * random.number() - 0.2).max(0.0);
    LambertLobe::new(albedo, random.direction()).expect("in range")
}

fn glossy(random: &mut Random) -> GgxLobe<Dielectric> {
    let ggx = Ggx::new(random.roughness()).expect("in range");
    let fresnel = Dielectric::new(1.0 + random.number()).expect("in range");
    GgxLobe::new(ggx, fresnel, random.incidence())
}

fn brushed(random: &mut Random) -> AnisotropicGgxLobe<Schlick> {
    let ggx = AnisotropicGgx::new(random.roughness(), random.roughness()).expect("in range");
    let fresnel = Schlick::new(random.number()).expect("in range");
    let incidence = random.incidence();
    let tangent = Direction::new(incidence.normal.any_orthonormal_vector()).expect("unit");
    AnisotropicGgxLobe::new(ggx, fresnel, incidence, tangent).expect("at right angles")
}

fn sum<A: Lobe, B: Lobe>(random: &mut Random, first: A, second: B) -> LobeSum<A, B> {
    let weights = from_fn(|_| (1.2 * random.number() - 0.2).max(0.0));
    LobeSum::weighted(weights, first, second).expect("in range")
}

#[test]
fn other_lobes_have_the_same_majorants() {
    check(lambert);
    check(brushed);
    check(|random| {
        let exponent = 1000.0 * random.number() * random.number();
        PhongLobe::new(random.number(), exponent, random.incidence()).expect("in range")
    });
    check(|random| {
        let sharpness = 1000.0 * random.number() * random.number();
        let amplitude = (1.2 * random.number() - 0.2).max(0.0);
        SphericalGaussian::new(random.direction(), sharpness, amplitude).expect("in range")
    });
    check_lobes(|random| {
        let outer = 3.1 * random.number();
        SpotLobe::new(outer * random.number(), outer, random.direction()).expect("in range")
    });
}

#[test]
fn sums_have_the_same_majorants() {
    check(|random| {
        let (paint, varnish) = (lambert(random), glossy(random));
        sum(random, paint, varnish)
    });
    // More numbers than a light has room for.
    check(|random| {
        let (grain, varnish) = (brushed(random), glossy(random));
        sum(random, grain, varnish)
    });
    check(|random| {
        let (paint, grain) = (lambert(random), brushed(random));
        let both = sum(random, paint, grain);
        let glow = SphericalGaussian::new(random.direction(), 3.0, 1.0).expect("in range");
        sum(random, glow, both)
    });
}

#[cfg(feature = "ltc")]
#[test]
fn transformed_cosines_have_the_same_majorants() {
    check(|random| {
        let ggx = Ggx::new(random.roughness()).expect("in range");
        super::LtcLobe::new(ggx, NoFresnel, random.incidence())
    });
}
