//! How far the majorant of glass is above the lobe where glass begins to reflect all light.
//!
//! F is infinitely steep there, and D of a smooth surface changes as much within a narrow cap. So both may be greatest in
//! different directions.

use std::f64::consts::TAU;

use fastrand::Rng;
use stochastic_light_culling::{Cap, HeightCorrelated, Lobe};
use support::adversary::{direction, log_uniform, unit_vector};
use support::caps::nearest;
use support::generators::Lit;
use support::reference::{Fresnel, Masking, Surface, Vector};

use crate::alone::{ROUGHNESSES, caps_of, stretched};
use crate::closing::{CHORD, cap, greatest};
use crate::members::{self, Member};

const CASES: usize = 200;
/// By about as much a majorant enlarges the chord of its cap, since directions are rounded. Where F begins to rise just
/// outside the cap, that alone is a few percent.
const ROUNDING: f64 = 1.5e-5;

/// Arcs of directions around the incoming one that are in a cap.
struct Arcs {
    incoming: Vector,
    /// At right angles to it: towards the cap, and across.
    sides: [Vector; 2],
    /// That of the cap's axis, its own, and that where all light is just reflected, or the nearest one of the cap.
    angles: [f64; 3],
}

impl Arcs {
    fn new(case: &Case, cap: &Cap) -> Self {
        let Surface { incoming, .. } = case.lit.surface;
        let axis = Vector::from(*cap.axis()).unit();
        let across = (axis - incoming * axis.dot(incoming)).unit();
        let middle = incoming.cross(axis).length().atan2(incoming.dot(axis));
        let radius = 2.0 * (0.5 * f64::from(cap.chord())).asin();
        let critical = (case.angle + 1e-12).clamp(middle - radius, middle + radius);
        Self {
            incoming,
            sides: [across, incoming.cross(across)],
            angles: [middle, radius, critical],
        }
    }

    /// For two shares in \[−1, 1\]: of the way from the critical angle to both ends of the cap, the closer the nearer
    /// the former, and of the arc.
    fn direction(&self, along: f64, across: f64) -> Vector {
        let [middle, radius, critical] = self.angles;
        let end = middle + radius.copysign(along);
        let angle = critical + (end - critical) * along * along;
        // By the law of haversines.
        let [width, offset] = [radius, angle - middle].map(|angle| (0.5 * angle).sin());
        let rest = (width + offset) * (width - offset);
        let haversine = rest.max(0.0) / (angle.sin() * middle.sin());
        let azimuth = 2.0 * haversine.sqrt().min(1.0).asin() * across;
        let side = self.sides[0] * azimuth.cos() + self.sides[1] * azimuth.sin();
        self.incoming.turned(side.unit(), angle)
    }

    fn directions(&self) -> impl Iterator<Item = Vector> {
        let shares =
            |steps: i8| (-steps..=steps).map(move |step| f64::from(step) / f64::from(steps));
        shares(100)
            .flat_map(move |along| shares(8).map(move |across| self.direction(along, across)))
    }
}

/// Glass seen from within, and a direction next to where it begins to reflect all light.
struct Case {
    lit: Lit,
    outgoing: Vector,
    fresnel: Fresnel,
    /// The angle between incoming and outgoing direction from which on all light is reflected.
    angle: f64,
}

impl Case {
    /// Of facets that are turned by `width` or less, mostly in the plane of incidence, and of directions within a few times
    /// `chord`. Glass that absorbs light has an extinction coefficient, too: F is steep there, but not infinitely.
    fn new(rng: &mut Rng, [index, extinction]: [f32; 2], width: f64, chord: f64) -> Self {
        let critical = f64::from(index).asin();
        let tilt = critical + (2.0 * rng.f64() - 1.0) * width.min(0.3);
        let normal = unit_vector(rng);
        let side = normal.orthogonal();
        let side = side.turned(normal.cross(side), TAU * rng.f64());
        let lit = Lit::new(normal, normal.turned(side, tilt));
        let Surface { incoming, .. } = lit.surface;
        let offset = unit_vector(rng) * (width * log_uniform(rng, 1e-3, 1.0));
        let toward = (lit.surface.mirror() + offset).unit();
        let across = (toward - incoming * toward.dot(incoming)).unit();
        let angle = 2.0 * critical;
        let offset = chord * 3.0 * (2.0 * rng.f64() - 1.0);
        Self {
            lit,
            outgoing: incoming.turned(across, angle + offset),
            fresnel: if extinction > 0.0 {
                Fresnel::Conductor(index, extinction)
            } else {
                Fresnel::Dielectric(index)
            },
            angle,
        }
    }

    /// The greatest value in the cap.
    fn greatest<L>(&self, rng: &mut Rng, member: &Member<L>, cap: &Cap) -> f64 {
        let climbed = greatest(rng, caps_of(&member.surface, *cap), |[_, _, to]| {
            member.value(to)
        });
        let arcs = Arcs::new(self, cap);
        let values = arcs.directions().map(|to| member.value(to));
        values.fold(climbed, f64::max)
    }

    /// The majorant within a cap over the greatest value there, or in a slightly greater cap. `None` near the horizon, and
    /// where both are zero.
    fn looseness<L: Lobe>(&self, rng: &mut Rng, member: &Member<L>) -> Option<f64> {
        if member.surface.normal.dot(self.outgoing) < 0.1 {
            return None;
        }
        let within = cap(self.outgoing, CHORD);
        let most = f64::from(member.lobe.maximum_within(&within));
        let greatest = self.greatest(rng, member, &within);
        // The model's own rounding.
        assert!(greatest * (1.0 - 1e-12) <= most, "{greatest} > {most}");
        let rounded = cap(self.outgoing, CHORD + ROUNDING);
        let rounded = self.greatest(rng, member, &rounded);
        (most > 0.0).then(|| most / rounded.max(greatest))
    }
}

fn check<L: Lobe>(
    name: &str,
    width: f32,
    extinction: impl Fn(&mut Rng) -> f32,
    member: impl Fn(&mut Rng, &Case) -> Member<L>,
) {
    let mut rng = Rng::with_seed(1);
    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for _ in 0..CASES {
        let index = (0.4 + 0.5 * rng.f64()) as f32;
        let extinction = extinction(&mut rng);
        let case = Case::new(&mut rng, [index, extinction], f64::from(width), CHORD);
        let member = member(&mut rng, &case);
        if let Some(ratio) = case.looseness(&mut rng, &member) {
            worst = worst.max(ratio);
            sum += ratio;
            count += 1.0;
        }
    }
    let mean = sum / count;
    println!("total reflection, {name} α = {width}: worst {worst:.4}, mean {mean:.4}");
    assert!(worst <= 1.02, "{name}");
    // Few are near the horizon.
    assert!(count > 0.7 * CASES as f64, "{name}: {count}");
}

#[test]
fn majorants_become_the_lobes_at_total_reflection() {
    let masking = Masking::HeightCorrelated;
    for alpha in ROUGHNESSES {
        let isotropic = |_: &mut Rng, case: &Case| {
            members::ggx_of::<HeightCorrelated>((alpha, case.fresnel, masking), &case.lit)
        };
        check("isotropic", alpha, |_| 0.0, isotropic);
        let absorbing = |rng: &mut Rng| log_uniform(rng, 1e-7, 0.1) as f32;
        check("absorbing", alpha, absorbing, isotropic);
        check(
            "anisotropic",
            alpha,
            |_| 0.0,
            |rng, case| {
                let roughness = stretched(rng, alpha);
                let tangent = direction(unit_vector(rng));
                let parameters = (roughness, tangent, case.fresnel, masking);
                members::anisotropic_of::<HeightCorrelated>(parameters, &case.lit)
            },
        );
    }
}

/// In caps of any size next to total reflection the bound holds, for the model and for the crate.
#[test]
fn no_lobe_is_greater_at_total_reflection() {
    const CAPS: usize = 16;
    const DIRECTIONS: usize = 32;
    fn holds<L: Lobe>(rng: &mut Rng, case: &Case, cap: &Cap, member: &Member<L>) {
        let arcs = Arcs::new(case, cap);
        let most = member.lobe.maximum_within(cap);
        for _ in 0..DIRECTIONS {
            let [along, across] = [(); 2].map(|()| 2.0 * rng.f64() - 1.0);
            let across = if rng.bool() {
                across
            } else {
                1_f64.copysign(across)
            };
            let to = nearest(cap, arcs.direction(along, across));
            let (model, own) = (member.value(to), member.lobe.value(*direction(to)));
            // The model's own rounding.
            assert!(
                model * (1.0 - 1e-12) <= f64::from(most) && own <= most,
                "{model} or {own} > {most} in {cap:?}: {:?} {:?}",
                member.lobe.numbers(),
                case.fresnel,
            );
        }
    }
    crate::search(|rng| {
        let index = match rng.u8(0..4) {
            0 => log_uniform(rng, 1e-3, 0.9),
            1 => 1.0 - log_uniform(rng, 1e-5, 0.9),
            _ => 0.1 + 0.8 * rng.f64(),
        };
        let extinction = match rng.u8(0..4) {
            0 => log_uniform(rng, 1e-9, 1.0),
            _ => 0.0,
        };
        let numbers = [index, extinction].map(|number| number as f32);
        let (width, chord) = (log_uniform(rng, 1e-4, 1.0), log_uniform(rng, 1e-7, 1.0));
        for _ in 0..CAPS {
            let case = Case::new(rng, numbers, width, chord);
            let within = cap(case.outgoing, chord * log_uniform(rng, 0.1, 2.0));
            let (alpha, masking) = (width as f32, Masking::HeightCorrelated);
            let one =
                members::ggx_of::<HeightCorrelated>((alpha, case.fresnel, masking), &case.lit);
            holds(rng, &case, &within, &one);
            let tangent = direction(unit_vector(rng));
            let parameters = (stretched(rng, alpha), tangent, case.fresnel, masking);
            let other = members::anisotropic_of::<HeightCorrelated>(parameters, &case.lit);
            holds(rng, &case, &within, &other);
        }
        2 * CAPS
    });
}
