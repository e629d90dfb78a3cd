//! The evaluation of one cluster at one point, in each lane.

use fearless_simd::{Simd, SimdMask};

use super::kernel::{Evaluated, Frame, Lights, Points, ShadedLight};
use crate::light::{Vsgl, Vsgls};
use crate::num::{F32Lanes, Real, Vector3};

impl ShadedLight for Vsgl {
    #[inline(always)]
    fn lines() -> usize {
        1
    }

    /// E is that of scalar code, and counts as the intensity of a light at unit distance. A cluster is not accepted
    /// where its light arrives from below the point's horizon.
    #[inline(always)]
    fn evaluate<'a, S: Simd>(
        frame: &Frame,
        lights: &Lights<F32Lanes<S>>,
        _: impl Fn(usize) -> Option<&'a Self>,
        points: &Points<F32Lanes<S>>,
    ) -> Option<Evaluated<S>> {
        let [x, y, z, sharpness, spread, ..] = lights.numbers;
        let clusters = Vsgls {
            position: lights.position,
            spread,
            axis: Vector3::new(x, y, z),
            sharpness,
            amplitude: lights.flux,
        };
        let incoming = clusters.incoming(points.position);
        let irradiance = incoming.scalar_irradiance;
        let one = irradiance.splat(1.0);
        let is_above = !points.normal.dot(-incoming.axis).is_positive();
        let is_accepted = frame.roulette.accepts_in_lanes(irradiance, one, lights.xi);
        let accepted = is_above & is_accepted;
        if !accepted.any_true() {
            return None;
        }
        let radiance = frame.roulette.accepted_radiance(irradiance, one);
        Some(Evaluated {
            accepted: accepted.to_bitmask() as u32,
            radiance: F32Lanes::select(accepted, radiance, radiance.zero()),
            intensity: irradiance,
            distance_squared: one,
            direction: -incoming.axis,
            sharpness: Some(incoming.sharpness),
        })
    }
}
