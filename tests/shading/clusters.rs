//! Clusters that count by what a receiver reflects of them, or by their weight in a list.

use std::collections::BTreeMap;

use stochastic_light_culling::{
    AtReceiver, Direction, Ggx, GgxLobe, InList, Incidence, LambertLobe, Lobe, Receiver,
    ReceiverBlock, Roulette, Schlick, Seed, ShadingBatch, SphericalGaussian, Vsgl, Xi, glam::Vec3,
};

use crate::scalar::Scalar;

/// The bits of what a receiver reflects of a light.
type Found = BTreeMap<(usize, u32), u32>;

fn random(i: u32, k: u32) -> f32 {
    2.0 * Seed(12).frame(k).hashed_xi(i).get() - 1.0
}

fn cluster(i: u32) -> (Vsgl, Xi) {
    let axis = Vec3::new(random(i, 0), random(i, 1) - 1.0, random(i, 2));
    let (axis, sharpness) = (Direction::new(axis).unwrap(), [0.0, 2.0, 40.0, 3000.0]);
    let lobe = SphericalGaussian::with_integral(axis, sharpness[i as usize % 4], 0.3).unwrap();
    let position = Vec3::new(3.0 * random(i, 3), 1.5 + random(i, 4), 3.0 * random(i, 5));
    let cluster = Vsgl::new(position, 0.4 * (1.0 + random(i, 6)), lobe).unwrap();
    (cluster, Seed(3).frame(0).hashed_xi(i))
}

/// What the receivers reflect of the lights, the same for both ways and any width.
fn reflected<D: Scalar, R: Lobe + Copy>(
    roulette: &Roulette,
    lights: &[(Vsgl, Xi)],
    weights: &[f32],
    receivers: &[Receiver<R>],
) -> Found {
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|(light, xi)| (light, *xi)));
    let all: Vec<u32> = (0..lights.len() as u32).collect();
    let list = D::list(&all, weights);
    let mut ways = Vec::new();
    for lanes in [16, 8, 4] {
        let estimator = D::estimator(roulette).with_lanes(lanes);
        let lists = receivers.iter().map(|receiver| (*receiver, list));
        let found = Found::new();
        ways.push(estimator.fold_reflected_at_points(
            &batch,
            lists,
            found,
            |mut found, i, of, c| {
                found.insert((i, of.light), c.to_bits());
                found
            },
        ));
        let block = ReceiverBlock::take(&mut receivers.iter().copied()).unwrap();
        let mut found = Found::new();
        estimator.reflected_at_block(&batch, list, &block, |of, reflected| {
            let accepted = of
                .iter()
                .map(|(i, _)| ((i, of.light), reflected[i].to_bits()));
            found.extend(accepted);
        });
        ways.push(found);
    }
    assert!(ways.iter().all(|way| *way == ways[0]));
    ways.swap_remove(0)
}

/// Compares that with what `estimate` makes of the product of arriving light and lobe. Returns how many of 1024 pairs
/// reflect.
fn check<D: Scalar, R: Lobe + Copy>(
    lobe: impl Fn(Incidence) -> R,
    product_integral: impl Fn(&R, &SphericalGaussian) -> f32,
    estimate: impl Fn(f32, Xi, f32) -> f32,
) -> u32 {
    let lights: Vec<_> = (0..64).map(cluster).collect();
    let weights: Vec<f32> = (0..64).map(|i| 1.5 + random(i, 9)).collect();
    let receiver = |i: u32| {
        let position = Vec3::new(
            2.0 * random(i, 20),
            0.3 * random(i, 21),
            2.0 * random(i, 22),
        );
        let incoming = Direction::new(Vec3::new(random(i, 23), 1.0, random(i, 24))).unwrap();
        let normal = Direction::Y;
        Receiver {
            position,
            lobe: lobe(Incidence { normal, incoming }),
        }
    };
    let receivers: Vec<_> = (0..16).map(receiver).collect();
    let roulette = Roulette::new(DELTA).unwrap();
    let found = reflected::<D, R>(&roulette, &lights, &weights, &receivers);
    let mut counted = 0;
    for (i, Receiver { position, lobe }) in receivers.iter().enumerate() {
        for (light, (cluster, xi)) in (0..).zip(&lights) {
            let incoming = cluster.incoming(*position);
            let product = if incoming.axis().y >= 0.0 {
                product_integral(lobe, &incoming)
            } else {
                0.0
            };
            let [least, most] = [1.0 - 1e-5, 1.0 + 1e-5]
                .map(|factor| estimate(factor * product, *xi, weights[light as usize]));
            let bits = found.get(&(i, light)).copied().unwrap_or_default();
            let reflected = f32::from_bits(bits);
            // A product of subnormal numbers has few digits.
            let [least, most] = [least - f32::MIN_POSITIVE, most + f32::MIN_POSITIVE];
            assert!(
                least <= reflected && reflected <= most,
                "{least} {reflected} {most}"
            );
            counted += u32::from(reflected > 0.0);
        }
    }
    counted
}

const DELTA: f32 = 3e-4;

fn glossy(incidence: Incidence) -> GgxLobe<Schlick> {
    GgxLobe::new(
        Ggx::new(0.2).unwrap(),
        Schlick::new(0.3).unwrap(),
        incidence,
    )
}

fn dull(incidence: Incidence) -> LambertLobe {
    LambertLobe::new(0.8, incidence.normal).unwrap()
}

#[test]
fn clusters_count_by_what_is_reflected() {
    let roulette = Roulette::new(DELTA).unwrap();
    let estimate = |product, xi, _| roulette.estimate(product, 1.0, xi);
    let glossy = check::<AtReceiver, _>(glossy, GgxLobe::product_integral, estimate);
    let dull = check::<AtReceiver, _>(dull, LambertLobe::product_integral, estimate);
    assert!(
        (50..900).contains(&glossy) && (100..900).contains(&dull),
        "{glossy} {dull}"
    );
}

#[test]
fn clusters_count_by_their_weight() {
    let estimate = |product: f32, _, weight| product * weight;
    let glossy = check::<InList, _>(glossy, GgxLobe::product_integral, estimate);
    let dull = check::<InList, _>(dull, LambertLobe::product_integral, estimate);
    assert!(glossy > 500 && dull > 500, "{glossy} {dull}");
}
