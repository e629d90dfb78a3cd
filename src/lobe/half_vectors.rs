//! The half vectors of a cap of directions, in each lane.
//!
//! # What they are
//!
//! Let ω_h be the unit half vector of two directions that lie within chords c_i of i and c_w of w, h = i + w,
//! k = i − w and c = c_i + c_w. The half turn around ω_h takes one of both directions to the other, and keeps
//! distances. So it takes i to within c of w. That is a quadratic inequality:
//!
//! ‖V(ω_h)‖ ≤ c with V(x) = (x × h, x·k), and ‖V(x)‖² = 4 x_k² + ‖h‖² x_a²
//!
//! for the components x_k of x along k and x_a across the plane of i and w. The half vectors fill an elliptic cone,
//! half as wide as the cap in the plane of incidence and 1/‖h‖ times as wide across it. Of greater caps it is greater:
//! V is linear in i and w, and changes with either by no more than these do.
//!
//! # The least sine
//!
//! Let s be the sine of the angle between ω_h and a unit vector n, X = ‖n × h‖, K = n·k, and ν ≥ 0. Then
//!
//! s² ≥ (1 + νc²) Φ − νc² with Φ = min ‖e‖² + ν‖V(n − e)‖² over all e,
//!
//! since Φ is no more than for e = n − tω_h with t = (n·ω_h)/(1 + νc²), where it is (s² + νc²)/(1 + νc²). A sum of
//! squares along two axes has its minimum in each of them:
//!
//! Φ = ν (T² + 4νX²)/((1 + 4ν)(1 + ν‖h‖²)), T² = X² + K².
//!
//! T is the distance between w and the mirror direction of i. For the best ν the bound is the least sine itself, by the
//! S-lemma. It is where c (1 + 4ν)(1 + ν‖h‖²) = √(T² + 8νX² + 4ν²(4X² − ‖h‖²K²)), but for terms in s². The root is
//! nearly linear in ν, and is so exactly where n is along k or across. A tangent in its place leaves a quadratic
//! equation. Any ν is safe, so that an error of the tangent, or of rounding, costs sharpness alone, in second order.
//!
//! # The half angle
//!
//! ω_i·ω_h is the cosine of half the angle between the directions. That of i and w has the cosine ½‖h‖ and the sine
//! ½‖k‖. Both caps together widen the angle by no more than that whose half has the sine ½c, since the arcsine is
//! superadditive. So the least cosine is ½(‖h‖√(1 − ¼c²) − ½c‖k‖). It nests: where an axis moves, the chord grows by as
//! much, and the angle of a sum of chords is at least the sum of their angles.
//!
//! By the triangle inequality it is at least ½(‖h‖ − c), the cosine for an angle that is wider by up to a half: too wide
//! where glass begins to reflect all light, and F is infinitely steep. That takes no roots, and serves where F is nowhere
//! steep, and from [`STEEP_LENGTH`] on, where a growing chord hardly lessens the cosine of the sum, and rounding could make
//! it greater.
//!
//! # Two scales
//!
//! On an anisotropic surface the least ‖Px‖ is asked for, where P takes the unit half vector x to two coordinates, and
//! stretches each. By the Cauchy–Schwarz inequality it is at least d·x/‖g‖ for d = Pᵀg and any g. The cone has
//! 4x_k² + ‖h‖²x_a² ≤ c², and hence x·h ≥ √(‖h‖² − c²). So, with the unit vector m along h,
//!
//! d·x ≥ (d·m)√(1 − c²/‖h‖²) − (c/‖h‖)√(‖d × m‖² − ¼(d·k)²),
//!
//! where the last root is √(¼‖h‖²d_k² + d_a²), because ‖k‖² = 4 − ‖h‖². If d·m is negative, so is what is on the right,
//! and zero is the bound. For the best g this is the distance to the nearest point of an ellipse. With B such that
//! dᵀBd‖h‖² is the square of that root, and Δ = (PPᵀ)⁻¹, it has d = (B + λΔ)⁻¹m for the λ where dᵀBd = c². Its
//! inverse root is nearly linear in λ, so one step of Newton's method is enough, from the λ that is right for
//! multiples of d = Δ⁻¹m. Again any d is safe.
//!
//! # Near grazing
//!
//! The cone is the flatter the shorter h is, and the root bends more. So x_k² is given the weight
//! ‖h‖² + γ(4 − ‖h‖²) in place of 4, and K² the factor γ, where γ = min(1, [`FLATNESS`] (‖h‖ − c)²): the wider cone
//! ‖x × h‖² + γ(x·k)² ≤ c². Since γ does not grow with the cap, greater caps have greater cones as before.
//!
//! # It nests
//!
//! The least sine of a greater cone is at most that of a lesser one. To another normal n′ it is at most ‖n′ − n‖
//! greater. What is computed is less by the error of ν, which takes nothing to first order, but may shrink from a pair
//! to a greater one. In a search over angles, chords and moves of every direction, it shrank by less than 1/1024 of what
//! c grew and 1/192 of what n moved; with no share of c, or 1/384 of n, a few pairs near grazing did not nest. So the
//! chords are enlarged by these shares.

use super::Caps;
use super::caps::half_angle_cosine;
use crate::num::{Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3, round_down};

/// Budget for the sine of a half vector's angle.
pub(super) const SINE_ROUNDINGS: u16 = 16;
/// Budget for its square.
const SQUARED_SINE_ROUNDINGS: u16 = 2 * SINE_ROUNDINGS;
/// Budget for the length of a half vector in the sine, in units of u.
pub(super) const LENGTH_ROUNDINGS: f32 = 20.0;
/// Budget for a bound of d·x, in units of u times ‖d‖/‖h‖.
const LINEAR_ROUNDINGS: f32 = 128.0;
/// The least share of its leading term that the first λ has. Where the ellipse nears the origin, a λ of zero would take
/// Newton's method far off.
const LEAST_SHARE: f32 = 1.0 / 1024.0;
/// Budget for the length of a half vector by a sum of angles, in units of u.
const SUM_ROUNDINGS: f32 = 64.0;
/// Twice the cosine of a half angle of 20°. Below, the length by a sum of angles falls by at least a third of what the
/// chord grows by, which is more than rounding where clusters are merged.
const STEEP_LENGTH: f32 = 1.88;
/// The γ of half vectors whose least length is one. Down to a length of ½ cones are what they are.
const FLATNESS: f32 = 4.0;
/// The share by which the chord of directions is enlarged, so that sines nest.
const CHORD_MARGIN: f32 = 1.0 / 1024.0;
/// The share by which the chord of normals is enlarged, so that sines nest.
const NORMAL_CHORD_MARGIN: f32 = 1.0 / 192.0;
/// The ν where the root has its tangent is this, times (T − c)/(c‖h‖): that of a round cone, where ‖h‖ is 2.
const FIRST_MULTIPLIER: f32 = 0.5;

/// The half vectors of two caps, in each lane.
#[derive(Clone, Copy)]
pub struct HalfVectors<N> {
    /// h, around which they lie
    pub(super) middle: Vector3<N>,
    /// k
    pub(super) difference: Vector3<N>,
    /// ‖h‖
    pub(super) length: N,
    pub(super) inverse_length: N,
    /// The least and the greatest length. The latter is positive.
    lengths: [N; 2],
    pub(super) chord: N,
}

impl<N: Single> HalfVectors<N> {
    /// Those of directions in each of both caps.
    #[inline(always)]
    pub fn of(incoming: &Caps<N>, outgoing: &Caps<N>) -> Self {
        let middle = incoming.axis + outgoing.axis;
        let (length, chord) = (middle.length(), outgoing.chord + incoming.chord);
        Self {
            middle,
            difference: incoming.axis - outgoing.axis,
            length,
            inverse_length: length.splat(1.0) / length,
            lengths: [
                (length - chord).max(length.zero()),
                (length + chord).min(length.splat(2.0)),
            ],
            chord,
        }
    }

    /// The least and the greatest cosine ω_i·ω_h = ½‖ω_i + ω‖ of the half angle, by the triangle inequality.
    #[inline(always)]
    pub fn half_angle_cosines(&self) -> [N; 2] {
        let [least, greatest] = self.lengths;
        [least * 0.5, greatest * 0.5]
    }

    /// As [`half_angle_cosines`](Self::half_angle_cosines), but the least one by a sum of angles.
    #[inline(always)]
    pub fn sharp_half_angle_cosines(&self) -> [N; 2] {
        let [least, greatest] = self.lengths;
        let of_sum = self.length * half_angle_cosine(self.chord)
            - self.difference.length() * self.chord * 0.5;
        let of_sum = of_sum - SUM_ROUNDINGS * UNIT_ROUNDOFF;
        let least = of_sum.min(least.splat(STEEP_LENGTH)).max(least);
        [least * 0.5, greatest * 0.5]
    }

    /// The cosine of the half angle in the middle.
    #[inline(always)]
    pub fn typical_half_angle_cosine(&self) -> N {
        (self.length * 0.5).min(self.length.splat(1.0))
    }

    /// The least squared sine of the angle to one of `normals`, at most 1.
    #[inline(always)]
    pub fn least_squared_sine_to_any(&self, normals: &Caps<N>) -> N {
        let sine = self.least_squared_sine(normals.axis).sqrt();
        let least = sine - normals.chord * (1.0 + NORMAL_CHORD_MARGIN);
        let least = least.max(sine.zero());
        least * least
    }

    /// The least squared sine of the angle to `normal`, at most 1.
    #[inline(always)]
    pub fn least_squared_sine(&self, normal: Vector3<N>) -> N {
        let zero = self.length.zero();
        let one = zero.splat(1.0);
        let chord = self.chord * (1.0 + CHORD_MARGIN);
        let length = (self.length + LENGTH_ROUNDINGS * UNIT_ROUNDOFF).min(zero.splat(2.0));
        // The weights of both components: ‖h‖² across the plane, and that along k by way of γ.
        let across = length * length;
        let least = (length - chord).max(zero);
        let flatness = (least * least * FLATNESS).min(one);
        let along = across + (-across + 4.0) * flatness;
        // X², γK² and T²
        let off_plane = self.off_plane(normal);
        let in_plane = self.difference.dot(normal);
        let in_plane = in_plane * in_plane * flatness;
        let distance = off_plane + in_plane;

        // All ν are times c from here on.
        let first = (distance.sqrt() - chord) * self.inverse_length * FIRST_MULTIPLIER;
        let first = first.max(zero);
        // The tangent of the root is (constant + slope ν)/root.
        let linear = along * off_plane;
        let quadratic = (along * (linear - across * in_plane)).max(zero);
        let constant = chord * distance + linear * first;
        let slope = linear * chord + quadratic * first;
        let root = (chord * constant + slope * first).sqrt();
        // leading ν² − excess ν − lacking = 0
        let leading = along * across * root;
        let excess = slope - (along + across) * chord * root;
        let lacking = chord * (constant - chord * root);
        let discriminant = excess * excess + leading * lacking * 4.0;
        let multiplier = (excess + discriminant.max(zero).sqrt()) * 0.5 / leading;
        let multiplier = multiplier.max(zero);

        let widened = (chord * multiplier + 1.0) * (chord * distance + linear * multiplier);
        let weights = (chord + along * multiplier) * (chord + across * multiplier);
        let squared = multiplier * (widened / weights - chord);
        let rounded = squared * round_down(1.0, SQUARED_SINE_ROUNDINGS);
        rounded.max(zero).min(one)
    }

    /// X²
    #[inline(always)]
    fn off_plane(&self, normal: Vector3<N>) -> N {
        self.middle.cross(normal).length_squared()
    }

    /// The squared sine of the angle between the middle and `normal`. 1 if the middle is zero.
    #[inline(always)]
    pub fn typical_squared_sine(&self, normal: Vector3<N>) -> N {
        let squared = self.off_plane(normal) * (self.inverse_length * self.inverse_length);
        squared.min(squared.splat(1.0))
    }

    /// By how much the angle to one of `normals` varies, in radians. Infinite if the middle is zero.
    #[inline(always)]
    pub fn spread(&self, normals: &Caps<N>) -> N {
        self.chord * self.inverse_length + normals.chord
    }

    /// The least length of (x/a, y/b) for the unit vectors (x, y, z) along the half vectors, in the frame to
    /// which `to_frame` rotates, and the reciprocals `factors` = \[1/a, 1/b\].
    ///
    /// By the triangle inequality, or by that of each coordinate alone: the greater of both.
    #[inline(always)]
    pub fn least_scaled_sine(&self, to_frame: &Matrix3<N>, factors: [N; 2]) -> N {
        let [a, b] = factors;
        let Vector3 { x, y, .. } = *to_frame * self.middle;
        let (zero, chord) = (a.zero(), self.chord);
        let together = length(x * a, y * b) - chord * a.max(b);
        let alone = length(
            (x.abs() - chord).max(zero) * a,
            (y.abs() - chord).max(zero) * b,
        );
        Real::max(together, alone) / self.lengths[1] * round_down(1.0, SINE_ROUNDINGS)
    }

    /// As [`least_scaled_sine`](Self::least_scaled_sine) for the reciprocal squares \[p, q\] = `squares`, which are positive,
    /// and mostly sharper. It does not nest.
    #[inline(always)]
    pub fn sharp_scaled_sine(&self, to_frame: &Matrix3<N>, squares: [N; 2]) -> N {
        let (zero, chord) = (self.chord.zero(), self.chord);
        let m = *to_frame * self.middle * self.inverse_length;
        let k = *to_frame * self.difference;
        let direction = self.towards_nearest(m, k, squares);
        // Its scale does not matter, but its square may underflow.
        let [x, y] = direction;
        let scale = zero.splat(1.0) / x.abs().max(y.abs());
        let [x, y] = [x * scale, y * scale];

        let squared = x * x + y * y;
        let across = x * m.y - y * m.x;
        let along = x * k.x + y * k.y;
        let cross_squared = squared * (m.z * m.z) + across * across;
        let width = (cross_squared - along * along * 0.25).max(zero).sqrt();
        let length = (self.length - LENGTH_ROUNDINGS * UNIT_ROUNDOFF).max(zero);
        let ratio = chord / length;
        let cosine = (ratio.one_minus() * (ratio + 1.0)).max(zero).sqrt();
        let rounding = squared.sqrt() * (LINEAR_ROUNDINGS * UNIT_ROUNDOFF) / length;
        let least = (x * m.x + y * m.y) * cosine - ratio * width - rounding;
        let [p, q] = squares;
        let least = least / (x * x * p + y * y * q).sqrt() * round_down(1.0, SINE_ROUNDINGS);
        // NaN where there is no d.
        Real::max(least, zero)
    }

    /// The d for which the bound of ‖Px‖ is greatest, or nearly so: x and y, of any scale.
    #[inline(always)]
    fn towards_nearest(&self, m: Vector3<N>, k: Vector3<N>, [p, q]: [N; 2]) -> [N; 2] {
        let (zero, inverse_chord) = (self.chord.zero(), self.chord.splat(1.0) / self.chord);
        let inverse_squared = self.inverse_length * self.inverse_length;
        let ellipse = [
            (m.y * m.y + m.z * m.z - k.x * k.x * 0.25) * inverse_squared,
            -(m.x * m.y + k.x * k.y * 0.25) * inverse_squared,
            (m.x * m.x + m.z * m.z - k.y * k.y * 0.25) * inverse_squared,
        ];
        let times = |[x, y]: [N; 2]| {
            let [xx, xy, yy] = ellipse;
            [xx * x + xy * y, xy * x + yy * y]
        };
        let dot = |[a, b]: [N; 2], [c, d]: [N; 2]| a * c + b * d;
        let middle = [m.x, m.y];

        let first = [m.x / p, m.y / q];
        let squared = dot(first, times(first)).max(zero);
        let leading = squared.sqrt() * inverse_chord;
        let multiplier = leading - squared / dot(first, middle);
        let multiplier = multiplier.max(leading * LEAST_SHARE);
        let [p, q] = [p * multiplier, q * multiplier];
        // Of B + λΔ for `share` of the first λ.
        let solve = |share: N, [x, y]: [N; 2]| {
            let [xx, xy, yy] = ellipse;
            let [xx, yy] = [xx + p * share, yy + q * share];
            let inverse = (xx * yy - xy * xy).recip();
            [(yy * x - xy * y) * inverse, (xx * y - xy * x) * inverse]
        };
        let one = zero.splat(1.0);
        let second = solve(one, middle);
        let image = times(second);
        let squared = dot(second, image).max(zero);
        let slope = dot(solve(one, image), [p * second[0], q * second[1]]);
        let step = squared * (squared.sqrt() * inverse_chord - 1.0) / slope;
        solve(Real::max(step + 1.0, zero), middle)
    }
}

/// √(x² + y²)
#[inline(always)]
fn length<N: Single>(x: N, y: N) -> N {
    (x * x + y * y).sqrt()
}
