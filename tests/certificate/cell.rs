//! The ellipsoids of the table within one cell.

use std::array::from_fn;

use super::interval::Interval;
use super::jet::{Jet, VARIABLES};
use super::table;

/// x = √α, y = τ + σ, z = ∜F0, and the tangents of half of φ and of half of ψ.
pub type Box5 = [Interval; VARIABLES];

/// A cell of the table: the knots at its corners, x changing fastest, and where it is.
#[derive(Clone, Debug)]
pub struct Cell {
    pub knots: [[f64; table::NUMBERS]; 8],
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Cell {
    /// The ellipsoids over a box: products of linear functions, which are largest and smallest at its
    /// corners, as are their derivatives.
    pub fn ellipsoids(&self, b: &Box5) -> [Jet; 6] {
        let w: [[f64; 2]; 3] = from_fn(|i| {
            let h = self.high[i] - self.low[i];
            [(b[i].low - self.low[i]) / h, (b[i].high - self.low[i]) / h]
        });
        let thin = (0..3).all(|i| b[i].low == b[i].high);
        from_fn(|j| {
            let k = self.knots.map(|k| k[j]);
            let lerp = |a: f64, b: f64, t: f64| a + (b - a) * t;
            let mut v = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
            let mut d = [v; 3];
            for c in 0..if thin { 1 } else { 8 } {
                let (u0, u1, u2) = (w[0][c & 1], w[1][c >> 1 & 1], w[2][c >> 2 & 1]);
                let e = |i: usize| lerp(k[i], k[i + 1], u0);
                let (e0, e1, e2, e3) = (e(0), e(2), e(4), e(6));
                let val = lerp(lerp(e0, e1, u1), lerp(e2, e3, u1), u2);
                v = v.hull(Interval::new(val - 1e-13, val + 1e-13));
                if thin {
                    break;
                }
                let dx = lerp(
                    lerp(k[1] - k[0], k[3] - k[2], u1),
                    lerp(k[5] - k[4], k[7] - k[6], u1),
                    u2,
                );
                let dy = lerp(e1 - e0, e3 - e2, u2);
                let dz = lerp(e2, e3, u1) - lerp(e0, e1, u1);
                for (i, x) in [dx, dy, dz].into_iter().enumerate() {
                    let x = x / (self.high[i] - self.low[i]);
                    d[i] = d[i].hull(Interval::new(x - 1e-12, x + 1e-12));
                }
            }
            let z = Interval::ZERO;
            let u: [f64; 3] = from_fn(|i| 0.5 * (w[i][0] + w[i][1]));
            let e = |i: usize| lerp(k[i], k[i + 1], u[0]);
            let m = lerp(lerp(e(0), e(2), u[1]), lerp(e(4), e(6), u[1]), u[2]);
            let r: [Interval; 3] = from_fn(|i| Jet::variable(b[i], 0).first[0]);
            let d: [Interval; 3] = if thin {
                [z; 3]
            } else {
                from_fn(|i| d[i] * r[i])
            };
            Jet {
                value: v,
                middle: Interval::new(m - 1e-13, m + 1e-13),
                first: [d[0], d[1], d[2], z, z],
                second: [z; 5],
            }
        })
    }
}
