//! Lights, points and lists at random, and the comparison of their estimates with those of one light at a time.

use proptest::prelude::*;
use stochastic_light_culling::{
    AtPoint, Estimate, Fresnel, Lobe, PointBlock, PointDecision, Roulette, ShadedPoint,
    ShadingBatch, Vpl, Xi, glam::Vec3,
};
use support::{
    generators::{Lit, log_uniform, unit_vector},
    parts::{Parts, parts},
    reference::Vector,
};

use crate::scalar::{Scalar, weights};

/// Where a point is, seen from a light.
#[derive(Clone, Copy, Debug)]
enum Place {
    AtLight,
    /// Along the light's mirror direction, its tangent, its normal or any direction, with a distance.
    Along(usize, Vec3, f32),
    /// At the light's horizon, above or below by a share of the distance.
    Grazing(f32, f32),
    Anywhere(Vec3),
}

#[derive(Clone, Copy, Debug)]
struct Point {
    light: usize,
    place: Place,
    /// None for a point that is lit from all sides, `Err` for one that the light only grazes.
    normal: Option<Result<Vec3, ()>>,
}

impl Point {
    fn of(&self, lights: &[Parts]) -> ShadedPoint {
        let origin = Parts {
            position: Vec3::ZERO,
            flux: 1.0,
            xi: Xi::new(1.0).unwrap(),
            lit: Lit::new(Vector([0.0, 0.0, 1.0]), Vector([0.0, 0.6, 0.8])),
            roughness: 1.0,
            share: 1.0,
        };
        let light = if lights.is_empty() {
            &origin
        } else {
            &lights[self.light % lights.len()]
        };
        let (normal, incoming) = (*light.lit.normal, *light.lit.incoming);
        let tangent = normal.any_orthonormal_vector();
        let position = match self.place {
            Place::AtLight => light.position,
            Place::Along(0, _, distance) => {
                light.position + distance * (2.0 * normal.dot(incoming) * normal - incoming)
            }
            Place::Along(1, _, distance) => light.position + distance * normal,
            Place::Along(_, way, distance) => light.position + distance * way,
            Place::Grazing(distance, height) => {
                light.position + distance * (tangent + height * normal)
            }
            Place::Anywhere(position) => position,
        };
        let normal = match self.normal {
            None => Vec3::ZERO,
            Some(Ok(normal)) => normal,
            Some(Err(())) => (position - light.position).any_orthogonal_vector(),
        };
        ShadedPoint { position, normal }
    }
}

fn point() -> impl Strategy<Value = Point> {
    let distance = || {
        prop_oneof![
            6 => log_uniform(1e-2, 1e2),
            1 => log_uniform(1e-25, 1e25),
        ]
        .prop_map(|x| x as f32)
    };
    let number = prop_oneof![
        Just(f32::NAN),
        Just(f32::INFINITY),
        Just(-3e38_f32),
        Just(1e-40_f32),
        -10.0..10.0_f32,
    ];
    let anywhere = [number.clone(), number.clone(), number].prop_map(Vec3::from_array);
    let way = || unit_vector().prop_map(Vector::to_f32);
    let height = (log_uniform(1e-9, 1e-3), any::<bool>()).prop_map(|(height, is_above)| {
        if is_above {
            height as f32
        } else {
            -height as f32
        }
    });
    let place = prop_oneof![
        1 => Just(Place::AtLight),
        10 => (0..4_usize, way(), distance())
            .prop_map(|(which, way, distance)| Place::Along(which, way, distance)),
        3 => (distance(), height).prop_map(|(distance, height)| Place::Grazing(distance, height)),
        1 => anywhere.prop_map(Place::Anywhere),
    ];
    let normal = prop_oneof![
        3 => Just(None),
        2 => way().prop_map(|normal| Some(Ok(normal))),
        1 => Just(Some(Err(()))),
    ];
    (any::<usize>(), place, normal).prop_map(|(light, place, normal)| Point {
        light,
        place,
        normal,
    })
}

#[derive(Clone, Debug)]
pub struct Frame {
    pub roulette: Roulette,
    pub least_distance_squared: f32,
    pub lights: Vec<Parts>,
    pub points: Vec<ShadedPoint>,
    /// Lights again and again, in any order.
    pub list: Vec<u32>,
}

pub fn frame() -> impl Strategy<Value = Frame> {
    let delta = prop_oneof![
        10 => log_uniform(1e-6, 1e3).prop_map(|x| x as f32),
        1 => Just(f32::from_bits(1)),
        1 => Just(f32::MAX),
    ];
    let least = prop_oneof![3 => Just(0.0), 1 => Just(1e-4), 1 => Just(1e4_f32)];
    let lights = prop::collection::vec(parts(), 0..24);
    let points = prop::collection::vec(point(), 0..40);
    let list = prop::collection::vec(any::<u32>(), 0..70);
    (delta, least, lights, points, list).prop_map(|(delta, least, lights, points, list)| Frame {
        roulette: Roulette::new(delta).unwrap(),
        least_distance_squared: least,
        points: points.iter().map(|point| point.of(&lights)).collect(),
        list: if lights.is_empty() {
            Vec::new()
        } else {
            list.iter().map(|i| i % lights.len() as u32).collect()
        },
        lights,
    })
}

/// A light that a point accepts, and the bits of all numbers.
pub fn bits(point: usize, estimate: &Estimate) -> (usize, u32, [u32; 6]) {
    let Vec3 { x, y, z } = estimate.direction;
    let numbers = [
        estimate.radiance,
        estimate.intensity,
        estimate.distance_squared,
        x,
        y,
        z,
    ];
    (point, estimate.light, numbers.map(f32::to_bits))
}

pub type Accepted = Vec<(usize, u32, [u32; 6])>;

/// What a light sends to a point.
pub struct Arrival {
    /// The place of the light in the list.
    pub turn: usize,
    light: u32,
    pub xi: Xi,
    pub intensity: f32,
    /// The squared distance, or the least one.
    pub squared: f32,
    pub direction: Vec3,
}

impl Arrival {
    /// As `bits` gives the estimate `radiance` of it.
    pub fn bits(&self, point: usize, radiance: f32) -> (usize, u32, [u32; 6]) {
        let [x, y, z] = self.direction.to_array();
        let numbers = [radiance, self.intensity, self.squared, x, y, z];
        (point, self.light, numbers.map(f32::to_bits))
    }
}

impl Frame {
    /// What each light of `list` sends to the point, by scalar functions, but for those below its horizon.
    pub fn arrivals<'l, L: Lobe>(
        &'l self,
        lights: &'l [(Vpl<L>, Xi)],
        point: ShadedPoint,
        list: &'l [u32],
    ) -> impl Iterator<Item = Arrival> + 'l {
        let ShadedPoint { position, normal } = point;
        let above = move |i: &u32| {
            let way = position - lights[*i as usize].0.position();
            let is_below = normal.dot(way) > 0.0;
            !is_below
        };
        (0..)
            .zip(list)
            .filter(move |(_, i)| above(i))
            .map(move |(turn, i)| {
                let (light, xi) = &lights[*i as usize];
                let (direction, squared) = light.direction_to(position);
                Arrival {
                    turn,
                    light: *i,
                    xi: *xi,
                    intensity: light.radiant_intensity(direction),
                    squared: if squared < self.least_distance_squared {
                        self.least_distance_squared
                    } else {
                        squared
                    },
                    direction,
                }
            })
    }

    /// What the point accepts of `list` with these `weights`, by scalar functions.
    pub fn scalar<D: Scalar, L: Lobe>(
        &self,
        lights: &[(Vpl<L>, Xi)],
        point: usize,
        list: &[u32],
        weights: &[f32],
    ) -> Accepted {
        let arrivals = self.arrivals(lights, self.points[point], list);
        let accepted = arrivals.filter_map(|arrival| {
            let weight = weights[arrival.turn];
            let [radiance, _] = D::estimate(&self.roulette, &arrival, weight, 1.0)?;
            Some(arrival.bits(point, radiance))
        });
        accepted.collect()
    }

    /// Whether vectors of every width find what scalar functions find.
    pub fn same<L: Lobe + Copy>(&self, lobe: impl Fn(&Parts) -> L) -> Result<usize, TestCaseError> {
        self.same_by::<AtPoint, L>(lobe)
    }

    /// Whether they do with any way to decide.
    pub fn same_by<D: Scalar + PointDecision, L: Lobe + Copy>(
        &self,
        lobe: impl Fn(&Parts) -> L,
    ) -> Result<usize, TestCaseError> {
        let light = |p: &Parts| (Vpl::new(p.position, p.flux, lobe(p)).unwrap(), p.xi);
        let lights: Vec<_> = self.lights.iter().map(light).collect();
        let mut batch = ShadingBatch::new();
        // Twice, for what the first leaves behind; then with ξ of its own.
        for _ in 0..2 {
            batch.clear();
            batch.extend(
                lights
                    .iter()
                    .map(|(light, _)| (light, Xi::new(0.5).unwrap())),
            );
        }
        for (i, (_, xi)) in (0..).zip(&lights) {
            batch.set_xi(i, *xi);
        }
        prop_assert_eq!(batch.len(), lights.len());

        // A list for each point: from none to all lights.
        let weights = weights(&self.list);
        let len_of = |point: usize| (point * 7) % (self.list.len() + 1);
        let points = 0..self.points.len();
        let accepted = |i, len| self.scalar::<D, L>(&lights, i, &self.list[..len], &weights[..len]);
        let expected: Accepted = points
            .clone()
            .flat_map(|i| accepted(i, len_of(i)))
            .collect();
        let shared: Vec<Accepted> = points
            .clone()
            .map(|i| accepted(i, self.list.len()))
            .collect();
        let list_of = |len: usize| D::list(&self.list[..len], &weights[..len]);

        for lanes in [16, 8, 4] {
            let estimator = D::estimator(&self.roulette)
                .with_lanes(lanes)
                .with_least_distance_squared(self.least_distance_squared)
                .unwrap();
            let mut found = Vec::new();
            let lists = points.clone().map(|i| (self.points[i], list_of(len_of(i))));
            estimator.at_points(&batch, lists, |i, estimate| found.push(bits(i, estimate)));
            prop_assert_eq!(&found, &expected, "{} lanes, by lights", lanes);

            let mut found = vec![Vec::new(); self.points.len()];
            let mut rest = self.points.iter().copied();
            let mut start = 0;
            while let Some(block) = PointBlock::take(&mut rest) {
                let list = list_of(self.list.len());
                estimator.at_block(&batch, list, &block, |estimates| {
                    assert_ne!(estimates.accepted, 0);
                    for i in 0..PointBlock::LEN {
                        let accepted = estimates.accepted >> i & 1 != 0;
                        assert_eq!(accepted, estimates.radiance[i] > 0.0);
                        assert!(accepted || estimates.radiance[i].to_bits() == 0);
                    }
                    for (i, estimate) in estimates.iter() {
                        found[start + i].push(bits(start + i, &estimate));
                    }
                });
                start += block.len();
            }
            prop_assert_eq!(&found, &shared, "{} lanes, by points", lanes);
        }
        Ok(expected.len())
    }

    pub fn same_ggx<F: Fresnel>(&self, fresnel: impl Fn(&Parts) -> F) -> Result<(), TestCaseError> {
        self.same(|light| light.ggx(fresnel(light)))?;
        self.same(|light| light.ggx(fresnel(light)).separable())?;
        self.same(|light| light.brushed(fresnel(light)))?;
        Ok(())
    }
}
