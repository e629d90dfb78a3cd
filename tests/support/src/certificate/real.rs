//! The arithmetic that the lobe's formulas need, so that they are written once: for numbers, and for
//! functions over a box.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Something to calculate with.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
{
    fn constant(x: f64) -> Self;
    fn square(self) -> Self;
    fn sqrt(self) -> Self;
    fn over_root(self, of: Self) -> Self;
}

impl Real for f64 {
    fn constant(x: f64) -> Self {
        x
    }

    fn square(self) -> Self {
        self * self
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn over_root(self, of: Self) -> Self {
        self / of.sqrt()
    }
}
