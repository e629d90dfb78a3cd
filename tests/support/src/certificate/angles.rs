//! The angle of incidence θ and δ, by the table's coordinates.

use std::ops::{Mul, Sub};

use super::interval::Interval;
use super::real::Real;
use super::taylor::{TINY, Taylor};

/// σ(1−τ²) − ατ(1−σ²), which falls as τ rises and σ = y − τ.
fn residual<T: Copy + Sub<Output = T> + Mul<Output = T>>(one: T, tau: T, alpha: T, y: T) -> T {
    let sigma = y - tau;
    sigma * (one - tau * tau) - alpha * tau * (one - sigma * sigma)
}

/// How fast the residual does so.
fn rate(tau: Interval, sigma: Interval, alpha: Interval) -> Interval {
    let one = Interval::at(1.0);
    one - tau.square() + tau * sigma * 2.0 * (one + alpha) + alpha * (one - sigma.square())
}

/// τ at given α and τ + σ, found by bisection and then verified.
fn tau(alpha: f64, y: f64) -> Interval {
    let (least, most) = ((y - 1.0).max(0.0), y.min(1.0));
    let (mut lo, mut hi) = (least, most);
    for _ in 0..54 {
        let m = 0.5 * (lo + hi);
        if residual(1.0, m, alpha, y) > 0.0 {
            lo = m;
        } else {
            hi = m;
        }
    }
    let at = |tau: f64| {
        let [one, tau, alpha, y] = [1.0, tau, alpha, y].map(Interval::at);
        residual(one, tau, alpha, y)
    };
    let mut e = 1e-14;
    let low = loop {
        let t = lo - e;
        if t <= least {
            break least;
        }
        if at(t).low >= 0.0 {
            break t;
        }
        e *= 10.0;
    };
    let mut e = 1e-14;
    let high = loop {
        let t = hi + e;
        if t >= most {
            break most;
        }
        if at(t).high <= 0.0 {
            break t;
        }
        e *= 10.0;
    };
    Interval::new(low, high)
}

/// Cosine and sine of the angle whose half has the tangent `t`.
pub fn half(t: Taylor) -> (Taylor, Taylor) {
    let over = (t.square() + Taylor::constant(1.0)).reciprocal() * 2.0;
    (over - Taylor::constant(1.0), t * over)
}

/// τ = tan(θ/2) and σ = tan(δ/2), by their sum y and x = √α: tanδ = α tanθ is σ(1−τ²) = ατ(1−σ²).
#[derive(Clone, Copy)]
pub struct Angles {
    pub tau: Interval,
    pub sigma: Interval,
}

impl Angles {
    /// τ falls and σ rises as α rises; both rise with y.
    pub fn new(x: Interval, y: Interval) -> Self {
        let a = [
            x.low * x.low * (1. - 1e-15),
            (x.high * x.high * (1. + 1e-15)).min(1.0),
        ];
        let (ll, hl) = (tau(a[0], y.low), tau(a[1], y.low));
        let (lh, hh) = if y.low == y.high {
            (ll, hl)
        } else {
            (tau(a[0], y.high), tau(a[1], y.high))
        };
        let sl = (Interval::at(y.low) - ll).low.max(0.0);
        let sh = (Interval::at(y.high) - hh).high.min(1.0);
        Self {
            tau: Interval::new(hl.low, lh.high),
            sigma: Interval::new(sl, sh),
        }
    }

    /// τ and σ as polynomials, τ by Newton's method, and then verified: by the mean value theorem it is off
    /// by the residual over the rate that this falls at.
    pub fn taylor(&self, x: Interval, y: Interval) -> (Taylor, Taylor) {
        let (alpha, sum) = (Taylor::variable(x, 0).square(), Taylor::variable(y, 1));
        let one = Taylor::constant(1.0);
        let (x_there, y_there) = (x.middle(), y.middle());
        let there = tau(x_there * x_there, y_there).middle();
        let [tau_there, sigma_there, alpha_there] =
            [there, y_there - there, x_there * x_there].map(Interval::at);
        let over = 1.0 / rate(tau_there, sigma_there, alpha_there).middle();
        let mut tau = Taylor::constant(there);
        // The first step gets the linear terms right, and the second the quadratic ones.
        for _ in 0..2 {
            tau = (tau + residual(one, tau, alpha, sum) * over).polynomial();
        }
        let between = self.tau.hull(tau.range());
        let least = rate(between, y - between, x.square()).low;
        let off = residual(one, tau, alpha, sum).range().largest() / least * (1.0 + 1e-14);
        // |∂τ/∂x| is at most 1/√2, and |∂τ/∂y| at most 1.
        let (by_x, by_y) = (0.7 * x.width() + TINY, y.width() + TINY);
        let all = by_x + by_y;
        let shares = [by_x / all, by_y / all, 0.0, 0.0, 0.0];
        let reach = 0.5 * self.tau.width() + f64::EPSILON;
        let tau = if least > 0.0 && off < reach {
            tau.widened(off, shares)
        } else {
            Taylor::constant(self.tau.middle()).widened(reach, shares)
        };
        (tau, sum - tau)
    }
}
