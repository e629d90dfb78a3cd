//! Majorants of transformed cosines within a cap of directions: of one lobe, or of all members of a family.

use super::ltc_lobes::LtcLobes;
use super::{Caps, Majorant};
use crate::num::{Double, Real, Single, UNIT_ROUNDOFF, Vector3};

/// Budget for the value, and for the rounding of a maximum within a cap to single precision.
const MAXIMUM_ROUNDINGS: u16 = 32;
/// Budget for the second row in the value, the cross product of the others in single precision, in units of u and the
/// product of their lengths.
const CROSS_ROUNDINGS: f64 = 4.0;
/// Budget for the other rows in the value, and for lengths of directions, in units of u and the norm of the matrix.
const VALUE_ROUNDINGS: f64 = 8.0;
/// Keeps the image of a direction away from zero.
const LEAST_IMAGE: f64 = 1e-60;

/// How far the image of a direction may be off in the value, for the squared lengths of the first and the third row.
#[inline(always)]
pub(super) fn rounding_of_image<D: Double>(first: D, third: D) -> D {
    (first * third).sqrt() * (CROSS_ROUNDINGS * f64::from(UNIT_ROUNDOFF))
}

/// How far the image of a direction may be off in the value, that of the direction itself included, for the squared
/// lengths of all rows.
#[inline(always)]
pub(super) fn rounding_of_value<D: Double>([first, second, third]: [D; 3]) -> D {
    let norm = (first + second + third).sqrt();
    norm * (VALUE_ROUNDINGS * f64::from(UNIT_ROUNDOFF)) + rounding_of_image(first, third)
}

impl<N: Single> LtcLobes<N> {
    /// The rows of M⁻¹, where the first and the third are as they are stored.
    #[inline(always)]
    pub(super) fn rows(&self) -> [Vector3<N::Double>; 3] {
        let (first, third) = (self.first.widen(), self.third.widen());
        [first, third.cross(first), third]
    }

    /// The majorant within a cap.
    #[inline(always)]
    pub fn majorant(&self, cap: &Caps<N>) -> Majorant<N> {
        let rows = self.rows();
        let squares = rows.map(Vector3::length_squared);
        let [x, determinant, z] = squares;
        let sum = x + determinant + z;
        let rounding = rounding_of_image(x, z);
        let zero = sum.zero();
        let members = LtcMembers {
            normals: Caps::around(self.normal),
            amplitude: self.amplitude,
            rows,
            deviations: [zero, rounding],
            norms: [z.sqrt(), sum.sqrt()],
            least_image: determinant * 2.0 / sum - rounding,
        };
        members.majorant(cap)
    }
}

/// One lobe, or the members of a family, in each lane.
#[derive(Clone, Copy)]
pub(super) struct LtcMembers<N: Single> {
    pub normals: Caps<N>,
    /// The greatest.
    pub amplitude: N,
    /// The rows of the mean of the matrices.
    pub rows: [Vector3<N::Double>; 3],
    /// How far the third row may be from that, and the matrix, or what the value takes for it.
    pub deviations: [N::Double; 2],
    /// The greatest length of the third row, and the greatest norm of the matrix.
    pub norms: [N::Double; 2],
    /// The least ‖M⁻¹ω‖ of all directions, or what the value takes for it.
    pub least_image: N::Double,
}

impl<N: Single> LtcMembers<N> {
    /// The majorant within a cap.
    ///
    /// z grows by no more than the chord times its row, and ‖M⁻¹ω‖ falls by no more than the chord times the
    /// greatest singular value, for which the root of the sum of all squared elements is taken. What the matrix of a
    /// member differs by from the mean adds to both.
    ///
    /// The least singular value is the determinant over the product of the others, of which half that sum is an
    /// upper bound. It bounds ‖M⁻¹ω‖ for wide caps.
    ///
    /// The typical value has the height of the majorant, and the image of the axis as far away as that and the spread
    /// together.
    #[inline(always)]
    pub fn majorant(&self, cap: &Caps<N>) -> Majorant<N> {
        let above = cap.greatest_cosine(&self.normals);
        let (axis, chord) = (cap.axis.widen(), cap.chord.widen());
        let image = self.rows.map(
            #[inline(always)]
            |row| row.dot(axis),
        );
        let [x, y, z] = image;
        let image = (x * x + y * y + z * z).sqrt();
        let height = z + self.norms[0] * chord + self.deviations[0];
        let spread = self.norms[1] * chord + self.deviations[1];
        let length = (image - spread).max(self.least_image);
        let length = length.max(length.splat(LEAST_IMAGE));
        let amplitude = self.amplitude.widen();
        let one = amplitude.splat(1.0);
        // z is no longer than the whole.
        let greatest = amplitude * (height / length).min(one) / (length * length * length);
        let squared = image * image + spread * spread * 0.5;
        let typical = amplitude * height.min(squared.sqrt()) / (squared * squared);
        let [greatest, typical] = [greatest, typical].map(
            #[inline(always)]
            |value| N::narrow(value.min(one.splat(f32::MAX.into()))),
        );
        let zero = self.amplitude.zero();
        let smallest = zero.splat(f32::MIN_POSITIVE);
        let greatest = Real::max(greatest.round_up(MAXIMUM_ROUNDINGS), smallest);
        let typical = Real::max(typical, smallest).min(greatest);
        let is_lit = self.amplitude.is_positive() & above.is_positive() & height.is_positive();
        let [greatest, typical] = N::select_all(is_lit, [greatest, typical], [zero; 2]);
        Majorant { greatest, typical }
    }
}
