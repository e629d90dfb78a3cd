//! The majorant of a family of lobes within a cap of directions: no member is greater, whether the model computes it or
//! the crate; and of nested families in nested caps the greater has the greater majorant.
//!
//! `CASES=100000000 cargo test --release --test families -- --nocapture` is the long run.

mod alone;
mod closing;
mod members;
mod nesting;
mod total_reflection;

use fastrand::Rng;
use members::{Member, surfaces};
use nesting::{check_blocks, check_nesting};
use rayon::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Cap, Direction, Fresnel, FresnelMajorant, Ggx, GgxFamily,
    GgxLobe, HeightCorrelated, Incidence, LambertLobe, Lobe, LobeFamily, LobeSum, LtcLobe,
    NoFresnel, PhongLobe, ReceiverLobe, Separable, SphericalGaussian, glam::Vec3,
};
use support::adversary::{direction, log_uniform, unit_vector};
use support::caps::nearest;
use support::reference::{MaskedAlone, Masking, Vector};

const CAPS_PER_FAMILY: usize = 32;

/// So many cases, or as many as the environment variable CASES says.
fn cases() -> usize {
    std::env::var("CASES").map_or(300_000, |cases| cases.parse().expect("a number"))
}

/// Draws families until as many members are tested in a cap as are wanted.
fn search(in_family: impl Fn(&mut Rng) -> usize + Sync + Send) {
    const BATCH: usize = 1024;
    let batch = |seed| {
        let (mut rng, mut tested) = (Rng::with_seed(seed), 0);
        while tested < BATCH {
            tested += in_family(&mut rng);
        }
        tested
    };
    let batches = 0..(cases() / BATCH + 1) as u64;
    let tested: usize = batches.into_par_iter().map(batch).sum();
    println!("{tested} lobes in a cap");
}

/// Caps of any size, most of them where a member is great or small.
fn cap<L>(rng: &mut Rng, members: &[Member<L>]) -> Cap {
    let aim = members[rng.usize(0..members.len())].likely_directions(rng);
    let offset = unit_vector(rng) * log_uniform(rng, 1e-7, 1.0);
    let chord = match rng.u8(0..8) {
        0 => 0.0,
        1 => 2.0,
        _ => log_uniform(rng, 1e-6, 2.0),
    };
    let axis = direction((aim[rng.usize(0..4)] + offset).unit());
    Cap::new(axis, chord as f32).expect("in range")
}

/// The greatest value of a member in the cap, of those that are looked at: as the model has it, and the crate.
fn greatest<L: Lobe>(rng: &mut Rng, member: &Member<L>, cap: &Cap) -> (f64, f32) {
    let axis = Vector::from(*cap.axis()).unit();
    let edge = (axis + unit_vector(rng) * 3.0).unit();
    let likely = member.likely_directions(rng).map(|to| nearest(cap, to));
    let directions = likely.into_iter().chain([axis, nearest(cap, edge)]);
    directions.fold((0.0, 0.0), |(model, own): (f64, f32), outgoing| {
        let value = member.lobe.value(*direction(outgoing));
        (model.max(member.value(outgoing)), own.max(value))
    })
}

fn check<L: ReceiverLobe + Copy>(rng: &mut Rng, members: &[Member<L>]) -> usize {
    let families = || members.iter().map(|member| member.lobe.family());
    let family = L::Family::union(families()).expect("of one at least");
    let part = L::Family::union(families().take(1 + rng.usize(0..members.len())));
    let part = part.expect("of one at least");
    let whole = L::Family::union([part, family].into_iter()).expect("of two");
    for _ in 0..CAPS_PER_FAMILY {
        let cap = cap(rng, members);
        let most = family.greatest_within(&cap);
        for member in members {
            let (model, own) = greatest(rng, member, &cap);
            let alone = member.lobe.maximum_within(&cap);
            // The model's own rounding.
            let model = model * (1.0 - 1e-12);
            let lobe = &member.lobe;
            assert!(
                model <= f64::from(alone) && own <= alone,
                "{model} {own} {alone} {cap:?}"
            );
            assert!(
                model <= f64::from(most) && own <= most,
                "{model} or {own} > {most} in {cap:?}: {:?} {:?}",
                lobe.value(*cap.axis()),
                member.surface,
            );
        }
        check_nesting(rng, &cap, (&part, &whole));
        for member in members {
            check_blocks(rng, &cap, member.lobe);
        }
    }
    CAPS_PER_FAMILY * members.len()
}

/// Draws members of a kind, and checks them.
macro_rules! check {
    ($rng:ident, $members:expr) => {{
        let members = $members;
        check($rng, &members)
    }};
}

#[test]
fn no_ggx_lobe_is_greater() {
    search(|rng| match rng.u8(0..5) {
        0 | 1 => {
            check!(
                rng,
                members::ggx::<HeightCorrelated>(rng, Masking::HeightCorrelated)
            )
        }
        2 | 3 => check!(rng, members::ggx::<Separable>(rng, Masking::Separable)),
        _ => check!(rng, members::ggx::<MaskedAlone>(rng, Masking::MaskedAlone)),
    });
}

#[test]
fn no_other_lobe_is_greater() {
    search(|rng| match rng.u8(0..9) {
        0 | 1 => {
            let masking = Masking::HeightCorrelated;
            check!(rng, members::anisotropic::<HeightCorrelated>(rng, masking))
        }
        2 => check!(
            rng,
            members::anisotropic::<Separable>(rng, Masking::Separable)
        ),
        3 => check!(rng, members::lambert(rng)),
        4 => check!(rng, members::phong(rng)),
        5 => check!(rng, members::gaussian(rng)),
        6 => check!(rng, members::transformed_cosine(rng)),
        _ => check!(rng, members::varnished(rng)),
    });
}

#[test]
fn no_spot_light_is_greater() {
    search(|rng| {
        let lit = surfaces(rng)[0];
        let members = [members::spot(rng, &lit)];
        for _ in 0..CAPS_PER_FAMILY {
            let cap = cap(rng, &members);
            let (model, own) = greatest(rng, &members[0], &cap);
            let most = members[0].lobe.maximum_within(&cap);
            let model = model * (1.0 - 1e-12);
            assert!(
                model <= f64::from(most) && own <= most,
                "{model} {own} {most}"
            );
        }
        CAPS_PER_FAMILY
    });
}

/// A lobe that is zero everywhere needs no light, nor does a family of such lobes, and they widen no other family.
fn check_empty<L: ReceiverLobe>(empty: &L, lit: &L) {
    assert!(empty.is_empty() && !lit.is_empty());
    let (empty, lit) = (empty.family(), lit.family());
    let union = |families: &[L::Family]| L::Family::union(families.iter().copied());
    let none = union(&[empty; 2]).expect("of two");
    for family in [empty, none, union(&[none, empty]).expect("of two")] {
        assert_eq!(family.greatest_within(&Cap::all()), 0.0);
        assert_eq!(union(&[family, lit, family]), Some(lit));
    }
    assert_eq!(union(&[]), None);
}

#[test]
fn black_surfaces_need_no_light() {
    let (up, down) = (Direction::Z, -Direction::Z);
    let slant = Direction::new(Vec3::new(0.6, 0.0, 0.8)).unwrap();
    let lit_from = |incoming| Incidence {
        normal: up,
        incoming,
    };
    let ggx = Ggx::new(0.1).unwrap();
    let anisotropic = AnisotropicGgx::new(0.1, 0.3).unwrap();
    // Seen from behind.
    let isotropic = |incoming| GgxLobe::new(ggx, NoFresnel, lit_from(incoming));
    check_empty(&isotropic(down), &isotropic(slant));
    let brushed = |incoming| {
        AnisotropicGgxLobe::new(anisotropic, NoFresnel, lit_from(incoming), Direction::X).unwrap()
    };
    check_empty(&brushed(down), &brushed(slant));
    let transformed = |incoming| LtcLobe::new(ggx, NoFresnel, lit_from(incoming));
    check_empty(&transformed(down), &transformed(slant));
    // Black.
    let lambert = |albedo| LambertLobe::new(albedo, slant).unwrap();
    check_empty(&lambert(0.0), &lambert(0.5));
    let phong = |albedo| PhongLobe::new(albedo, 5.0, lit_from(slant)).unwrap();
    check_empty(&phong(0.0), &phong(0.5));
    let gaussian = |amplitude| SphericalGaussian::new(slant, 5.0, amplitude).unwrap();
    check_empty(&gaussian(0.0), &gaussian(0.5));
    // Both, and with a weight of zero.
    let sum = |weights, albedo, incoming| {
        LobeSum::weighted(weights, lambert(albedo), isotropic(incoming)).unwrap()
    };
    let lit = sum([1.0; 2], 0.5, slant);
    check_empty(&sum([1.0; 2], 0.0, down), &lit);
    check_empty(&sum([0.0; 2], 0.5, slant), &lit);
    check_empty(&sum([0.0, 1.0], 0.5, down), &lit);
}

/// A factor that is 1, with a majorant of any numbers.
#[derive(Clone, Copy)]
struct Wild(FresnelMajorant);

impl Fresnel for Wild {
    fn reflectance(&self, _half_angle_cosine: f32) -> f32 {
        1.0
    }

    fn majorant(&self) -> FresnelMajorant {
        self.0
    }
}

#[test]
fn fresnel_majorants_that_are_none_count_as_one() {
    let ggx = Ggx::new(0.3).unwrap();
    let incidence = Incidence::head_on(Direction::Z);
    let cap = Cap::new(Direction::Z, 0.1).unwrap();
    let whole = GgxLobe::new(ggx, NoFresnel, incidence).family();
    let numbers = [
        [-1e-14, 1e18],
        [0.0, 0.0],
        [f32::NAN, 0.0],
        [0.5, -1.0],
        [0.5, f32::NAN],
        [0.5, f32::INFINITY],
    ];
    for [base, rise] in numbers {
        let wild = Wild(FresnelMajorant { base, rise });
        let family = GgxLobe::new(ggx, wild, incidence).family();
        assert_eq!(family.greatest_within(&cap), whole.greatest_within(&cap));
        // A greater lobe beside it changes nothing.
        let both = LobeFamily::union([family, whole].into_iter()).unwrap();
        assert_eq!(both.greatest_within(&cap), whole.greatest_within(&cap));
    }
}

#[test]
fn opposite_axes_and_mirrors_have_finite_bounds() {
    let mirror = |normal| {
        let ggx = Ggx::new(Ggx::MIN_ROUGHNESS).unwrap();
        GgxLobe::new(ggx, NoFresnel, Incidence::head_on(normal)).family()
    };
    let both = LobeFamily::union([Direction::Z, -Direction::Z].map(mirror).into_iter());
    let both: GgxFamily = both.unwrap();
    let upward = Cap::new(Direction::Z, 0.0).unwrap();
    let most = both.greatest_within(&upward);
    assert!(most.is_finite() && most >= mirror(Direction::Z).greatest_within(&upward));
    // Straight behind the eye, where the half vector vanishes.
    let behind = mirror(Direction::Z).greatest_within(&Cap::new(-Direction::Z, 1.9).unwrap());
    assert!(behind.is_finite());
}

#[test]
fn unions_of_caps_hold_them() {
    let around = |axis, chord| Cap::new(axis, chord).unwrap();
    assert_eq!(Cap::union([].into_iter()), None);
    let narrow = around(Direction::X, 0.1);
    assert_eq!(Cap::union([narrow; 3].into_iter()), Some(narrow));
    // However much the sum of their axes is rounded.
    let slant = around(Direction::new(Vec3::new(0.1, 0.7, 0.3)).unwrap(), 0.0);
    for count in [2, 255, 5_000, 100_000] {
        assert_eq!(Cap::union((0..count).map(|_| slant)), Some(slant));
    }
    let both = Cap::union([narrow, around(Direction::Y, 0.2)].into_iter()).unwrap();
    let to_y = (*both.axis() - *Direction::Y).length();
    assert!(both.chord() >= to_y + 0.2 && both.chord() < to_y + 0.2001);
    // No mean: any axis holds all.
    let opposite = Cap::union([narrow, around(-Direction::X, 0.0)].into_iter()).unwrap();
    assert_eq!(opposite.chord(), 2.0);
}
