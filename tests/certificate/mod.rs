//! The proof that the ellipsoids of the table enclose the isosurface, cell by cell.
//!
//! A cell has three parameters, and the surface two: over the five together it is to be shown that
//! ‖y‖² ≤ 1 for the point sζ = c + A y, wherever it is above the horizon. A box of them is done
//!
//! - if all of it is below the horizon,
//! - if interval arithmetic with the largest s says so, or
//! - if ‖y‖² at its 32 corners, plus what it can be above a product of linear functions between them,
//!   says so: for a function with second derivatives ∂ᵢ² ≥ −κᵢ that is Σ κᵢ wᵢ²/8, wᵢ being the widths.
//!   As s has no derivative at the horizon, the tangent (s² + q)/(2√q) ≥ s stands in for it.
//!
//! Else it is halved where it bends most. Both of the latter need the light itself inside, which is
//! shown first. All is rounded outward.
#![allow(dead_code, unused_imports, reason = "each user needs a part")]

mod angles;
mod cell;
mod interval;
mod jet;
mod lobe;
mod over_box;
mod real;
#[path = "../../src/bound/table.rs"]
pub mod table;

pub use angles::Angles;
pub use cell::Cell;
pub use interval::Interval;
pub use lobe::{Lobe, level, masked};

pub use real::Real;

use cell::Box5;
use jet::VARIABLES;

/// What ‖y‖² is shown to be at most: the rest is for rounding to `f32`.
const MOST: f64 = 1.0 - 2e-4;

/// Where a cell is left, or is not shown not to be.
#[derive(Clone, Copy, Debug)]
pub struct Doubt {
    /// √α, tan(θ/2) + tan(δ/2) and ∜F0.
    pub parameters: [f64; 3],
}

impl Doubt {
    fn of(b: &Box5) -> Self {
        Self {
            parameters: [b[0].middle(), b[1].middle(), b[2].middle()],
        }
    }
}

/// The number of boxes that it takes to show that the ellipsoids of `cell` enclose the surface.
///
/// # Errors
///
/// The first doubt after `limit` boxes.
pub fn prove(cell: &Cell, limit: usize) -> Result<usize, Doubt> {
    let mut count = 0;
    let unit = Interval::new(0.0, 1.0);
    let [x, y, z] = [0, 1, 2].map(|i| Interval::new(cell.low[i], cell.high[i]));
    let whole = [x, y, z, unit, unit];
    halve_until(whole, &mut count, limit, |b| {
        let ellipsoid = cell.ellipsoids(b).map(|jet| jet.value);
        let light = level(Interval::at(0.0), [Interval::ZERO; 3], &ellipsoid);
        (light.high <= MOST)
            .then_some(())
            .ok_or([b[0], b[1], b[2]].map(Interval::width))
            .map_err(|[x, y, z]| [x, y, z, 0.0, 0.0])
    })?;
    for sign in [1.0, -1.0] {
        let mut known = ([x, y], Angles::new(x, y));
        halve_until(whole, &mut count, limit, |b| {
            if known.0 != [b[0], b[1]] {
                known = ([b[0], b[1]], Angles::new(b[0], b[1]));
            }
            is_enclosed(cell, &known.1, b, sign)
        })?;
    }
    Ok(count)
}

/// Halves boxes along the variable with the largest number that `check` gives, until it gives none.
fn halve_until(
    whole: Box5,
    count: &mut usize,
    limit: usize,
    mut check: impl FnMut(&Box5) -> Result<(), [f64; VARIABLES]>,
) -> Result<(), Doubt> {
    let mut boxes = vec![whole];
    while let Some(b) = boxes.pop() {
        *count += 1;
        let Err(scores) = check(&b) else { continue };
        if *count > limit {
            return Err(Doubt::of(&b));
        }
        let worst = (0..VARIABLES)
            .max_by(|i, j| scores[*i].total_cmp(&scores[*j]))
            .expect("there are variables");
        let middle = b[worst].middle();
        let (mut lower, mut upper) = (b, b);
        lower[worst].high = middle;
        upper[worst].low = middle;
        boxes.extend([lower, upper]);
    }
    Ok(())
}

/// Nothing if the box is done, else how much each variable is to blame.
fn is_enclosed(cell: &Cell, angles: &Angles, b: &Box5, sign: f64) -> Result<(), [f64; VARIABLES]> {
    let ellipsoids = cell.ellipsoids(b);
    let highest = over_box::highest_level(angles, b, sign, &ellipsoids.map(|jet| jet.value));
    if highest.is_none_or(|level| level <= MOST) {
        return Ok(());
    }
    let by_width = Err(std::array::from_fn(|i| {
        let share = if i < 3 {
            0.3 / (cell.high[i] - cell.low[i])
        } else {
            1.0
        };
        b[i].width() * share
    }));
    let corners = corners(cell, b, sign);
    let low = corners
        .iter()
        .map(|((s, _), _)| s.low)
        .fold(f64::INFINITY, f64::min);
    let high = corners.iter().map(|((s, _), _)| s.high).fold(0.0, f64::max);
    if !(low.is_finite() && high.is_finite()) {
        return by_width;
    }
    // Any q will do; this one touches s where it matters.
    let q = (0.5 * (low + high)).max(0.25 * high).max(1e-4);
    let squared = over_box::squared_jet(angles, b, sign);
    // In units of half a width the bound is Σ κᵢ/2.
    let bends = over_box::bends(squared, q, &ellipsoids).map(|bend| 0.5 * bend);
    let bend: f64 = bends.iter().sum();
    if !bend.is_finite() {
        return by_width;
    }
    let most = corners
        .iter()
        .map(|((squared, z), ellipsoid)| {
            let s = (*squared + Interval::at(q)) * Interval::at(0.5 / q.sqrt());
            level(s, *z, ellipsoid).high
        })
        .fold(0.0, f64::max);
    if (most + bend) * (1.0 + 1e-12) <= MOST {
        Ok(())
    } else {
        Err(bends)
    }
}

/// s², ζ and the ellipsoid at the corners of a box.
fn corners(cell: &Cell, b: &Box5, sign: f64) -> Vec<(over_box::Squared<Interval>, [Interval; 6])> {
    let end =
        |i: usize, side: usize| Interval::at(if side & 1 == 1 { b[i].high } else { b[i].low });
    let mut corners = Vec::with_capacity(32);
    for side in 0..4 {
        let (x, y) = (end(0, side), end(1, side >> 1));
        let angles = Angles::new(x, y);
        for z in [end(2, 0), end(2, 1)] {
            let ellipsoid = cell.ellipsoids(&[x, y, z, x, x]).map(|jet| jet.value);
            for side in 0..4 {
                let point = [x, y, z, end(3, side), end(4, side >> 1)];
                corners.push((over_box::squared(&angles, &point, sign), ellipsoid));
            }
        }
    }
    corners
}

impl Cell {
    /// The cells of the table.
    pub fn all() -> Vec<Self> {
        let [x, y, z] = [table::ROUGHNESSES, table::INCIDENCES, table::REFLECTANCES];
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
            knots: std::array::from_fn(corner),
            low: place(knot),
            high: place(knot.map(|i| i + 1)),
        }
    }
}

/// The coordinates of a knot.
pub fn place([i, j, k]: [usize; 3]) -> [f64; 3] {
    let share = |i: usize, knots: usize| i as f64 / (knots - 1) as f64;
    let least = f64::from(table::LEAST_ROOT);
    [
        share(i, table::ROUGHNESSES),
        2.0 * share(j, table::INCIDENCES),
        least + (1.0 - least) * share(k, table::REFLECTANCES),
    ]
}
