//! Powers of the cosine, the lobes of Phong and Lambert: what they are, and that their ellipsoids are the
//! smallest.

use std::f64::consts::{PI, TAU};

use approx::assert_relative_eq;
use proptest::prelude::*;
use stochastic_light_culling::{
    Bounded, Direction, Incidence, LambertLobe, Lobe, PhongLobe, Tight, glam::Vec3,
};
use support::generators;
use support::reference::{Brdf, Vector};

proptest! {
    #![proptest_config(generators::cases(1000))]

    #[test]
    fn phong_lobe_agrees_with_the_model(
        albedo in 0.0..=1.0_f32,
        exponent in generators::exponent(),
        lit in generators::lit(),
        off in generators::log_uniform(1e-3, 10.0),
        side in generators::unit_vector(),
    ) {
        let lobe = PhongLobe::new(albedo, exponent, Incidence { normal: lit.normal, incoming: lit.incoming }).unwrap();
        // As far off the mirror direction as the lobe is wide, more or less.
        let mirror = lit.surface.mirror().unit();
        let width = (1.0 / (1.0 + f64::from(exponent))).sqrt();
        let outgoing = (mirror + side * (off * width)).unit().to_f32();
        let exact_outgoing = Vector::from(outgoing).unit();
        // Where it ends, for n = 0 all at once.
        if [lit.surface.normal, mirror].iter().any(|v| v.dot(exact_outgoing).abs() < 1e-6) {
            return Ok(());
        }
        let (value, exact) = (
            f64::from(lobe.value(outgoing)),
            lit.surface.value(Brdf::Phong { albedo, exponent }, exact_outgoing),
        );
        // The axis and ω_o are off by an ulp each, which the slope n tanγ of ln cosⁿγ multiplies.
        let slope = f64::from(exponent) * exact_outgoing.cross(mirror).length();
        let cosine = exact_outgoing.dot(mirror);
        let tolerance = 1e-6 + 4e-7 * slope / cosine.max(1e-3);
        prop_assert!((value - exact).abs() <= tolerance * exact + 1e-37, "{value} {exact}");
        prop_assert_eq!(lobe.value(Vec3::NAN), 0.0);
        prop_assert_eq!(lobe.value(-*lit.normal), 0.0);
    }
}

/// A surface lit at a slant, with μ = `cosine` to rounding.
fn lit_at(cosine: f32) -> generators::Lit {
    let normal = Vector([0.36, 0.48, 0.8]);
    let incoming = normal.turned(normal.orthogonal(), f64::from(cosine).acos());
    generators::Lit::new(normal, incoming)
}

/// ∫ value dω over all directions, by the midpoint rule about `axis`, evenly in 1 − cosⁿ⁺¹γ.
fn reflected(lobe: &PhongLobe, rings: u32) -> f64 {
    let (axis, exponent) = (
        Vector::from(*lobe.axis()).unit(),
        f64::from(lobe.exponent()),
    );
    let side = axis.orthogonal();
    let across = axis.cross(side);
    let mut sum = 0.0;
    for ring in 0..rings {
        let share = (f64::from(ring) + 0.5) / f64::from(rings);
        let cosine = share.powf(1.0 / (exponent + 1.0));
        // dω = dcosγ dφ, and dcosγ = cosγ^{−n}/(n+1) dshare.
        let solid_angle = TAU / (cosine.powf(exponent) * (exponent + 1.0));
        for sector in 0..rings {
            let phi = TAU * (f64::from(sector) + 0.5) / f64::from(rings);
            let off = side * phi.cos() + across * phi.sin();
            let outgoing = axis.turned(off, cosine.acos()).to_f32();
            sum += f64::from(lobe.value(outgoing)) * solid_angle;
        }
    }
    sum / f64::from(rings * rings)
}

/// All of ρ about its axis, and never more than that above a surface.
#[test]
fn phong_lobe_gains_no_energy() {
    for exponent in [0.0, 0.5, 1.0, 2.0, 10.0, 300.0, 1e4, 1e6] {
        let free = PhongLobe::about(0.8, exponent, lit_at(0.3).normal).unwrap();
        assert_relative_eq!(
            reflected(&free, 200),
            f64::from(0.8_f32),
            max_relative = 2e-3
        );
        for cosine in [1.0, 0.7, 0.2, 0.01] {
            let lit = lit_at(cosine);
            let lobe = PhongLobe::new(
                0.8,
                exponent,
                Incidence {
                    normal: lit.normal,
                    incoming: lit.incoming,
                },
            )
            .unwrap();
            let reflected = reflected(&lobe, 200);
            assert!(
                reflected < 0.802,
                "n = {exponent}, μ = {cosine}: {reflected}"
            );
            // Half of it at least is above the horizon.
            assert!(
                reflected > 0.399,
                "n = {exponent}, μ = {cosine}: {reflected}"
            );
        }
    }
}

fn volume(semi_axes: Vec3) -> f64 {
    semi_axes.to_array().into_iter().map(f64::from).product()
}

/// The least ab² of an ellipsoid of revolution around l = cosᵐγ, by search over 1/a and c/a; b is then what
/// encloses. The logarithm is convex in both, as for any smallest ellipsoid.
fn least_volume_around_cosine_power(m: f64) -> f64 {
    let samples: Vec<(f64, f64)> = (0..=1500)
        .map(|i| {
            // Even where the lobe is thin.
            let tangent = (0.5 * PI * f64::from(i) / 1500.0).tan() * (1.0 / (m + 1.0)).sqrt();
            let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
            let radius = cosine.powf(m);
            (radius * cosine, radius * radius * (1.0 - cosine * cosine))
        })
        .collect();
    let volume = |inverse: f64, shift: f64| {
        let across_squared = samples
            .iter()
            .map(|(height, squared)| {
                let rest = 1.0 - (inverse * height - shift).powi(2);
                // A pole may touch.
                if *squared < 1e-14 && rest > -1e-12 {
                    0.0
                } else if rest <= 0.0 {
                    f64::INFINITY
                } else {
                    squared / rest
                }
            })
            .fold(0.0, f64::max);
        across_squared / inverse
    };
    // |height/a − c/a| ≤ 1 for heights from 0 to 1.
    least(0.5, 2.0, |inverse| {
        least((inverse - 1.0).max(0.0), 1.0, |shift| {
            volume(inverse, shift)
        })
    })
}

/// The least value of a convex function.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let third = (high - low) / 3.0;
        if f(low + third) <= f(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    f(0.5 * (low + high))
}

/// Volume over that of the smallest ellipsoid around the lobe, found by search.
#[test]
fn ellipsoid_of_a_cosine_power_is_the_smallest() {
    let exponents = [
        0.0, 0.01, 0.1, 0.3, 0.5, 1.0, 1.5, 1.9, 1.999, 2.0, 2.1, 3.0, 5.0, 10.0, 100.0, 1e3, 1e4,
        1e6,
    ];
    for exponent in exponents {
        let lobe = PhongLobe::about(0.7, exponent, Direction::Z).unwrap();
        let reach = f64::from(lobe.value(Vec3::Z)).sqrt();
        let least = least_volume_around_cosine_power(0.5 * f64::from(exponent));
        let ratio = volume(lobe.unit_bound().semi_axes()) / (least * reach.powi(3));
        // Narrow ones pay for the rounding of their axis.
        let allowed = 1.0002 + 2e-6 * f64::from(exponent).sqrt();
        assert!(
            ratio > 0.9998 && ratio < allowed,
            "n = {exponent}: {ratio} of the smallest"
        );
    }
}

#[test]
fn ellipsoid_of_a_diffuse_light_is_the_smallest() {
    for albedo in [1e-30, 0.2, 1.0] {
        let lobe = LambertLobe::new(albedo, Direction::Y).unwrap();
        let reach = (f64::from(albedo) / PI).sqrt();
        let tight = volume(lobe.unit_bound_by(Tight).semi_axes());
        let ratio = tight / (least_volume_around_cosine_power(0.5) * reach.powi(3));
        assert!(ratio > 0.9998 && ratio < 1.0001, "{ratio} of the smallest");
        let of_the_sphere = tight / f64::from(lobe.unit_bound().radius()).powi(3);
        assert!(
            of_the_sphere > 0.889 && of_the_sphere < 0.8897,
            "{of_the_sphere} of the sphere"
        );
    }
}

/// The closed form and the constants agree where the two lobes do: cosine to the first power.
#[test]
fn phong_lobes_of_exponent_one_are_bounded_as_lambert_s() {
    let phong = PhongLobe::about(0.6, 1.0, Direction::Z)
        .unwrap()
        .unit_bound();
    let lambert = LambertLobe::new(0.6, Direction::Z)
        .unwrap()
        .unit_bound_by(Tight);
    let difference = (phong.semi_axes() - lambert.semi_axes()).abs() / lambert.semi_axes();
    assert!(difference.max_element() < 5e-3, "{difference}");
    assert!((volume(phong.semi_axes()) / volume(lambert.semi_axes()) - 1.0).abs() < 1e-4);
}
