//! Every bound contains every point of the isosurface that it bounds, with no tolerance; and none is
//! larger than it has to be.

mod case;
mod other_lobes;

use std::f64::consts::TAU;

use proptest::prelude::*;
use stochastic_light_culling::{
    Bounded, ConstantLobe, Direction, Ellipsoid, Ggx, GgxLobe, Incidence, LambertLobe, Lobe,
    NoFresnel, Paper, PhongLobe, Roulette, Tight, Vpl, Xi, glam::Vec3,
};
use support::generators::{self, Lit};
use support::reference::{self, Brdf, Fresnel, Masking, Shape, Vector, smith_g1};

use case::{Case, case};
use other_lobes::other_lobes;

proptest! {
    #![proptest_config(generators::cases(2000))]

    #[test]
    fn every_bound_encloses_the_isosurface(
        case in case(),
        random in prop::collection::vec(generators::unit_vector(), 40),
    ) {
        let directions = case.directions(&random);
        for (name, shape) in case.bounds() {
            for direction in &directions {
                let level = shape.level(case.position.into(), *direction * case.radius(*direction));
                prop_assert!(level <= 1.0, "{name} is left at level {level} towards {direction:?}");
            }
        }
    }

    #[test]
    fn bounds_of_other_lobes_enclose_them(
        axis in generators::unit_vector(),
        share in 0.001..=1.0_f32,
        exponent in generators::exponent(),
        random in prop::collection::vec(generators::unit_vector(), 40),
    ) {
        let lit = Lit::new(axis, axis);
        let brdf = Brdf::Phong { albedo: share, exponent };
        let case = Case { brdf, lit, position: Vec3::ZERO, roulette: (1.0, 1.0, 1.0) };
        for lobe in other_lobes(lit.normal, share, exponent) {
            for direction in case.directions(&random) {
                let reach = (lobe.value)(direction).sqrt();
                let level = lobe.bound.level(Vector::ZERO, direction * reach);
                prop_assert!(level <= 1.0, "{} is left at level {level} towards {direction:?}", lobe.name);
            }
        }
    }

    /// With F, G2 and the hemisphere put at their bounds, the spheroid is touched all along the plane
    /// of incidence.
    #[test]
    fn spheroid_is_touched_in_the_plane_of_incidence(
        roughness in generators::roughness(),
        fresnel in generators::fresnel(),
        lit in generators::lit(),
        roulette in generators::roulette(),
    ) {
        let case = Case {
            brdf: Brdf::Ggx { roughness, fresnel, masking: Masking::HeightCorrelated },
            lit,
            position: Vec3::ZERO,
            roulette,
        };
        let bounds = case.ggx_bounds(roughness, fresnel, Masking::HeightCorrelated);
        let shape = Shape::from(bounds.spheroid);
        let (mu, alpha) = (lit.surface.incident_cosine(), f64::from(roughness));
        let (flux, delta, xi) = roulette;
        // With the crate's F_max, whose own test says how tight it is.
        let most = bounds.max_fresnel * smith_g1(alpha, mu) / (4.0 * mu)
            * f64::from(flux) / (f64::from(delta) * f64::from(xi));
        // Where F vanishes altogether there is nothing to touch.
        prop_assume!(bounds.max_fresnel > 1e-15);
        let mirror = lit.surface.mirror().unit();
        let side = match lit.surface.normal.cross(lit.surface.incoming) {
            cross if cross.length() > 1e-12 => cross.unit().cross(mirror),
            _ => mirror.orthogonal(),
        };
        for step in 0..64 {
            let angle = 2.0 * (alpha * (TAU * f64::from(step) / 128.0).tan()).atan();
            let half = mirror.turned(side, angle) + lit.surface.incoming;
            if half.dot(lit.surface.normal) < 1e-6 {
                continue;
            }
            let ndf = reference::ggx_ndf(alpha, half.unit(), lit.surface.normal);
            let level = shape.level(Vector::ZERO, mirror.turned(side, angle) * (most * ndf).sqrt());
            // The level of a point near the light says little; its distance to the surface does.
            let reach = level_reach(&shape, mirror.turned(side, angle));
            let share = (most * ndf).sqrt() / reach;
            prop_assert!(share > 1.0 - 1e-4 && level <= 1.0 + 1e-9,
                "reaches {share} of the spheroid at {angle} rad, level {level}");
        }
    }

    #[test]
    fn spheres_are_touched(
        roughness in generators::roughness(),
        lit in generators::lit(),
        roulette in generators::roulette(),
    ) {
        let case = Case { brdf: Brdf::Constant, lit, position: Vec3::ZERO, roulette };
        let spheroid = case.spheroid(roughness, Fresnel::None, Masking::HeightCorrelated);
        let shape = Shape::from(spheroid);
        let tips = [1.0, -1.0].map(|end| shape.point(Vector([end, 0.0, 0.0])));
        let around = Shape::from(spheroid.enclosing_sphere());
        for tip in tips {
            prop_assert!(around.level(Vector::ZERO, tip) > 1.0 - 1e-5);
        }
        let at_focus = Shape::from(spheroid.sphere_at_focus());
        prop_assert!(at_focus.level(Vector::ZERO, tips[0]) > 1.0 - 1e-5);

        let lambert = LambertLobe::new(0.8, lit.normal).unwrap();
        let case = Case { brdf: Brdf::Lambert { albedo: 0.8 }, ..case };
        let sphere = Shape::from(case.bound(lambert));
        let side = lit.surface.normal.orthogonal();
        let widest = lit.surface.normal.turned(side, (1.0_f64 / 3.0).powf(0.5).acos());
        prop_assert!(sphere.level(Vector::ZERO, widest * case.radius(widest)) > 1.0 - 1e-5);

        let case = Case { brdf: Brdf::Constant, ..case };
        let sphere = Shape::from(case.bound(ConstantLobe));
        prop_assert!(sphere.level(Vector::ZERO, side * case.radius(side)) > 1.0 - 1e-5);
    }
}

/// How far `shape` reaches from the origin, which is inside, towards `direction`.
fn level_reach(shape: &Shape, direction: Vector) -> f64 {
    let scaled = |v: Vector| {
        Vector(std::array::from_fn(|i| {
            shape.axes[i].dot(v) / shape.semi_axes[i]
        }))
    };
    let (d, o) = (scaled(direction), scaled(-(shape.offset + shape.origin)));
    let (a, b, c) = (d.dot(d), d.dot(o), o.dot(o) - 1.0);
    let root = (b * b - a * c).sqrt();
    // Of the two forms of the root, the one that does not cancel.
    if b > 0.0 {
        -c / (b + root)
    } else {
        (root - b) / a
    }
}

/// A spheroid that is placed already is placed anew without losing its near end to rounding.
#[test]
fn placing_a_placed_spheroid_rounds_outward() {
    let ggx = Ggx::new(0.01).unwrap();
    let lobe = GgxLobe::new(
        ggx,
        NoFresnel,
        Incidence {
            normal: Direction::Z,
            incoming: Direction::new(Vec3::ONE).unwrap(),
        },
    );
    let (first, then) = (Vec3::new(0.1, 0.7, -0.3), Vec3::new(900.0, -70.3, 11.1));
    let once = lobe.unit_bound_by(Paper).placed(first, 1e-3);
    let again = Shape::from(once.placed(then, 0.3));
    let inner = Shape::from(once);
    for end in [-1.0, 1.0] {
        for axis in 0..3 {
            let mut unit = Vector::ZERO;
            unit.0[axis] = end;
            let moved = inner.point(unit) * f64::from(0.3_f32) + Vector::from(then);
            assert!(again.level(Vector::ZERO, moved) <= 1.0);
        }
    }
}

#[test]
fn lights_that_reach_nothing_have_an_empty_range() {
    let below = Direction::new(Vec3::new(0.3, 0.0, -1.0)).unwrap();
    let ggx = Ggx::new(0.2).unwrap();
    let (roulette, xi) = (Roulette::new(0.001).unwrap(), Xi::new(0.5).unwrap());
    let lit_from_below = GgxLobe::new(
        ggx,
        NoFresnel,
        Incidence {
            normal: Direction::Z,
            incoming: below,
        },
    );
    let lit_along = GgxLobe::new(
        ggx,
        NoFresnel,
        Incidence {
            normal: Direction::Z,
            incoming: Direction::X,
        },
    );
    for lobe in [lit_from_below, lit_along] {
        let light = Vpl::new(Vec3::ONE, 1.0, lobe).unwrap();
        assert!(light.bound(&roulette, xi).is_empty());
        assert_eq!(light.radiant_intensity(Vec3::Z), 0.0);
    }
    let lit = GgxLobe::new(
        ggx,
        NoFresnel,
        Incidence {
            normal: Direction::Z,
            incoming: -below,
        },
    );
    let dark = Vpl::new(Vec3::ONE, 0.0, lit).unwrap();
    let dark = dark.bound_by(Paper, &roulette, xi);
    assert!(dark.is_empty() && Ellipsoid::from(dark).is_empty());
    assert!(dark.enclosing_sphere().is_empty() && dark.sphere_at_focus().is_empty());
    let black = Vpl::new(Vec3::ONE, 1.0, LambertLobe::new(0.0, Direction::Z).unwrap()).unwrap();
    assert!(
        black.bound(&roulette, xi).is_empty() && black.bound_by(Tight, &roulette, xi).is_empty()
    );
    for (albedo, incoming) in [(0.0, Direction::Z), (1.0, below), (1.0, Direction::X)] {
        let dark = PhongLobe::new(
            albedo,
            40.0,
            Incidence {
                normal: Direction::Z,
                incoming,
            },
        )
        .unwrap();
        assert!(dark.unit_bound().is_empty());
        assert_eq!(dark.value(*dark.axis()), 0.0);
        assert_eq!(dark.value(Vec3::Z), 0.0);
    }
}
