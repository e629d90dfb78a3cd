//! Lights that are evaluated many at a time have, bit by bit, the estimates of those evaluated one by one.
#![cfg(feature = "cull")]

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Conductor, ConstantLobe, Dielectric, Direction, Estimate,
    Fresnel, Ggx, GgxLobe, Incidence, LambertLobe, Lobe, LtcLobe, MaskingShadowing, NoFresnel,
    PhongLobe, PointBlock, RadianceEstimator, Roulette, Schlick, ShadedPoint, ShadingBatch,
    SphericalGaussian, SpotLobe, Vpl, Xi, glam::Vec3,
};
use support::{
    generators::{self, Lit, cases, log_uniform, unit_vector},
    reference::Vector,
};

/// What a light is made of, whatever its lobe.
#[derive(Clone, Copy, Debug)]
struct Parts {
    position: Vec3,
    flux: f32,
    xi: Xi,
    lit: Lit,
    roughness: f32,
    /// An albedo, or a reflectance.
    share: f32,
}

impl Parts {
    fn incidence(&self) -> Incidence {
        let Lit {
            normal, incoming, ..
        } = self.lit;
        Incidence { normal, incoming }
    }

    fn ggx<F: Fresnel>(&self, fresnel: F) -> GgxLobe<F> {
        GgxLobe::new(Ggx::new(self.roughness).unwrap(), fresnel, self.incidence())
    }

    fn brushed<F: Fresnel>(&self, fresnel: F) -> AnisotropicGgxLobe<F> {
        // Now and then of the same roughness along and across.
        let across = if self.share > 0.9 {
            self.roughness
        } else {
            self.share.max(1e-3)
        };
        let ggx = AnisotropicGgx::new(self.roughness, across).unwrap();
        let tangent = Direction::new(self.lit.normal.any_orthonormal_vector()).unwrap();
        AnisotropicGgxLobe::new(ggx, fresnel, self.incidence(), tangent).unwrap()
    }

    fn conductor(&self) -> Conductor {
        Conductor::new(0.1 + self.share, 3.0).unwrap()
    }
}

/// Often ordinary, now and then at an end of its range: dark, blinding, lit from behind, and narrow.
fn parts() -> impl Strategy<Value = Parts> {
    let position = prop_oneof![
        20 => generators::position(),
        1 => Just(Vec3::splat(3e38)),
    ];
    let flux = prop_oneof![
        20 => log_uniform(1e-6, 1e6).prop_map(|x| x as f32),
        1 => Just(0.0),
        1 => Just(f32::from_bits(1)),
        1 => Just(f32::MAX),
    ];
    let xi = prop_oneof![
        10 => log_uniform(2.3e-10, 1.0).prop_map(|x| x as f32),
        1 => Just(1.0),
        1 => Just(f32::from_bits(1)),
    ];
    let lit = prop_oneof![
        20 => generators::lit(),
        1 => generators::lit().prop_map(|lit| Lit { incoming: -lit.incoming, ..lit }),
        1 => generators::lit().prop_map(|lit| Lit { incoming: lit.normal, ..lit }),
    ];
    let roughness = prop_oneof![
        20 => generators::roughness(),
        1 => Just(Ggx::MIN_ROUGHNESS),
    ];
    let share = prop_oneof![20 => 0.0..=1.0_f32, 1 => Just(0.0), 1 => Just(1.0)];
    (position, flux, xi, lit, roughness, share).prop_map(
        |(position, flux, xi, lit, roughness, share)| Parts {
            position,
            flux,
            xi: Xi::new(xi).unwrap(),
            lit,
            roughness,
            share,
        },
    )
}

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
struct Frame {
    roulette: Roulette,
    least_distance_squared: f32,
    lights: Vec<Parts>,
    points: Vec<ShadedPoint>,
    /// Lights again and again, in any order.
    list: Vec<u32>,
}

fn frame() -> impl Strategy<Value = Frame> {
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
fn bits(point: usize, estimate: &Estimate) -> (usize, u32, [u32; 6]) {
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

type Accepted = Vec<(usize, u32, [u32; 6])>;

impl Frame {
    /// What the point accepts of `list`, by scalar functions.
    fn scalar<L: Lobe>(&self, lights: &[(Vpl<L>, Xi)], point: usize, list: &[u32]) -> Accepted {
        let ShadedPoint {
            position, normal, ..
        } = self.points[point];
        let mut accepted = Vec::new();
        for i in list {
            let (light, xi) = &lights[*i as usize];
            if normal.dot(position - light.position()) > 0.0 {
                continue;
            }
            let (direction, squared) = light.direction_to(position);
            let squared = if squared < self.least_distance_squared {
                self.least_distance_squared
            } else {
                squared
            };
            let intensity = light.radiant_intensity(direction);
            let radiance = self.roulette.estimate(intensity, squared, *xi);
            let accepts = self.roulette.accepts(intensity, squared, *xi);
            assert_eq!(accepts, radiance > 0.0, "{intensity} {squared} {xi:?}");
            if accepts {
                let (x, y, z) = direction.into();
                let numbers = [radiance, intensity, squared, x, y, z];
                accepted.push((point, *i, numbers.map(f32::to_bits)));
            }
        }
        accepted
    }

    /// Whether vectors of every width find what scalar functions find.
    fn same<L: Lobe + Copy>(&self, lobe: impl Fn(&Parts) -> L) -> Result<usize, TestCaseError> {
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
        let list_of = |point: usize| &self.list[..(point * 7) % (self.list.len() + 1)];
        let points = 0..self.points.len();
        let expected: Accepted = points
            .clone()
            .flat_map(|i| self.scalar(&lights, i, list_of(i)))
            .collect();
        let shared: Vec<Accepted> = points
            .clone()
            .map(|i| self.scalar(&lights, i, &self.list))
            .collect();

        for lanes in [16, 8, 4] {
            let estimator = RadianceEstimator::new(&self.roulette)
                .with_lanes(lanes)
                .with_least_distance_squared(self.least_distance_squared)
                .unwrap();
            let mut found = Vec::new();
            let lists = points.clone().map(|i| (self.points[i], list_of(i)));
            estimator.at_points(&batch, lists, |i, estimate| found.push(bits(i, estimate)));
            prop_assert_eq!(&found, &expected, "{} lanes, by lights", lanes);

            let mut found = vec![Vec::new(); self.points.len()];
            let mut rest = self.points.iter().copied();
            let mut start = 0;
            while let Some(block) = PointBlock::take(&mut rest) {
                estimator.at_block(&batch, &self.list, &block, |estimates| {
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

    fn same_ggx<F: Fresnel>(&self, fresnel: impl Fn(&Parts) -> F) -> Result<(), TestCaseError> {
        self.same(|light| light.ggx(fresnel(light)))?;
        self.same(|light| light.ggx(fresnel(light)).separable())?;
        self.same(|light| light.brushed(fresnel(light)))?;
        Ok(())
    }
}

/// A lobe that the crate does not know: a cosine within a window.
#[derive(Clone, Copy)]
struct Windowed(Direction);

impl Lobe for Windowed {
    fn value(&self, outgoing: Vec3) -> f32 {
        let cosine = self.0.dot(outgoing);
        if cosine > 0.5 { cosine } else { 0.0 }
    }
}

/// A Fresnel factor and a masking function of a caller's own.
#[derive(Clone, Copy)]
struct Coat(f32);

impl Fresnel for Coat {
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        self.0.max(0.04 + 0.96 * (1.0 - half_angle_cosine).powi(5))
    }
}

#[derive(Clone, Copy)]
struct MaskedAlone;

impl MaskingShadowing for MaskedAlone {
    fn over_four_incident_cosines(cosine: f32, root: f32, _: f32, _: f32) -> f32 {
        0.5 / (cosine + root)
    }
}

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
        let expected = (0..64).flat_map(|i| frame.scalar(&lights, i, &[0]));
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
