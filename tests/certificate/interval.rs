//! Intervals of `f64`, rounded outward.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::real::Real;

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
    pub const ZERO: Self = Self {
        low: 0.0,
        high: 0.0,
    };
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
    pub fn hull(self, o: Self) -> Self {
        Self {
            low: self.low.min(o.low),
            high: self.high.max(o.high),
        }
    }
}

impl Real for Interval {
    fn constant(x: f64) -> Self {
        Self::at(x)
    }
    fn square(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        let least = if self.low <= 0.0 && self.high >= 0.0 {
            0.0
        } else {
            down(a.min(b).powi(2)).max(0.0)
        };
        Self {
            low: least,
            high: up(a.max(b).powi(2)),
        }
    }
    fn sqrt(self) -> Self {
        Self {
            low: down(self.low.max(0.0).sqrt()).max(0.0),
            high: up(self.high.max(0.0).sqrt()),
        }
    }
    fn within(self, low: f64, high: f64) -> Self {
        Self {
            low: self.low.max(low).min(high),
            high: self.high.min(high).max(low),
        }
    }
}
impl Add for Interval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            low: down(self.low + o.low),
            high: up(self.high + o.high),
        }
    }
}
impl Sub for Interval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self {
            low: down(self.low - o.high),
            high: up(self.high - o.low),
        }
    }
}
impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            low: -self.high,
            high: -self.low,
        }
    }
}
impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = [
            self.low * o.low,
            self.low * o.high,
            self.high * o.low,
            self.high * o.high,
        ];
        let lo = p[0].min(p[1]).min(p[2].min(p[3]));
        let hi = p[0].max(p[1]).max(p[2].max(p[3]));
        if p.iter().any(|x| x.is_nan()) {
            return Self::ALL;
        }
        Self {
            low: down(lo),
            high: up(hi),
        }
    }
}
impl Div for Interval {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if o.low <= 0.0 && o.high >= 0.0 {
            return Self::ALL;
        }
        self * Self {
            low: down(1.0 / o.high),
            high: up(1.0 / o.low),
        }
    }
}
impl Mul<f64> for Interval {
    type Output = Self;
    fn mul(self, o: f64) -> Self {
        self * Self::at(o)
    }
}
