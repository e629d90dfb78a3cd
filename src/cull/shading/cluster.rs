//! What a cluster sends to a point, in each lane.

use fearless_simd::Simd;

use super::kernel::{Arriving, Lights, Points, ShadedLight};
use crate::light::{Vsgl, Vsgls};
use crate::num::{F32Lanes, Real, Vector3};

impl ShadedLight for Vsgl {
    #[inline(always)]
    fn lines() -> usize {
        1
    }

    /// E is that of scalar code, and counts as the intensity of a light at unit distance. A cluster does not arrive
    /// where its axis is below the point's horizon.
    #[inline(always)]
    fn arriving<'a, S: Simd>(
        _: f32,
        _: Option<F32Lanes<S>>,
        lights: &Lights<F32Lanes<S>>,
        _: impl Fn(usize) -> Option<&'a Self>,
        points: &Points<F32Lanes<S>>,
    ) -> Option<Arriving<S>> {
        let [x, y, z, sharpness, spread, ..] = lights.numbers;
        let clusters = Vsgls {
            position: lights.position,
            spread,
            axis: Vector3::new(x, y, z),
            sharpness,
            amplitude: lights.flux,
        };
        let incoming = clusters.incoming(points.position);
        let intensity = incoming.scalar_irradiance;
        Some(Arriving {
            may_be_lit: !points.normal.dot(-incoming.axis).is_positive(),
            intensity,
            distance_squared: intensity.splat(1.0),
            direction: -incoming.axis,
            sharpness: Some(incoming.sharpness),
        })
    }
}
