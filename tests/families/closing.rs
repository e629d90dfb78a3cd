//! How far majorants are above the greatest value within their caps, as these close.

use std::f64::consts::TAU;

use fastrand::Rng;
use stochastic_light_culling::{
    Cap, GgxFamily, GgxLobe, HeightCorrelated, Lobe, LobeFamily, MaskingShadowing, ReceiverLobe,
    Separable,
};
use support::adversary::{direction, log_uniform, unit_vector};
use support::caps::nearest;
use support::generators::Lit;
use support::reference::{Brdf, Fresnel, Masking, Surface, Vector};

use crate::members;

/// Of every cap.
pub const CHORD: f64 = 1e-3;
/// A mirror-like and a rough one, metals, glass seen from either side.
pub const FRESNELS: [Fresnel; 6] = [
    Fresnel::None,
    Fresnel::Schlick(0.04),
    Fresnel::Schlick(0.9),
    Fresnel::Dielectric(1.5),
    Fresnel::Dielectric(0.67),
    Fresnel::Conductor(0.2, 3.9),
];

pub fn cap(axis: Vector, chord: f64) -> Cap {
    Cap::new(direction(axis), chord as f32).expect("in range")
}

/// A surface that is lit at up to 78° from the normal.
pub fn surface(rng: &mut Rng) -> Surface {
    let normal = unit_vector(rng);
    let side = normal.orthogonal();
    let side = side.turned(normal.cross(side), TAU * rng.f64());
    let incoming = normal.turned(side, (0.2 + 0.8 * rng.f64()).acos());
    Surface { normal, incoming }
}

/// A surface, and a direction at which the lobe is not small.
fn case(rng: &mut Rng, alpha: f32) -> Option<(Surface, Vector)> {
    let surface = surface(rng);
    let offset = unit_vector(rng) * (f64::from(alpha) * log_uniform(rng, 1e-2, 3.0));
    let outgoing = (surface.mirror() + offset).unit();
    (surface.normal.dot(outgoing) > 0.1).then_some((surface, outgoing))
}

/// The greatest value for a normal, an incoming and an outgoing direction in these caps: the best of some, from which it
/// climbs.
pub fn greatest(rng: &mut Rng, caps: [Cap; 3], value: impl Fn([Vector; 3]) -> f64) -> f64 {
    let axes = caps.map(|cap| Vector::from(*cap.axis()).unit());
    let mirror = Surface {
        normal: axes[0],
        incoming: axes[1],
    }
    .mirror();
    let mut best = [axes[0], axes[1], nearest(&caps[2], mirror)];
    let mut most = value(best);
    for step in 0..240_i32 {
        // From anywhere in the caps, and then ever nearer to the best.
        let (from, reach) = if step < 60 {
            (axes, 2.0)
        } else {
            (best, 0.5_f64.powi(step / 20 - 3))
        };
        let mut tried = from;
        for (tried, cap) in tried.iter_mut().zip(&caps) {
            let offset = unit_vector(rng) * (reach * f64::from(cap.chord()));
            *tried = nearest(cap, (*tried + offset).unit());
        }
        let value = value(tried);
        if value > most {
            (best, most) = (tried, value);
        }
    }
    most
}

/// The majorants of a lobe within a cap, and of a family of lobes whose normals and incoming directions are in caps of
/// the same size, over the greatest values there.
fn looseness<G: MaskingShadowing>(
    rng: &mut Rng,
    alpha: f32,
    fresnel: Fresnel,
    masking: Masking,
) -> Option<[f64; 2]>
where
    GgxLobe<support::reference::GivenFresnel, G>: ReceiverLobe<Family = GgxFamily<G>>,
{
    let (surface, outgoing) = case(rng, alpha)?;
    let lobe = |normal, incoming| {
        let lit = Lit::new(normal, incoming);
        members::ggx_of::<G>((alpha, fresnel, masking), &lit)
    };
    let value = |[normal, incoming, outgoing]: [Vector; 3]| {
        let brdf = Brdf::Ggx {
            roughness: alpha,
            fresnel,
            masking,
        };
        Surface { normal, incoming }.value(brdf, outgoing)
    };
    let Surface { normal, incoming } = surface;
    let outgoing = cap(outgoing, CHORD);
    let one = lobe(normal, incoming).lobe;
    let single = [cap(normal, 0.0), cap(incoming, 0.0), outgoing];
    let of_one = f64::from(one.maximum_within(&outgoing)) / greatest(rng, single, value);

    let around = |axis: Vector, azimuth: i32| {
        // From the plane of incidence, so that the least and the greatest cosine are among them.
        let across = normal.cross(incoming).unit();
        let side = axis.cross(across).unit();
        let side = side.turned(across, f64::from(azimuth) * TAU / 8.0);
        axis.turned(side, 2.0 * (0.5 * CHORD).asin())
    };
    let families = (0..64).map(|i| {
        let (normal, incoming) = (around(normal, i / 8), around(incoming, i % 8));
        lobe(normal, incoming).lobe.family()
    });
    let family = GgxFamily::<G>::union(families).expect("64");
    let all = [cap(normal, CHORD), cap(incoming, CHORD), outgoing];
    let of_family = f64::from(family.greatest_within(&outgoing)) / greatest(rng, all, value);
    Some([of_one, of_family])
}

/// By how much the majorant of a family may exceed F, which it takes in Schlick's form.
fn schlick_excess(fresnel: Fresnel) -> f64 {
    match fresnel {
        Fresnel::Dielectric(index) if index < 1.0 => 26.0,
        Fresnel::Dielectric(_) => 1.45,
        Fresnel::Conductor(..) => 1.05,
        _ => 1.0,
    }
}

/// Where a majorant is greater than the lobe, it is because F, D and G2 take their extremes in different directions, and
/// because a family has F in Schlick's form.
#[test]
fn majorants_become_the_lobes_as_caps_close() {
    for alpha in [0.003, 0.01, 0.03, 0.06, 0.1, 0.2, 0.5, 1.0] {
        let mut rng = Rng::with_seed(1);
        let of_width = CHORD / f64::from(alpha);
        for fresnel in FRESNELS {
            let (mut worst, mut sum, mut count) = ([1.0_f64; 2], [0.0; 2], 0.0);
            for case in 0..80 {
                let ratios = match case % 2 {
                    0 => {
                        let masking = Masking::HeightCorrelated;
                        looseness::<HeightCorrelated>(&mut rng, alpha, fresnel, masking)
                    }
                    _ => looseness::<Separable>(&mut rng, alpha, fresnel, Masking::Separable),
                };
                let Some(ratios) = ratios else { continue };
                count += 1.0;
                for i in 0..2 {
                    assert!(ratios[i] > 1.0 - 1e-4, "{ratios:?}");
                    worst[i] = worst[i].max(ratios[i]);
                    sum[i] += ratios[i];
                }
            }
            let mean = sum.map(|sum| sum / count);
            println!("α = {alpha}, {fresnel:?}: worst {worst:.4?}, mean {mean:.4?}");
            let excess = schlick_excess(fresnel);
            assert!(worst[0] <= 1.02);
            assert!(mean[0] <= 1.004);
            assert!(worst[1] <= (1.03 + 0.03 * of_width) * excess);
            assert!(mean[1] <= 1.01 * excess);
        }
    }
}
