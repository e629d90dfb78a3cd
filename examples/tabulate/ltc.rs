//! Fits linearly transformed cosines to GGX lobes with height-correlated masking.
//!
//! Light comes from (−√(1−μ²), 0, μ). In the frame of the vector t = (μ, 0, −√(1−μ²)), the bitangent and the
//! mirror direction u, the matrix is
//!
//! M⁻¹ = [[A, 0, αB], [0, 1, 0], [αD, 0, αE]].
//!
//! With α taken out, the elements are bounded and hardly change from knot to knot, however narrow the lobe.
//! A and E are positive, B is not negative and D is not positive, so every mean of such matrices is
//! invertible.

use std::f64::consts::{FRAC_PI_2, PI};

use argmin::core::{CostFunction, Error, Executor, State};
use argmin::solver::neldermead::NelderMead;
use rayon::prelude::*;
use support::ggx_nodes::{Node, albedos, nodes};

#[allow(
    dead_code,
    reason = "the crate reads the table, the fit only needs its layout"
)]
#[path = "../../src/lobe/ltc_table.rs"]
pub mod layout;

use layout::{KNOTS, MATRIX_SCALES, Matrices};

/// Nodes along each of two coordinates, of each of two sets.
const NODES_OF_FIT: usize = 24;
/// Iterations of the minimiser from each start, and from where that ends.
const ITERATIONS: [u64; 2] = [300, 200];
/// The least count of A and E, which keeps every matrix invertible.
const LEAST_COUNT: u16 = 66;
/// The weight of the squared change of D between knots of α. For narrow lobes the error hardly depends on D.
const SMOOTHNESS: f64 = 1e-6;
/// α at the first knots, where the elements are at their limit.
const LEAST_ALPHA: f64 = 1.6e-5;

/// The most of the energy that a fit gives away to be nearer. Part of it is left for interpolation and rounding.
const MOST_LET_GO: f64 = 2.5e-3;
/// The weight of the squared skew. Bounds of skewed lobes are loose, and a narrow lobe gains nothing by skew.
const SKEW: f64 = 4e-3;

/// A, B, D and E.
pub type Elements = [f64; 4];

/// The bytes of the table.
pub fn table() -> Vec<u8> {
    let columns: Vec<_> = (0..KNOTS).into_par_iter().map(column).collect();
    let knots = (0..KNOTS).flat_map(|i| columns.iter().map(move |column| column[i]));
    let knots: Box<[_]> = knots.collect();
    let matrices: Box<Matrices> = knots.try_into().expect("one for each knot");
    let albedos: Vec<_> = (0..KNOTS * KNOTS)
        .into_par_iter()
        .map(|at| albedo_counts(&matrices, at / KNOTS, at % KNOTS))
        .collect();
    let counts = matrices.iter().flatten().copied();
    let counts = counts.chain(albedos.into_iter().flatten());
    counts.flat_map(u16::to_le_bytes).collect()
}

/// The counts of the matrices at a knot of √(1 − μ), for all knots of α. Each fit starts from the one before,
/// from rough to smooth.
pub fn column(j: usize) -> Vec<[u16; 4]> {
    let share = j as f64 / (KNOTS - 1) as f64;
    let mu = 1.0 - share * share;
    let mut elements = vec![[0.0; 4]; KNOTS];
    let mut last = None;
    for i in (0..KNOTS).rev() {
        let lobe = Target::new(alpha_at(i), mu);
        let fit = if j == 0 {
            lobe.fit_head_on(last.map_or(1.1, |last: Elements| last[3]))
        } else {
            lobe.fit(last)
        };
        elements[i] = fit;
        last = Some(fit);
    }
    elements.into_iter().map(counts).collect()
}

/// The counts of n_A and f_A at the knots `i` of √α and `j` of tan(θ/2) + tan(δ/2), both times the share of the
/// energy with which a lobe of these `matrices` is nearest.
pub fn albedo_counts(matrices: &Matrices, i: usize, j: usize) -> [u16; 2] {
    let alpha = alpha_at(i);
    let mu = cosine_at(alpha, 2.0 * j as f64 / (KNOTS - 1) as f64);
    let elements = layout::matrix_of(matrices, alpha.sqrt(), (1.0 - mu).sqrt());
    let share = Target::new(alpha, mu).error(elements).1;
    albedos(alpha, mu).map(|albedo| count(share * albedo, 0))
}

fn alpha_at(i: usize) -> f64 {
    let root = i as f64 / (KNOTS - 1) as f64;
    (root * root).max(LEAST_ALPHA)
}

fn counts(elements: Elements) -> [u16; 4] {
    let [a, b, d, e] = std::array::from_fn(|k| elements[k] / MATRIX_SCALES[k]);
    [
        count(a, LEAST_COUNT),
        count(b, 0),
        count(d, 0),
        count(e, LEAST_COUNT),
    ]
}

fn count(share: f64, least: u16) -> u16 {
    ((share * 65535.0).round().clamp(0.0, 65535.0) as u16).max(least)
}

/// μ where tan(θ/2) + tan(δ/2) is `coordinate`, tanδ = α tanθ.
fn cosine_at(alpha: f64, coordinate: f64) -> f64 {
    let coordinate_at = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        let slope = alpha * sine;
        (0.5 * angle).tan() + slope / (cosine + cosine.hypot(slope))
    };
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    if coordinate_at(high) <= coordinate {
        return 0.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if coordinate_at(middle) < coordinate {
            low = middle;
        } else {
            high = middle;
        }
    }
    low.cos()
}

/// The lobe that is to be fitted.
struct Target {
    alpha: f64,
    mu: f64,
    nodes: Vec<Node>,
    /// The integral of the lobe.
    albedo: f64,
    /// The integral of its square.
    square: f64,
}

impl Target {
    fn new(alpha: f64, mu: f64) -> Self {
        let nodes = nodes(alpha, mu, NODES_OF_FIT);
        let square = nodes
            .iter()
            .map(|node| node.weight * node.value * node.value)
            .sum();
        Self {
            alpha,
            mu,
            albedo: albedos(alpha, mu)[0],
            square,
            nodes,
        }
    }

    /// The squared sine of the angle between the third row and the axis of the lobe, where the first two
    /// components of M⁻¹ω vanish.
    fn squared_skew(&self, [a, b, d, e]: Elements) -> f64 {
        let b = self.alpha * b;
        let (along, across) = (a * e - b * d, a * d + b * e);
        (across / along.hypot(across)).powi(2)
    }

    /// The squared relative L2 error of a lobe with nearly the energy of the target, and the share of it.
    fn error(&self, [a, b, d, e]: Elements) -> (f64, f64) {
        let (alpha, mu) = (self.alpha, self.mu);
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        // Rows 1 and 3 along x and z.
        let row = |along: f64, up: f64| [along * mu + up * sine, up * mu - along * sine];
        let (first, third) = (row(a, alpha * b), row(alpha * d, alpha * e));
        let determinant = alpha * (a * e - alpha * b * d);
        // The direction of Mᵀn, whose third component gives the share above the horizon.
        let (up, along) = (a * mu + alpha * b * sine, alpha * (e * sine + d * mu));
        let above = 0.5 * (1.0 + up / up.hypot(along));
        let factor = self.albedo * determinant / (PI * above);
        // Integrals of the lobe's square, and of its product with the target.
        let (mut own, mut common) = (0.0, 0.0);
        for node in &self.nodes {
            let [x, y, z] = node.outgoing;
            let height = third[0] * x + third[1] * z;
            let side = first[0] * x + first[1] * z;
            let squared = side * side + y * y + height * height;
            let value = factor * height.max(0.0) / (squared * squared);
            own += node.weight * value * value;
            common += node.weight * value * node.value;
        }
        let share = (common / own.max(f64::MIN_POSITIVE)).clamp(1.0 - MOST_LET_GO, 1.0);
        let error = (share * (share * own - 2.0 * common) + self.square) / self.square;
        (error, share)
    }

    /// At normal incidence, where the matrix is diagonal with two equal elements.
    fn fit_head_on(&self, start: f64) -> Elements {
        let cost = |x: &[f64]| self.penalised([1.0, 0.0, 0.0, x[0]]);
        let e = minimum(&cost, vec![vec![start], vec![0.9 * start]], ITERATIONS[0])[0];
        [1.0, 0.0, 0.0, e]
    }

    /// From the fit for the next rougher surface, or, for α = 1, the best from several starts.
    fn fit(&self, rougher: Option<Elements>) -> Elements {
        let cosine = self.mu.max(0.05);
        let starts = match rougher {
            Some(rougher) => vec![rougher],
            None => vec![
                [1.0, 0.01, -1.2, 1.0],
                [0.7 * cosine, 0.5, -1.2, 1.2 * cosine],
                [cosine, 0.3, -0.6, 1.2 * cosine],
                [0.05, 1.0, -1.5, 0.05],
            ],
        };
        let cost = |x: &[f64]| {
            let elements = [x[0], x[1], x[2], x[3]];
            let change = rougher.map_or(0.0, |rougher| x[2] - rougher[2]);
            self.penalised(elements) + SMOOTHNESS * change * change
        };
        let best = starts.into_iter().map(|start| {
            let mut found = start.to_vec();
            for (iterations, size) in ITERATIONS.into_iter().zip([0.1, 0.03]) {
                let mut simplex = vec![found.clone(); 5];
                for (k, corner) in simplex[1..].iter_mut().enumerate() {
                    let step = [-found[0], 0.5, -1.0, found[3]][k];
                    corner[k] += size * step;
                }
                found = minimum(&cost, simplex, iterations);
            }
            let error = cost(&found);
            (clamped([found[0], found[1], found[2], found[3]]).0, error)
        });
        let best = best.min_by(|a, b| a.1.total_cmp(&b.1));
        best.expect("there is a start").0
    }

    /// The error of the nearest elements in range, and their squared distance.
    fn penalised(&self, elements: Elements) -> f64 {
        let (clamped, excess) = clamped(elements);
        self.error(clamped).0 + excess + SKEW * self.squared_skew(clamped)
    }
}

/// The nearest elements that the table can hold, and the squared distance to them.
fn clamped(elements: Elements) -> (Elements, f64) {
    let least = f64::from(LEAST_COUNT) / 65535.0;
    let mut excess = 0.0;
    let clamped = std::array::from_fn(|k| {
        let share = elements[k] / MATRIX_SCALES[k];
        let least = if k == 0 || k == 3 { least } else { 0.0 };
        let inside = share.clamp(least, 1.0);
        excess += (share - inside).powi(2);
        inside * MATRIX_SCALES[k]
    });
    (clamped, excess)
}

struct Cost<'a>(&'a dyn Fn(&[f64]) -> f64);

impl CostFunction for Cost<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Error> {
        Ok((self.0)(x))
    }
}

/// Where `cost` is least, by the method of [Nelder & Mead 1965].
pub fn minimum(cost: &dyn Fn(&[f64]) -> f64, simplex: Vec<Vec<f64>>, iterations: u64) -> Vec<f64> {
    let start = simplex[0].clone();
    let executor = Executor::new(Cost(cost), NelderMead::new(simplex))
        .configure(|state| state.max_iters(iterations))
        .timer(false);
    let result = executor.run().expect("the cost is a number everywhere");
    result.state().get_best_param().cloned().unwrap_or(start)
}
