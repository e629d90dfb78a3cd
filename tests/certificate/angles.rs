//! The angle of incidence θ and δ, by the table's coordinates.

use super::interval::Interval;
use super::jet::Jet;
use super::real::Real;

/// σ(1−τ²) − ατ(1−σ²), which falls as τ rises.
fn residual(tau: Interval, alpha: f64, y: f64) -> Interval {
    let one = Interval::at(1.0);
    let sigma = Interval::at(y) - tau;
    sigma * (one - tau.square()) - Interval::at(alpha) * tau * (one - sigma.square())
}
/// τ at given α and τ + σ, found by bisection and then verified.
fn tau(alpha: f64, y: f64) -> Interval {
    let (least, most) = ((y - 1.0).max(0.0), y.min(1.0));
    let (mut lo, mut hi) = (least, most);
    for _ in 0..54 {
        let m = 0.5 * (lo + hi);
        let s = y - m;
        if s * (1.0 - m * m) - alpha * m * (1.0 - s * s) > 0.0 {
            lo = m;
        } else {
            hi = m;
        }
    }
    let mut e = 1e-14;
    let low = loop {
        let t = lo - e;
        if t <= least {
            break least;
        }
        if residual(Interval::at(t), alpha, y).low >= 0.0 {
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
        if residual(Interval::at(t), alpha, y).high <= 0.0 {
            break t;
        }
        e *= 10.0;
    };
    Interval::new(low, high)
}

/// Cosine and sine of the angle whose half has the tangent `t` in [0, 1].
pub fn half(t: Interval) -> (Interval, Interval) {
    let one = Interval::at(1.0);
    let c = |t: f64| {
        let t = Interval::at(t).square();
        (one - t) / (one + t)
    };
    let s = |t: f64| {
        let t = Interval::at(t);
        t * 2.0 / (one + t.square())
    };
    (
        Interval::new(c(t.high).low, c(t.low).high).within(0.0, 1.0),
        Interval::new(s(t.low).low, s(t.high).high).within(0.0, 1.0),
    )
}
pub fn half_jet(t: Jet) -> (Jet, Jet) {
    let one = Interval::at(1.0);
    let u = one / (one + t.value.square());
    let u2 = u.square();
    let t_ = t.value;
    (
        t.chain(
            |t| half(t).0,
            -(t_ * u2) * 4.0,
            u2 * (Interval::at(3.0) - u * 4.0) * 4.0,
        ),
        t.chain(
            |t| half(t).1,
            u * (u * 2.0 - one) * 2.0,
            -(t_ * u2 * (u * 4.0 - one)) * 4.0,
        ),
    )
}

/// τ = tan(θ/2) and σ = tan(δ/2), by their sum y and x = √α: tanδ = α tanθ is σ(1−τ²) = ατ(1−σ²).
#[derive(Clone, Copy)]
pub struct Angles {
    pub tau: Interval,
    pub sigma: Interval,
}

impl Angles {
    /// τ falls as α rises and σ rises; both rise with y.
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
    /// The derivatives of the implicit function, whose denominator is D = 1−τ² + 2τσ(1+α) + α(1−σ²).
    ///
    /// ∂τ/∂y is in [0, 1], and |∂τ/∂x| = 2xτ(1−σ²)/D at most 1/√2: by the means' inequality D is at
    /// least 2√(2τσ(1−τ²)) = 2√2 τx√(1−σ²).
    pub fn jets(&self, x: Interval, y: Interval) -> (Jet, Jet) {
        let mid = Angles::new(Interval::at(x.middle()), Interval::at(y.middle()));
        let (rx, ry) = (Jet::variable(x, 0).first[0], Jet::variable(y, 0).first[0]);
        let one = Interval::at(1.0);
        let (t, s) = (self.tau, self.sigma);
        let al = x.square();
        let (ct, cs) = (one - t.square(), one - s.square());
        let ts = t * s;
        let d = ct + ts * (one + al) * 2.0 + al * cs;
        let ty = ((ct + al * ts * 2.0) / d).within(0.0, 1.0);
        let sy = one - ty;
        let tx = (-(x * t * cs * 2.0) / d).within(-0.7072, 0.0);
        let sx = -tx;
        let mixed = |dt: Interval, ds: Interval| dt * s + t * ds;
        let dy = -(t * ty) * 2.0 + (one + al) * mixed(ty, sy) * 2.0 - al * s * sy * 2.0;
        let tyy = (-(t * ty) * 2.0 + al * mixed(ty, sy) * 2.0 - ty * dy) / d;
        let dx = -(t * tx) * 2.0 + (one + al) * mixed(tx, sx) * 2.0 + x * ts * 4.0 + x * cs * 2.0
            - al * s * sx * 2.0;
        let mx = -(t * cs + x * tx * cs - x * ts * sx * 2.0) * 2.0;
        let txx = (mx - tx * dx) / d;
        let z = Interval::ZERO;
        let (tx, ty, txx, tyy) = (tx * rx, ty * ry, txx * rx.square(), tyy * ry.square());
        let (sx, sy) = (sx * rx, sy * ry);
        (
            Jet {
                value: t,
                middle: mid.tau,
                first: [tx, ty, z, z, z],
                second: [txx, tyy, z, z, z],
            },
            Jet {
                value: s,
                middle: mid.sigma,
                first: [sx, sy, z, z, z],
                second: [-txx, -tyy, z, z, z],
            },
        )
    }
}
