//! The smallest ellipsoids at the knots, enlarged until samples between the knots are inside too.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;

use crate::certificate::{Angles, Interval, Lobe, level, masked, place, table};
use crate::reference::Smallest;

/// What the knots are enlarged by after all samples are inside.
const MARGIN: f64 = 1.015;
const SIZE: [usize; 3] = [table::ROUGHNESSES, table::INCIDENCES, table::REFLECTANCES];

type Knot = [f64; table::NUMBERS];

/// The table's numbers, in its order.
pub fn table() -> Vec<f32> {
    let mut knots: Vec<Knot> = all(SIZE)
        .into_par_iter()
        .map(|at| smallest(place(at)))
        .collect();
    let cells = all(SIZE.map(|knots| knots - 1));
    let growths: Vec<f64> = cells.par_iter().map(|cell| growth(&knots, *cell)).collect();
    let mut most = vec![1.0_f64; knots.len()];
    for (cell, growth) in cells.iter().zip(growths) {
        for corner in corners(*cell) {
            most[index(corner)] = most[index(corner)].max(growth);
        }
    }
    for (knot, growth) in knots.iter_mut().zip(most) {
        for number in &mut knot[2..] {
            *number *= growth * MARGIN;
        }
    }
    knots.into_iter().flatten().map(|x| x as f32).collect()
}

fn all([x, y, z]: [usize; 3]) -> Vec<[usize; 3]> {
    let pairs = (0..x).flat_map(move |i| (0..y).map(move |j| [i, j]));
    pairs
        .flat_map(|[i, j]| (0..z).map(move |k| [i, j, k]))
        .collect()
}

fn index([i, j, k]: [usize; 3]) -> usize {
    (i * SIZE[1] + j) * SIZE[2] + k
}

fn corners(cell: [usize; 3]) -> [[usize; 3]; 8] {
    std::array::from_fn(|c| {
        [
            cell[0] + (c & 1),
            cell[1] + (c >> 1 & 1),
            cell[2] + (c >> 2),
        ]
    })
}

fn smallest(parameters: [f64; 3]) -> Knot {
    let Smallest { center, shape } = Smallest::around(points(parameters, [160, 60]), 1e-4);
    [center[0], center[1], shape[0], shape[1], shape[2], shape[3]]
}

/// The factor by which the ellipsoids of a cell must grow to hold samples of the surface.
fn growth(knots: &[Knot], cell: [usize; 3]) -> f64 {
    let ends = corners(cell).map(|corner| knots[index(corner)]);
    let (low, high) = (place(cell), place(cell.map(|i| i + 1)));
    let mut most = 1.0_f64;
    for share in all([5, 5, 3]) {
        let t = [0, 1, 2].map(|i| share[i] as f64 / [4.0, 4.0, 2.0][i]);
        let knot: Knot = std::array::from_fn(|n| {
            let weight = |c: usize| {
                let along = |i: usize| if c >> i & 1 == 1 { t[i] } else { 1.0 - t[i] };
                along(0) * along(1) * along(2)
            };
            (0..8).map(|c| weight(c) * ends[c][n]).sum()
        });
        let parameters = [0, 1, 2].map(|i| low[i] + (high[i] - low[i]) * t[i]);
        for point in points(parameters, [60, 24]) {
            most = most.max(level(1.0, point, &knot));
        }
    }
    most.sqrt()
}

/// Points of the isosurface at √α, tan(θ/2) + tan(δ/2) and ∜F0, and the light.
fn points([x, y, z]: [f64; 3], [steps, steps_across]: [usize; 2]) -> Vec<[f64; 3]> {
    let angles = Angles::new(Interval::at(x), Interval::at(y));
    let angle = |half: Interval| (2.0 * half.middle().atan()).sin_cos();
    let ((s, c), (sd, cd)) = (angle(angles.tau), angle(angles.sigma));
    let alpha = x * x;
    let rl = c.hypot(alpha * s);
    let aol = if s > 0.2 { sd / s } else { alpha / rl };
    let lobe = Lobe {
        alpha,
        c,
        s,
        cd,
        sd,
        rl,
        aol,
    };
    let fresnel = |cosine: f64| z.powi(4) + (1.0 - z.powi(4)) * (1.0 - cosine).powi(5);
    let at = |phi: f64, psi: f64| {
        let ((up, along), (across, rest)) = (phi.sin_cos(), psi.sin_cos());
        let m = [rest * along, across, rest * up];
        let point = lobe.point(alpha.powi(2) + (1.0 - alpha.powi(2)) * m[2].powi(2), m);
        let is_above = point.e > 0.0;
        is_above.then(|| {
            let squared = masked(&lobe, &point) * fresnel(point.t) / fresnel(c);
            point.z.map(|zeta| squared.sqrt() * zeta)
        })
    };
    let step = PI / steps as f64;
    let mut points = vec![[0.0; 3]];
    for j in 0..steps_across {
        let psi = FRAC_PI_2 * j as f64 / steps_across as f64;
        for i in 0..steps {
            let phi = step * (i as f64 + 0.5);
            let (here, next) = (at(phi, psi), at(phi + step, psi));
            points.extend(here);
            if here.is_some() == next.is_some() {
                continue;
            }
            // At grazing incidence F and G2 leave the lobe an edge at the horizon.
            let (mut above, mut below) = (phi, phi + step);
            if here.is_none() {
                (above, below) = (below, above);
            }
            for _ in 0..40 {
                let middle = 0.5 * (above + below);
                if at(middle, psi).is_some() {
                    above = middle;
                } else {
                    below = middle;
                }
            }
            let inward = step * (above - below).signum();
            points.extend(
                [0.0, 0.03, 0.1, 0.3]
                    .map(|share| at(above + share * inward, psi))
                    .iter()
                    .flatten(),
            );
        }
    }
    points
}
