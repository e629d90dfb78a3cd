//! Ellipsoids around isotropic lobes: near the smallest, not above the paper's, and touched.

use std::f64::consts::PI;

use proptest::prelude::*;
use rayon::prelude::*;
use stochastic_light_culling::{
    Bounded, Ellipsoid, Ggx, GgxLobe, Incidence, Paper, Tight, Triaxial, glam::Vec3,
};
use support::generators;
use support::reference::{Fresnel, GivenFresnel, Masking, Shape, Vector, smith_g1, smith_g2};
use support::tightness::{self, volume};

use super::extent::surface_points;

pub fn spheroid_volume<F: stochastic_light_culling::Fresnel>(lobe: &GgxLobe<F>) -> f64 {
    volume(&Ellipsoid::from(lobe.unit_bound_by(Paper)))
}

/// The mean and the largest of the tight bound's volumes over the smallest there are, and the largest
/// over the paper's.
fn tightness(reflectances: &[f32]) -> [f64; 3] {
    // A third of the grid, which still has every roughness and every angle; the whole of it is
    // `examples/tightness`.
    let places: Vec<_> = tightness::grid(reflectances)
        .into_iter()
        .step_by(3)
        .collect();
    let volumes: Vec<_> = places
        .into_par_iter()
        .map(tightness::Place::measure)
        .collect();
    let ratios = || volumes.iter().map(|v| v.tight / v.attainable);
    let most = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
    [
        ratios().sum::<f64>() / volumes.len() as f64,
        most(&mut ratios()),
        most(&mut volumes.iter().map(|v| v.tight)),
    ]
}

#[test]
fn volume_is_near_the_least_for_metals() {
    let [mean, most, over_paper] = tightness(&tightness::METALS);
    println!("mean {mean}, most {most}, over the paper's at most {over_paper}");
    assert!(mean <= 1.15 && most <= 1.25, "mean {mean}, most {most}");
    assert!(over_paper <= 1.001, "{over_paper}");
}

#[test]
fn volume_is_near_the_least_for_dielectrics() {
    let [mean, most, over_paper] = tightness(&tightness::DIELECTRICS);
    println!("mean {mean}, most {most}, over the paper's at most {over_paper}");
    assert!(mean <= 1.2 && most <= 1.5, "mean {mean}, most {most}");
    assert!(over_paper <= 1.001, "{over_paper}");
}

/// Volume of the triaxial ellipsoid over the paper's spheroid, against the least of the family (F = 1),
/// found by search.
#[test]
fn triaxial_volume_is_near_the_least_of_the_family() {
    let degrees = [10.0_f32, 30.0, 45.0, 60.0, 75.0, 85.0];
    let least = [
        (0.5, [0.991, 0.928, 0.863, 0.799, 0.752, 0.735]),
        (0.2, [0.986, 0.892, 0.784, 0.658, 0.526, 0.460]),
        (0.1, [0.985, 0.881, 0.751, 0.587, 0.396, 0.276]),
        (0.05, [0.985, 0.874, 0.730, 0.545, 0.326, 0.174]),
        (0.01, [0.985, 0.868, 0.712, 0.509, 0.272, 0.102]),
    ];
    for (roughness, row) in least {
        for (degrees, least) in degrees.into_iter().zip(row) {
            let angle = degrees.to_radians();
            let incoming = Vec3::new(angle.sin(), 0.0, angle.cos());
            let lit = generators::Lit::new(Vector::from(Vec3::Z), incoming.into());
            let said = say(roughness, Fresnel::None, &lit);
            let ratio = volume(&said.triaxial) / said.spheroid_volume;
            assert!(
                ratio > least - 6e-4 && ratio < 1.03 * least + 6e-4,
                "α = {roughness}, {degrees}°: {ratio}, least {least}"
            );
        }
    }
}

/// The largest F·G2/G1 over the hemisphere, by search in the plane of incidence and head-on.
fn exact_max_reflected(roughness: f32, fresnel: Fresnel, masking: Masking, mu: f64) -> f64 {
    let (alpha, angle) = (f64::from(roughness), mu.min(1.0).acos());
    (0..4000)
        .map(|i| 0.5 * PI * f64::from(i) / 4000.0)
        .map(|outgoing| {
            let share = smith_g2(alpha, masking, mu, outgoing.cos()) / smith_g1(alpha, mu);
            let widest = fresnel.at((0.5 * (angle + outgoing)).cos());
            let narrowest = fresnel.at((0.5 * (angle - outgoing)).cos());
            share * widest.max(narrowest)
        })
        .fold(0.0, f64::max)
}

/// What a lobe says: its largest F·G2/G1, the two ellipsoids past the paper, and the volume of the
/// paper's.
struct Said {
    max_reflected: f64,
    triaxial: Ellipsoid,
    tight: Ellipsoid,
    spheroid_volume: f64,
}

fn say(roughness: f32, fresnel: Fresnel, lit: &generators::Lit) -> Said {
    let fresnel = GivenFresnel::try_from(fresnel).unwrap();
    let ggx = Ggx::new(roughness).unwrap();
    let lobe = GgxLobe::new(
        ggx,
        fresnel,
        Incidence {
            normal: lit.normal,
            incoming: lit.incoming,
        },
    );
    Said {
        max_reflected: lobe.max_reflected().into(),
        triaxial: lobe.unit_bound_by(Triaxial),
        tight: lobe.unit_bound_by(Tight),
        spheroid_volume: spheroid_volume(&lobe),
    }
}

proptest! {
    #![proptest_config(generators::cases(1000))]

    #[test]
    fn joint_maximum_bounds_and_is_nearly_attained(
        roughness in generators::roughness(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
    ) {
        let mu = lit.surface.incident_cosine();
        let exact = exact_max_reflected(roughness, fresnel, Masking::HeightCorrelated, mu);
        let said = say(roughness, fresnel, &lit).max_reflected;
        prop_assert!(said >= exact - 1e-20, "{said} {exact}");
        // Of factors that rise slowly; one that rises from nothing to all within a segment has only its
        // value at the segment's end.
        let is_slow = match fresnel {
            Fresnel::None | Fresnel::Schlick(_) => true,
            Fresnel::Dielectric(eta) => (1.25..4.0).contains(&eta),
            Fresnel::Conductor(_, kappa) => kappa > 1.0,
        };
        prop_assert!(!is_slow || said <= 1.6 * exact, "{said} {exact}");
    }

    #[test]
    fn ellipsoids_are_not_above_the_spheroid_and_the_triaxial_one_is_touched(
        roughness in generators::up_to_one(0.01),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
    ) {
        let said = say(roughness, fresnel, &lit);
        prop_assume!(said.max_reflected > 1e-15);
        prop_assert!(volume(&said.tight) <= 1.001 * said.spheroid_volume);
        prop_assert!(volume(&said.triaxial) <= 1.001 * said.spheroid_volume);
        // The tight one's axes are orthonormal, so that its semi-axes mean what they say: to eleven roundings
        // of a length, and to as many of a right angle.
        let rotation = said.tight.rotation();
        let axes = [rotation.x_axis, rotation.y_axis, rotation.z_axis].map(Vector::from);
        for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)] {
            let off = axes[i].dot(axes[j]) - f64::from(u8::from(i == j));
            prop_assert!(off.abs() <= 22.0 * f64::from(f32::EPSILON) / 2.0, "{i} {j}: {off}");
        }

        // The surface l = r√(πD) with r² = (F G2/G1)_max G1/(4πμ), everywhere.
        let (alpha, mu) = (f64::from(roughness), lit.surface.incident_cosine());
        let radius_squared = said.max_reflected * smith_g1(alpha, mu) / (4.0 * PI * mu);
        let shape = Shape::from(said.triaxial);
        // Touched where the amplitude of the derivation's sinusoids is: a dense net finds it nearly.
        let most = surface_points(alpha, &lit)
            .map(|x| shape.level(Vector::ZERO, x * radius_squared.sqrt()))
            .fold(0.0, f64::max);
        prop_assert!(most <= 1.0, "left at {most}");
        prop_assert!(most > 0.99, "reached only to {most}");
    }
}
