//! How far the majorant of a lobe of any kind is above its greatest value within a cap, as this closes.

use std::f64::consts::TAU;
use std::fmt::Debug;
use std::slice;

use fastrand::Rng;
use stochastic_light_culling::{
    AnisotropicGgxLobe, Cap, ConstantLobe, HeightCorrelated, Lobe, MaskingShadowing, Separable,
};
use support::adversary::{direction, log_uniform, unit_vector};
use support::caps::nearest;
use support::generators::Lit;
use support::reference::{Fresnel, GivenFresnel, Masking, Surface, SurfaceFrame, Vector};

use crate::closing::{CHORD, FRESNELS, cap, greatest, surface};
use crate::members::{self, Member};

pub const ROUGHNESSES: [f32; 8] = [0.003, 0.01, 0.03, 0.06, 0.1, 0.2, 0.5, 1.0];
const CASES: usize = 200;

fn lit(rng: &mut Rng) -> Lit {
    let surface = surface(rng);
    Lit::new(surface.normal, surface.incoming)
}

/// A direction of about this distance from `axis`, or less.
fn near(rng: &mut Rng, axis: Vector, width: f64) -> Vector {
    (axis + unit_vector(rng) * (width * log_uniform(rng, 1e-2, 3.0))).unit()
}

/// A direction where facets turned by about the roughness along the tangents mirror the light, or by less.
fn mirrored(rng: &mut Rng, lit: &Lit, frame: &SurfaceFrame, roughness: [f32; 2]) -> Vector {
    let slope = log_uniform(rng, 1e-2, 3.0);
    let (sine, cosine) = (TAU * rng.f64()).sin_cos();
    let [x, y] = roughness.map(|alpha| f64::from(alpha) * slope);
    let [along, across] = frame.tangents;
    let facet = (frame.normal + along * (x * cosine) + across * (y * sine)).unit();
    let incoming = lit.surface.incoming;
    facet * (2.0 * facet.dot(incoming)) - incoming
}

/// A lobe, and a direction at which it is not small.
struct Drawn<L> {
    member: Member<L>,
    outgoing: Vector,
    /// That of a microfacet lobe.
    fresnel: Option<Fresnel>,
}

impl<L> Drawn<L> {
    fn new(member: Member<L>, outgoing: Vector) -> Self {
        Self {
            member,
            outgoing,
            fresnel: None,
        }
    }

    /// The angle between incoming and outgoing direction where total reflection begins.
    fn critical(&self) -> Option<f64> {
        match self.fresnel {
            Some(Fresnel::Dielectric(index)) if index < 1.0 => Some(2.0 * f64::from(index).asin()),
            _ => None,
        }
    }

    /// `outgoing`, or where total reflection begins in the same plane, if that is in the cap.
    fn steepest(&self, cap: &Cap, outgoing: Vector) -> Vector {
        let incoming = self.member.surface.incoming;
        let Some(angle) = self.critical() else {
            return outgoing;
        };
        let across = (outgoing - incoming * outgoing.dot(incoming)).unit();
        let steepest = incoming.turned(across, angle + 1e-12);
        if nearest(cap, steepest) == steepest {
            steepest
        } else {
            outgoing
        }
    }
}

/// The majorant within a cap over the greatest value there. `None` near the horizon, and where both are zero.
fn looseness<L: Lobe>(rng: &mut Rng, drawn: &Drawn<L>) -> Option<f64> {
    let (member, surface) = (&drawn.member, drawn.member.surface);
    if surface.normal.dot(drawn.outgoing) < 0.1 {
        return None;
    }
    let outgoing = cap(drawn.outgoing, CHORD);
    let most = f64::from(member.lobe.maximum_within(&outgoing));
    let value = |[_, _, to]: [Vector; 3]| {
        let steepest = drawn.steepest(&outgoing, to);
        member.value(to).max(member.value(steepest))
    };
    let caps = caps_of(&surface, outgoing);
    // The better of two searches.
    let greatest = greatest(rng, caps, value).max(greatest(rng, caps, value));
    (most > 0.0 || greatest > 0.0).then(|| most / greatest)
}

/// The normal and the incoming direction alone, and the cap.
pub fn caps_of(surface: &Surface, outgoing: Cap) -> [Cap; 3] {
    [
        cap(surface.normal, 0.0),
        cap(surface.incoming, 0.0),
        outgoing,
    ]
}

fn check<L: Lobe>(name: &str, draw: impl Fn(&mut Rng) -> Drawn<L>) {
    let mut rng = Rng::with_seed(1);
    let (mut worst, mut sum, mut count) = (1.0_f64, 0.0, 0.0);
    for _ in 0..CASES {
        let drawn = draw(&mut rng);
        let Some(ratio) = looseness(&mut rng, &drawn) else {
            continue;
        };
        // But for the model's own rounding.
        assert!(ratio > 1.0 - 1e-12, "{name}: {ratio}");
        worst = worst.max(ratio);
        sum += ratio;
        count += 1.0;
    }
    let mean = sum / count;
    println!("{name}: worst {worst:.4}, mean {mean:.4}");
    assert!(worst <= 1.02, "{name}");
}

/// `alpha` along one tangent, and as much or more along the other.
pub fn stretched(rng: &mut Rng, alpha: f32) -> [f32; 2] {
    let other = log_uniform(rng, f64::from(alpha), 1.0).min(1.0) as f32;
    if rng.bool() {
        [alpha, other]
    } else {
        [other, alpha]
    }
}

fn check_anisotropic<G: MaskingShadowing>(masking: Masking, fresnel: Fresnel, alpha: f32)
where
    AnisotropicGgxLobe<GivenFresnel, G>: Lobe,
{
    check(
        &format!("anisotropic α = {alpha}, {fresnel:?}, {masking:?}"),
        |rng| {
            let lit = lit(rng);
            let roughness = stretched(rng, alpha);
            let tangent = direction(unit_vector(rng));
            let member = members::anisotropic_of::<G>((roughness, tangent, fresnel, masking), &lit);
            let frame = SurfaceFrame::new(lit.surface.normal, member.lobe.tangent());
            let outgoing = mirrored(rng, &lit, &frame, roughness);
            Drawn {
                member,
                outgoing,
                fresnel: Some(fresnel),
            }
        },
    );
}

#[test]
fn majorants_of_anisotropic_lobes_become_the_lobes() {
    for alpha in ROUGHNESSES {
        for fresnel in FRESNELS {
            check_anisotropic::<HeightCorrelated>(Masking::HeightCorrelated, fresnel, alpha);
            check_anisotropic::<Separable>(Masking::Separable, fresnel, alpha);
        }
    }
}

#[test]
fn majorants_of_other_lobes_become_the_lobes() {
    check("Lambert", |rng| {
        let (lit, albedo) = (lit(rng), rng.f32());
        let outgoing = near(rng, lit.surface.normal, 1.0);
        Drawn::new(members::lambert_of(albedo, &lit), outgoing)
    });
    for alpha in ROUGHNESSES {
        let width = f64::from(alpha);
        let sharpness = (1.0 / alpha).powi(2).round();
        check(&format!("Phong {sharpness}"), |rng| {
            let (lit, albedo) = (lit(rng), rng.f32());
            let outgoing = near(rng, lit.surface.mirror().unit(), width);
            Drawn::new(members::phong_of([albedo, sharpness], &lit), outgoing)
        });
        check(&format!("Gaussian {sharpness}"), |rng| {
            let lit = lit(rng);
            let outgoing = near(rng, lit.surface.normal, width);
            Drawn::new(members::gaussian_of([sharpness, 1.0], &lit), outgoing)
        });
        check(&format!("transformed cosine {alpha}"), |rng| {
            let (lit, share) = (lit(rng), rng.f32());
            let outgoing = near(rng, lit.surface.mirror().unit(), width);
            Drawn::new(
                members::transformed_cosine_of([alpha, share], &lit),
                outgoing,
            )
        });
        for fresnel in FRESNELS {
            check(&format!("paint under α = {alpha}, {fresnel:?}"), |rng| {
                let lit = lit(rng);
                let weights = [rng.f32(), rng.f32()];
                let varnish = (alpha, fresnel, Masking::HeightCorrelated);
                let varnish = members::ggx_of::<HeightCorrelated>(varnish, &lit);
                let paint = members::lambert_of(0.5, &lit);
                let outgoing = near(rng, lit.surface.mirror().unit(), width);
                Drawn {
                    member: members::weighted(weights, paint, varnish),
                    outgoing,
                    fresnel: Some(fresnel),
                }
            });
        }
    }
    let constant = ConstantLobe.maximum_within(&Cap::all());
    assert!(constant <= 1.02 * ConstantLobe::PEAK);
}

/// Where the greatest value in a cap is searched, the majorant is not exceeded either.
fn holds<L: Lobe + Debug>(rng: &mut Rng, member: &Member<L>) {
    let outgoing = crate::cap(rng, slice::from_ref(member));
    let caps = caps_of(&member.surface, outgoing);
    let greatest = greatest(rng, caps, |[_, _, to]| member.value(to));
    let most = f64::from(member.lobe.maximum_within(&outgoing));
    // The model's own rounding.
    assert!(
        greatest * (1.0 - 1e-12) <= most,
        "{greatest} > {most} in {outgoing:?}: {member:?}"
    );
}

#[test]
fn no_lobe_is_greater_where_it_is_searched() {
    const CHECKED: usize = 200;
    fn all<L: Lobe + Debug>(rng: &mut Rng, members: &[Member<L>]) {
        for member in members {
            holds(rng, member);
        }
    }
    crate::search(|rng| {
        let correlated = Masking::HeightCorrelated;
        match rng.u8(0..5) {
            0 => {
                let members = members::ggx::<HeightCorrelated>(rng, correlated);
                all(rng, &members);
            }
            1 => {
                let members = members::anisotropic::<HeightCorrelated>(rng, correlated);
                all(rng, &members);
            }
            2 => {
                let members = members::anisotropic::<Separable>(rng, Masking::Separable);
                all(rng, &members);
            }
            3 => {
                let members = members::transformed_cosine(rng);
                all(rng, &members);
            }
            _ => {
                let members = members::phong(rng);
                all(rng, &members);
            }
        }
        CHECKED
    });
}
