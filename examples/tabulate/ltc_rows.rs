//! Chooses the inequalities behind the bound of transformed cosines: for each step of m₁₁ and m₁₁|b| one whose ellipsoids
//! are small around the lobes of the table that have such an M. The notation is that of the bound.
//!
//! Each inequality holds for any M. So they are made for coarse places, of two steps by two, and each place takes the
//! best of all. Then the places where even that is worst get inequalities of their own, as many as a byte can count. Those
//! that no place takes make room for others, a few times.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

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

/// Lobes between two knots of the table along each coordinate, for which rows are made, and among which each place takes
/// the best one. Near grazing incidence lobes between two knots are of many places.
pub const FINENESS: [usize; 2] = [2, 16];
/// The most lobes that a choice is made for, of an inequality and among all.
const LOBES: [usize; 2] = [24, 96];
/// How often inequalities that no place takes are replaced.
const REPLACEMENTS: u32 = 3;
/// The most rows that a byte can count.
const MOST_ROWS: usize = 256;
/// Intervals of the proof while choosing, and of what is chosen.
const INTERVALS: [u32; 2] = [1_000, 20_000];
const ITERATIONS: u64 = 600;
/// The largest share that keeps Q away from singular.
const LARGEST_SHARE: f64 = 0.9;
/// The least ν that is chosen.
const LEAST_NU: f64 = 1e-7;
/// The largest angle of incidence, in degrees.
const MOST_DEGREES: f64 = 89.9;
/// By how much larger a bound may be beyond the last knot before grazing incidence.
const GRAZING_ALLOWANCE: f64 = 1.03;

/// The sizes m₁₁, m₂₂ and m₁₁|b| of M, for a third row of M⁻¹ of unit length.
type Sizes = [f64; 3];

/// A lobe that the table is made for.
#[derive(Clone, Copy)]
pub struct Lobe {
    sizes: Sizes,
    /// By how much larger than elsewhere its bound may be.
    allowance: f64,
}

/// A row before rounding: α₁, α₂, ln ν, the angle of û and the share of α₃.
type Choice = [f64; 5];

/// A row as it is stored.
type Row = [f32; layout::NUMBERS];

/// The bytes of the table.
pub fn table() -> Vec<u8> {
    let coarse = coarse_places();
    let mut rows: Vec<Row> = coarse.par_iter().map(|lobes| row(lobes)).collect();
    let places = Place::all(FINENESS[0]);
    let mut worst = by_quality(&places, &rows);
    worst.truncate(MOST_ROWS - rows.len());
    rows.par_extend(worst.into_par_iter().map(Place::row));
    let places = Place::all(FINENESS[1]);
    for _ in 0..REPLACEMENTS {
        let taken: BTreeSet<usize> = places.par_iter().map(|place| place.best(&rows).0).collect();
        let unused: Vec<usize> = (coarse.len()..rows.len())
            .filter(|i| !taken.contains(i))
            .collect();
        let worst = by_quality(&places, &rows);
        let worst: Vec<_> = unused.into_iter().zip(worst).collect();
        let made: Vec<_> = worst
            .into_par_iter()
            .map(|(i, place)| (i, place.row()))
            .collect();
        for (i, row) in made {
            rows[i] = row;
        }
    }
    let indices = indices(&places, &rows);
    let numbers = rows.into_iter().flatten().flat_map(f32::to_le_bytes);
    indices.into_iter().chain(numbers).collect()
}

/// The places, those first where the best row is worst.
fn by_quality<'a>(places: &'a [Place], rows: &[Row]) -> Vec<&'a Place> {
    let mut worst: Vec<_> = places
        .par_iter()
        .map(|place| (place, place.best(rows).1))
        .collect();
    worst.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    worst.into_iter().map(|(place, _)| place).collect()
}

/// The index of the best row for each place.
fn indices(places: &[Place], rows: &[Row]) -> Vec<u8> {
    let best: Vec<usize> = places.par_iter().map(|place| place.best(rows).0).collect();
    // Where there are no lobes, the row of the nearest place that has some.
    let nearest = |index: usize| {
        let [x, y] = steps(index);
        let distance = |place: &Place| {
            let [other_x, other_y] = steps(place.index);
            x.abs_diff(other_x).pow(2) + y.abs_diff(other_y).pow(2)
        };
        let nearest = (0..places.len()).min_by_key(|i| distance(&places[*i]));
        best[nearest.expect("there are lobes")] as u8
    };
    (0..layout::PLACES).map(nearest).collect()
}

/// The lobes of each coarse place that has some. Each group has a row, in this order, before all others.
pub fn coarse_places() -> Vec<Vec<Lobe>> {
    let mut coarse = BTreeMap::new();
    for lobe in lobes(FINENESS[0]) {
        let key = steps(place(lobe.sizes)).map(|step| step / 2);
        coarse.entry(key).or_insert_with(Vec::new).push(lobe);
    }
    coarse.into_values().collect()
}

/// The steps of m₁₁ and of m₁₁|b| at a place.
fn steps(index: usize) -> [usize; 2] {
    [index / layout::STEPS, index % layout::STEPS]
}

/// A place of the table that has lobes.
pub struct Place {
    pub index: usize,
    lobes: Vec<Lobe>,
    /// Some of the lobes, each with the volume that its bound may have, once they are asked for.
    allowed: OnceLock<Vec<(Sizes, f64)>>,
}

impl Place {
    /// All of them, for this many lobes between two knots.
    pub fn all(fineness: usize) -> Vec<Self> {
        let mut groups = BTreeMap::new();
        for lobe in lobes(fineness) {
            let group = groups.entry(place(lobe.sizes));
            group.or_insert_with(Vec::new).push(lobe);
        }
        let places = groups.into_iter().map(|(index, lobes)| Self {
            index,
            lobes,
            allowed: OnceLock::new(),
        });
        places.collect()
    }

    /// A row for the lobes.
    fn row(&self) -> Row {
        row(&self.lobes)
    }

    /// The row that is best for the lobes, and the worst quotient of volumes with it.
    pub fn best(&self, rows: &[Row]) -> (usize, f64) {
        let allowed = self.allowed.get_or_init(|| some_of(&self.lobes, LOBES[1]));
        let worst = |row: &Row| {
            let [alpha_1, alpha_2, sine, cosine, nu, q, share] = *row;
            let inequality = LtcInequality::from_numbers([alpha_1, alpha_2, sine, cosine, nu]);
            let ratio = |(sizes, allowed): &(Sizes, f64)| {
                volume(*sizes, &inequality, q.into(), share.into()) / allowed
            };
            allowed.iter().map(ratio).fold(0.0, f64::max)
        };
        let ratios = rows.iter().map(worst).enumerate();
        ratios
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .expect("there are rows")
    }
}

/// Up to `most` of these, each with the volume of the smallest ellipsoid, times what is allowed.
fn some_of(lobes: &[Lobe], most: usize) -> Vec<(Sizes, f64)> {
    let count = lobes.len().min(most);
    let chosen = (0..count).map(|i| lobes[i * lobes.len() / count]);
    let allowed = |lobe: Lobe| (lobe.sizes, smallest(lobe.sizes) * lobe.allowance);
    chosen.map(allowed).collect()
}

/// The place of M in the table.
fn place([along, _, slant]: Sizes) -> usize {
    layout::place(along as f32, slant as f32)
}

/// The lobes at the knots of their table and between, up to [`MOST_DEGREES`].
fn lobes(fineness: usize) -> Vec<Lobe> {
    let last = fineness * (table::KNOTS - 1);
    let most = (1.0 - MOST_DEGREES.to_radians().cos()).sqrt();
    let mut lobes = Vec::new();
    for i in 1..=last {
        // Half of them, alternating.
        for j in (i % 2..=last).step_by(2) {
            let root = i as f64 / last as f64;
            let incidence = (j as f64 / last as f64).min(most);
            let alpha = root * root;
            // Narrower lobes have the matrix of a larger μ.
            if alpha * (1.0 - incidence * incidence) >= f64::from(table::LEAST_WIDTH) {
                let is_grazing = j > fineness * (table::KNOTS - 2);
                lobes.push(Lobe {
                    sizes: sizes(alpha, table::matrix(root, incidence)),
                    allowance: if is_grazing { GRAZING_ALLOWANCE } else { 1.0 },
                });
            }
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
pub fn row(lobes: &[Lobe]) -> Row {
    let chosen = some_of(lobes, LOBES[0]);
    let count = chosen.len();
    let cost = |choice: &[f64]| {
        let choice = [choice[0], choice[1], choice[2], choice[3], choice[4]];
        let Some(inequality) = inequality(choice) else {
            return 1e30;
        };
        let q = inequality.proved_q(INTERVALS[0]);
        let excess = |(sizes, allowed): &(Sizes, f64)| {
            (volume(*sizes, &inequality, q, choice[4]) / allowed - 1.0).powi(6)
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
            [narrow, 0.02, nu(1e-4), 0.97 * tilt, 0.4],
            [1.3, 0.05, nu(0.05), 0.0, 0.5],
            [narrow, 0.002, nu(0.1), 0.5 * tilt, 0.5],
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
fn rounded(choice: Choice) -> Row {
    let exact = inequality(choice).expect("the best choice is in range");
    let numbers = [
        exact.alpha_1,
        exact.alpha_2,
        exact.sine,
        exact.cosine,
        exact.nu,
    ]
    .map(|x| x as f32);
    let stored = LtcInequality::from_numbers(numbers);
    let [alpha_1, alpha_2, sine, cosine, nu] = numbers;
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
