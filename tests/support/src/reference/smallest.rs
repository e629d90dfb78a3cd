//! The smallest ellipsoid around points, as accurately as is asked for.

/// {c + A y : ‖y‖ ≤ 1} with c = (c₁, c₂, 0) and A lower triangular with A₃₁ = A₃₂ = 0.
#[derive(Clone, Copy, Debug)]
pub struct Smallest {
    pub center: [f64; 2],
    /// A₁₁, A₂₁, A₂₂, A₃₃.
    pub shape: [f64; 4],
}

impl Smallest {
    /// A₁₁A₂₂A₃₃, the volume over that of the unit sphere.
    pub fn volume(&self) -> f64 {
        self.shape[0] * self.shape[2] * self.shape[3]
    }

    /// ‖y‖² of a point.
    pub fn level(&self, [x, y, z]: [f64; 3]) -> f64 {
        let [along, slant, aside, across] = self.shape;
        let first = (x - self.center[0]) / along;
        let second = (y - self.center[1] - slant * first) / aside;
        first * first + second * second + (z / across).powi(2)
    }

    /// The smallest ellipsoid around `points` and their mirror images in the plane z = 0, larger in
    /// volume by a share 3/2 `tolerance` at most.
    ///
    /// Khachiyan's algorithm with away steps [Todd & Yıldırım 2007, *On Khachiyan's algorithm for the
    /// computation of minimum-volume enclosing ellipsoids*]: weights of the points whose moments are
    /// those of the ellipsoid. A point and its image have equal weights, so that of the 4×4 matrix of
    /// moments of (x, y, 1, z) a 3×3 block and one element are left. Points that cannot be on the
    /// ellipsoid are dropped on the way [Harman & Pronzato 2007].
    pub fn around(mut points: Vec<[f64; 3]>, tolerance: f64) -> Self {
        let mut weights = first_weights(&points);
        for iteration in 0.. {
            let moments = Moments::of(&points, &weights);
            let heights: Vec<f64> = points
                .iter()
                .map(|p| moments.heights(p).iter().sum())
                .collect();
            let by_height = |i: &usize, j: &usize| heights[*i].total_cmp(&heights[*j]);
            let farthest = (0..points.len())
                .max_by(by_height)
                .expect("there are points");
            let nearest = (0..points.len())
                .filter(|i| weights[*i] > 0.0)
                .min_by(by_height)
                .expect("weights add up to one");
            let excess = heights[farthest] / 4.0 - 1.0;
            if excess < tolerance || iteration == 100_000 {
                return moments.ellipsoid(heights[farthest]);
            }
            let is_away = 1.0 - heights[nearest] / 4.0 > excess;
            let chosen = if is_away { nearest } else { farthest };
            let step = best_step(moments.heights(&points[chosen]), weights[chosen]);
            for weight in &mut weights {
                *weight *= 1.0 - step;
            }
            weights[chosen] = (weights[chosen] + step).max(0.0);
            if is_away && weights[chosen] < 1e-15 {
                weights[chosen] = 0.0;
            }
            if iteration % 20 == 0 {
                let gap = 4.0 * excess;
                let least =
                    4.0 + 2.0 * (gap / 4.0 - (gap / 4.0 * (4.0 + gap / 4.0 - 1.0)).max(0.0).sqrt());
                let kept: Vec<usize> = (0..points.len())
                    .filter(|i| weights[*i] > 0.0 || heights[*i] >= 0.999 * least)
                    .collect();
                points = kept.iter().map(|i| points[*i]).collect();
                weights = kept.iter().map(|i| weights[*i]).collect();
            }
        }
        unreachable!("the loop ends by returning")
    }
}

/// Equal weights of the points farthest in a few directions.
fn first_weights(points: &[[f64; 3]]) -> Vec<f64> {
    let mut weights = vec![0.0; points.len()];
    let farthest = |d: [f64; 3]| {
        let along = |i: usize| (0..3).map(|k| d[k] * points[i][k]).sum::<f64>();
        (0..points.len())
            .max_by(|i, j| along(*i).total_cmp(&along(*j)))
            .expect("there are points")
    };
    for k in 0..8 {
        let (sine, cosine) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
        weights[farthest([cosine, sine, 0.0])] += 1.0 / 16.0;
    }
    weights[farthest([0.0, 0.0, 1.0])] += 0.5;
    weights
}

/// The moments Σ w (x, y, 1)(x, y, 1)ᵀ and Σ w z².
struct Moments {
    plane: [[f64; 3]; 3],
    inverse: [[f64; 3]; 3],
    across: f64,
}

impl Moments {
    fn of(points: &[[f64; 3]], weights: &[f64]) -> Self {
        let (mut plane, mut across) = ([[0.0; 3]; 3], 0.0);
        for ([x, y, z], weight) in points.iter().zip(weights).filter(|(_, w)| **w > 0.0) {
            let v = [*x, *y, 1.0];
            for (row, a) in plane.iter_mut().zip(v) {
                for (element, b) in row.iter_mut().zip(v) {
                    *element += weight * a * b;
                }
            }
            across += weight * z * z;
        }
        Self {
            plane,
            inverse: inverse(plane),
            across,
        }
    }

    /// How far out a point is, in the plane and across it: 4 in all on the ellipsoid, in the end.
    fn heights(&self, [x, y, z]: &[f64; 3]) -> [f64; 2] {
        let v = [*x, *y, 1.0];
        let plane = (0..3)
            .map(|i| v[i] * (0..3).map(|j| self.inverse[i][j] * v[j]).sum::<f64>())
            .sum();
        [plane, z * z / self.across]
    }

    /// The ellipsoid of points no higher than `height`.
    fn ellipsoid(&self, height: f64) -> Smallest {
        let m = &self.plane;
        let center = [m[0][2], m[1][2]];
        let covariance = |i: usize, j: usize| (height - 1.0) * (m[i][j] - center[i] * center[j]);
        let along = covariance(0, 0).sqrt();
        let slant = covariance(0, 1) / along;
        let aside = (covariance(1, 1) - slant * slant).sqrt();
        let across = ((height - 1.0) * self.across).sqrt();
        Smallest {
            center,
            shape: [along, slant, aside, across],
        }
    }
}

/// The step β towards a point, or away, that makes the determinant of the moments the largest: with a
/// and b the heights less 1, 2 ln(1−β) + ln(1+βa) + ln(1+βb), whose derivative vanishes where
/// (a + b − 2) + (2ab − 3(a + b)) β − 4ab β² = 0.
fn best_step([a, b]: [f64; 2], weight: f64) -> f64 {
    let (a, b) = (a - 1.0, b - 1.0);
    let (c0, c1, c2) = (a + b - 2.0, 2.0 * a * b - 3.0 * (a + b), -4.0 * a * b);
    let root = (c1 * c1 - 4.0 * c2 * c0).max(0.0).sqrt();
    let roots = [
        -c0 / c1,
        (root - c1) / (2.0 * c2),
        (-root - c1) / (2.0 * c2),
    ];
    let roots = if c2.abs() < 1e-12 {
        &roots[..1]
    } else {
        &roots[1..]
    };
    let step = roots
        .iter()
        .copied()
        .filter(|step| step.is_finite() && (*step > 0.0) == (c0 > 0.0) && *step < 1.0)
        .min_by(|x, y| x.abs().total_cmp(&y.abs()))
        .unwrap_or(if c0 > 0.0 { 0.5 } else { -1.0 });
    step.max(-weight / (1.0 - weight))
}

fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |i: usize, j: usize| {
        let [(a, b), (c, d)] = [i, j].map(|k| ((k + 1) % 3, (k + 2) % 3));
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}
