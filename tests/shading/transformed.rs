//! Transformed cosines, which are made in lanes, and of which a block leaves out those that are too faint before it
//! evaluates them.

use proptest::prelude::*;
use stochastic_light_culling::{
    Direction, Ggx, Incidence, LtcLobe, PointBlock, RadianceEstimator, Roulette, Schlick,
    ShadingBatch, Vpl, Xi, glam::Vec3,
};
use support::generators::{cases, log_uniform, unit_vector, up_to_one};

/// A surface that light arrives at from below now and then, and at every fifth place from straight above.
fn surface() -> impl Strategy<Value = (Ggx, Schlick, Incidence)> {
    let angle = prop_oneof![4 => 0.0..1.7_f32, 1 => Just(0.0)];
    (up_to_one(1e-6), 0.0..=1.0_f32, unit_vector(), angle).prop_map(|(alpha, f0, normal, angle)| {
        let normal = Direction::new(normal.to_f32()).unwrap();
        let across = normal.any_orthonormal_vector();
        let incoming = *normal * angle.cos() + across * angle.sin();
        let incoming = if angle == 0.0 {
            normal
        } else {
            Direction::new(incoming).unwrap()
        };
        (
            Ggx::new(alpha).unwrap(),
            Schlick::new(f0).unwrap(),
            Incidence { normal, incoming },
        )
    })
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn made_in_lanes_they_are_the_same(surfaces in prop::collection::vec(surface(), 0..40)) {
        let many: Vec<_> = LtcLobe::many(surfaces.iter().copied()).collect();
        let one_by_one = surfaces.iter().map(|(ggx, fresnel, lit)| LtcLobe::new(*ggx, *fresnel, *lit));
        prop_assert_eq!(many, one_by_one.collect::<Vec<_>>());
    }
}

proptest! {
    #![proptest_config(cases(20_000))]

    /// With ξ as near as may be to p, at which a light begins to count.
    #[test]
    fn faint_ones_are_left_out_as_they_round(
        (ggx, fresnel, incidence) in surface(),
        matrix in prop::option::weighted(0.2, [0.05..3.0_f32, -2.0..2.0_f32, -2.0..2.0_f32, 0.05..3.0_f32]),
        way in unit_vector(),
        share in 0.0..1.0_f32,
        [distance, flux, delta] in [log_uniform(1e-6, 1e6), log_uniform(1e-20, 1e10), log_uniform(1e-12, 1e9)],
        ulps in -6..6_i32,
    ) {
        let lobe = match matrix.map(|matrix| LtcLobe::with_matrix(matrix, share, incidence)) {
            Some(Ok(own)) => own,
            _ => LtcLobe::new(ggx, fresnel, incidence),
        };
        // In any direction, or about as far from the mirror direction as the lobe is wide.
        let (n, w) = (*incidence.normal, *incidence.incoming);
        let mirror = 2.0 * n.dot(w) * n - w;
        let way = way.to_f32();
        let way = if share < 0.3 { way } else { (mirror + 4.0 * ggx.roughness() * way).normalize_or_zero() };
        let [distance, flux, delta] = [distance, flux, delta].map(|x| x as f32);
        let point = way * distance;
        let vpl = Vpl::new(Vec3::ZERO, flux, lobe).unwrap();
        let roulette = Roulette::new(delta).unwrap();
        let (direction, squared) = vpl.direction_to(point);
        let intensity = vpl.radiant_intensity(direction);
        let limit = roulette.probability(intensity, squared);
        let xi = f32::from_bits(limit.to_bits().saturating_add_signed(ulps).max(1));
        let Ok(xi) = Xi::new(xi) else { return Ok(()) };
        let mut batch = ShadingBatch::new();
        batch.push(&vpl, xi);
        let block = PointBlock::take(&mut std::iter::once(point.into())).unwrap();
        for lanes in [4, 8, 16] {
            let mut radiance = 0.0;
            let estimator = RadianceEstimator::new(&roulette).with_lanes(lanes);
            estimator.at_block(&batch, &[0], &block, |estimates| radiance = estimates.radiance[0]);
            let exact = roulette.estimate(intensity, squared, xi);
            prop_assert_eq!(radiance.to_bits(), exact.to_bits(), "{} and {}", radiance, exact);
        }
    }
}
