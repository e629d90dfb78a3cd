//! The microfacet terms are what they are defined to be, and agree with the model.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use approx::assert_relative_eq;
use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Conductor, Dielectric, Direction, Fresnel, Ggx, GgxLobe,
    HeightCorrelated, Incidence, Lobe, MaskingShadowing, NoFresnel, Schlick, Separable, glam::Vec3,
};
use support::generators;
use support::reference::{self, Brdf, Masking, Vector, ggx_ndf, smith_g1, smith_g2};

const ROUGHNESSES: [f32; 7] = [1e-3, 0.01, 0.05, 0.2, 0.5, 0.9, 1.0];

/// ∫ D(ω) g(ω) dω over the upper hemisphere by the midpoint rule, in angles that spread the lobe
/// evenly: tan θ = α tan t.
fn integrate_over_normals(roughness: f32, rings: u32, g: impl Fn(Vector) -> f64) -> f64 {
    let ggx = Ggx::new(roughness).unwrap();
    integrate_over_facets([roughness; 2], rings, |normal| {
        f64::from(ggx.ndf_at(normal.to_f32(), Vec3::Z)) * g(normal)
    })
}

/// ∫ f(ω) dω over the upper hemisphere, at the normals (α_x tan t cos φ, α_y tan t sin φ, 1).
fn integrate_over_facets(roughness: [f32; 2], rings: u32, f: impl Fn(Vector) -> f64) -> f64 {
    let [alpha_x, alpha_y] = roughness.map(f64::from);
    let sectors = 2 * rings;
    let mut sum = 0.0;
    for ring in 0..rings {
        let tangent = (FRAC_PI_2 * (f64::from(ring) + 0.5) / f64::from(rings)).tan();
        for sector in 0..sectors {
            let phi = TAU * (f64::from(sector) + 0.5) / f64::from(sectors);
            let (sine, cosine) = phi.sin_cos();
            let slopes = Vector([alpha_x * tangent * cosine, alpha_y * tangent * sine, 1.0]);
            // dω = cos³θ dx dy of the slopes, and dx dy = α_xα_y tan t dtan t dφ.
            let solid_angle =
                alpha_x * alpha_y * tangent * (1.0 + tangent * tangent) / slopes.length().powi(3);
            sum += f(slopes.unit()) * solid_angle;
        }
    }
    sum * FRAC_PI_2 / f64::from(rings) * TAU / f64::from(sectors)
}

#[test]
fn ndf_projects_to_unit_area() {
    for roughness in ROUGHNESSES {
        let area = integrate_over_normals(roughness, 200, |m| m.0[2]);
        assert_relative_eq!(area, 1.0, epsilon = 1e-4);
    }
}

/// μ = G1(μ) ∫ D(ω) max(ω_i·ω, 0) dω: the visible facets fill the projected area [Heitz 2014].
#[test]
fn masking_fulfils_its_defining_integral() {
    for roughness in ROUGHNESSES {
        for cosine in [0.01_f64, 0.1, 0.4, 0.8, 1.0] {
            let incoming = Vector([(1.0 - cosine * cosine).sqrt(), 0.0, cosine]);
            let facing = integrate_over_normals(roughness, 600, |m| m.dot(incoming).max(0.0));
            let masking = f64::from(Ggx::new(roughness).unwrap().masking(cosine as f32));
            assert_relative_eq!(masking * facing, cosine, max_relative = 1e-3);
        }
    }
}

const GRAINS: [[f32; 2]; 4] = [[0.5, 0.5], [0.02, 0.3], [1.0, 0.05], [0.1, 0.07]];

#[test]
fn grained_ndf_projects_to_unit_area_and_masking_fulfils_its_integral() {
    for roughness in GRAINS {
        let ggx = AnisotropicGgx::new(roughness[0], roughness[1]).unwrap();
        let density = |m: Vector| f64::from(ggx.ndf(m.to_f32()));
        let area = integrate_over_facets(roughness, 300, |m| density(m) * m.0[2]);
        assert_relative_eq!(area, 1.0, epsilon = 1e-4);
        for (cosine, azimuth) in [(0.05_f64, 0.3_f64), (0.4, 1.2), (0.8, 2.9), (1.0, 0.0)] {
            let sine = (1.0 - cosine * cosine).sqrt();
            let incoming = Vector([sine * azimuth.cos(), sine * azimuth.sin(), cosine]);
            let facing =
                integrate_over_facets(roughness, 600, |m| density(m) * m.dot(incoming).max(0.0));
            let masking = f64::from(ggx.masking(incoming.to_f32()));
            assert_relative_eq!(masking * facing, cosine, max_relative = 2e-3);
        }
    }
}

#[test]
fn grained_terms_vanish_below_the_horizon_and_for_nan() {
    let ggx = AnisotropicGgx::new(0.3, 0.1).unwrap();
    for below in [Vec3::X, -Vec3::Z, Vec3::NAN, Vec3::ZERO] {
        assert_eq!(ggx.ndf(below), 0.0);
        assert_eq!(ggx.masking(below), 0.0);
        assert_eq!(ggx.masking_shadowing::<Separable>(below, Vec3::Z), 0.0);
        assert_eq!(
            ggx.masking_shadowing::<HeightCorrelated>(Vec3::Z, below),
            0.0
        );
    }
    assert_relative_eq!(
        ggx.ndf(Vec3::Z),
        1.0 / (0.03 * PI) as f32,
        max_relative = 1e-6
    );
}

#[test]
fn ndf_vanishes_below_the_horizon_and_for_nan() {
    let ggx = Ggx::new(0.3).unwrap();
    for cosine in [0.0, -0.5, -1.0, f32::NAN] {
        assert_eq!(ggx.ndf(cosine), 0.0);
        assert_eq!(ggx.masking(cosine), 0.0);
    }
    assert_eq!(ggx.ndf_at(-Vec3::Z, Vec3::Z), 0.0);
    assert_eq!(ggx.ndf_at(Vec3::NAN, Vec3::Z), 0.0);
    assert_relative_eq!(
        ggx.ndf(1.0),
        1.0 / (std::f32::consts::PI * 0.09),
        max_relative = 1e-6
    );
}

/// A surface lit at a slant, with μ = `cosine` to rounding.
fn lit_at(cosine: f32) -> generators::Lit {
    let normal = Vector([0.36, 0.48, 0.8]);
    let incoming = normal.turned(normal.orthogonal(), f64::from(cosine).acos());
    generators::Lit::new(normal, incoming)
}

fn relative_error(value: f32, exact: f64) -> f64 {
    (f64::from(value) - exact).abs() / exact.abs().max(1e-30)
}

fn check_fresnel(fresnel: impl Fresnel, model: reference::Fresnel, cosine: f32, mu: f32) {
    let exact = model.at(f64::from(cosine));
    let value = f64::from(fresnel.reflectance(cosine));
    // Relative to 1 − F as well: near total reflection F is steep, and 1 − F is what is small.
    assert!(
        (value - exact).abs() <= 2e-5 * exact + 1e-12
            || (value - exact).abs() <= 2e-3 * (1.0 - exact),
        "{model:?} at {cosine}: {value}, but exactly {exact}"
    );
    assert!((0.0..=1.0).contains(&value));

    let lit = lit_at(mu);
    let most = model.max_above_surface(lit.surface.incident_cosine());
    let ggx = Ggx::new(0.5).unwrap();
    let lobe = GgxLobe::new(
        ggx,
        fresnel,
        Incidence {
            normal: lit.normal,
            incoming: lit.incoming,
        },
    );
    let bound = f64::from(lobe.max_fresnel());
    assert!(
        bound >= most,
        "{model:?} at {mu}: {bound} does not bound {most}"
    );
    assert!(
        bound <= 1.01 * most,
        "{model:?} at {mu}: {bound} is loose, {most} is attained"
    );
}

proptest! {
    #![proptest_config(generators::cases(1000))]

    /// At least F everywhere, and where F rises slowly not much more.
    #[test]
    fn fresnel_majorant_bounds(fresnel in generators::fresnel(), cosine in 0.0..=1.0_f64) {
        let majorant = match fresnel {
            reference::Fresnel::None => NoFresnel.majorant(),
            reference::Fresnel::Schlick(f0) => Schlick::new(f0).unwrap().majorant(),
            reference::Fresnel::Dielectric(eta) => Dielectric::new(eta).unwrap().majorant(),
            reference::Fresnel::Conductor(eta, kappa) => Conductor::new(eta, kappa).unwrap().majorant(),
        };
        let bound = f64::from(majorant.base) + f64::from(majorant.rise) * (1.0 - cosine).powi(5);
        let exact = fresnel.at(cosine);
        prop_assert!(bound >= exact * (1.0 - 1e-12) - 1e-15, "{bound} {exact}");
        let is_slow = matches!(fresnel, reference::Fresnel::Dielectric(eta) if (1.3..2.0).contains(&eta));
        prop_assert!(!is_slow || bound <= 2.0 * exact, "{bound} {exact}");
    }

    #[test]
    fn fresnel_agrees_and_its_maximum_is_attained(
        model in generators::fresnel(),
        cosine in generators::up_to_one(1e-3),
        mu in generators::up_to_one(1e-3),
    ) {
        match model {
            reference::Fresnel::None => check_fresnel(NoFresnel, model, cosine, mu),
            reference::Fresnel::Schlick(f0) => {
                check_fresnel(Schlick::new(f0).unwrap(), model, cosine, mu);
            }
            reference::Fresnel::Dielectric(eta) => {
                check_fresnel(Dielectric::new(eta).unwrap(), model, cosine, mu);
            }
            reference::Fresnel::Conductor(eta, kappa) => {
                check_fresnel(Conductor::new(eta, kappa).unwrap(), model, cosine, mu);
            }
        }
    }

    #[test]
    fn terms_agree_with_the_model(
        roughness in generators::roughness(),
        mu in generators::up_to_one(1e-3),
        mu_o in generators::up_to_one(1e-6),
        lit in generators::lit(),
    ) {
        let (ggx, alpha) = (Ggx::new(roughness).unwrap(), f64::from(roughness));
        let (mu64, mu_o64) = (f64::from(mu), f64::from(mu_o));
        let half = Vector::from(*lit.incoming);
        prop_assert!(relative_error(
            ggx.ndf_at(*lit.incoming, *lit.normal),
            ggx_ndf(alpha, half.unit(), lit.surface.normal),
        ) < 1e-5 + 1e-6 / alpha);
        prop_assert!(relative_error(ggx.masking(mu), smith_g1(alpha, mu64)) < 1e-6);

        let g1 = ggx.masking(mu);
        let correlated = HeightCorrelated::masking_shadowing(ggx, mu, mu_o);
        let separable = Separable::masking_shadowing(ggx, mu, mu_o);
        prop_assert!(relative_error(
            correlated, smith_g2(alpha, Masking::HeightCorrelated, mu64, mu_o64)) < 2e-6);
        prop_assert!(relative_error(
            separable, smith_g2(alpha, Masking::Separable, mu64, mu_o64)) < 2e-6);
        prop_assert!(correlated <= g1 * (1.0 + 1e-6));
        prop_assert!(separable <= correlated * (1.0 + 1e-6));
    }

    #[test]
    fn lobe_agrees_with_the_model(
        roughness in generators::up_to_one(0.01),
        f0 in 0.0..=1.0_f32,
        lit in generators::lit(),
        outgoing in generators::unit_vector(),
    ) {
        let schlick = Schlick::new(f0).unwrap();
        let lobe = GgxLobe::new(Ggx::new(roughness).unwrap(), schlick, Incidence { normal: lit.normal, incoming: lit.incoming });
        let outgoing = outgoing.to_f32();
        let exact_outgoing = Vector::from(outgoing).unit();
        // Where μ_o is all rounding, so is what depends on it.
        if exact_outgoing.dot(lit.surface.normal).abs() < 1e-4 {
            return Ok(());
        }
        for (value, masking) in [
            (lobe.value(outgoing), Masking::HeightCorrelated),
            (lobe.separable().value(outgoing), Masking::Separable),
        ] {
            let fresnel = reference::Fresnel::Schlick(f0);
            let brdf = Brdf::Ggx { roughness, fresnel, masking };
            let exact = lit.surface.value(brdf, exact_outgoing);
            prop_assert!(relative_error(value, exact) < 1e-3 || f64::from(value) == exact,
                "{value} {exact}");
        }
    }

    #[test]
    fn grained_lobe_agrees_with_the_model_and_is_reciprocal(
        roughness in [generators::up_to_one(0.01), generators::up_to_one(0.01)],
        f0 in 0.0..=1.0_f32,
        lit in generators::lit(),
        tangent in generators::unit_vector(),
        outgoing in generators::unit_vector(),
    ) {
        let ggx = AnisotropicGgx::new(roughness[0], roughness[1]).unwrap();
        let schlick = Schlick::new(f0).unwrap();
        let [tangent, outgoing] = [tangent, outgoing].map(|v| Direction::new(v.to_f32()).unwrap());
        let exact_outgoing = Vector::from(*outgoing).unit();
        let (normal, mu_o) = (lit.surface.normal, lit.surface.normal.dot(exact_outgoing));
        // Where μ_o is all rounding, so is what depends on it; and a tangent may be none.
        if mu_o.abs() < 1e-4 || normal.cross(Vector::from(*tangent)).length() < 1e-3 {
            return Ok(());
        }
        let towards = |incoming| {
            AnisotropicGgxLobe::new(ggx, schlick, Incidence { normal: lit.normal, incoming }, tangent).unwrap()
        };
        let (lobe, back) = (towards(lit.incoming), towards(outgoing));
        let mu = lit.surface.incident_cosine();
        for (value, reverse, masking) in [
            (lobe.value(*outgoing), back.value(*lit.incoming), Masking::HeightCorrelated),
            (lobe.separable().value(*outgoing), back.separable().value(*lit.incoming),
                Masking::Separable),
        ] {
            let fresnel = reference::Fresnel::Schlick(f0);
            let brdf = Brdf::Anisotropic { roughness, tangent, fresnel, masking };
            let exact = lit.surface.value(brdf, exact_outgoing);
            prop_assert!(relative_error(value, exact) < 1e-3 || f64::from(value) == exact,
                "{value} {exact}");
            // f(ω_i, ω_o) = f(ω_o, ω_i)
            prop_assert!(relative_error(reverse, exact * mu / mu_o.max(1e-4)) < 2e-3
                || (value == 0.0 && reverse == 0.0), "{reverse} {exact}");
        }
    }

    #[test]
    fn grain_of_equal_roughness_reflects_as_none(
        roughness in generators::up_to_one(0.01),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
        outgoing in generators::unit_vector(),
    ) {
        let tangent = Direction::new(tangent.to_f32()).unwrap();
        let ggx = AnisotropicGgx::new(roughness, roughness).unwrap();
        if let Ok(lobe) =
            AnisotropicGgxLobe::new(ggx, NoFresnel, Incidence { normal: lit.normal, incoming: lit.incoming }, tangent)
        {
            let plain = GgxLobe::new(Ggx::new(roughness).unwrap(), NoFresnel, Incidence { normal: lit.normal, incoming: lit.incoming });
            let outgoing = outgoing.to_f32();
            let [value, same] = [lobe.value(outgoing), plain.value(outgoing)];
            prop_assert!((value - same).abs() <= 1e-3 * same, "{value} {same}");
            let [value, same] = [lobe.separable().value(outgoing), plain.separable().value(outgoing)];
            prop_assert!((value - same).abs() <= 1e-3 * same, "{value} {same}");
        }
    }

    #[test]
    fn lobe_is_finite_at_every_edge(
        roughness in prop_oneof![Just(Ggx::MIN_ROUGHNESS), generators::roughness()],
        incoming_height in generators::log_uniform(1e-45, 1.0),
        outgoing_height in generators::log_uniform(1e-45, 1.0),
        sign in prop_oneof![Just(-1.0_f32), Just(1.0_f32)],
    ) {
        let incoming = stochastic_light_culling::Direction::new(
            Vec3::new(1.0, 0.0, incoming_height as f32)).unwrap();
        let outgoing = Vec3::new(sign, 0.0, outgoing_height as f32).normalize();
        let lobe = GgxLobe::new(Ggx::new(roughness).unwrap(), NoFresnel, Incidence { normal: stochastic_light_culling::Direction::Z, incoming });
        let rougher = 1.0_f32.min(1e3 * roughness);
        let grain = AnisotropicGgx::new(roughness, rougher).unwrap();
        let grained = AnisotropicGgxLobe::new(grain, NoFresnel, Incidence { normal: Direction::Z, incoming }, Direction::Y).unwrap();
        for value in [
            lobe.value(outgoing),
            lobe.separable().value(outgoing),
            grained.value(outgoing),
            grained.separable().value(outgoing),
        ] {
            prop_assert!(value.is_finite() && value >= 0.0, "{value}");
        }
        prop_assert_eq!(lobe.value(Vec3::NAN), 0.0);
        prop_assert_eq!(lobe.value(-Vec3::Z), 0.0);
    }
}

#[test]
fn normal_incidence_and_full_roughness_are_ordinary() {
    let lobe = GgxLobe::new(
        Ggx::new(1.0).unwrap(),
        NoFresnel,
        Incidence::head_on(stochastic_light_culling::Direction::Z),
    );
    assert_relative_eq!(
        f64::from(lobe.value(Vec3::Z)),
        1.0 / (4.0 * PI),
        max_relative = 1e-6
    );
}
