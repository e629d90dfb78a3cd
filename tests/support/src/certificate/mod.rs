//! The proof that the ellipsoids of the table enclose the isosurface, cell by cell.
//!
//! A cell has three parameters, and the surface two: over the five together it is to be shown that
//! ‖y‖² ≤ 1 for the point sζ = c + A y, wherever it is above the horizon. Over a box of them ‖y‖² is
//! calculated as a polynomial of the second degree and what that is off by at most ([`taylor`]), and the
//! box is done if either all of it is below the horizon, or the polynomial is low enough, which for the
//! most part is a matter of its 32 corners. Else it is halved where most is lost.
//!
//! Where s or its factors have no such polynomial, as s has none at the horizon, something larger stands
//! in for it. That is allowed once the light is shown to be inside: an ellipsoid that contains the light
//! and Sζ contains all between them, and so sζ for any s ≤ S.
//!
//! All is rounded outward.

mod angles;
mod cell;
mod chain;
mod cluster;
mod interval;
mod lobe;
mod operators;
mod over_box;
mod real;
mod slopes;
#[path = "../../../../src/bound/table.rs"]
#[expect(dead_code, reason = "the crate interpolates between the knots")]
mod table;
pub mod taylor;

use std::array::from_fn;

pub use angles::Angles;
pub use cell::{Box5, Cell};
pub use cluster::ClusterCell;
pub use interval::Interval;
pub use lobe::{Lobe, Point, level, masked};
pub use over_box::{Parameters, Verdict, root};
pub use real::Real;
pub use slopes::{Slopes, prove_positive};
pub use taylor::Taylor;

use taylor::{PerVariable, VARIABLES};

/// How many knots the table has along each coordinate.
pub const KNOTS: [usize; 3] = [table::ROUGHNESSES, table::INCIDENCES, table::REFLECTANCES];
/// How many numbers an ellipsoid of the table is.
pub const NUMBERS: usize = table::NUMBERS;
/// The least ∜F0 of the table.
pub const LEAST_ROOT: f64 = table::LEAST_ROOT as f64;

/// What ‖y‖² is shown to be at most: the rest is for rounding to `f32`.
const MOST: f64 = 1.0 - 2e-4;
/// No box is narrower by that in one variable than in another, in shares of all there is.
const NARROWEST: f64 = 1.0 / 4096.0;

/// Where a cell is left, or is not shown not to be.
#[derive(Clone, Copy, Debug)]
pub struct Doubt {
    /// √α, tan(θ/2) + tan(δ/2) and ∜F0.
    pub parameters: [f64; 3],
}

/// Half vectors m = (cosψ sinφ, sinψ, cosψ cosφ), by the tangents of φ/2 and ψ/2: those across the plane of
/// incidence are alike.
const HALF_VECTORS: [Interval; 2] = [
    Interval {
        low: -1.0,
        high: 1.0,
    },
    Interval {
        low: 0.0,
        high: 1.0,
    },
];

/// The number of boxes that it takes to show that the ellipsoids of `cell` enclose the surface.
///
/// # Errors
///
/// The first doubt after `limit` boxes.
pub fn prove(cell: &Cell, limit: usize) -> Result<usize, Doubt> {
    let mut count = 0;
    let [x, y, z] = [0, 1, 2].map(|i| Interval::new(cell.low[i], cell.high[i]));
    let [p, q] = HALF_VECTORS;
    let whole = [x, y, z, p, q];
    halve_until(whole, &mut count, limit, |b| {
        if Parameters::new(cell, b).level_of_light() <= MOST {
            return Ok(());
        }
        let [x, y, z] = [b[0], b[1], b[2]].map(Interval::width);
        Err([x, y, z, 0.0, 0.0])
    })?;
    let mut parameters = Parameters::new(cell, &whole);
    halve_until(whole, &mut count, limit, |b| {
        if !parameters.are_of(b) {
            parameters = Parameters::new(cell, b);
        }
        match parameters.verdict(b) {
            Verdict::BelowHorizon => Ok(()),
            Verdict::Level { most, .. } if most <= MOST => Ok(()),
            Verdict::Level { most, blame } if most.is_finite() => Err(blame),
            Verdict::Level { .. } => Err(from_fn(|i| {
                // The surface first.
                let weight = if i < 3 { 0.3 } else { 1.0 };
                weight * b[i].width() / whole[i].width()
            })),
        }
    })?;
    Ok(count)
}

/// Halves boxes along the variable with the largest number that `check` gives, until it gives none.
fn halve_until(
    whole: Box5,
    count: &mut usize,
    limit: usize,
    mut check: impl FnMut(&Box5) -> Result<(), PerVariable>,
) -> Result<(), Doubt> {
    let mut boxes = vec![whole];
    while let Some(b) = boxes.pop() {
        *count += 1;
        let Err(blame) = check(&b) else { continue };
        if *count > limit {
            return Err(Doubt {
                parameters: [b[0], b[1], b[2]].map(Interval::middle),
            });
        }
        let shares: PerVariable = from_fn(|i| b[i].width() / whole[i].width());
        let widest = shares.into_iter().fold(0.0, f64::max);
        let worst = (0..VARIABLES)
            .filter(|i| shares[*i] >= NARROWEST * widest)
            .max_by(|i, j| blame[*i].total_cmp(&blame[*j]))
            .expect("the widest is wide enough");
        let middle = b[worst].middle();
        let (mut lower, mut upper) = (b, b);
        lower[worst].high = middle;
        upper[worst].low = middle;
        boxes.extend([lower, upper]);
    }
    Ok(())
}

impl Cell {
    /// The cells of the table.
    pub fn all() -> Vec<Self> {
        let [x, y, z] = KNOTS;
        let cells = (0..x - 1).flat_map(|i| (0..y - 1).map(move |j| (i, j)));
        cells
            .flat_map(|(i, j)| (0..z - 1).map(move |k| Self::at([i, j, k])))
            .collect()
    }

    /// The cell after the knot numbered `knot` along each coordinate.
    pub fn at(knot: [usize; 3]) -> Self {
        let corner = |c: usize| {
            let at = [
                knot[0] + (c & 1),
                knot[1] + (c >> 1 & 1),
                knot[2] + (c >> 2),
            ];
            table::knot(at).map(f64::from)
        };
        Self {
            knots: from_fn(corner),
            low: place(knot),
            high: place(knot.map(|i| i + 1)),
        }
    }
}

/// The coordinates of a knot.
pub fn place([i, j, k]: [usize; 3]) -> [f64; 3] {
    let share = |i: usize, knots: usize| i as f64 / (knots - 1) as f64;
    [
        share(i, KNOTS[0]),
        2.0 * share(j, KNOTS[1]),
        LEAST_ROOT + (1.0 - LEAST_ROOT) * share(k, KNOTS[2]),
    ]
}
