//! Intervals of `f64`, rounded outward.

use std::ops::{Add, Mul, Sub};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    pub low: f64,
    pub high: f64,
}

/// Less than `x` by at least its rounding; −∞ for what is not a number.
fn down(x: f64) -> f64 {
    let below = x - (x.abs() * f64::EPSILON + f64::MIN_POSITIVE);
    if below.is_nan() {
        f64::NEG_INFINITY
    } else {
        below
    }
}

fn up(x: f64) -> f64 {
    -down(-x)
}

impl Interval {
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    pub fn at(x: f64) -> Self {
        Self { low: x, high: x }
    }

    pub fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    pub fn width(self) -> f64 {
        self.high - self.low
    }

    pub fn largest(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    pub fn square(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        let least = if self.low <= 0.0 && self.high >= 0.0 {
            0.0
        } else {
            let least = a.min(b);
            down(least * least).max(0.0)
        };
        let most = a.max(b);
        Self {
            low: least,
            high: up(most * most),
        }
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            low: down(self.low + other.low),
            high: up(self.high + other.high),
        }
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            low: down(self.low - other.high),
            high: up(self.high - other.low),
        }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let ends = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        if ends.iter().any(|x| x.is_nan()) {
            return Self::ALL;
        }
        Self {
            low: down(ends.into_iter().fold(f64::INFINITY, f64::min)),
            high: up(ends.into_iter().fold(f64::NEG_INFINITY, f64::max)),
        }
    }
}

impl Mul<f64> for Interval {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self * Self::at(factor)
    }
}
