//! Functions over a box with their derivatives, as intervals: for proofs by the mean value theorem.

use std::ops::{Add, Mul, Sub};

use super::Interval;

/// A function of `D` variables over a box: its values, and its derivative by each variable.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<const D: usize> {
    pub value: Interval,
    pub slopes: [Interval; D],
}

impl<const D: usize> Slopes<D> {
    pub fn constant(x: f64) -> Self {
        Self {
            value: Interval::at(x),
            slopes: [Interval::at(0.0); D],
        }
    }

    pub fn variable(value: Interval, index: usize) -> Self {
        let mut variable = Self::constant(0.0);
        variable.value = value;
        variable.slopes[index] = Interval::at(1.0);
        variable
    }

    /// All variables of a box.
    pub fn variables(sides: [Interval; D]) -> [Self; D] {
        std::array::from_fn(|i| Self::variable(sides[i], i))
    }

    /// A function of this one, with the given values and derivatives.
    pub fn chain(self, value: Interval, slope: Interval) -> Self {
        Self {
            value,
            slopes: self.slopes.map(|inner| inner * slope),
        }
    }

    pub fn squared(self) -> Self {
        self.chain(self.value.square(), self.value * 2.0)
    }

    /// 1/x for x > 0.
    pub fn reciprocal(self) -> Self {
        let value = Interval::new(1.0 / self.value.high, 1.0 / self.value.low).widened();
        self.chain(value, value.square() * -1.0)
    }

    /// √x for x > 0.
    pub fn root(self) -> Self {
        let value = Interval::new(self.value.low.sqrt(), self.value.high.sqrt()).widened();
        let slope = Interval::new(0.5 / value.high, 0.5 / value.low).widened();
        self.chain(value, slope)
    }

    pub fn exponential(self) -> Self {
        let value = Interval::new(self.value.low.exp(), self.value.high.exp()).widened();
        self.chain(value, value)
    }

    /// ln x for x > 0.
    pub fn logarithm(self) -> Self {
        let value = Interval::new(self.value.low.ln(), self.value.high.ln()).widened();
        let slope = Interval::new(1.0 / self.value.high, 1.0 / self.value.low).widened();
        self.chain(value, slope)
    }
}

impl Interval {
    /// With room for the rounding of functions that are off by a few units in the last place.
    pub fn widened(self) -> Self {
        let room = 1e-15;
        Self {
            low: self.low - room * self.low.abs() - f64::MIN_POSITIVE,
            high: self.high + room * self.high.abs() + f64::MIN_POSITIVE,
        }
    }
}

impl<const D: usize> Add for Slopes<D> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
        }
    }
}

impl<const D: usize> Sub for Slopes<D> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] - other.slopes[i]),
        }
    }
}

impl<const D: usize> Mul for Slopes<D> {
    type Output = Self;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slopes: std::array::from_fn(|i| {
                self.slopes[i] * other.value + self.value * other.slopes[i]
            }),
        }
    }
}

impl<const D: usize> Mul<f64> for Slopes<D> {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            slopes: self.slopes.map(|slope| slope * factor),
        }
    }
}

impl<const D: usize> Add<f64> for Slopes<D> {
    type Output = Self;

    fn add(self, shift: f64) -> Self {
        Self {
            value: self.value + Interval::at(shift),
            ..self
        }
    }
}

/// The number of boxes that it takes to show that `gap` is positive everywhere in `whole`.
///
/// `gaps` gives functions over a box of which one is to be positive there. It is asked over the box and over its
/// middle. One that has no value there is left out.
///
/// # Errors
///
/// The middle of a box in which no function is positive, or the first in doubt after `limit` boxes.
pub fn prove_positive<const D: usize, const K: usize>(
    whole: [Interval; D],
    limit: usize,
    gaps: impl Fn([Slopes<D>; D]) -> [Option<Slopes<D>>; K],
) -> Result<usize, [f64; D]> {
    let mut boxes = vec![whole];
    let mut count = 0;
    while let Some(sides) = boxes.pop() {
        count += 1;
        let middle = sides.map(Interval::middle);
        let over = gaps(Slopes::variables(sides));
        let within = gaps(Slopes::variables(middle.map(Interval::at)));
        let mut best: Option<(f64, [f64; D])> = None;
        let mut can_be = false;
        for (over, within) in over.into_iter().zip(within) {
            if let Some(within) = within {
                can_be |= within.value.high > 0.0;
            }
            let Some(over) = over else { continue };
            let changes: [f64; D] =
                std::array::from_fn(|i| over.slopes[i].largest() * 0.5 * sides[i].width());
            let change: f64 = changes.iter().sum();
            let by_slopes = within.map_or(f64::NEG_INFINITY, |w| w.value.low - change);
            let least = over.value.low.max(by_slopes);
            // False for NaN.
            if least > f64::NEG_INFINITY && best.is_none_or(|(other, _)| least > other) {
                best = Some((least, changes));
            }
        }
        if best.is_some_and(|(least, _)| least > 0.0) {
            continue;
        }
        if !can_be || count > limit {
            return Err(middle);
        }
        // Where most is lost, of what is not too narrow; else the widest.
        let shares: [f64; D] = std::array::from_fn(|i| sides[i].width() / whole[i].width());
        let widest = shares.into_iter().fold(0.0, f64::max);
        let weights = best.map_or(shares, |(_, changes)| {
            if changes.iter().all(|change| change.is_finite()) {
                changes
            } else {
                shares
            }
        });
        let longest = (0..D)
            .filter(|i| shares[*i] >= widest / 4096.0)
            .max_by(|i, j| weights[*i].total_cmp(&weights[*j]))
            .expect("the widest is wide enough");
        let (mut lower, mut upper) = (sides, sides);
        lower[longest].high = middle[longest];
        upper[longest].low = middle[longest];
        boxes.extend([lower, upper]);
    }
    Ok(count)
}
