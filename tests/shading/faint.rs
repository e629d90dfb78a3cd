//! Lights that a block leaves out since they are too faint, before it evaluates them.

use proptest::prelude::*;
use stochastic_light_culling::{
    Dielectric, Direction, GgxLobe, Lobe, LtcLobe, NoFresnel, PointBlock, RadianceEstimator,
    Roulette, ShadingBatch, Vpl, Xi, glam::Vec3,
};
use support::generators::{self, cases, log_uniform, unit_vector};

use crate::transformed::surface;

/// A point as seen from a light at the origin, the light's flux, δ, and how far ξ is from p.
#[derive(Clone, Debug)]
struct Drawn {
    way: Vec3,
    /// Below 0.4, how to choose the way.
    share: f32,
    distance: f32,
    flux: f32,
    delta: f32,
    ulps: i32,
}

fn drawn() -> impl Strategy<Value = Drawn> {
    let numbers = [
        log_uniform(1e-6, 1e6),
        log_uniform(1e-20, 1e10),
        log_uniform(1e-12, 1e9),
    ];
    (unit_vector(), 0.0..1.0_f32, numbers, -6..6_i32).prop_map(|(way, share, numbers, ulps)| {
        let [distance, flux, delta] = numbers.map(|number| number as f32);
        Drawn {
            way: way.to_f32(),
            share,
            distance,
            flux,
            delta,
            ulps,
        }
    })
}

impl Drawn {
    /// The point: in any direction, exactly in the `mirror` direction, or about as far from that as the lobe is wide.
    fn point(&self, mirror: Vec3, roughness: f32) -> Vec3 {
        let way = match self.share {
            ..0.3 => self.way,
            0.3..0.4 => mirror,
            _ => (mirror + 4.0 * roughness * self.way).normalize_or_zero(),
        };
        way * self.distance
    }

    /// Lights the point by `lobe`, with ξ as near as may be to p, at which a light begins to count.
    fn light<L: Lobe + Copy>(&self, lobe: L, point: Vec3) -> Result<(), TestCaseError> {
        let vpl = Vpl::new(Vec3::ZERO, self.flux, lobe).unwrap();
        let roulette = Roulette::new(self.delta).unwrap();
        let (direction, squared) = vpl.direction_to(point);
        let intensity = vpl.radiant_intensity(direction);
        let limit = roulette.probability(intensity, squared);
        let xi = f32::from_bits(limit.to_bits().saturating_add_signed(self.ulps).max(1));
        let Ok(xi) = Xi::new(xi) else { return Ok(()) };
        let mut batch = ShadingBatch::new();
        batch.push(&vpl, xi);
        let block = PointBlock::take(&mut std::iter::once(point.into())).unwrap();
        for lanes in [4, 8, 16] {
            let mut radiance = 0.0;
            let estimator = RadianceEstimator::new(&roulette).with_lanes(lanes);
            estimator.at_block(&batch, &[0], &block, |estimates| {
                radiance = estimates.radiance[0];
            });
            let exact = roulette.estimate(intensity, squared, xi);
            prop_assert_eq!(
                radiance.to_bits(),
                exact.to_bits(),
                "{} and {}",
                radiance,
                exact
            );
        }
        Ok(())
    }
}

fn mirror(normal: Direction, incoming: Direction) -> Vec3 {
    2.0 * normal.dot(*incoming) * *normal - *incoming
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn transformed_cosines_are_left_out_as_they_round(
        (ggx, fresnel, incidence) in surface(),
        matrix in prop::option::weighted(0.2, [0.05..3.0_f32, -2.0..2.0_f32, -2.0..2.0_f32, 0.05..3.0_f32]),
        share in 0.0..1.0_f32,
        drawn in drawn(),
    ) {
        let lobe = match matrix.map(|matrix| LtcLobe::with_matrix(matrix, share, incidence)) {
            Some(Ok(own)) => own,
            _ => LtcLobe::new(ggx, fresnel, incidence),
        };
        let mirror = mirror(incidence.normal, incidence.incoming);
        drawn.light(lobe, drawn.point(mirror, ggx.roughness()))?;
    }

    /// The narrower a lobe, the more rounding moves the image of a direction.
    #[test]
    fn narrow_transformed_cosines_are_left_out_as_they_round(
        matrix in generators::ltc_matrix(),
        (_, _, incidence) in surface(),
        image in unit_vector(),
        drawn in drawn(),
    ) {
        let lobe = LtcLobe::with_matrix(matrix, 1.0, incidence).unwrap();
        let way = lobe.inverse_matrix().inverse() * image.to_f32();
        let point = way.normalize_or_zero() * drawn.distance;
        drawn.light(lobe, point)?;
    }

    /// Where all of F, G2 and D are what the test takes them to be at most, as without a Fresnel factor along the normal,
    /// and where they are not.
    #[test]
    fn ggx_lights_are_left_out_as_they_round(
        (ggx, schlick, incidence) in surface(),
        index in 1.0..3.0_f32,
        drawn in drawn(),
    ) {
        let point = drawn.point(mirror(incidence.normal, incidence.incoming), ggx.roughness());
        let white = GgxLobe::new(ggx, NoFresnel, incidence);
        drawn.light(white, point)?;
        drawn.light(white.separable(), point)?;
        drawn.light(GgxLobe::new(ggx, schlick, incidence), point)?;
        drawn.light(GgxLobe::new(ggx, Dielectric::new(index).unwrap(), incidence), point)?;
        let along_normal = *incidence.normal * drawn.distance;
        drawn.light(white, along_normal)?;
    }
}
