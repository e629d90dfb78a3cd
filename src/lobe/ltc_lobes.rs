//! The value of an [`LtcLobe`](super::LtcLobe), for one lobe in each lane.

use super::{FIRST_NUMBERS, LobeNumbers};
use crate::num::{Real, Single, UNIT_ROUNDOFF, Vector3};

/// Budget for the images of a direction and of a way along it, in units of u times the norm of M⁻¹: 18, times
/// (η(1 − η))^(−½), η = 2⁻⁸.
const IMAGE_ROUNDINGS: f64 = 306.0;
/// (1 − η)², and the same again to pay for all else that is rounded.
const LEFT_OF_FOURTH_POWER: f32 = 0.98;
/// The least and the largest norm of M⁻¹ that the test of faint lights takes, and the largest reciprocal of a squared
/// ‖M⁻¹ω‖, alone and times the amplitude: 2¹² and 2⁴⁰.
const NORMS: [f64; 2] = [0.1, 4096.0];
const LARGEST_PEAK: f64 = 1_099_511_627_776.0;
/// The least δξ that it takes, and the least product over (Φ + 1)²: 2⁻⁶⁰. So neither side loses digits to underflow, nor
/// does the value.
const LEAST: f32 = 8.673_617_4e-19;
/// Is far above what ΦA loses to underflow, and far below all that counts: 2⁻¹²⁰.
const LEAST_FACTOR: f32 = 7.523_164e-37;

/// How many numbers a lobe has.
pub(crate) const LTC_NUMBERS: usize = 11;
/// With more, a light would take a second cache line.
const _: () = assert!(LTC_NUMBERS <= FIRST_NUMBERS);

/// An [`LtcLobe`](super::LtcLobe) in each lane.
///
/// The first row of M⁻¹ is nearly parallel to the third where a lobe is narrow at grazing incidence. So it is kept in
/// two parts, along the third row and across. Then neither the second row, a cross product, nor an image cancels.
#[derive(Clone, Copy)]
pub(crate) struct LtcLobes<N> {
    pub normal: Vector3<N>,
    /// The factor of z/‖M⁻¹ω‖⁴. Its last five bits hold the [image error](Self::image_error).
    pub amplitude: N,
    /// What of the first row of M⁻¹ is perpendicular to the third, but for rounding.
    pub across: Vector3<N>,
    /// The third row of M⁻¹.
    pub third: Vector3<N>,
    /// The factor of the third row in the first.
    pub shear: N,
}

impl<N: Single> LtcLobes<N> {
    #[inline(always)]
    pub fn from_numbers(numbers: &LobeNumbers<N>) -> Self {
        let [
            n_x,
            n_y,
            n_z,
            amplitude,
            x_x,
            x_y,
            x_z,
            z_x,
            z_y,
            z_z,
            shear,
            ..,
        ] = *numbers;
        Self {
            normal: Vector3::new(n_x, n_y, n_z),
            amplitude,
            across: Vector3::new(x_x, x_y, x_z),
            third: Vector3::new(z_x, z_y, z_z),
            shear,
        }
    }

    /// The inverse of [`from_numbers`](Self::from_numbers).
    #[inline(always)]
    pub fn numbers(&self) -> [N; LTC_NUMBERS] {
        let (n, x, z) = (self.normal, self.across, self.third);
        let (amplitude, shear) = (self.amplitude, self.shear);
        [
            n.x, n.y, n.z, amplitude, x.x, x.y, x.z, z.x, z.y, z.z, shear,
        ]
    }

    /// Lobes that are zero in every direction.
    #[inline(always)]
    pub fn empty(normal: Vector3<N>) -> Self {
        let (zero, one) = (normal.x.zero(), normal.x.splat(1.0));
        Self {
            normal,
            amplitude: zero,
            across: Vector3::new(one, zero, zero),
            third: Vector3::new(zero, zero, one),
            shear: zero,
        }
    }

    /// `yes` where `mask` holds, and `no`, with the same normal, elsewhere.
    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let [amplitude, shear] =
            N::select_all(mask, [yes.amplitude, yes.shear], [no.amplitude, no.shear]);
        Self {
            normal: no.normal,
            amplitude,
            across: Vector3::select(mask, yes.across, no.across),
            third: Vector3::select(mask, yes.third, no.third),
            shear,
        }
    }

    /// The second row of M⁻¹.
    #[inline(always)]
    pub fn second(&self) -> Vector3<N> {
        self.third.cross(self.across)
    }

    /// v towards `outgoing`.
    #[inline(always)]
    pub fn value(&self, outgoing: Vector3<N>) -> N {
        let zero = self.amplitude.zero();
        let height = self.third.dot(outgoing);
        let is_lit = self.normal.dot(outgoing).is_positive() & height.is_positive();
        if N::is_known_false(is_lit) {
            return zero;
        }
        let x = self.across.dot(outgoing) + self.shear * height;
        let y = self.second().dot(outgoing);
        let over = (x * x + y * y + height * height).recip();
        // Two factors, since the fourth power of a length may overflow.
        let value = self.amplitude * over * (height * over);
        N::select(is_lit, value, zero)
    }
}

/// Where that of a light is below a radiance.
impl<N: Single> LtcLobes<N> {
    /// Whether Φv(ω)/l² is below `least` at the end of `way`, ω = `way`/l, also as [`value`](Self::value) rounds.
    ///
    /// With w = `way` that is ΦA (M⁻¹w)₃ l < `least` ‖M⁻¹w‖⁴: no quotient, where direction and value take one each. If
    /// M⁻¹w is off by e, (a − e)² ≥ (1 − η)a² − e²/η for any η in (0, 1).
    #[inline(always)]
    pub fn is_fainter(&self, flux: N, way: Vector3<N>, length_squared: N, least: N) -> N::Mask {
        let [across, y, z] = [self.across, self.second(), self.third].map(
            #[inline(always)]
            |row| row.near_dot(way),
        );
        let x = z.times_plus(self.shear, across);
        let image = Vector3::new(x, y, z);
        let length = length_squared.sqrt();
        let error = self.image_error() * length;
        let squared = (-error).times_plus(error, image.near_dot(image));
        let factor = flux * self.amplitude + LEAST_FACTOR;
        let least_product = (flux + 1.0) * (flux + 1.0) * LEAST;
        let product = ((z + error) * length).times_plus(factor, least_product);
        let is_in_range = least.gt(least.splat(LEAST));
        // Overflows only above all that is compared.
        let scaled = squared * (least * LEFT_OF_FOURTH_POWER) * squared.abs();
        is_in_range & scaled.gt(product)
    }
}

impl<N: Single> LtcLobes<N> {
    /// The rows of M⁻¹.
    #[inline(always)]
    pub fn rows(&self) -> [Vector3<N::Double>; 3] {
        let (across, third) = (self.across.widen(), self.third.widen());
        let first = across + third * self.shear.widen();
        [first, third.cross(across), third]
    }

    /// The most by which rounding moves M⁻¹ω, rounded up to a power of two. Infinite if the test of faint lights is not
    /// for this lobe.
    #[inline(always)]
    fn image_error(&self) -> N {
        self.amplitude.power_in_last_bits()
    }

    /// With the [error](Self::image_error) for these squared lengths of the rows of M⁻¹.
    #[inline(always)]
    pub fn with_image_error(self, [first, second, third]: [N::Double; 3]) -> Self {
        let sum = first + second + third;
        let norm = sum.sqrt();
        // The determinant, `second`, over the product of the greater singular values, of which half the sum is an upper
        // bound.
        let least = second * 2.0 / sum;
        let peak = self.amplitude.widen().max(sum.splat(1.0));
        let [shortest, longest] = NORMS;
        let is_in_range = norm.gt(sum.splat(shortest))
            & norm.le(sum.splat(longest))
            & peak.le(least * least * LARGEST_PEAK);
        let error = N::narrow(norm * (IMAGE_ROUNDINGS * f64::from(UNIT_ROUNDOFF)));
        let amplitude = self.amplitude;
        let error = N::select(is_in_range, error, amplitude.splat(f32::INFINITY));
        let with_error = amplitude.with_power_in_last_bits(error);
        Self {
            // An empty lobe stays empty.
            amplitude: N::select(amplitude.is_positive(), with_error, amplitude),
            ..self
        }
    }
}
