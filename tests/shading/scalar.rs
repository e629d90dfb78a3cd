//! How a decision is made for one light at one receiver.

use stochastic_light_culling::{
    AtPoint, AtReceiver, Decision, InList, RadianceEstimator, Roulette, WeightedList,
};

use crate::frame::Arrival;

pub trait Scalar: Decision + Copy {
    fn estimator(roulette: &Roulette) -> RadianceEstimator<Self>;

    fn list<'l>(lights: &'l [u32], weights: &'l [f32]) -> Self::List<'l>;

    /// The estimate of the radiance of a light that counts, and of what a lobe with this `value` reflects of it.
    fn estimate(
        roulette: &Roulette,
        arrival: &Arrival,
        weight: f32,
        value: f32,
    ) -> Option<[f32; 2]>;
}

impl Scalar for AtPoint {
    fn estimator(roulette: &Roulette) -> RadianceEstimator<Self> {
        RadianceEstimator::new(roulette)
    }

    fn list<'l>(lights: &'l [u32], _: &'l [f32]) -> &'l [u32] {
        lights
    }

    fn estimate(roulette: &Roulette, arrival: &Arrival, _: f32, value: f32) -> Option<[f32; 2]> {
        let radiance = roulette.estimate(arrival.intensity, arrival.squared, arrival.xi);
        (radiance > 0.0).then_some([radiance, radiance * value])
    }
}

impl Scalar for AtReceiver {
    fn estimator(roulette: &Roulette) -> RadianceEstimator<Self> {
        RadianceEstimator::aware(roulette)
    }

    fn list<'l>(lights: &'l [u32], _: &'l [f32]) -> &'l [u32] {
        lights
    }

    fn estimate(roulette: &Roulette, arrival: &Arrival, _: f32, value: f32) -> Option<[f32; 2]> {
        let reflected = roulette.estimate(arrival.intensity * value, arrival.squared, arrival.xi);
        let radiance = (arrival.intensity / arrival.squared).max(roulette.delta() / value);
        (reflected > 0.0).then_some([radiance, reflected])
    }
}

impl Scalar for InList {
    fn estimator(_: &Roulette) -> RadianceEstimator<Self> {
        RadianceEstimator::listed()
    }

    fn list<'l>(lights: &'l [u32], weights: &'l [f32]) -> WeightedList<'l> {
        WeightedList { lights, weights }
    }

    fn estimate(_: &Roulette, arrival: &Arrival, weight: f32, value: f32) -> Option<[f32; 2]> {
        let radiance = arrival.intensity / arrival.squared * weight;
        (radiance > 0.0).then_some([radiance, radiance * value])
    }
}

/// A weight for each light of a list: of the first many, all that one could be.
pub fn weights(list: &[u32]) -> Vec<f32> {
    const ODD: [f32; 8] = [0.0, 1e-45, 1e38, f32::INFINITY, f32::NAN, -2.0, -0.0, 1.0];
    let weight = |(turn, light): (usize, &u32)| {
        let odd = ODD[(*light as usize + turn / 3) % ODD.len()];
        if turn % 3 == 0 {
            odd
        } else {
            1.0 + 0.37 * (turn as f32)
        }
    };
    list.iter().enumerate().map(weight).collect()
}
