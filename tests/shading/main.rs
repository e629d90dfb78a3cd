//! Lights that are evaluated many at a time have, bit by bit, the estimates of those evaluated one by one.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use stochastic_light_culling::{
    AtPoint, ConstantLobe, Dielectric, Direction, Estimate, Ggx, GgxLobe, InList, Incidence,
    LambertLobe, LtcLobe, NoFresnel, PhongLobe, PointBlock, RadianceEstimator, Roulette, Schlick,
    ShadedPoint, ShadingBatch, SphericalGaussian, SpotLobe, Vpl, WeightedList, Xi, glam::Vec3,
};
use support::{
    generators::{self, cases, log_uniform, unit_vector},
    parts::{Coat, Parts, Windowed},
    reference::MaskedAlone,
};

mod clusters;
mod faint;
mod frame;
mod receivers;
mod scalar;
mod transformed;

use frame::{Frame, bits, frame};

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn glossy_lights(frame in frame()) {
        frame.same_ggx(|_| NoFresnel)?;
        frame.same_ggx(|light| Schlick::new(light.share).unwrap())?;
        frame.same_ggx(|light| Dielectric::new(0.5 + light.share).unwrap())?;
        frame.same_ggx(Parts::conductor)?;
        frame.same_ggx(|light| Coat(light.share))?;
        frame.same(|light| light.ggx(Coat(light.share)).with_masking::<MaskedAlone>())?;
    }

    #[test]
    fn other_lights(frame in frame()) {
        // From a pencil to all directions.
        let spot = |light: &Parts| {
            let outer = std::f32::consts::PI * light.roughness;
            SpotLobe::new(light.share * outer, outer, light.lit.normal).unwrap()
        };
        frame.same(spot)?;
        frame.same(|light| LambertLobe::new(light.share, light.lit.normal).unwrap())?;
        frame.same(|_| ConstantLobe)?;
        // From flat to as narrow as may be.
        let exponent = |light: &Parts| PhongLobe::MAX_EXPONENT * light.roughness.powi(4);
        frame.same(|light| {
            PhongLobe::new(light.share, exponent(light), light.incidence()).unwrap()
        })?;
        frame.same(|light| {
            PhongLobe::about(light.share, exponent(light), light.lit.normal).unwrap()
        })?;
        frame.same(|light| {
            let sharpness = SphericalGaussian::MAX_SHARPNESS * light.roughness.powi(4);
            SphericalGaussian::new(light.lit.normal, sharpness, light.share).unwrap()
        })?;
        frame.same(|light| {
            let schlick = Schlick::new(light.share).unwrap();
            LtcLobe::new(Ggx::new(light.roughness).unwrap(), schlick, light.incidence())
        })?;
        frame.same(|light| Windowed(light.lit.normal))?;
    }

    #[test]
    fn listed_lights(frame in frame()) {
        frame.same_by::<InList, _>(|light| light.ggx(Coat(light.share)))?;
        frame.same_by::<InList, _>(|_| ConstantLobe)?;
    }

    /// Directions have unit length wherever squared distances are normal numbers, and are never longer.
    #[test]
    fn directions_have_unit_length(
        position in generators::position(),
        way in unit_vector(),
        distance in log_uniform(1e-30, 1e30),
    ) {
        let light = Vpl::new(position, 1.0, ConstantLobe).unwrap();
        let point = position + (way * distance).to_f32();
        let exact = (point - position).as_dvec3();
        let (direction, squared) = light.direction_to(point);
        let length = direction.as_dvec3().length();
        prop_assert!(length <= 1.0 + 1e-6, "{}", length);
        if (1.1e-19..1.8e19).contains(&exact.length()) {
            prop_assert!((length - 1.0).abs() < 1e-6, "{}", length);
            prop_assert!((exact.normalize() - direction.as_dvec3()).length() < 1e-6);
            prop_assert!((f64::from(squared) / exact.length_squared() - 1.0).abs() < 1e-6);
        }
    }
}

/// Points at the horizon of a light, where rounding decides whether it is lit: no light that is, by the
/// direction, is taken for one that faces away.
#[test]
fn lights_at_the_horizon_are_not_taken_for_dark() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut number = || 2.0 * random.f32() - 1.0;
    let roulette = Roulette::new(1e-30).unwrap();
    let xi = Xi::new(f32::from_bits(1)).unwrap();
    let mut lit = 0;
    for _ in 0..2000 {
        let normal = Direction::new(Vec3::new(number(), number(), number())).unwrap();
        let (across, down) = normal.any_orthonormal_pair();
        let frame = Frame {
            roulette,
            least_distance_squared: 0.0,
            lights: Vec::new(),
            points: (0..64)
                .map(|_| {
                    let way = across * number() + down * number();
                    let scale = [1e-18_f32, 1e-8, 1.0, 1e8, 1e18][(number().abs() * 5.0) as usize];
                    (scale * (way + *normal * (1e-7 * number()))).into()
                })
                .collect(),
            list: vec![0],
        };
        let lobe = LambertLobe::new(1.0, normal).unwrap();
        let lights = [(Vpl::new(Vec3::ZERO, 1e10, lobe).unwrap(), xi)];
        let mut batch = ShadingBatch::new();
        batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));
        let mut found = Vec::new();
        let lists = frame.points.iter().map(|point| (*point, &frame.list[..]));
        let estimator = RadianceEstimator::new(&roulette);
        estimator.at_points(&batch, lists, |i, estimate| found.push(bits(i, estimate)));
        let expected = (0..64).flat_map(|i| frame.scalar::<AtPoint, _>(&lights, i, &[0], &[1.0]));
        assert_eq!(found, expected.collect::<Vec<_>>());
        lit += found.len();
    }
    assert!((30_000..100_000).contains(&lit), "{lit} of 128000");
}

/// Of ordinary lights and points, not all are rejected.
#[test]
fn ordinary_points_accept_ordinary_lights() {
    let ggx = Ggx::new(0.3).unwrap();
    let lobe = GgxLobe::new(ggx, NoFresnel, Incidence::head_on(Direction::Y));
    let light = |i: u32| Vpl::new(Vec3::new(i as f32, 0.0, 0.0), 1.0, lobe).unwrap();
    let mut batch = ShadingBatch::new();
    assert!(batch.is_empty());
    for i in 0..20 {
        batch.push(&light(i), Xi::new(0.5).unwrap());
    }
    let estimator = RadianceEstimator::new(&Roulette::new(0.01).unwrap());
    let (list, mut accepted): (Vec<u32>, _) = ((0..20).rev().collect(), Vec::new());
    let point = ShadedPoint::from(Vec3::new(10.0, 2.0, 0.0));
    estimator.at_points(&batch, [(point, &list[..])], |_, estimate| {
        accepted.push(estimate.light);
    });
    assert!(accepted.is_sorted_by(|a, b| a > b), "{accepted:?}");
    assert!(
        accepted.contains(&10) && !accepted.contains(&0),
        "{accepted:?}"
    );

    // From below nothing arrives.
    let normal = Vec3::Y;
    let turned = ShadedPoint { normal, ..point };
    estimator.at_points(&batch, [(turned, &list[..])], |_, _| {
        panic!("below the horizon")
    });
    assert!(estimator.with_least_distance_squared(-1.0).is_err());
    assert!(estimator.with_least_distance_squared(f32::NAN).is_err());
}

#[test]
#[should_panic(expected = "index out of bounds")]
fn an_index_of_no_light_panics() {
    let batch = ShadingBatch::<ConstantLobe>::new();
    let estimator = RadianceEstimator::new(&Roulette::new(0.01).unwrap());
    let point = ShadedPoint::from(Vec3::ZERO);
    estimator.at_points(&batch, [(point, &[0][..])], |_, _| ());
}

/// A missing weight does not pass for an answer: not in the middle of a vector, nor past it.
#[test]
fn a_light_without_a_weight_panics() {
    let mut batch = ShadingBatch::new();
    batch.push(
        &Vpl::new(Vec3::Z, 1.0, ConstantLobe).unwrap(),
        Xi::new(1.0).unwrap(),
    );
    let (estimator, point) = (RadianceEstimator::listed(), ShadedPoint::from(Vec3::ZERO));
    let (lights, weights) = ([0; 40], [1.0; 40]);
    let sum = |count: usize, weight_count: usize| {
        let list = WeightedList {
            lights: &lights[..count],
            weights: &weights[..weight_count],
        };
        let block = PointBlock::take(&mut [point].into_iter()).unwrap();
        let mut of_block = 0.0;
        estimator.at_block(&batch, list, &block, |found| of_block += found.radiance[0]);
        let add = |sum, _, estimate: &Estimate| sum + estimate.radiance;
        let of_point = estimator.fold_at_points(&batch, [(point, list)], 0.0, add);
        assert_eq!(of_block, of_point);
    };
    sum(40, 40);
    for (lights, weights) in [(1, 0), (3, 2), (40, 39)] {
        std::panic::catch_unwind(|| sum(lights, weights)).unwrap_err();
    }
}
