//! A function over a box: its values, and its first and pure second derivatives.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::interval::Interval;
use super::real::Real;

/// The variables: three parameters of the table, two of a point of the surface.
pub const VARIABLES: usize = 5;

#[derive(Clone, Copy, Debug)]
pub struct Jet {
    pub value: Interval,
    /// At the middle of the box.
    pub middle: Interval,
    pub first: [Interval; VARIABLES],
    /// ∂²/∂x_i² for each i; mixed derivatives are not needed.
    pub second: [Interval; VARIABLES],
}

impl Jet {
    pub fn variable(value: Interval, i: usize) -> Self {
        let middle = Interval::at(value.middle());
        let mut jet = Self {
            value,
            middle,
            ..Self::constant(0.0)
        };
        let r = (value.high - middle.low).max(middle.low - value.low) * (1.0 + 1e-15);
        jet.first[i] = Interval::at(r);
        jet
    }

    /// The value as well as the middle and the slopes tell it.
    pub fn centred(self) -> Self {
        let reach: f64 = self.first.iter().map(|d| d.largest()).sum::<f64>() * (1.0 + 1e-14);
        if !reach.is_finite() || reach >= self.value.width() {
            return self;
        }
        let v = Interval::new(
            self.middle.low - reach - f64::EPSILON * self.middle.largest(),
            self.middle.high + reach + f64::EPSILON * self.middle.largest(),
        );
        Self {
            value: self.value.within(v.low, v.high),
            ..self
        }
    }

    /// A function of this one with the given value and derivatives.
    pub fn chain(self, f: impl Fn(Interval) -> Interval, slope: Interval, bend: Interval) -> Self {
        Self {
            value: f(self.value),
            middle: f(self.middle),
            first: self.first.map(|d| d * slope),
            second: from_fn(|i| bend * self.first[i].square() + slope * self.second[i]),
        }
        .centred()
    }

    fn reciprocal(self) -> Self {
        let r = Interval::at(1.0) / self.value;
        let squared = r.square();
        self.chain(|x| Interval::at(1.0) / x, -squared, squared * r * 2.0)
    }
}

impl Real for Jet {
    fn constant(x: f64) -> Self {
        let zero = [Interval::ZERO; VARIABLES];
        Self {
            value: Interval::at(x),
            middle: Interval::at(x),
            first: zero,
            second: zero,
        }
    }

    fn square(self) -> Self {
        self.chain(Interval::square, self.value * 2.0, Interval::at(2.0))
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let slope = Interval::at(0.5) / root;
        self.chain(Interval::sqrt, slope, -(slope / self.value) * 0.5)
    }

    fn within(self, low: f64, high: f64) -> Self {
        Self {
            value: self.value.within(low, high),
            middle: self.middle.within(low, high),
            ..self
        }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            middle: self.middle + other.middle,
            first: from_fn(|i| self.first[i] + other.first[i]),
            second: from_fn(|i| self.second[i] + other.second[i]),
        }
        .centred()
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            middle: -self.middle,
            first: self.first.map(Neg::neg),
            second: self.second.map(Neg::neg),
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self {
            value: a.value * b.value,
            middle: a.middle * b.middle,
            first: from_fn(|i| a.first[i] * b.value + a.value * b.first[i]),
            second: from_fn(|i| {
                a.second[i] * b.value + a.first[i] * b.first[i] * 2.0 + a.value * b.second[i]
            }),
        }
        .centred()
    }
}

impl Div for Jet {
    type Output = Self;

    #[expect(
        clippy::suspicious_arithmetic_impl,
        reason = "a quotient is a product with a reciprocal"
    )]
    fn div(self, other: Self) -> Self {
        self * other.reciprocal()
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            middle: self.middle * factor,
            first: self.first.map(|d| d * factor),
            second: self.second.map(|d| d * factor),
        }
    }
}
