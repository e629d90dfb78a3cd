//! The greatest value of a lobe within a cap of directions: never too low, and the value itself as the cap closes.

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Cap, ConstantLobe, Direction, Error, Ggx, GgxLobe,
    Incidence, LambertLobe, Lobe, PhongLobe, SphericalGaussian, SpotLobe, glam::Vec3,
};
use support::caps::{nearest, spiral};
use support::generators::{self, Lit, log_uniform};
use support::reference::{Brdf, Fresnel, GivenFresnel, MaskedAlone, Masking, Vector};

/// What the crate says of the lobe within the cap.
fn maximum_within(brdf: Brdf, lit: &Lit, cap: &Cap) -> f32 {
    let (normal, incoming) = (lit.normal, lit.incoming);
    let incidence = Incidence { normal, incoming };
    match brdf {
        Brdf::Ggx {
            roughness,
            fresnel,
            masking,
        } => {
            let (ggx, fresnel) = (Ggx::new(roughness), GivenFresnel::try_from(fresnel));
            let lobe = GgxLobe::new(ggx.unwrap(), fresnel.unwrap(), incidence);
            match masking {
                Masking::HeightCorrelated => lobe.maximum_within(cap),
                Masking::Separable => lobe.separable().maximum_within(cap),
                Masking::MaskedAlone => lobe.with_masking::<MaskedAlone>().maximum_within(cap),
            }
        }
        Brdf::Anisotropic {
            roughness: [along, across],
            tangent,
            fresnel,
            masking,
        } => {
            let ggx = AnisotropicGgx::new(along, across).unwrap();
            let fresnel = GivenFresnel::try_from(fresnel).unwrap();
            let lobe = AnisotropicGgxLobe::new(ggx, fresnel, incidence, tangent).unwrap();
            match masking {
                Masking::HeightCorrelated => lobe.maximum_within(cap),
                Masking::Separable => lobe.separable().maximum_within(cap),
                Masking::MaskedAlone => lobe.with_masking::<MaskedAlone>().maximum_within(cap),
            }
        }
        Brdf::Lambert { albedo } => LambertLobe::new(albedo, normal)
            .unwrap()
            .maximum_within(cap),
        Brdf::Phong { albedo, exponent } => {
            let lobe = PhongLobe::new(albedo, exponent, incidence).unwrap();
            lobe.maximum_within(cap)
        }
        Brdf::SphericalGaussian {
            amplitude,
            sharpness,
        } => {
            let lobe = SphericalGaussian::new(normal, sharpness, amplitude).unwrap();
            lobe.maximum_within(cap)
        }
        Brdf::Spot {
            angles: [inner, outer],
            ..
        } => SpotLobe::new(inner, outer, normal)
            .unwrap()
            .maximum_within(cap),
        Brdf::Ltc { lobe, .. } => lobe.maximum_within(cap),
        Brdf::Constant => ConstantLobe.maximum_within(cap),
    }
}

/// A lobe, and a cap: mostly near its peak or near the horizon.
#[derive(Clone, Debug)]
struct Case {
    brdf: Brdf,
    lit: Lit,
    cap: Cap,
}

impl Case {
    /// Directions of the cap, most of them where the lobe is greatest.
    fn directions(&self, random: &[Vector]) -> Vec<Vector> {
        let surface = self.lit.surface;
        let axis = Vector::from(*self.cap.axis()).unit();
        let mut directions = vec![
            axis,
            surface.mirror().unit(),
            surface.normal,
            -surface.incoming,
        ];
        if let Brdf::Anisotropic {
            roughness, tangent, ..
        } = self.brdf
        {
            directions.extend(surface.mirrored_by_facets(roughness, tangent).step_by(8));
        }
        directions.extend_from_slice(random);
        directions.extend(spiral(&self.cap));
        directions
            .into_iter()
            .map(|direction| nearest(&self.cap, direction))
            .collect()
    }

    fn greatest(&self, random: &[Vector]) -> f64 {
        let value = |direction| self.lit.surface.value(self.brdf, direction);
        self.directions(random)
            .into_iter()
            .map(value)
            .fold(0.0, f64::max)
    }
}

fn case(chord: impl Strategy<Value = f32>) -> impl Strategy<Value = Case> {
    let off = (generators::unit_vector(), log_uniform(1e-7, 1.0));
    (generators::brdf(), generators::lit(), 0..5_u32, off, chord).prop_map(
        |(brdf, lit, aim, (off, size), chord)| {
            let surface = lit.surface;
            let aim = match aim {
                0 => surface.normal,
                1 => surface.normal.orthogonal(),
                2 => -surface.incoming,
                _ => surface.mirror(),
            };
            let axis = Direction::new((aim + off * size).unit().to_f32()).unwrap();
            Case {
                brdf: brdf
                    .laid_on(surface.normal)
                    .lit_by(lit.normal, lit.incoming),
                lit,
                cap: Cap::new(axis, chord).unwrap(),
            }
        },
    )
}

fn random() -> impl Strategy<Value = Vec<Vector>> {
    proptest::collection::vec(generators::unit_vector(), 32)
}

proptest! {
    #![proptest_config(generators::cases(4000))]

    #[test]
    fn a_lobe_is_nowhere_greater(
        case in case(prop_oneof![
            4 => log_uniform(1e-7, 2.0).prop_map(|chord| chord as f32),
            1 => Just(0.0_f32),
            1 => Just(2.0_f32),
        ]),
        random in random(),
    ) {
        let most = f64::from(maximum_within(case.brdf, &case.lit, &case.cap));
        // The model's own rounding.
        let greatest = case.greatest(&random) * (1.0 - 1e-12);
        prop_assert!(greatest <= most, "{greatest} > {most}");
    }

    /// At a chord of 10⁻³ a lobe changes little within the cap if it is wide and neither is near grazing.
    #[test]
    fn it_becomes_the_value_as_the_cap_closes(
        case in case(prop_oneof![Just(0.0_f32), Just(1e-3)]),
        random in random(),
    ) {
        let chord = f64::from(case.cap.chord());
        let surface = case.lit.surface;
        // Towards a thinner medium F is as steep as can be, at the critical angle.
        if let Brdf::Ggx { fresnel, .. } | Brdf::Anisotropic { fresnel, .. } = case.brdf
            && let Fresnel::Dielectric(index) | Fresnel::Conductor(index, _) = fresnel
            && index <= 1.0
        {
            return Ok(());
        }
        let (width, has_horizon) = match case.brdf {
            Brdf::Ggx { roughness, .. } => (f64::from(roughness), true),
            Brdf::Anisotropic { roughness: [along, across], .. } => (f64::from(along.min(across)), true),
            Brdf::Phong { exponent, .. } => ((1.0 + f64::from(exponent)).sqrt().recip(), true),
            Brdf::SphericalGaussian { sharpness, .. } => ((1.0 + f64::from(sharpness)).sqrt().recip(), false),
            Brdf::Spot { angles: [inner, outer], .. } => (f64::from(outer - inner), false),
            // Narrower than that of GGX, and ever more so towards grazing incidence.
            Brdf::Ltc {
                roughness,
                matrix: None,
                ..
            } => (f64::from(roughness) * 0.3 * surface.incident_cosine(), true),
            // A caller's matrix may be as narrow as it likes.
            Brdf::Ltc { .. } => return Ok(()),
            Brdf::Lambert { .. } | Brdf::Constant => (1.0, true),
        };
        let axis = Vector::from(*case.cap.axis()).unit();
        // Half vectors that vanish have any direction.
        let half = (surface.incoming + axis).length();
        // A power of the cosine below 1 is steep there too.
        let is_edge = matches!(case.brdf, Brdf::Phong { .. }) && surface.mirror().dot(axis) < 0.1;
        let is_grazing = is_edge || has_horizon && surface.normal.dot(axis) < 0.1;
        if width < 0.1 || half < 0.3 || is_grazing {
            return Ok(());
        }
        let most = f64::from(maximum_within(case.brdf, &case.lit, &case.cap));
        let greatest = case.greatest(&random);
        // Far from its peak a lobe may fall by many times its value there, but not by more of its peak.
        let peak = f64::from(maximum_within(case.brdf, &case.lit, &Cap::all()));
        let is_steep = greatest < 0.1 * peak;
        let steps = if is_steep { 4.0 * chord / width } else { 0.0 };
        // 2 % for a width of 0.3.
        let allowed = greatest * (1.0 + 6.0 * chord / width) + peak * (steps + 1e-4);
        prop_assert!(most <= allowed, "{most} > {allowed}, where {greatest}");
    }

    #[test]
    fn the_cap_of_a_ball_holds_its_points(
        [apex, center] in [generators::position(), generators::position()],
        share in log_uniform(1e-6, 2.0),
        points in random(),
    ) {
        let radius = ((center - apex).length() * share as f32).max(1e-20);
        let cap = Cap::of_sphere(apex, center, radius);
        let axis = Vector::from(*cap.axis()).unit();
        for unit in points {
            let way = Vector::from(center) + unit * f64::from(radius) - Vector::from(apex);
            if way.length() > 0.0 {
                prop_assert!((way.unit() - axis).length() <= f64::from(cap.chord()));
            }
        }
    }
}

#[test]
fn caps_that_are_none_are_refused_or_hold_all() {
    for chord in [-1e-9, 2.000_001, f32::NAN, f32::INFINITY] {
        let refused = Cap::new(Direction::X, chord);
        assert!(matches!(refused, Err(Error::Number { .. })), "{chord}");
    }
    let numbers = [f32::NAN, f32::INFINITY, 1e30, 0.0];
    for number in numbers {
        let cap = Cap::of_sphere(Vec3::ZERO, Vec3::splat(number), 1e30);
        assert_eq!(cap, Cap::all());
    }
    assert_eq!(Cap::of_sphere(Vec3::ZERO, Vec3::X, f32::NAN), Cap::all());
    assert_eq!(Cap::of_sphere(Vec3::ZERO, Vec3::X, 1.0), Cap::all());
}

#[test]
fn a_cap_below_the_horizon_sees_nothing() {
    let lobe = LambertLobe::new(1.0, Direction::Z).unwrap();
    let cap = Cap::new(-Direction::Z, 0.99).unwrap();
    assert_eq!(lobe.maximum_within(&cap), 0.0);
    let incidence = Incidence::head_on(Direction::Z);
    let glossy = GgxLobe::new(
        Ggx::new(0.5).unwrap(),
        stochastic_light_culling::NoFresnel,
        incidence,
    );
    assert_eq!(glossy.maximum_within(&cap), 0.0);
}

/// A lobe of another crate culls nothing unless it says more.
#[test]
fn a_lobe_may_leave_its_maximum_unknown() {
    struct Own;
    impl Lobe for Own {
        fn value(&self, _: Vec3) -> f32 {
            1.0
        }
    }
    assert_eq!(Own.maximum_within(&Cap::all()), f32::INFINITY);
}
