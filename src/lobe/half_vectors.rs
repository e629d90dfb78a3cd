//! The half vectors of a cap of directions, in each lane.

use super::Caps;
use crate::num::{Matrix3, Real, Single, Vector3, round_down};

/// Budget for the quotient of the sine of a half vector's angle.
const SINE_ROUNDINGS: u16 = 6;

/// A ball that holds half vectors, in each lane.
#[derive(Clone, Copy)]
pub struct HalfVectors<N> {
    /// h
    middle: Vector3<N>,
    /// ‖h‖
    length: N,
    /// The least and the greatest length. The latter is positive.
    lengths: [N; 2],
    chord: N,
}

impl<N: Single> HalfVectors<N> {
    /// Those within `chord` of `middle`.
    #[inline(always)]
    pub fn within(middle: Vector3<N>, chord: N) -> Self {
        let length = middle.length();
        Self {
            middle,
            length,
            lengths: [
                (length - chord).max(length.zero()),
                (length + chord).min(length.splat(2.0)),
            ],
            chord,
        }
    }

    /// h, around which they lie.
    #[inline(always)]
    pub fn middle(&self) -> Vector3<N> {
        self.middle
    }

    /// The least and the greatest cosine ω_i·ω_h = ½‖ω_i + ω‖ of the half angle.
    #[inline(always)]
    pub fn half_angle_cosines(&self) -> [N; 2] {
        self.lengths.map(
            #[inline(always)]
            |length| length * 0.5,
        )
    }

    /// That of the middle, for both.
    #[inline(always)]
    pub fn typical_half_angle_cosines(&self) -> [N; 2] {
        [(self.length * 0.5).min(self.length.splat(1.0)); 2]
    }

    /// The least sine of the angle to one of `normals`, at most 1.
    #[inline(always)]
    pub fn least_sine(&self, normals: &Caps<N>) -> N {
        let across = self.middle.cross(normals.axis).length();
        let share = (across - self.chord) / self.lengths[1] * round_down(1.0, SINE_ROUNDINGS);
        let least = share - normals.chord;
        Real::max(least, share.zero()).min(share.splat(1.0))
    }

    /// The sine of the angle between the middle and the axis of `normals`. 1 if the middle is zero.
    #[inline(always)]
    pub fn typical_sine(&self, normals: &Caps<N>) -> N {
        let across = self.middle.cross(normals.axis).length();
        (across / self.length).min(across.splat(1.0))
    }

    /// By how much the angle to one of `normals` varies, in radians. Infinite if the middle is zero.
    #[inline(always)]
    pub fn spread(&self, normals: &Caps<N>) -> N {
        self.chord / self.length + normals.chord
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
}

/// √(x² + y²)
#[inline(always)]
fn length<N: Single>(x: N, y: N) -> N {
    (x * x + y * y).sqrt()
}
