//! The ellipsoids of the table within one cell.

use std::array::from_fn;

use super::NUMBERS;
use super::interval::Interval;
use super::real::Real;
use super::taylor::{Taylor, VARIABLES};

/// x = √α, y = τ + σ, z = ∜F0, and the tangents of half of φ and of half of ψ.
pub type Box5 = [Interval; VARIABLES];

/// A cell of the table: the knots at its corners, x changing fastest, and where it is.
#[derive(Clone, Debug)]
pub struct Cell {
    pub knots: [[f64; NUMBERS]; 8],
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Cell {
    /// The ellipsoids over a box. The factors here are off by some 10⁻¹⁶, far less than what is left for the
    /// interpolation in `f32`.
    pub fn ellipsoids(&self, b: &Box5) -> [Taylor; NUMBERS] {
        let share: [Taylor; 3] = from_fn(|i| {
            let over = 1.0 / (self.high[i] - self.low[i]);
            (Taylor::variable(b[i], i) - Taylor::constant(self.low[i])) * over
        });
        from_fn(|number| {
            let knot = |c: usize| self.knots[c][number];
            let along = |c: usize| Taylor::constant(knot(c)) + share[0] * (knot(c + 1) - knot(c));
            let towards = |a: Taylor, b: Taylor, i: usize| a + (b - a) * share[i];
            let near = towards(along(0), along(2), 1);
            let far = towards(along(4), along(6), 1);
            towards(near, far, 2)
        })
    }
}
