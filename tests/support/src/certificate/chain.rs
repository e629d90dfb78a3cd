//! Functions of a function over a box.

use std::array::from_fn;

use super::interval::Interval;
use super::real::Real;
use super::taylor::{ROUNDING, TINY, Taylor, UPWARD, after};

impl Taylor {
    /// A function of this one: f, f′ and f″/2 at its constant, and no less than what these three terms are
    /// off by wherever it reaches.
    #[inline]
    fn chain(&self, [value, slope, bend]: [f64; 3], off: f64) -> Self {
        let [linear, quadratic, rest] = self.sums;
        let beyond = quadratic + rest;
        let reach = linear + beyond;
        // (λ + ε)² is off λ² by ε(2λ + ε).
        let off = off + bend.abs() * beyond * (linear + reach);
        let share = off / reach.max(TINY);
        let rounding = ROUNDING * (value.abs() + slope.abs() * reach + bend.abs() * reach * reach);
        let l = &self.linear;
        let curved = |k: usize, bend: f64| {
            from_fn(|i| slope * self.quadratic[k][i] + bend * (l[i] * l[after(i, k)]))
        };
        Self::new(
            value,
            l.map(|x| slope * x),
            [
                curved(0, bend),
                curved(1, 2.0 * bend),
                curved(2, 2.0 * bend),
            ],
            from_fn(|i| {
                let off = slope.abs() * self.rest[i] + share * self.variation(i);
                (off + rounding) * UPWARD + TINY
            }),
        )
    }

    /// A function of what is positive whose third derivative is of one sign: what three terms are off by
    /// rises or falls all along, and is most at an end.
    fn chain_positive(&self, terms: [f64; 3], f: impl Fn(f64) -> f64) -> Self {
        let Interval { low, high } = self.range();
        if low.is_nan() || low <= 0.0 {
            return self.chain(terms, f64::INFINITY);
        }
        let [value, slope, bend] = terms;
        let off = |x: f64| {
            let d = x - self.constant;
            (f(x) - (value + d * (slope + d * bend))).abs()
        };
        let reach = self.reach();
        let size = value + reach * (slope.abs() + reach * bend.abs()) + f(low);
        let slack = 32.0 * f64::EPSILON * size;
        self.chain(terms, off(low).max(off(high)) + slack)
    }

    /// One over it; not finite unless it is positive.
    pub fn reciprocal(&self) -> Self {
        let over = 1.0 / self.constant;
        self.chain_positive([over, -over * over, over * over * over], |x| 1.0 / x)
    }

    /// One over its root; not finite unless it is positive.
    pub fn reciprocal_root(&self) -> Self {
        let over = 1.0 / self.constant;
        let root = over.sqrt();
        let slope = -0.5 * root * over;
        self.chain_positive([root, slope, -0.75 * slope * over], |x| 1.0 / x.sqrt())
    }

    /// Its fifth power.
    pub fn fifth_power(&self) -> Self {
        let (x, d) = (self.constant, self.reach());
        let (x2, d2) = (x * x, d * d);
        let off = d2 * d * (10.0 * x2 + 5.0 * x.abs() * d + d2);
        self.chain([x2 * x2 * x, 5.0 * x2 * x2, 10.0 * x2 * x], off)
    }

    /// No less than its root wherever it has one: three terms of that about a positive number, and what the
    /// fourth is at most. Those after it come to less than nothing.
    ///
    /// It is not to exceed that number by more than the number itself.
    pub fn above_root(&self, about: f64) -> Self {
        let (root, over) = (about.sqrt(), 1.0 / about);
        let d = (*self - Self::constant(about)) * over;
        let most = (d.constant + d.reach()).max(0.0);
        let terms =
            Self::constant(1.0 + 0.0625 * most * most * most) + d * 0.5 - d.square() * 0.125;
        // More by what the factors' rounding takes away: three terms are at least 3/8 where there is a root.
        terms * (root * (1.0 + 1e-13))
    }
}

impl Real for Taylor {
    fn constant(x: f64) -> Self {
        let zero = [0.0; super::taylor::VARIABLES];
        Self {
            constant: x,
            linear: zero,
            quadratic: [zero; 3],
            rest: zero,
            sums: [0.0; 3],
        }
    }

    #[inline]
    fn square(self) -> Self {
        let c = self.constant;
        self.chain([c * c, 2.0 * c, 1.0], 0.0)
    }

    /// Not finite unless it is positive.
    fn sqrt(self) -> Self {
        let (root, over) = (self.constant.sqrt(), 1.0 / self.constant);
        let slope = 0.5 * root * over;
        self.chain_positive([root, slope, -0.25 * slope * over], f64::sqrt)
    }

    /// Not finite unless `of` is positive.
    fn over_root(self, of: Self) -> Self {
        self * of.reciprocal_root()
    }
}
