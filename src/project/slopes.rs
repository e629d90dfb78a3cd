//! The slopes x/z and y/z that a projected shape spans.
//!
//! A slope s belongs to the plane x = s z through the eye. Let M take the shape to the unit ball around c, and
//! let m times the first row of M⁻¹ be (g, h, K); the third row is (0, 0, 1/m). In the space of the ball the
//! plane has the normal (g, h, K − s). It touches the ball if
//!
//! (g c_x + h c_y + (K − s) c_z)² = g² + h² + (K − s)².
//!
//! With w = g c_x + h c_y this is a quadratic equation for s − K, whose roots are
//!
//! s − K = (w c_z ± √(w² + (g² + h²) A)) / A, A = c_z² − 1.
//!
//! They bound the slopes if the shape lies ahead of the camera's plane, c_z > 1; else all slopes are in reach.
//! The root is of a sum of squares, so nothing cancels in it. A sphere of radius r around c is the case M = 1/r,
//! with lengths instead of multiples of r: K = 0, w = c_x, the root r √(c_x² + A), and A = c_z² − r².

use crate::num::{Real, Single, UNIT_ROUNDOFF};

/// Budget for both ends of a range of slopes, in units of the magnitudes of their terms.
const SLOPE_ROUNDINGS: f32 = 24.0;
/// Lower bound of A for a shape whose slopes are bounded. Its relative error is that of normal numbers.
const LEAST_SQUARE: f32 = 1e-30;

/// The planes through the eye that touch a ball.
#[derive(Clone, Copy)]
pub(super) struct TangentPlanes<N: Single> {
    /// c_z
    depth: N,
    /// A
    square: N,
    /// 1/A
    per_square: N,
    /// Whether the ball lies ahead of the camera's plane.
    is_ahead: N::Mask,
}

impl<N: Single> TangentPlanes<N> {
    /// The planes that touch a ball of this radius whose center has this depth.
    #[inline(always)]
    pub fn new(depth: N, radius: N) -> Self {
        let square = (depth - radius) * (depth + radius);
        Self {
            depth,
            square,
            per_square: square.recip(),
            is_ahead: depth.gt(radius) & square.gt(depth.splat(LEAST_SQUARE)),
        }
    }

    /// The slopes of an ellipsoid, the unit ball in the space of M, from the terms of K, from g and h, and from
    /// the coordinates of the center that these are multiplied with.
    #[inline(always)]
    pub fn slopes_of_ellipsoid(
        &self,
        [first, second]: [N; 2],
        [g, h]: [N; 2],
        [along, across]: [N; 2],
    ) -> [N; 2] {
        let (axis, axis_terms) = (first + second, first.abs() + second.abs());
        let (own, mixed) = (g * along, h * across);
        let w = own + mixed;
        let middle_terms = (own.abs() + mixed.abs()) * self.depth;
        let root = (w * w + (g * g + h * h) * self.square).sqrt();
        let [min, max] = self.relative_slopes(w * self.depth, root);
        let terms = axis_terms + (middle_terms + root) * self.per_square;
        self.outward([axis + min, axis + max], terms)
    }

    /// The slopes of a sphere whose center has the coordinate `across`.
    #[inline(always)]
    pub fn slopes_of_sphere(&self, across: N, radius: N) -> [N; 2] {
        let middle = across * self.depth;
        let root = (across * across + self.square).sqrt() * radius;
        let terms = (middle.abs() + root) * self.per_square;
        self.outward(self.relative_slopes(middle, root), terms)
    }

    /// (w c_z ± root)/A from `middle` = w c_z.
    #[inline(always)]
    fn relative_slopes(&self, middle: N, root: N) -> [N; 2] {
        let (near, far) = (middle - root, middle + root);
        [near * self.per_square, far * self.per_square]
    }

    /// Rounds a range of slopes outward, by an upper bound of the magnitudes of their terms. All slopes where the ball
    /// is not ahead, or where an overflow makes NaN.
    #[inline(always)]
    fn outward(&self, [min, max]: [N; 2], terms: N) -> [N; 2] {
        let rounding = terms * (SLOPE_ROUNDINGS * UNIT_ROUNDOFF);
        let (min, max) = (min - rounding, max + rounding);
        N::select_all(self.is_ahead & min.le(max), [min, max], unbounded(min))
    }
}

/// All numbers.
#[inline(always)]
pub(super) fn unbounded<N: Real<Element = f32>>(like: N) -> [N; 2] {
    [like.splat(f32::NEG_INFINITY), like.splat(f32::INFINITY)]
}
