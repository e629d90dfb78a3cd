//! Receivers that reflect lights many at a time reflect, bit by bit, what they do one by one.

use proptest::prelude::*;
use stochastic_light_culling::{
    AtPoint, AtReceiver, Dielectric, Direction, Estimate, Ggx, GgxLobe, InList, Incidence,
    LambertLobe, Lobe, LtcLobe, NoFresnel, PointBlock, RadianceEstimator, Receiver, ReceiverBlock,
    Roulette, Schlick, ShadedPoint, ShadingBatch, Vpl, Xi, glam::Vec3,
};
use support::generators::cases;
use support::parts::{Coat, Parts, Windowed};

use crate::frame::{Frame, bits, frame};
use crate::scalar::{Scalar, weights};

/// A light that a receiver accepts, as `bits` gives it, and the bits of what is reflected.
type Reflected = Vec<((usize, u32, [u32; 6]), u32)>;

proptest! {
    #![proptest_config(cases(128))]

    #[test]
    fn reflect_what_they_do_one_by_one(frame in frame()) {
        same_glossy::<AtPoint>(&frame)?;
        same::<AtPoint, _>(&frame, |of| of.ggx(Dielectric::new(0.5 + of.share).unwrap()))?;
        same::<AtPoint, _>(&frame, |of| of.brushed(NoFresnel))?;
        same::<AtPoint, _>(&frame, |of| LambertLobe::new(of.share, of.lit.normal).unwrap())?;
        same::<AtPoint, _>(&frame, |of| Windowed(of.lit.normal))?;
        same::<AtPoint, _>(&frame, |of| {
            let ggx = Ggx::new(of.roughness).unwrap();
            LtcLobe::new(ggx, Schlick::new(of.share).unwrap(), of.incidence())
        })?;
    }

    #[test]
    fn decide_as_they_do_one_by_one(frame in frame()) {
        same_glossy::<AtReceiver>(&frame)?;
        same::<AtReceiver, _>(&frame, |of| Windowed(of.lit.normal))?;
    }

    #[test]
    fn weigh_as_they_do_one_by_one(frame in frame()) {
        same_glossy::<InList>(&frame)?;
    }
}

/// With a lobe that is numbers alone, and one with a caller's Fresnel factor.
fn same_glossy<D: Scalar>(frame: &Frame) -> Result<(), TestCaseError> {
    same::<D, _>(frame, |of| of.ggx(Schlick::new(of.share).unwrap()))?;
    same::<D, _>(frame, |of| of.ggx(Coat(of.share)))
}

/// Whether receivers at the points of `frame`, with lobes of its lights' parts, reflect the same in vectors of
/// every width.
fn same<D: Scalar, R: Lobe + Copy>(
    frame: &Frame,
    lobe: impl Fn(&Parts) -> R,
) -> Result<(), TestCaseError> {
    if frame.lights.is_empty() {
        return Ok(());
    }
    let receivers: Vec<_> = (0..)
        .zip(&frame.points)
        .map(|(i, point): (usize, _)| Receiver {
            position: point.position,
            lobe: lobe(&frame.lights[i % frame.lights.len()]),
        })
        .collect();
    let lights: Vec<_> = frame
        .lights
        .iter()
        .map(|of| of.vpl(of.ggx(NoFresnel)))
        .collect();
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));

    let weights = weights(&frame.list);
    let len_of = |i: usize| (i * 7) % (frame.list.len() + 1);
    let list_of = |len: usize| D::list(&frame.list[..len], &weights[..len]);
    let one_by_one = |i: usize, len: usize| -> Reflected {
        let Receiver { position, lobe } = receivers[i];
        let normal = lobe.horizon_normal().map_or(Vec3::ZERO, Vec3::from);
        let point = ShadedPoint { position, normal };
        let arrivals = frame.arrivals(&lights, point, &frame.list[..len]);
        let accepted = arrivals.filter_map(|arrival| {
            let value = lobe.value(-arrival.direction);
            let weight = weights[arrival.turn];
            let [radiance, reflected] = D::estimate(&frame.roulette, &arrival, weight, value)?;
            Some((arrival.bits(i, radiance), reflected.to_bits()))
        });
        accepted.collect()
    };
    let turns = 0..receivers.len();
    let expected: Vec<Reflected> = turns.clone().map(|i| one_by_one(i, len_of(i))).collect();
    let shared: Vec<Reflected> = turns
        .clone()
        .map(|i| one_by_one(i, frame.list.len()))
        .collect();

    for lanes in [16, 8, 4] {
        let estimator = D::estimator(&frame.roulette)
            .with_lanes(lanes)
            .with_least_distance_squared(frame.least_distance_squared)
            .unwrap();
        let lists = turns.clone().map(|i| (receivers[i], list_of(len_of(i))));
        let push = |mut found: Reflected, i, estimate: &Estimate, reflected: f32| {
            found.push((bits(i, estimate), reflected.to_bits()));
            found
        };
        let found = estimator.fold_reflected_at_points(&batch, lists, Vec::new(), push);
        prop_assert_eq!(found, expected.concat(), "{} lanes, by lights", lanes);

        let mut found = vec![Vec::new(); receivers.len()];
        let (mut rest, mut start) = (receivers.iter().copied(), 0);
        while let Some(block) = ReceiverBlock::take(&mut rest) {
            let list = list_of(frame.list.len());
            estimator.reflected_at_block(&batch, list, &block, |estimates, reflected| {
                for (i, reflected) in reflected.iter().enumerate() {
                    let accepted = estimates.accepted >> i & 1 != 0;
                    assert_eq!(accepted, estimates.radiance[i] > 0.0);
                    assert!(accepted || reflected.to_bits() == 0, "{reflected}");
                }
                for (i, estimate) in estimates.iter() {
                    found[start + i].push((bits(start + i, &estimate), reflected[i].to_bits()));
                }
            });
            start += block.points().len();
        }
        prop_assert_eq!(&found, &shared, "{} lanes, by receivers", lanes);
    }
    Ok(())
}

/// [Xia et al. 2023, Eq. 11]: what of a point does not depend on the light is a factor of the sum.
#[test]
fn transformed_cosines_sum_as_in_the_source() {
    let eye = Vec3::new(-2.0, 3.0, 1.0);
    let to_eye = Direction::new(eye).unwrap();
    let incidence = Incidence {
        normal: Direction::Y,
        incoming: to_eye,
    };
    let lobe = LtcLobe::new(
        Ggx::new(0.3).unwrap(),
        Schlick::new(0.5).unwrap(),
        incidence,
    );
    let mut lights = ShadingBatch::new();
    let (mut sum, list) = (0.0, (0..40).collect::<Vec<u32>>());
    let inverse = lobe.inverse_matrix().as_dmat3();
    for i in 0..40_u32 {
        let place = Vec3::new(0.3 * (i % 8) as f32 - 1.0, 2.0, 0.4 * (i / 8) as f32 - 1.0);
        let lamp = Vpl::point(place, 1.0 + i as f32).unwrap();
        lights.push(&lamp, Xi::new(1e-6).unwrap());
        let place = place.as_dvec3();
        let cosine = inverse * place.normalize();
        let intensity = f64::from(1 + i) / place.length_squared();
        sum += intensity * cosine.z.max(0.0) / cosine.length_squared().powi(2);
    }
    let expected = f64::from(lobe.amplitude()) * sum;
    let receiver = Receiver {
        position: Vec3::ZERO,
        lobe,
    };
    // With so small a δ no light is left to chance.
    let estimator = RadianceEstimator::new(&Roulette::new(1e-6).unwrap());
    let total = estimator.fold_reflected_at_points(
        &lights,
        [(receiver, &list[..])],
        0.0,
        |sum, _, _, reflected| sum + f64::from(reflected),
    );
    assert!((total / expected - 1.0).abs() < 1e-5, "{total} {expected}");

    // Seen from elsewhere it is another sum; from below there is none.
    let from = |eye| {
        GgxLobe::new(
            Ggx::new(0.3).unwrap(),
            NoFresnel,
            Incidence {
                normal: Direction::Y,
                incoming: Direction::new(eye).unwrap(),
            },
        )
    };
    for (eye, is_dark) in [(Vec3::new(3.0, 1.0, 0.0), false), (-eye, true)] {
        let receiver = Receiver {
            position: Vec3::ZERO,
            lobe: from(eye),
        };
        let mut sums = [0.0; PointBlock::LEN];
        let block = ReceiverBlock::take(&mut [receiver].into_iter()).unwrap();
        estimator.reflected_at_block(&lights, &list, &block, |_, reflected| {
            for (sum, reflected) in sums.iter_mut().zip(reflected) {
                *sum += reflected;
            }
        });
        assert_eq!(sums[0] == 0.0, is_dark, "{}", sums[0]);
        assert_eq!(sums[1..], [0.0; 15]);
    }
}
