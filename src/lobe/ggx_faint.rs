//! Whether a light with a [`GgxLobe`](super::GgxLobe) is too faint, without its value.
//!
//! With w = lω, the way from the light, and h = lω_i + w, which is l times the half vector of the lobe, D is α²‖h‖⁴ over
//! π(α²(h·n)² + ‖h × n‖²)². F is at most 1, and G2/(4μ) at most G1(μ)/(4μ). So no quotient is left in Φv/l² < `least`.

use core::f32::consts::FRAC_2_PI;

use super::GgxLobes;
use crate::num::{Single, UNIT_ROUNDOFF, Vector3};

/// Budget for ‖h‖² and for the squares of which D is made, in units of u l².
const SQUARE_ROUNDINGS: f32 = 192.0;
/// Less than ((1 − η)/(1 + η))² = 0.984, η = 2⁻⁸, to pay for all else that is rounded.
const LEFT_OF_SQUARES: f32 = 0.97;
/// The squared distances that the test takes, from 2⁻³⁸ to 2³⁸, and the δξ, from 2⁻⁶⁰ to 2⁴⁰. So neither side loses
/// digits to underflow, nor does the value.
const SQUARED_DISTANCES: [f32; 2] = [3.637_979e-12, 2.748_779e11];
const RADIANCES: [f32; 2] = [8.673_617_4e-19, 1.099_511_6e12];
/// Is far above what Φα² loses to underflow, and far below all that counts: 2⁻¹²⁰.
const LEAST_FACTOR: f32 = 7.523_164e-37;
/// What the greater side exceeds at least: 2⁻⁸⁰.
const LEAST_PRODUCT: f32 = 8.271_806e-25;

impl<N: Single> GgxLobes<N> {
    /// Whether Φv(ω)/l² is below `least` at the end of `way`, also as [`value`](Self::value) rounds, whatever F and G2.
    ///
    /// ‖h‖² is 2l(l + ω_i·w), and ‖h × n‖² is ‖h‖² − (h·n)². The difference cancels where α is small: it is taken to be
    /// less by all that rounding may have added, and the test holds for fewer lights.
    #[inline(always)]
    pub fn is_fainter(&self, flux: N, way: Vector3<N>, length_squared: N, least: N) -> N::Mask {
        let alpha = self.roughness;
        let length = length_squared.sqrt();
        let half = (self.incoming.near_dot(way) + length) * length;
        let cosine = (self.incident_cosine).times_plus(length, self.normal.near_dot(way));
        let error = length_squared * (SQUARE_ROUNDINGS * UNIT_ROUNDOFF);
        let square = half + error;
        let k = alpha.one_minus() * (alpha + 1.0);
        let spread = (-(cosine * k)).times_plus(cosine, half + half - error);
        let factor = flux * (alpha * alpha * FRAC_2_PI) + LEAST_FACTOR;
        let product = (square * factor).times_plus(square, alpha.splat(LEAST_PRODUCT));
        let masking = (self.incident_cosine + self.incident_root) * LEFT_OF_SQUARES;
        // Overflows only above all that is compared.
        let scaled = spread * (length_squared * (least * masking)) * spread.abs();
        let is_in_range =
            is_between(length_squared, SQUARED_DISTANCES) & is_between(least, RADIANCES);
        is_in_range & scaled.gt(product)
    }
}

/// False for NaN.
#[inline(always)]
fn is_between<N: Single>(number: N, [least, greatest]: [f32; 2]) -> N::Mask {
    number.gt(number.splat(least)) & number.le(number.splat(greatest))
}

#[cfg(all(test, feature = "cull"))]
mod tests {
    use super::super::lanes_tests::Random;
    use super::super::{Ggx, GgxLobe, Incidence, Lobe, NoFresnel};
    use super::*;
    use crate::base::Direction;

    /// G2 is no less than G1(μ)/√2 where μ_o ≥ α. So without a Fresnel factor the test is loose by less than half.
    #[test]
    fn holds_for_lights_that_are_half_as_faint_again() {
        let (mut random, mut held) = (Random(7), 0);
        for _ in 0..10_000 {
            let (incidence, alpha) = (random.incidence(), random.roughness().max(0.03));
            let lobe = GgxLobe::new(Ggx::new(alpha).expect("in range"), NoFresnel, incidence);
            let outgoing = *random.direction();
            let value = lobe.value(outgoing);
            let distance = 100.0 * random.number() + 0.01;
            let squared = distance * distance;
            if value > 0.0 && outgoing.dot(*incidence.normal) >= alpha {
                let (way, flux) = (Vector3::from(outgoing) * distance, 3.0);
                let fainter = |times: f32| {
                    let least = times * (flux * value / squared);
                    lobe.lanes().is_fainter(flux, way, squared, least)
                };
                assert!(fainter(1.6) && !fainter(1.0), "{lobe:?} {outgoing}");
                held += 1;
            }
        }
        assert!(held > 1000, "{held}");
    }

    #[test]
    fn holds_for_no_light_out_of_range() {
        let (lit, up) = (
            Incidence::head_on(Direction::Z),
            Vector3::new(0.0, 0.0, 1.0),
        );
        let lobe = GgxLobe::new(Ggx::new(0.1).expect("in range"), NoFresnel, lit).lanes();
        let fainter = |distance: f32, flux: f32, least: f32| {
            lobe.is_fainter(flux, up * distance, distance * distance, least)
        };
        assert!(fainter(1.0, 1e-9, 1.0) && fainter(1e5, 1e-9, 1.0));
        for distance in [0.0, 1e-7, 1e7, f32::INFINITY, f32::NAN] {
            assert!(!fainter(distance, 1e-9, 1.0), "{distance}");
        }
        for least in [0.0, 1e-20, 1e20, f32::INFINITY, f32::NAN] {
            assert!(!fainter(1.0, 0.0, least), "{least}");
        }
        assert!(!fainter(1.0, f32::MAX, 1.0) && !fainter(1.0, f32::NAN, 1.0));
    }
}
