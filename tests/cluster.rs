//! Clusters of lights: their sums add, the lights that stand for them have their flux, and what arrives of such
//! a light is what its formula integrates to.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use stochastic_light_culling::{
    ClusterSums, Direction, Ggx, Incidence, Lobe, SphericalGaussian, Vsgl, glam::Vec3,
};
use support::generators::{self, cases, log_uniform};
use support::quadrature::integral;
use support::reference::Vector;

/// The radiance that arrives from `direction`, by Eq. 7 of the 2016 supplemental before the product is taken.
fn radiance(light: &Vsgl, point: Vec3, direction: Vector) -> f64 {
    let lobe = light.lobe();
    let way = Vector::from(light.position()) - Vector::from(point);
    let spread_squared = f64::from(light.spread()).powi(2);
    let [to_light, axis] = [way.unit(), Vector::from(*lobe.axis()).unit()];
    let exponent = |apart: Vector, sharpness: f64| -0.5 * sharpness * apart.dot(apart);
    let of_lobe = exponent(direction + axis, lobe.sharpness().into());
    let of_spread = exponent(direction - to_light, way.dot(way) / spread_squared);
    f64::from(lobe.amplitude()) / (TAU * spread_squared) * (of_lobe + of_spread).exp()
}

fn light() -> impl Strategy<Value = Vsgl> {
    let spread = log_uniform(1e-3, 1e2);
    let sharpness = prop_oneof![4 => log_uniform(1e-2, 1e4), 1 => Just(0.0)];
    (
        generators::unit_vector(),
        sharpness,
        spread,
        generators::position(),
    )
        .prop_map(|(axis, sharpness, spread, position)| {
            let axis = Direction::new(axis.to_f32()).unwrap();
            let lobe = SphericalGaussian::new(axis, sharpness as f32, 0.8).unwrap();
            Vsgl::new(position, spread as f32, lobe).unwrap()
        })
}

proptest! {
    #![proptest_config(cases(256))]

    /// E, in single precision, against quadrature, and the SG of what arrives against the radiance itself.
    #[test]
    fn what_arrives_agrees_with_quadrature(
        light in light(),
        way in generators::unit_vector(),
        ahead in 0.0..=1.0_f64,
        distance in log_uniform(1e-2, 1e2),
    ) {
        let axis = Vector::from(*light.lobe().axis()).unit();
        let way = (way * (1.0 - ahead) + axis * ahead).unit();
        let point = light.position() + (way * (distance * f64::from(light.spread()))).to_f32();
        let arriving = light.incoming(point);
        let from = Vector::from(*arriving.axis()).unit();
        let width = (1.0 + f64::from(arriving.sharpness())).sqrt().recip();
        let exact = integral(from, width, |w| radiance(&light, point, w));
        prop_assume!(exact > 1e-30);
        let found = f64::from(light.scalar_irradiance(point));
        prop_assert!((found / exact - 1.0).abs() < 2e-5, "{found} {exact}");
        let integral = f64::from(arriving.integral());
        prop_assert!((integral / exact - 1.0).abs() < 2e-5, "{integral} {exact}");
        let peak = f64::from(arriving.amplitude());
        let exact_peak = radiance(&light, point, from);
        // The rounding of the axis, which both exponents multiply.
        prop_assert!((peak / exact_peak - 1.0).abs() < 1e-3, "{peak} {exact_peak}");
    }

    /// E never grows along a way out from the centre.
    #[test]
    fn irradiance_falls_outward(
        light in light(),
        way in generators::unit_vector(),
        distance in log_uniform(1e-3, 1e3),
    ) {
        let at = |distance: f64| {
            let light = Vsgl::new(Vec3::ZERO, light.spread(), *light.lobe()).unwrap();
            light.scalar_irradiance((way * (distance * f64::from(light.spread()))).to_f32())
        };
        let (near, far) = (at(distance), at(1.01 * distance));
        prop_assert!(far <= near * 1.000_001, "{near} {far}");
        prop_assert!(near <= at(0.0) * 1.000_001);
    }

    /// Sums in any order, and halves of a cluster, make the same lights.
    #[test]
    fn merging_is_a_sum(
        lights in prop::collection::vec((generators::position(), log_uniform(1e-3, 1e3), generators::lit(), generators::roughness()), 1..40),
    ) {
        let sums: Vec<_> = lights.iter().map(|(position, flux, lit, roughness)| {
            let incidence = Incidence { normal: lit.normal, incoming: lit.incoming };
            let dull = SphericalGaussian::diffuse(0.5, lit.normal).unwrap();
            let ggx = Ggx::new(*roughness).unwrap();
            let glossy = SphericalGaussian::specular(ggx, 0.3, incidence).unwrap();
            ClusterSums::of_light(*position, *flux as f32, &dull, &glossy).unwrap()
        }).collect();
        let forward: ClusterSums = sums.iter().copied().sum();
        let backward: ClusterSums = sums.iter().rev().copied().sum();
        let halves = forward.scaled(0.5) + backward.scaled(0.5);
        let flux: f64 = lights.iter().map(|(_, flux, ..)| f64::from(*flux as f32)).sum();
        prop_assert!((forward.flux() / (0.8 * flux) - 1.0).abs() < 1e-6);
        for other in [backward, halves] {
            for (a, b) in [(forward.diffuse(), other.diffuse()), (forward.glossy(), other.glossy())] {
                let same = |a: f32, b: f32, tolerance: f32| (a - b).abs() <= tolerance * a.abs();
                prop_assert!(same(a.lobe().integral(), b.lobe().integral(), 1e-6));
                prop_assert!(same(a.lobe().sharpness(), b.lobe().sharpness(), 1e-5));
                let far = a.position().length();
                prop_assert!((a.position() - b.position()).length() <= 3e-7 * far);
                prop_assert!((a.spread() - b.spread()).abs() <= 1e-5 * a.spread() + 2e-7 * far);
            }
        }
        // The flux of the light that stands for them.
        let share = f64::from(forward.glossy().lobe().integral()) / (0.3 * flux) - 1.0;
        prop_assert!(share.abs() < 1e-5, "{share}");
    }
}

/// The sums of lights on a sphere, in a plane, and apart: against their moments.
#[test]
fn spread_is_the_mean_squared_distance() {
    let lobe = SphericalGaussian::diffuse(1.0, Direction::Z).unwrap();
    let dark = SphericalGaussian::new(Direction::Z, 0.0, 0.0).unwrap();
    for far in [0.0, 1.0, 1e3_f32] {
        let center = Vec3::new(far, -far, 0.5 * far);
        let sums: ClusterSums = (0..100)
            .map(|i| {
                let (sine, cosine) = (TAU * f64::from(i) / 100.0).sin_cos();
                let around = Vec3::new(cosine as f32, sine as f32, 0.0) * 0.25;
                ClusterSums::of_light(center + around, 0.01, &lobe, &dark).unwrap()
            })
            .sum();
        let light = sums.diffuse();
        assert!((light.position() - center).length() < 1e-5 + 1e-7 * far);
        assert!(
            (light.spread() - 0.25).abs() < 1e-5 + 1e-7 * far,
            "{}",
            light.spread()
        );
        assert!((light.lobe().integral() - 1.0).abs() < 1e-5);
        assert!((light.lobe().sharpness() - 2.0).abs() < 1e-5);
        assert!(sums.glossy().lobe().is_empty());
    }
}

#[test]
fn clusters_of_nothing_of_one_and_of_opposites() {
    let up = SphericalGaussian::with_integral(Direction::Z, 30.0, 0.5).unwrap();
    let down = SphericalGaussian::with_integral(-Direction::Z, 30.0, 0.5).unwrap();
    let point = Vec3::new(0.3, 0.2, 2.0);

    // No light, and light without flux.
    let dark = ClusterSums::of_light(point, 0.0, &up, &up).unwrap();
    for cluster in [
        ClusterSums::EMPTY,
        ClusterSums::default(),
        dark,
        dark + dark,
    ] {
        for light in [cluster.diffuse(), cluster.glossy()] {
            assert!(light.lobe().is_empty() && light.spread() == 0.0);
            assert_eq!(light.scalar_irradiance(point), 0.0);
            assert_eq!(light.scalar_irradiance(light.position()), 0.0);
            assert_eq!(light.incoming(point).amplitude(), 0.0);
        }
    }

    // One light, far from the origin: a point light.
    let far = Vec3::new(1234.5, -77.7, 0.1);
    let one = ClusterSums::of_light(far, 3.0, &up, &up).unwrap().glossy();
    assert_eq!((one.position(), one.spread()), (far, 0.0));
    // As far as single precision resolves it there.
    let from_light = far + point - far;
    let expected = 3.0 * up.value(from_light.normalize()) / from_light.length_squared();
    let error = one.scalar_irradiance(far + point) / expected - 1.0;
    assert!(error.abs() < 1e-5, "{error}");
    assert_eq!(one.scalar_irradiance(far), f32::INFINITY);
    assert!(one.incoming(far + point).sharpness() == SphericalGaussian::MAX_SHARPNESS);
    let arriving = one.incoming(far + point).integral() / expected - 1.0;
    assert!(arriving.abs() < 1e-5, "{arriving}");

    // Opposite lobes: constant, with the flux of both.
    let side = Vec3::new(0.1, 0.0, 0.0);
    let both = ClusterSums::of_light(-side, 1.0, &up, &up).unwrap()
        + ClusterSums::of_light(side, 1.0, &down, &down).unwrap();
    let light = both.glossy();
    assert_eq!(light.lobe().sharpness(), 0.0);
    assert!((f64::from(light.lobe().amplitude()) - 1.0 / (4.0 * PI)).abs() < 1e-6);
    assert!((light.spread() - 0.1).abs() < 1e-6);
    let reach = [Vec3::X, Vec3::Y, -Vec3::Z].map(|way| light.scalar_irradiance(way));
    assert!(
        reach.iter().all(|e| (e / reach[0] - 1.0).abs() < 1e-5),
        "{reach:?}"
    );
    // At its centre, E = 2c/σ² · ½.
    let center = light.scalar_irradiance(light.position()) * 0.01;
    assert!(
        (center / (2.0 * light.lobe().amplitude()) - 1.0).abs() < 1e-4,
        "{center}"
    );
}

#[test]
fn bad_input_is_refused_or_defined() {
    let lobe = SphericalGaussian::diffuse(1.0, Direction::Z).unwrap();
    for flux in [-1.0, f32::NAN, f32::INFINITY] {
        assert!(ClusterSums::of_light(Vec3::ZERO, flux, &lobe, &lobe).is_err());
    }
    for position in [Vec3::NAN, Vec3::new(f32::INFINITY, 0.0, 0.0)] {
        assert!(ClusterSums::of_light(position, 1.0, &lobe, &lobe).is_err());
        assert!(Vsgl::new(position, 1.0, lobe).is_err());
    }
    for spread in [-1e-9, f32::NAN, f32::INFINITY, 2e15] {
        assert!(Vsgl::new(Vec3::ZERO, spread, lobe).is_err());
    }
    let sums = ClusterSums::of_light(Vec3::ONE, 1.0, &lobe, &lobe).unwrap();
    for factor in [0.0, -1.0, f32::NAN] {
        assert_eq!(sums.scaled(factor).flux(), 0.0);
    }
    let light = sums.diffuse();
    for point in [Vec3::NAN, Vec3::INFINITY] {
        assert_eq!(light.scalar_irradiance(point), 0.0);
        assert_eq!(light.incoming(point).amplitude(), 0.0);
    }
    // The largest numbers there are.
    let bright = SphericalGaussian::new(Direction::Z, 1e6, f32::MAX).unwrap();
    let most = ClusterSums::of_light(Vec3::splat(f32::MAX), f32::MAX, &bright, &bright).unwrap();
    let light = (most + most + sums).glossy();
    assert!(light.lobe().amplitude() == f32::MAX && light.position().is_finite());
    assert!(!light.scalar_irradiance(Vec3::ZERO).is_nan());
    assert!(
        !light
            .incoming(Vec3::splat(f32::MIN))
            .value(Vec3::Z)
            .is_nan()
    );
}
