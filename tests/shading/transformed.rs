//! Transformed cosines, which are made in lanes.

use proptest::prelude::*;
use stochastic_light_culling::{Direction, Ggx, Incidence, LtcLobe, Schlick};
use support::generators::{cases, unit_vector, up_to_one};

/// A surface that light arrives at from below now and then, and at every fifth place from straight above.
pub fn surface() -> impl Strategy<Value = (Ggx, Schlick, Incidence)> {
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
