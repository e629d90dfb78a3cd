//! The proof that the ellipsoids of the table for clusters enclose, cell by cell.
//!
//! A cell has two parameters, and a point on an ellipsoid of revolution one. Over the three together it is to be
//! shown that the point is outside of the cluster's reach. Since that is a star about the light, the ellipsoid then
//! holds all of it.

#[path = "../../../../src/bound/cluster_table.rs"]
mod table;

use super::{Interval, Slopes, prove_positive};
use table::{KNOTS, NUMBERS, TABLE};

/// A function of √w, √t and the height on the ellipsoid, from −1 at its rear to 1 at its front.
type Function = Slopes<3>;

/// L(S) = coth S − 1/S, which rises to 1 and is concave.
fn langevin(s: f64) -> f64 {
    if s < 0.05 {
        s / 3.0 - s.powi(3) / 45.0 + 2.0 * s.powi(5) / 945.0
    } else {
        1.0 / s.tanh() - 1.0 / s
    }
}

/// L′(S) = 1/S² − 1/sinh²S, which falls from 1/3 to 0.
fn langevin_slope(s: f64) -> f64 {
    if s < 0.05 {
        1.0 / 3.0 - s * s / 15.0 + 2.0 * s.powi(4) / 189.0
    } else if s > 300.0 {
        1.0 / (s * s)
    } else {
        1.0 / (s * s) - 1.0 / s.sinh().powi(2)
    }
}

/// With room for the rounding of both functions, which cancel.
fn rough(low: f64, high: f64) -> Interval {
    Interval::new(low - 1e-12, high + 1e-12)
}

fn langevin_of(s: Function) -> Function {
    let Interval { low, high } = s.value;
    let slope = rough(langevin_slope(high), langevin_slope(low));
    s.chain(rough(langevin(low), langevin(high)), slope)
}

/// L(S)/S, which falls from 1/3. Its slope is (L′ − L/S)/S: not below −L/S², nor below −2S/45, as its series
/// alternates.
fn langevin_share_of(s: Function) -> Function {
    let Interval { low, high } = s.value;
    let share = |s: f64| if s < 1e-9 { 1.0 / 3.0 } else { langevin(s) / s };
    let least = (-2.0 * high / 45.0).max(-langevin(high) / (low * low));
    s.chain(rough(share(high), share(low)), rough(least, 0.0))
}

/// ln((1 − e^{−2S})/(2S)), whose slope is L(S) − 1.
fn decay_of(s: Function) -> Function {
    let Interval { low, high } = s.value;
    let decay = |s: f64| {
        if s < 1e-4 {
            -s + s * s / 6.0
        } else {
            (-(-2.0 * s).exp_m1() / (2.0 * s)).ln()
        }
    };
    let slope = rough(langevin(low) - 1.0, langevin(high) - 1.0);
    s.chain(rough(decay(high), decay(low)), slope)
}

/// The ellipsoids of a cell of the table, in units of R.
#[derive(Clone, Copy, Debug)]
pub struct ClusterCell {
    low: [f64; 2],
    corners: [[f64; NUMBERS]; 4],
}

impl ClusterCell {
    const WIDTH: f64 = 1.0 / (KNOTS - 1) as f64;

    /// The cells of the table.
    pub fn all() -> Vec<Self> {
        let knots = (0..KNOTS - 1).flat_map(|i| (0..KNOTS - 1).map(move |j| [i, j]));
        knots.map(Self::at).collect()
    }

    /// The number of boxes that it takes to show that the ellipsoids of the cell enclose.
    ///
    /// # Errors
    ///
    /// Where an ellipsoid does not, or the first doubt after `limit` boxes: √w, √t, and the height.
    pub fn prove(&self, limit: usize) -> Result<usize, [f64; 3]> {
        prove_positive(self.sides(), limit, |b| self.gaps(b))
    }

    fn at(knot: [usize; 2]) -> Self {
        let first = knot[1] * KNOTS + knot[0];
        Self {
            low: knot.map(|i| i as f64 * Self::WIDTH),
            corners: [0, 1, KNOTS, KNOTS + 1].map(|step| {
                let [a, b, c, _] = TABLE[first + step];
                [a, b, c].map(f64::from)
            }),
        }
    }

    fn sides(&self) -> [Interval; 3] {
        let [x, y] = self.low.map(|low| Interval::new(low, low + Self::WIDTH));
        [x, y, Interval::new(-1.0, 1.0)]
    }

    fn numbers(&self, [root_w, root_t]: [Function; 2]) -> [Function; NUMBERS] {
        let share = |x: Function, low: f64| (x + -low) * (1.0 / Self::WIDTH);
        let [u, v] = [share(root_w, self.low[0]), share(root_t, self.low[1])];
        std::array::from_fn(|n| {
            let [a, b, c, d] = self.corners.map(|corner| corner[n]);
            let near = u * (b - a) + a;
            let far = u * (d - c) + c;
            near + (far - near) * v
        })
    }

    /// What is positive at a point of the ellipsoid if it is outside of the cluster's reach, in three forms of
    /// which each implies it, and a coarse one.
    ///
    /// With l and z in units of R and the squared distance from the axis ρ² = Bw sin²φ, the point is outside if
    /// λL(S)l(l − z) > uG/R², u = t + R²l². Let Q = l(l − z)/w, and λw = 2(1 − w). For u > 1 the point is outside
    /// in any case, so that bounds of G need to hold for u ≤ 1 alone.
    fn gaps(&self, [root_w, root_t, height]: [Function; 3]) -> [Option<Function>; 5] {
        let one = Function::constant(1.0);
        let [front, rear, across] = self.numbers([root_w, root_t]);
        let (along, center) = ((front + rear) * 0.5, (front - rear) * 0.5);
        let (w, t) = (root_w.squared(), root_t.squared());
        let reach_squared = one - t;
        let z = center + along * height;
        let radius_squared_over_w = across * (one - height.squared());
        let l_squared = z.squared() + w * radius_squared_over_w;
        let u = t + reach_squared * l_squared;
        let coarse = Some(Self::coarse_gap(
            [w, t, z],
            radius_squared_over_w,
            [l_squared, u],
        ));
        if l_squared.value.low <= 0.0 || u.value.low <= 0.0 {
            return [None, None, None, None, coarse];
        }
        let l = l_squared.root();
        let q = if (l + z).value.low > 0.0 {
            radius_squared_over_w * l * (l + z).reciprocal()
        } else if w.value.low > 0.0 {
            l * (l - z) * w.reciprocal()
        } else {
            return [None, None, None, None, coarse];
        };
        let lambda_w = (one - w) * 2.0;
        // L ≥ 1 − 1/S, and G ≤ −ln u, which is at most (1/u − u)/2.
        let at_least = q * (lambda_w - t * w * u.reciprocal());
        let narrow = reach_squared * at_least + u * u.logarithm();
        let below = one - l_squared;
        let narrow_and_flat = at_least - below * (u + 1.0) * 0.5;
        let has_spread = w.value.low > 0.0 && t.value.low > 0.0;
        if !has_spread {
            return [Some(narrow), Some(narrow_and_flat), None, None, coarse];
        }
        let most = lambda_w * (w * t).reciprocal();
        let s = most * u;
        // G is the difference of two values of a function.
        let differs = (reach_squared.value.low > 0.0).then(|| {
            let decay = decay_of(s) - decay_of(most);
            langevin_of(s) * lambda_w * q - u * decay * reach_squared.reciprocal()
        });
        // G = (λ/t)(1 − u)(1 − L̄), where L̄ is the mean of L from S to λ/t, not less than that of chords; and all
        // times t/u.
        let mean =
            (langevin_of(s) + langevin_of((s + most) * 0.5) * 2.0 + langevin_of(most)) * 0.25;
        let by_chords = langevin_share_of(s) * lambda_w * q - below * (one - mean);
        [
            Some(narrow),
            Some(narrow_and_flat),
            differs,
            Some(by_chords),
            coarse,
        ]
    }

    /// By the ends of intervals alone, for boxes at w = 0 next to the light. For z ≤ 0 Q is at least ρ²/w + 2z²/w,
    /// and else at least ρ²/2w. uG/R² is at most −u ln u/R², and at most 1 − l².
    fn coarse_gap(
        [w, t, z]: [Function; 3],
        radius_squared_over_w: Function,
        [l_squared, u]: [Function; 2],
    ) -> Function {
        let radius = radius_squared_over_w.value.low.max(0.0);
        let q = if z.value.high <= 0.0 {
            radius + 2.0 * z.value.square().low / w.value.high
        } else {
            0.5 * radius
        };
        let [low, high] = [u.value.low, u.value.high].map(|u| u.clamp(0.0, 1.0));
        let entropy = |u: f64| if u > 0.0 { -u * u.ln() } else { 0.0 };
        let peak = (-1.0_f64).exp();
        let most = if low <= peak && peak <= high {
            peak
        } else {
            entropy(low).max(entropy(high))
        };
        let most = (most / (1.0 - t.value.high).max(0.0)).min(1.0 - l_squared.value.low.min(1.0));
        let gap = q * (2.0 - 3.0 * w.value.high) - most;
        Slopes {
            value: Interval::new(gap - 1e-12, f64::INFINITY),
            slopes: [Interval::ALL; 3],
        }
    }
}
