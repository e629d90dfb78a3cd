//! Chooses the inequalities behind the bound of transformed cosines: for each step of m₁₁ and m₁₁|b| the one whose
//! ellipsoids are smallest around the lobes of the table that have such an M. The notation is that of the bound.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;
use support::ltc_inequality::LtcInequality;
use support::reference::Smallest;

use crate::ltc::{Elements, layout as table, minimum};

#[allow(
    dead_code,
    reason = "the crate reads the table, this only needs its layout"
)]
#[path = "../../src/bound/ltc_rows.rs"]
pub mod layout;

/// Lobes between two knots of the table along each coordinate.
const FINENESS: usize = 2;
/// The most lobes that a choice is made for.
const LOBES: usize = 24;
/// Intervals of the proof while choosing, and of what is chosen.
const INTERVALS: [u32; 2] = [300, 20_000];
const ITERATIONS: u64 = 300;
/// The largest share that keeps Q away from singular.
const LARGEST_SHARE: f64 = 0.9;
/// The least ν that is chosen.
const LEAST_NU: f64 = 1e-3;
/// The largest angle of incidence, in degrees.
const MOST_DEGREES: f64 = 89.9;

/// The sizes m₁₁, m₂₂ and m₁₁|b| of M, for a third row of M⁻¹ of unit length.
pub type Sizes = [f64; 3];

/// A row before rounding: α₁, α₂, ln ν, the angle of û and the share of α₃.
type Choice = [f64; 5];

/// The bytes of the table.
pub fn table() -> Vec<u8> {
    let mut groups = vec![Vec::new(); layout::PLACES];
    for sizes in lobes() {
        groups[place(sizes)].push(sizes);
    }
    let places: Vec<usize> = (0..layout::PLACES)
        .filter(|i| !groups[*i].is_empty())
        .collect();
    let rows: Vec<_> = places.par_iter().map(|i| row(&groups[*i])).collect();
    // Where there are no lobes, the row of the nearest place that has some.
    let [x, y] = [
        |i: usize| (i / layout::STEPS) as f64,
        |i: usize| (i % layout::STEPS) as f64,
    ];
    let nearest = |i: usize| {
        let distance = |at: usize| (x(i) - x(at)).powi(2) + (y(i) - y(at)).powi(2);
        let order = |a: &usize, b: &usize| distance(places[*a]).total_cmp(&distance(places[*b]));
        (0..places.len()).min_by(order).expect("there are lobes") as u8
    };
    let indices = (0..layout::PLACES).map(nearest);
    indices
        .chain(rows.into_iter().flatten().flat_map(f32::to_le_bytes))
        .collect()
}

/// The place of M in the table.
pub fn place([along, _, slant]: Sizes) -> usize {
    layout::place(along as f32, slant as f32)
}

/// The lobes at the knots of their table and between, up to [`MOST_DEGREES`].
pub fn lobes() -> Vec<Sizes> {
    let last = FINENESS * (table::KNOTS - 1);
    let most = (1.0 - MOST_DEGREES.to_radians().cos()).sqrt();
    let mut lobes = Vec::new();
    for i in 1..=last {
        // Half of them, alternating.
        for j in (i % 2..=last).step_by(2) {
            let root = i as f64 / last as f64;
            let incidence = (j as f64 / last as f64).min(most);
            lobes.push(sizes(root * root, table::matrix(root, incidence)));
        }
    }
    lobes
}

fn sizes(alpha: f64, [a, b, d, e]: Elements) -> Sizes {
    let (b, d, e) = (alpha * b, alpha * d, alpha * e);
    let (length, determinant) = (d.hypot(e), a * e - b * d);
    let slant = (a * d + b * e) / determinant;
    [length * length / determinant, length, slant.abs()]
}

/// The row for these lobes.
pub fn row(lobes: &[Sizes]) -> [f32; layout::NUMBERS] {
    let count = lobes.len().min(LOBES);
    let chosen: Vec<(Sizes, f64)> = (0..count)
        .map(|i| lobes[i * lobes.len() / count])
        .map(|sizes| (sizes, smallest(sizes)))
        .collect();
    let cost = |choice: &[f64]| {
        let choice = [choice[0], choice[1], choice[2], choice[3], choice[4]];
        let Some(inequality) = inequality(choice) else {
            return 1e30;
        };
        let q = inequality.proved_q(INTERVALS[0]);
        let excess = |(sizes, smallest): &(Sizes, f64)| {
            (volume(*sizes, &inequality, q, choice[4]) / smallest - 1.0).powi(6)
        };
        chosen.iter().map(excess).sum::<f64>()
    };
    let mut best = (f64::INFINITY, [0.0; 5]);
    for ([_, _, slant], _) in [chosen[0], chosen[count / 2], chosen[count - 1]] {
        let tilt = slant.atan();
        let narrow = 1.0 / tilt.cos().max(0.1).sqrt();
        let nu = |nu: f64| nu.ln();
        for start in [
            [0.85, 0.1, nu(0.05), 0.6 * tilt, 0.4],
            [1.0, 0.09, nu(0.01), 0.7 * tilt, 0.4],
            [narrow, 0.05, nu(0.01), 0.95 * tilt, 0.3],
            [0.9, 0.02, nu(0.1), 0.1, 0.3],
        ] {
            let mut found = start.to_vec();
            for size in [1.0, 0.3] {
                let mut simplex = vec![found.clone(); 6];
                for (k, corner) in simplex[1..].iter_mut().enumerate() {
                    corner[k] += size * [0.05, 0.02, 0.5, -0.05, 0.1][k];
                }
                found = minimum(&cost, simplex, ITERATIONS);
            }
            let error = cost(&found);
            if error < best.0 {
                best = (error, [found[0], found[1], found[2], found[3], found[4]]);
            }
        }
    }
    rounded(best.1)
}

/// The inequality of a choice; none outside its range.
fn inequality([alpha_1, alpha_2, log_nu, angle, share]: Choice) -> Option<LtcInequality> {
    let (sine, cosine) = angle.sin_cos();
    let nu = log_nu.exp();
    let is_valid = (0.5..100.0).contains(&alpha_1)
        && (0.0..10.0).contains(&alpha_2)
        && (LEAST_NU..1.0).contains(&nu)
        && (0.0..FRAC_PI_2).contains(&angle)
        && (0.01..LARGEST_SHARE).contains(&share);
    is_valid.then_some(LtcInequality {
        alpha_1,
        alpha_2,
        sine,
        cosine,
        nu,
    })
}

/// The row as it is stored, with a q that is proved for the rounded numbers.
fn rounded(choice: Choice) -> [f32; layout::NUMBERS] {
    let exact = inequality(choice).expect("the best choice is in range");
    let [alpha_1, alpha_2, sine, cosine, nu] = [
        exact.alpha_1,
        exact.alpha_2,
        exact.sine,
        exact.cosine,
        exact.nu,
    ]
    .map(|x| x as f32);
    let stored = LtcInequality {
        alpha_1: alpha_1.into(),
        alpha_2: alpha_2.into(),
        sine: sine.into(),
        cosine: cosine.into(),
        nu: nu.into(),
    };
    // The next larger number, for it was rounded to the nearest.
    let q = f32::from_bits((stored.proved_q(INTERVALS[1]) as f32).to_bits() + 1);
    [alpha_1, alpha_2, sine, cosine, nu, q, choice[4] as f32]
}

/// The volume of the ellipsoid, in the space of X.
fn volume([m_1, m_2, k]: Sizes, inequality: &LtcInequality, q: f64, share: f64) -> f64 {
    let LtcInequality {
        alpha_1,
        alpha_2,
        sine,
        cosine,
        nu,
    } = *inequality;
    let v = [cosine * m_1, cosine * k - sine];
    let t = [sine * m_1, sine * k + cosine];
    let along = |i: usize, j: usize| v[i] * v[j] + nu * t[i] * t[j];
    let alpha_3 = share / (along(0, 0) + along(1, 1)).max(m_2 * m_2);
    let [q_11, q_33] = [0, 1].map(|i| 1.0 - alpha_3 * along(i, i));
    let (q_13, q_22) = (-alpha_3 * along(0, 1), 1.0 - alpha_3 * m_2 * m_2);
    let determinant = q_11 * q_33 - q_13 * q_13;
    let [l_1, l_3] = [alpha_2 * t[0], alpha_1 + alpha_2 * t[1]];
    let inside = q_33 * l_1 * l_1 - 2.0 * q_13 * l_1 * l_3 + q_11 * l_3 * l_3;
    let level = q / (4.0 * alpha_3) + 0.25 * inside / determinant;
    (level * level * level / (determinant * q_22)).sqrt()
}

/// The volume of the smallest ellipsoid around the isosurface, in the space of X.
fn smallest([m_1, m_2, k]: Sizes) -> f64 {
    const STEPS: u32 = 50;
    let mut points = vec![[0.0; 3]];
    for i in 0..STEPS {
        for j in 0..STEPS {
            let (sine, cosine) = (FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(STEPS)).sin_cos();
            let (across, along) = (PI * (f64::from(j) + 0.5) / f64::from(STEPS)).sin_cos();
            let [x, y, z] = [sine * along, sine * across, cosine];
            let length = (m_1 * x + k * z).hypot(m_2 * y).hypot(z);
            let radius = (z * length).sqrt();
            points.push([z * radius, x * radius, y * radius]);
        }
    }
    Smallest::around(points, 1e-3).volume()
}
