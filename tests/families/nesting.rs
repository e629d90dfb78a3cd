//! Bounds nest: of a greater family in a greater cap, and of a light towards a block of tiles.

use std::f64::consts::TAU;

use fastrand::Rng;
use stochastic_light_culling::{
    Blind, Cap, GgxFamily, HeightCorrelated, Lobe, LobeFamily, ReceiverCluster, ReceiverLobe,
    Roulette, Vpl, glam::Vec3,
};
use support::adversary::{direction, log_uniform, unit_vector};
use support::generators::Lit;
use support::reference::{self, Masking, Surface, Vector};

use crate::{members, search};

/// 2⁻²⁴
const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 / 2.0;

/// A cap around another cap and a union around its part have the greater majorant. Each step may cost 96u of a chord, where
/// merging pays 160u, and 512u of the majorant.
pub fn check_nesting<F: LobeFamily>(rng: &mut Rng, cap: &Cap, (part, whole): (&F, &F)) {
    let axis = Vector::from(*cap.axis()).unit();
    let offset = match rng.u8(0..3) {
        0 => 0.0,
        _ => log_uniform(rng, 1e-6, 1.0),
    };
    check_nesting_around(axis + unit_vector(rng) * offset, cap, (part, whole));
}

/// A light that reaches the receivers of a tile reaches those of a block with more of them: the bound of its lobe alone
/// grows with the ball, by way of a cap that may be sharp for the tile.
pub fn check_blocks<L: Lobe>(rng: &mut Rng, cap: &Cap, lobe: L) {
    let roulette = Roulette::new(1.0).expect("in range");
    let light = Vpl::new(Vec3::ZERO, 1.0, lobe).expect("in range");
    let axis = Vector::from(*cap.axis()).unit();
    let around = |rng: &mut Rng, axis: Vector, radius: f64| {
        let Vector([x, y, z]) = axis + unit_vector(rng) * radius;
        (Vec3::new(x as f32, y as f32, z as f32), Blind)
    };
    let (radius, step) = (0.5 * f64::from(cap.chord()), log_uniform(rng, 1e-6, 1.0));
    let receivers: [_; 3] = std::array::from_fn(|_| around(rng, axis, radius));
    let beside = [around(rng, axis, radius + step)];
    let [tile, beside] = [&receivers[..], &beside]
        .map(|receivers| ReceiverCluster::of(receivers.iter().copied()).expect("there are some"));
    let mut block = ReceiverCluster::union([tile, beside].into_iter()).expect("of two");
    for merges in 1..3 {
        let [less, more] = [tile, block].map(|of| of.greatest_radiance(&light, &roulette, 0.0));
        assert!(
            less <= more,
            "{less} in a tile, but {more} in a block of {merges}, {tile:?} {block:?}: {}",
            std::any::type_name::<L>()
        );
        block = ReceiverCluster::union([block].into_iter()).expect("of one");
    }
}

/// The least cap around the direction of `aim` and another cap.
fn cap_around(aim: Vector, cap: &Cap) -> Cap {
    let axis = Vector::from(*cap.axis()).unit();
    let around = direction(aim.unit());
    let apart = (Vector::from(*around).unit() - axis).length();
    let chord = apart + f64::from(cap.chord()) + 96.0 * UNIT_ROUNDOFF;
    Cap::new(around, chord.min(2.0) as f32).expect("in range")
}

/// As [`check_nesting`], for the cap around the direction of `aim`.
fn check_nesting_around<F: LobeFamily>(aim: Vector, cap: &Cap, (part, whole): (&F, &F)) {
    let greater = cap_around(aim, cap);
    let [less, more] = [part.greatest_within(cap), whole.greatest_within(&greater)].map(f64::from);
    assert!(
        less <= more * (1.0 + 512.0 * UNIT_ROUNDOFF),
        "{less} in {cap:?}, but {more} in {greater:?}: {part:?} {whole:?}"
    );
}

/// Half vectors are in elliptic cones, which are flattest near grazing. Moves of a normal, of an incoming direction and
/// of a cap, away from the mirror direction or anywhere, change the least sine by as much as the chords pay for.
#[test]
fn bounds_nest_near_grazing() {
    search(|rng| {
        let chord = log_uniform(rng, 1e-5, 3e-2);
        let near = |rng: &mut Rng, axis: Vector, away: Vector| {
            let toward = [away, away * -1.0, unit_vector(rng)][rng.usize(0..3)];
            let step = match rng.u8(0..3) {
                0 => 0.0,
                _ => chord * log_uniform(rng, 1e-2, 3.0),
            };
            (axis + (toward + unit_vector(rng) * (0.3 * rng.f64())) * step).unit()
        };
        let normal = unit_vector(rng);
        let side = normal.orthogonal();
        let side = side.turned(normal.cross(side), TAU * rng.f64());
        let incoming = normal.turned(side, log_uniform(rng, 0.01, 0.7).acos());
        let mirror = Surface { normal, incoming }.mirror();
        let outgoing = (mirror + unit_vector(rng) * (chord * log_uniform(rng, 0.8, 60.0))).unit();
        let away = (outgoing - mirror).unit();
        let alpha = (chord * log_uniform(rng, 0.3, 30.0)).clamp(1e-4, 1.0) as f32;
        let family = |normal, incoming| {
            let parameters = (alpha, reference::Fresnel::None, Masking::HeightCorrelated);
            members::ggx_of::<HeightCorrelated>(parameters, &Lit::new(normal, incoming))
                .lobe
                .family()
        };
        let part = family(normal, incoming);
        let other = family(near(rng, normal, away * -1.0), near(rng, incoming, away));
        let whole = GgxFamily::union([part, other].into_iter()).expect("of two");
        let cap = Cap::new(direction(outgoing), chord as f32).expect("in range");
        check_nesting_around(near(rng, outgoing, away), &cap, (&part, &whole));
        1
    });
}
