//! Ellipsoids around anisotropic lobes: near the smallest, and isotropic where the grain is.

use std::f64::consts::PI;

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Bounded, Direction, Ggx, GgxLobe, Incidence, NoFresnel,
    Triaxial, glam::Vec3,
};
use support::generators;
use support::reference::{
    GivenFresnel, Masking, Shape, SurfaceFrame, Vector, anisotropic_g2, anisotropic_ndf,
};
use support::tightness::volume;

/// Volume over that of the smallest ellipsoid around the lobe (F = 1), found by Khachiyan's algorithm and
/// given in units of r′³: incidence in and at 45° to the tangent's plane, and across it.
#[test]
fn ellipsoid_of_the_grain_is_near_the_smallest() {
    let azimuths = [0.0_f32, 45.0, 90.0];
    let smallest = [
        ([0.5, 0.25], 30.0_f32, [7.8008e-2, 7.9746e-2, 7.8197e-2]),
        ([0.5, 0.25], 60.0, [6.5289e-2, 6.3357e-2, 3.887e-2]),
        ([0.5, 0.25], 85.0, [5.6395e-2, 5.1683e-2, 2.3784e-2]),
        ([0.4, 0.05], 30.0, [1.1493e-2, 2.0654e-2, 2.3396e-2]),
        ([0.4, 0.05], 60.0, [9.1355e-3, 2.2003e-2, 1.3118e-2]),
        ([0.4, 0.05], 85.0, [7.2146e-3, 1.9614e-2, 1.1053e-3]),
        ([0.1, 0.02], 30.0, [9.0685e-4, 9.9082e-4, 1.0139e-3]),
        ([0.1, 0.02], 60.0, [5.7025e-4, 6.747e-4, 5.7505e-4]),
        ([0.1, 0.02], 85.0, [2.018e-4, 3.3763e-4, 1.0026e-4]),
    ];
    let mut sum = 0.0;
    for (roughness, degrees, row) in smallest {
        for (azimuth, smallest) in azimuths.into_iter().zip(row) {
            let (angle, azimuth) = (degrees.to_radians(), azimuth.to_radians());
            let along = Vec3::new(azimuth.cos(), azimuth.sin(), 0.0);
            let incoming = along * angle.sin() + Vec3::Z * angle.cos();
            let lit = generators::Lit::new(Vector::from(Vec3::Z), incoming.into());
            let lobe = grained(roughness, NoFresnel, &lit, Vector::from(Vec3::X));
            let [alpha_x, alpha_y] = roughness.map(f64::from);
            let (g1, mu) = (smith_of_grain(&lobe, &lit), lit.surface.incident_cosine());
            let scale = (g1 / (4.0 * PI * mu * alpha_x * alpha_y)).sqrt();
            let ratio = volume(&lobe.unit_bound()) / (smallest * scale.powi(3));
            assert!(
                ratio > 0.999 && ratio < 1.5,
                "α = {roughness:?}, {degrees}°, {azimuth}: {ratio} of the smallest"
            );
            sum += ratio;
        }
    }
    assert!(sum / 27.0 < 1.12, "{} on average", sum / 27.0);
}

/// A lobe with a grain along `tangent`, or at right angles to a normal that is parallel to that.
fn grained<F: stochastic_light_culling::Fresnel>(
    [along, across]: [f32; 2],
    fresnel: F,
    lit: &generators::Lit,
    tangent: Vector,
) -> AnisotropicGgxLobe<F> {
    let ggx = AnisotropicGgx::new(along, across).unwrap();
    let on = |tangent: Vector| {
        let tangent = Direction::new(tangent.to_f32()).unwrap();
        AnisotropicGgxLobe::new(
            ggx,
            fresnel,
            Incidence {
                normal: lit.normal,
                incoming: lit.incoming,
            },
            tangent,
        )
    };
    on(tangent)
        .or_else(|_| on(lit.surface.normal.orthogonal()))
        .unwrap()
}

/// G1(ω_i)
fn smith_of_grain<F, G>(lobe: &AnisotropicGgxLobe<F, G>, lit: &generators::Lit) -> f64
where
    F: stochastic_light_culling::Fresnel,
{
    let frame = SurfaceFrame::new(lit.surface.normal, lobe.tangent());
    let incoming = frame.slopes(lit.surface.incoming);
    let head_on = [0.0; 2];
    anisotropic_g2(
        lobe.ggx().roughness(),
        Masking::Separable,
        incoming,
        head_on,
    )
}

proptest! {
    #![proptest_config(generators::cases(1000))]

    #[test]
    fn grain_of_equal_roughness_is_none(
        roughness in generators::roughness(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
    ) {
        let fresnel = GivenFresnel::try_from(fresnel).unwrap();
        let plain = GgxLobe::new(Ggx::new(roughness).unwrap(), fresnel, Incidence { normal: lit.normal, incoming: lit.incoming });
        let grained = grained([roughness; 2], fresnel, &lit, tangent);
        prop_assert_eq!(grained.unit_bound(), plain.unit_bound_by(Triaxial));
        prop_assert_eq!(grained.separable().unit_bound(), plain.separable().unit_bound_by(Triaxial));
    }

    #[test]
    fn ellipsoid_of_the_grain_is_touched_and_not_above_the_spheroid_of_the_rougher(
        roughness in [generators::up_to_one(0.01), generators::up_to_one(0.01)],
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
    ) {
        let fresnel = GivenFresnel::try_from(fresnel).unwrap();
        let lobe = grained(roughness, fresnel, &lit, tangent);
        let reflected = f64::from(lobe.max_reflected());
        prop_assume!(reflected > 1e-15);
        let bound = lobe.unit_bound();

        // The surface l = r′/(ω_hᵀP⁻²ω_h), everywhere.
        let g1 = smith_of_grain(&lobe, &lit);
        let [alpha_x, alpha_y] = roughness.map(f64::from);
        let mu = lit.surface.incident_cosine();
        let scale = (reflected * g1 / (4.0 * PI * mu * alpha_x * alpha_y)).sqrt();
        let rougher = alpha_x.max(alpha_y);
        let spheroid = scale.powi(3) * rougher * rougher * 0.5 * (1.0 + rougher * rougher);
        prop_assert!(volume(&bound) <= 1.001 * spheroid);

        let shape = Shape::from(bound);
        let normal = lit.surface.normal;
        let frame = SurfaceFrame::new(normal, lobe.tangent());
        let peak = PI * alpha_x * alpha_y;
        let most = lit.surface.mirrored_by_facets(roughness, lobe.tangent())
            .chain([lit.surface.mirror()])
            .map(|outgoing| {
                let half = (outgoing + lit.surface.incoming).unit();
                let density = anisotropic_ndf(roughness, frame.slopes(half), half.dot(normal));
                shape.level(Vector::ZERO, outgoing * (scale * (peak * density).sqrt()))
            })
            .fold(0.0, f64::max);
        prop_assert!(most <= 1.0, "left at {most}");
        prop_assert!(most > 0.98, "reached only to {most}");
    }

    /// F·G2/G1 at any azimuth is below what the bound takes it to be.
    #[test]
    fn joint_maximum_of_a_grain_bounds(
        roughness in generators::two_roughnesses(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        tangent in generators::unit_vector(),
        outgoing in prop::collection::vec(generators::unit_vector(), 40),
    ) {
        let given = GivenFresnel::try_from(fresnel).unwrap();
        let lobe = grained(roughness, given, &lit, tangent);
        let frame = SurfaceFrame::new(lit.surface.normal, lobe.tangent());
        let g1 = smith_of_grain(&lobe, &lit);
        for outgoing in outgoing {
            if outgoing.dot(lit.surface.normal) <= 0.0 {
                continue;
            }
            let half = (outgoing + lit.surface.incoming).unit();
            let [i, o] = [lit.surface.incoming, outgoing].map(|v| frame.slopes(v));
            let g2 = anisotropic_g2(roughness, Masking::HeightCorrelated, i, o);
            let share = fresnel.at(half.dot(lit.surface.incoming).min(1.0)) * g2 / g1;
            let said = f64::from(lobe.max_reflected());
            prop_assert!(said >= share - 1e-20, "{said} {share}");
        }
    }
}
