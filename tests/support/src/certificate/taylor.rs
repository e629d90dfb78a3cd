//! A function over a box as a polynomial of the second degree, and what that is off by at most.
//!
//! Sums and products of such functions are of the same kind: what is of a higher degree goes to the rest,
//! as does the rounding. So the rest falls with the third power of the box's size.

use std::array::from_fn;

use super::interval::Interval;

/// The variables: three parameters of the table, two of a point of the surface.
pub const VARIABLES: usize = 5;

pub type PerVariable = [f64; VARIABLES];

/// What the coefficients of a result are off by altogether, over their sizes without cancellation, by
/// variable. Each is a sum of at most four products, with a factor or two of its own, which comes to ten
/// units of 2⁻⁵³; these are 32.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON / VARIABLES as f64;
/// The same for what is positive and a sum of at most some hundred terms; and for what underflows.
pub const UPWARD: f64 = 1.0 + 256.0 * f64::EPSILON;
pub const TINY: f64 = 1e-100;

/// With each variable as u_i from −1 to 1, a function within Σ `rest` of
/// `constant` + Σ `linear`_i u_i + Σ `quadratic`_ki u_i u_(i+k mod 5).
#[derive(Clone, Copy, Debug)]
pub struct Taylor {
    pub constant: f64,
    pub linear: PerVariable,
    pub quadratic: [PerVariable; 3],
    /// By the variable that would take that part away if it were known better.
    pub rest: PerVariable,
    /// Sums of the magnitudes of `linear`, `quadratic` and `rest`.
    pub(super) sums: [f64; 3],
}

/// The variable `k` after `i`.
pub(super) fn after(i: usize, k: usize) -> usize {
    const AFTER: [usize; 9] = [0, 1, 2, 3, 4, 0, 1, 2, 3];
    AFTER[i + k]
}

fn sum(of: &PerVariable) -> f64 {
    of.iter().map(|x| x.abs()).sum()
}

/// The least of qu² − lu for u in [−1, 1] and l ≥ 0.
fn least_of_parabola(l: f64, q: f64) -> f64 {
    if l < 2.0 * q {
        -0.25 * l * l / q
    } else {
        q - l
    }
}

impl Taylor {
    #[inline]
    pub(super) fn new(
        constant: f64,
        linear: PerVariable,
        quadratic: [PerVariable; 3],
        rest: PerVariable,
    ) -> Self {
        let [a, b, c] = &quadratic;
        let sums = [sum(&linear), sum(a) + sum(b) + sum(c), sum(&rest)];
        Self {
            constant,
            linear,
            quadratic,
            rest,
            sums,
        }
    }

    /// The variable numbered `i`.
    pub fn variable(values: Interval, i: usize) -> Self {
        let middle = values.middle();
        // To both ends, wherever the middle was rounded to.
        let reach = (values.high - middle).max(middle - values.low) * UPWARD;
        let zero = [0.0; VARIABLES];
        let mut linear = zero;
        linear[i] = reach;
        Self::new(middle, linear, [zero; 3], zero)
    }

    /// What is within `reach` of it, with these shares of the variables in that, which are 1 together.
    pub fn widened(self, reach: f64, shares: PerVariable) -> Self {
        let rest = from_fn(|i| (self.rest[i] + shares[i] * reach) * UPWARD + TINY);
        Self::new(self.constant, self.linear, self.quadratic, rest)
    }

    /// Without what it is off by.
    pub fn polynomial(self) -> Self {
        Self::new(self.constant, self.linear, self.quadratic, [0.0; VARIABLES])
    }

    /// How far it can be from its constant.
    pub fn reach(&self) -> f64 {
        (self.sums[0] + self.sums[1] + self.sums[2]) * UPWARD
    }

    pub fn is_finite(&self) -> bool {
        (self.constant + self.reach()).is_finite()
    }

    /// The share of the variable numbered `i` in the magnitudes of `quadratic`.
    pub(super) fn bend(&self, i: usize) -> f64 {
        let [squares, by_one, by_two] = &self.quadratic;
        let mixed = by_one[i].abs()
            + by_one[after(i, 4)].abs()
            + by_two[i].abs()
            + by_two[after(i, 3)].abs();
        squares[i].abs() + 0.5 * mixed
    }

    /// What it varies by with the variable numbered `i`.
    pub fn variation(&self, i: usize) -> f64 {
        self.linear[i].abs() + self.bend(i) + self.rest[i]
    }

    /// The sum of the magnitudes of its coefficients.
    pub(super) fn size(&self) -> f64 {
        self.constant.abs() + self.sums[0] + self.sums[1]
    }

    /// The numbers that it stays within: along each variable what a parabola stays within.
    pub fn range(&self) -> Interval {
        let [squares, by_one, by_two] = &self.quadratic;
        let slack = 128.0 * f64::EPSILON * (self.size() + self.sums[2]);
        let off = sum(by_one) + sum(by_two) + self.sums[2] + slack;
        let (mut low, mut high) = (0.0, 0.0);
        for (l, q) in self.linear.iter().zip(squares) {
            low += least_of_parabola(l.abs(), *q);
            high -= least_of_parabola(l.abs(), -*q);
        }
        Interval::new(self.constant + low - off, self.constant + high + off)
    }

    /// No less than the function anywhere: at the corners of the box, which is where a sum of products of
    /// different variables is largest, with squares at most what they are there.
    pub fn most(&self) -> f64 {
        let [squares, by_one, by_two] = &self.quadratic;
        let upward: f64 = squares.iter().map(|x| x.max(0.0)).sum();
        let mut most = f64::NEG_INFINITY;
        for corner in 0..1 << (VARIABLES - 1) {
            let side: PerVariable = from_fn(|i| if corner >> i & 1 == 1 { 1.0 } else { -1.0 });
            let (mut odd, mut even) = (0.0_f64, 0.0);
            for i in 0..VARIABLES {
                odd += side[i] * self.linear[i];
                even += side[i] * (side[after(i, 1)] * by_one[i] + side[after(i, 2)] * by_two[i]);
            }
            // The opposite corner changes the sign of what is odd.
            most = most.max(even + odd.abs());
        }
        let slack = 128.0 * f64::EPSILON * (self.size() + self.sums[2]);
        self.constant + most + upward + self.sums[2] + slack
    }
}
