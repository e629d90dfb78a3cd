//! The ellipsoid around points that reaches least.

use stochastic_light_culling::glam::DVec3;

type Vector = [f64; 6];
type Matrix = [[f64; 6]; 6];

/// The ellipsoid ‖Bx − d‖ ≤ 1 around the light, with B lower triangular and B₃₁ = B₃₂ = d₃ = 0:
/// B₁₁, B₂₁, B₂₂, d₁, d₂ and B₃₃, in which ‖Bx − d‖² is convex.
#[derive(Clone, Copy)]
pub struct Fit(Vector);

/// A direction from the light, and what it counts.
pub struct Ray {
    pub along: DVec3,
    pub weight: f64,
}

/// A point that is to be inside where ‖y‖² is `most` ≤ 1.
pub struct Held {
    pub point: DVec3,
    pub most: f64,
}

/// What is made small: ln Σ w ρ², ρ being the distance from the light to the ellipsoid along a ray of
/// weight w, and `volume` ln V, under a barrier of this `strength`: the mean of −ln(1 − ‖y‖²/most).
pub struct Aim<'a> {
    pub points: &'a [Held],
    pub rays: &'a [Ray],
    pub volume: f64,
    pub strength: f64,
}

impl Fit {
    /// {c + A y : ‖y‖ ≤ 1}, of c₁, c₂, A₁₁, A₂₁, A₂₂ and A₃₃.
    pub fn new([c1, c2, a11, a21, a22, a33]: Vector) -> Self {
        let (b11, b22) = (1.0 / a11, 1.0 / a22);
        let b21 = -a21 * b11 * b22;
        Self([b11, b21, b22, b11 * c1, b21 * c1 + b22 * c2, 1.0 / a33])
    }

    /// c₁, c₂, A₁₁, A₂₁, A₂₂ and A₃₃.
    pub fn numbers(&self) -> Vector {
        let [b11, b21, b22, d1, d2, b33] = self.0;
        let (a11, a22) = (1.0 / b11, 1.0 / b22);
        let a21 = -b21 * a11 * a22;
        [a11 * d1, a21 * d1 + a22 * d2, a11, a21, a22, 1.0 / b33]
    }

    fn moved(mut self, by: &Vector, length: f64) -> Self {
        for (number, by) in self.0.iter_mut().zip(by) {
            *number += length * by;
        }
        self
    }

    /// Bx
    fn turned(&self, x: DVec3) -> DVec3 {
        let [b11, b21, b22, _, _, b33] = self.0;
        DVec3::new(b11 * x.x, b21 * x.x + b22 * x.y, b33 * x.z)
    }

    fn light(&self) -> DVec3 {
        DVec3::new(self.0[3], self.0[4], 0.0)
    }

    fn is_around_light(&self) -> bool {
        [0, 2, 5].iter().all(|i| self.0[*i] > 0.0) && self.light().length_squared() < 1.0
    }
}

/// Half of the slope of ‖y‖², y = Bx − d.
fn half_slope(y: DVec3, x: DVec3) -> Vector {
    [y.x * x.x, y.y * x.x, y.y * x.y, -y.x, -y.y, y.z * x.z]
}

impl Aim<'_> {
    /// From `start`, which holds the points.
    pub fn reach(&self, start: Fit) -> Fit {
        let mut fit = start;
        let mut strength = 1.0;
        while strength > self.strength {
            strength = (0.25 * strength).max(self.strength);
            self.descend(&mut fit, strength / self.points.len() as f64);
        }
        fit
    }

    /// Without the barrier, and its slope.
    fn size(&self, fit: &Fit) -> (f64, Vector) {
        let d = fit.light();
        let rest = 1.0 - d.length_squared();
        let (mut sum, mut slope) = (0.0, [0.0; 6]);
        for Ray { along, weight } in self.rays {
            let v = fit.turned(*along);
            let (p, q) = (v.length_squared(), d.dot(v));
            // tv − d is of length 1, and there half the slope by t is the root.
            let root = (q * q + p * rest).sqrt();
            let t = (q + root) / p;
            sum += weight * t * t;
            let by_numbers = half_slope(v * t - d, *along * t);
            for (s, g) in slope.iter_mut().zip(by_numbers) {
                *s -= weight * 2.0 * t * g / root;
            }
        }
        let mut slope = slope.map(|s| s / sum);
        let mut volume = 1.0;
        for i in [0, 2, 5] {
            slope[i] -= self.volume / fit.0[i];
            volume /= fit.0[i];
        }
        (sum.ln() + self.volume * volume.ln(), slope)
    }

    /// None outside.
    fn value(&self, fit: &Fit, strength: f64) -> Option<f64> {
        if !fit.is_around_light() {
            return None;
        }
        let d = fit.light();
        let mut value = self.size(fit).0;
        for Held { point, most } in self.points {
            let share = (fit.turned(*point) - d).length_squared() / most;
            if share >= 1.0 {
                return None;
            }
            value -= strength * (1.0 - share).ln();
        }
        Some(value)
    }

    fn slopes(&self, fit: &Fit, strength: f64) -> (Vector, Matrix) {
        let mut first = self.size(fit).1;
        let mut second = [[0.0; 6]; 6];
        for i in 0..6 {
            let h = 1e-5 * fit.0[i].abs().max(0.01);
            let mut unit = [0.0; 6];
            unit[i] = h;
            let [low, high] = [-1.0, 1.0].map(|sign| self.size(&fit.moved(&unit, sign)).1);
            for j in 0..6 {
                let bend = (high[j] - low[j]) / (4.0 * h);
                second[i][j] += bend;
                second[j][i] += bend;
            }
        }
        let d = fit.light();
        for Held { point, most } in self.points {
            let x = *point;
            let y = fit.turned(x) - d;
            let over = 2.0 / (most - y.length_squared());
            let slope = half_slope(y, x);
            for i in 0..6 {
                first[i] += strength * over * slope[i];
                for j in 0..6 {
                    second[i][j] += strength * over * over * slope[i] * slope[j];
                }
            }
            // Of y₁, y₂ and y₃, which are linear.
            for row in [
                [x.x, 0.0, 0.0, -1.0, 0.0, 0.0],
                [0.0, x.x, x.y, 0.0, -1.0, 0.0],
                [0.0, 0.0, 0.0, 0.0, 0.0, x.z],
            ] {
                for i in 0..6 {
                    for j in 0..6 {
                        second[i][j] += strength * over * row[i] * row[j];
                    }
                }
            }
        }
        (first, second)
    }

    /// By Newton's method.
    fn descend(&self, fit: &mut Fit, strength: f64) {
        let mut now = self.value(fit, strength).expect("all points are inside");
        for _ in 0..60 {
            let (slope, bend) = self.slopes(fit, strength);
            let step = downhill(&bend, &slope);
            let decrease: f64 = -step.iter().zip(slope).map(|(s, g)| s * g).sum::<f64>();
            if decrease < 1e-9 {
                return;
            }
            let lengths = (0..30).map(|halvings| 0.5_f64.powi(halvings));
            let found = lengths.into_iter().find_map(|length| {
                let next = fit.moved(&step, length);
                let value = self.value(&next, strength)?;
                (value <= now - 0.1 * length * decrease).then_some((next, value))
            });
            let Some(next) = found else { return };
            (*fit, now) = next;
        }
    }
}

/// Newton's step, with as much more on the diagonal as it takes to go down.
fn downhill(bend: &Matrix, slope: &Vector) -> Vector {
    let mut more = 0.0;
    loop {
        let mut matrix = *bend;
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] += more * row[i].abs().max(1e-3);
        }
        if let Some(solution) = solution(&matrix, slope) {
            return solution.map(|x| -x);
        }
        more = (4.0 * more).max(1e-3);
    }
}

/// Of a positive definite system, by Cholesky.
fn solution(m: &Matrix, v: &Vector) -> Option<Vector> {
    let mut l = [[0.0; 6]; 6];
    for i in 0..6 {
        for j in 0..=i {
            let rest = m[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if j < i {
                l[i][j] = rest / l[j][j];
            } else if rest > 1e-12 * m[i][i].abs() {
                l[i][i] = rest.sqrt();
            } else {
                return None;
            }
        }
    }
    let mut x = *v;
    for i in 0..6 {
        x[i] = (x[i] - (0..i).map(|k| l[i][k] * x[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..6).rev() {
        x[i] = (x[i] - (i + 1..6).map(|k| l[k][i] * x[k]).sum::<f64>()) / l[i][i];
    }
    Some(x)
}
