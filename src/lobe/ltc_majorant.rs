//! Majorants of transformed cosines within a cap of directions: of one lobe, or of all members of a family.

use super::ltc_lobes::LtcLobes;
use super::{Caps, Majorant};
use crate::num::{Double, Real, Single, UNIT_ROUNDOFF, Vector3};

/// Budget for the value, and for the rounding of a maximum within a cap to single precision.
const MAXIMUM_ROUNDINGS: u16 = 32;
/// Budget for the first and the second row in the value, of which one is a sum and the other a cross product, in units of
/// u and their lengths.
const ROW_ROUNDINGS: f64 = 4.0;
/// Budget for the products of rows in the value, and for lengths of directions, in units of u and the norm of the matrix.
const VALUE_ROUNDINGS: f64 = 8.0;
/// Keeps the image of a direction away from zero.
const LEAST_IMAGE: f64 = 1e-60;

/// How far the image of a direction may be off in the value, for the squared lengths of the first and the second row.
#[inline(always)]
pub(super) fn rounding_of_rows<D: Double>(first: D, second: D) -> D {
    (first + second).sqrt() * (ROW_ROUNDINGS * f64::from(UNIT_ROUNDOFF))
}

/// How far the image of a direction may be off in the value, that of the direction itself included, for the squared
/// lengths of all rows.
#[inline(always)]
pub(super) fn rounding_of_value<D: Double>([first, second, third]: [D; 3]) -> D {
    let norm = (first + second + third).sqrt();
    norm * (VALUE_ROUNDINGS * f64::from(UNIT_ROUNDOFF)) + rounding_of_rows(first, second)
}

impl<N: Single> LtcLobes<N> {
    /// The majorant within a cap.
    #[inline(always)]
    pub fn majorant(&self, cap: &Caps<N>) -> Majorant<N> {
        let rows = self.rows();
        let squares = rows.map(Vector3::length_squared);
        let [x, determinant, z] = squares;
        let sum = x + determinant + z;
        let rounding = rounding_of_rows(x, determinant);
        let zero = sum.zero();
        let members = LtcMembers {
            normals: Caps::around(self.normal),
            amplitude: self.amplitude,
            rows,
            deviations: [zero, rounding],
            norms: [z.sqrt(), sum.sqrt()],
            least_image: determinant * 2.0 / sum - rounding,
        };
        if cap.must_nest {
            return members.majorant(cap);
        }
        let rounding = rounding_of_value(squares);
        members.majorant_of_images(cap, least_image(&rows, cap) - rounding)
    }
}

/// The least ‖M⁻¹ω‖ within a cap, for the rows of M⁻¹.
///
/// The image is at least d·ω for d = M⁻ᵀg and any unit vector g, and in a cap of the angle γ around w that is at least
/// (d·w) cos γ − ‖d × w‖ sin γ. The best g is along the image that is nearest to zero. That is found on the plane that
/// touches the sphere at w: for w + x it is M⁻¹w + Bx, where B has two columns, and x = −(BᵀB + μ)⁻¹BᵀM⁻¹w has the length
/// of the chord, or is shorter and μ zero. The inverse length is nearly linear in μ, so one step of Newton's method is
/// enough.
#[inline(always)]
fn least_image<N: Single>(rows: &[Vector3<N::Double>; 3], cap: &Caps<N>) -> N::Double {
    let (axis, chord) = (cap.axis.widen(), cap.chord.widen());
    let zero = chord.zero();
    let image_of = |way: Vector3<N::Double>| {
        let [x, y, z] = rows.map(
            #[inline(always)]
            |row| row.dot(way),
        );
        Vector3::new(x, y, z)
    };
    let (tangent, bitangent) = cap.axis.any_orthonormal_pair();
    let image = image_of(axis);
    let columns = [tangent, bitangent].map(|way| image_of(way.widen()));
    let [b, c] = columns;
    let (bb, bc, cc) = (b.dot(b), b.dot(c), c.dot(c));
    let [r, s] = columns.map(|column| column.dot(image));
    let squared = r * r + s * s;
    let norm = (bb * r * r + bc * r * s * 2.0 + cc * s * s) / squared;
    let first = (squared.sqrt() / chord - norm).max(zero);
    // (BᵀB + μ)⁻¹ of a vector.
    let solve = |multiplier: N::Double, [x, y]: [N::Double; 2]| {
        let [bb, cc] = [bb + multiplier, cc + multiplier];
        let inverse = zero.splat(1.0) / (bb * cc - bc * bc);
        [(cc * x - bc * y) * inverse, (bb * y - bc * x) * inverse]
    };
    let [x, y] = solve(first, [r, s]);
    let [dx, dy] = solve(first, [x, y]);
    let squared = x * x + y * y;
    let step = (squared.sqrt() / chord - 1.0) * squared / (x * dx + y * dy);
    let [x, y] = solve((first + step).max(zero), [r, s]);
    let nearest = image - b * x - c * y;
    let toward = nearest / nearest.length();

    let [first, second, third] = *rows;
    let d = first * toward.x + second * toward.y + third * toward.z;
    let squared = chord * chord;
    let cosine = -(squared * 0.5) + 1.0;
    let sine = chord * (-(squared * 0.25) + 1.0).max(zero).sqrt();
    // Not the cosine of a sum of angles where that is more than straight.
    let least = d.dot(axis).max(zero) * cosine - d.cross(axis).length() * sine;
    // NaN where there is no g.
    least.max(zero)
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
    /// One lobe has a sharper bound of ‖M⁻¹ω‖, which does not nest.
    ///
    /// The least singular value is the determinant over the product of the others, of which half that sum is an
    /// upper bound. It bounds ‖M⁻¹ω‖ for wide caps.
    ///
    /// The typical value has the height of the majorant, and the image of the axis as far away as that and the spread
    /// together.
    #[inline(always)]
    pub fn majorant(&self, cap: &Caps<N>) -> Majorant<N> {
        self.majorant_of_images(cap, cap.axis.x.widen().zero())
    }

    /// The majorant within a cap where the length of each image is at least `least`, or what the value takes for it.
    #[inline(always)]
    fn majorant_of_images(&self, cap: &Caps<N>, least: N::Double) -> Majorant<N> {
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
        let length = (image - spread).max(self.least_image).max(least);
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
