//! Sums and products of functions over a box.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::taylor::{PerVariable, ROUNDING, TINY, Taylor, UPWARD, after};

impl Add for Taylor {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let rounding = ROUNDING * (self.size() + other.size());
        let (a, b) = (&self, &other);
        Self::new(
            a.constant + b.constant,
            from_fn(|i| a.linear[i] + b.linear[i]),
            from_fn(|k| from_fn(|i| a.quadratic[k][i] + b.quadratic[k][i])),
            from_fn(|i| (a.rest[i] + b.rest[i] + rounding) * UPWARD + TINY),
        )
    }
}

impl Neg for Taylor {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self {
            constant: -self.constant,
            linear: self.linear.map(Neg::neg),
            quadratic: self.quadratic.map(|row| row.map(Neg::neg)),
            ..self
        }
    }
}

impl Sub for Taylor {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Taylor {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (&self, &other);
        let (size_a, size_b) = (a.size(), b.size());
        let ([_, bends_a, rest_a], [_, bends_b, _]) = (a.sums, b.sums);
        let rounding = ROUNDING * size_a * size_b;
        let curved = |k: usize| -> PerVariable {
            from_fn(|i| {
                let j = after(i, k);
                let crossed = if k == 0 {
                    a.linear[i] * b.linear[i]
                } else {
                    a.linear[i] * b.linear[j] + a.linear[j] * b.linear[i]
                };
                a.constant * b.quadratic[k][i] + b.constant * a.quadratic[k][i] + crossed
            })
        };
        Self::new(
            a.constant * b.constant,
            from_fn(|i| a.constant * b.linear[i] + b.constant * a.linear[i]),
            [curved(0), curved(1), curved(2)],
            from_fn(|i| {
                let cubic = a.linear[i].abs() * bends_b + b.linear[i].abs() * bends_a;
                let quartic = bends_a * b.bend(i);
                let rests = size_b * a.rest[i] + (size_a + rest_a) * b.rest[i];
                (rests + cubic + quartic + rounding) * UPWARD + TINY
            }),
        )
    }
}

impl Mul<f64> for Taylor {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        let magnitude = factor.abs();
        let rounding = ROUNDING * magnitude * self.size();
        Self::new(
            self.constant * factor,
            self.linear.map(|x| x * factor),
            self.quadratic.map(|row| row.map(|x| x * factor)),
            self.rest
                .map(|x| (x * magnitude + rounding) * UPWARD + TINY),
        )
    }
}

impl Div for Taylor {
    type Output = Self;

    #[expect(
        clippy::suspicious_arithmetic_impl,
        reason = "a quotient is a product with a reciprocal"
    )]
    fn div(self, other: Self) -> Self {
        self * other.reciprocal()
    }
}
