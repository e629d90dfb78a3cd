//! Makes the table of ellipsoids around clusters: the smallest ellipsoids of revolution at the knots, enlarged
//! until they enclose between the knots too.
//!
//! In units of u₁ (`src/bound/cluster.rs`) a cluster has two parameters, λ and t = A/u₁, and reaches
//! R = √(1 − t). With u = l² + t and S = λu/t it reaches as far as l in the directions at the angle to its axis
//! whose cosine is c, 1 − c = uG/(λL(S)l²), G = ln((1 − e^{−2S})/(1 − e^{−2λ/t})) − ln u.

use std::f64::consts::PI;

#[allow(
    dead_code,
    reason = "the crate reads the table, the fit only needs its layout"
)]
#[path = "../../src/bound/cluster_table.rs"]
pub mod layout;

use layout::{KNOTS, NUMBERS, UNIT};

/// How far an ellipsoid extends ahead and behind, and its squared semi-axis across over w, in units of R.
pub type Knot = [f64; NUMBERS];

/// Height along the axis and squared distance from it, in units of R.
type Point = [f64; 2];

/// The share by which an ellipsoid is larger than samples need, for the proof.
const ROOM: f64 = 0.01;
/// The least extent behind the light. Where the smallest ellipsoid ends at the light, the proof would not end.
const LEAST_REAR: f64 = 0.03;

/// The bytes of the table.
pub fn table() -> Vec<u8> {
    let all = || (0..KNOTS * KNOTS).map(|k| [k % KNOTS, k / KNOTS]);
    let at = |knot: [usize; 2]| knot.map(|i| i as f64 / (KNOTS - 1) as f64);
    let mut knots: Vec<Knot> = all()
        .map(|knot| smallest(&surface(at(knot), 200), at(knot), LEAST_REAR))
        .collect();
    let mut growths = vec![1.0_f64; knots.len()];
    for [i, j] in all().filter(|[i, j]| i + 1 < KNOTS && j + 1 < KNOTS) {
        let corners = [0, 1, KNOTS, KNOTS + 1].map(|step| j * KNOTS + i + step);
        let growth = growth_of_cell([i, j], corners.map(|corner| knots[corner]));
        for corner in corners {
            growths[corner] = growths[corner].max(growth);
        }
    }
    for (knot, growth) in knots.iter_mut().zip(growths) {
        *knot = grown(*knot, growth * (1.0 + ROOM));
    }
    let counts = knots.into_iter().flatten();
    let counts = counts.map(|number| (number / f64::from(UNIT)).ceil() as u16);
    counts.flat_map(u16::to_le_bytes).collect()
}

/// λ and t at √w and √t.
pub fn parameters([root_w, root_t]: [f64; 2]) -> [f64; 2] {
    // At the ends the limits are near enough.
    let w = (root_w * root_w).max(1e-7);
    [2.0 * (1.0 / w - 1.0), (root_t * root_t).min(1.0 - 1e-6)]
}

/// The ellipsoid scaled up about its centre.
fn grown([front, rear, across]: Knot, growth: f64) -> Knot {
    let (along, center) = (0.5 * (front + rear) * growth, 0.5 * (front - rear));
    [along + center, along - center, across * growth * growth]
}

/// The factor by which the ellipsoids of a cell must grow to enclose at samples.
fn growth_of_cell(cell: [usize; 2], corners: [Knot; 4]) -> f64 {
    const STEPS: usize = 4;
    let mut most = 1.0_f64;
    for step in 0..(STEPS + 1) * (STEPS + 1) {
        let share = [step % (STEPS + 1), step / (STEPS + 1)].map(|i| i as f64 / STEPS as f64);
        let place = [0, 1].map(|i| (cell[i] as f64 + share[i]) / (KNOTS - 1) as f64);
        let knot = between(corners, share);
        most = most.max(level(&surface(place, 150), knot, place));
    }
    most
}

/// The ellipsoid between those of the `corners` of a cell, √w changing faster.
pub fn between(corners: [Knot; 4], [u, v]: [f64; 2]) -> Knot {
    std::array::from_fn(|n| {
        let [a, b, c, d] = corners.map(|corner| corner[n]);
        let (near, far) = (a + (b - a) * u, c + (d - c) * u);
        near + (far - near) * v
    })
}

/// The factor by which an ellipsoid must grow about its centre to hold the points.
pub fn level(points: &[Point], [front, rear, across]: Knot, place: [f64; 2]) -> f64 {
    let (along, center) = (0.5 * (front + rear), 0.5 * (front - rear));
    let across = across * w(place);
    let levels = points
        .iter()
        .map(|[height, squared]| ((height - center) / along).powi(2) + squared / across);
    levels.fold(0.0, f64::max).sqrt()
}

fn w(place: [f64; 2]) -> f64 {
    let [lambda, _] = parameters(place);
    1.0 / (1.0 + 0.5 * lambda)
}

/// Points of the surface, in units of R.
pub fn surface(place: [f64; 2], steps: usize) -> Vec<Point> {
    let [lambda, t] = parameters(place);
    let reach = (1.0 - t).sqrt();
    let share = |i: usize| i as f64 / steps as f64;
    if lambda < 1e-9 {
        let angles = (0..=steps).map(|i| PI * share(i));
        return angles
            .map(|angle| [angle.cos(), angle.sin().powi(2)])
            .collect();
    }
    // l(1 − c)
    let lag = |l: f64| {
        let u = l * l + t;
        u * decay(lambda, t, u) / (lambda * langevin(lambda * u / t) * l)
    };
    // The least l, straight behind.
    let (mut low, mut high) = (0.0, reach);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle > 0.0 && lag(middle) <= 2.0 * middle {
            high = middle;
        } else {
            low = middle;
        }
    }
    let least = high;
    let mut points = vec![[-least / reach, 0.0], [1.0, 0.0]];
    for i in 1..steps {
        let evenly = least + (reach - least) * (0.5 - 0.5 * (PI * share(i)).cos());
        let by_decades = least * (reach / least).powf(share(i));
        for l in [evenly, by_decades] {
            let lag = lag(l).clamp(0.0, 2.0 * l);
            points.push([(l - lag) / reach, lag * (2.0 * l - lag) / (reach * reach)]);
        }
    }
    points
}

/// L(S) = coth S − 1/S.
fn langevin(s: f64) -> f64 {
    if s < 1e-3 {
        s / 3.0 - s.powi(3) / 45.0
    } else {
        1.0 / s.tanh() - 1.0 / s
    }
}

/// G
fn decay(lambda: f64, t: f64, u: f64) -> f64 {
    let share = |s: f64| (-(-2.0 * s).exp_m1()).ln();
    let of_spread = if t > 0.0 {
        share(lambda * u / t) - share(lambda / t)
    } else {
        0.0
    };
    of_spread - u.ln()
}

/// The smallest ellipsoid of revolution around the points that reaches back as far as `least_rear`, found by search.
pub fn smallest(points: &[Point], place: [f64; 2], least_rear: f64) -> Knot {
    let heights = points.iter().map(|[height, _]| *height);
    let (rear, front) = (
        -heights.clone().fold(f64::INFINITY, f64::min),
        heights.fold(f64::NEG_INFINITY, f64::max),
    );
    let rear = rear.max(least_rear);
    // In the inverse of the semi-axis along, and in the centre over it, the condition across is convex.
    let extents = |inverse: f64, shift: f64| [(1.0 + shift) / inverse, (1.0 - shift) / inverse];
    let squared = |inverse: f64, shift: f64| {
        let across = points.iter().map(|[height, squared]| {
            let rest = 1.0 - (height * inverse - shift).powi(2);
            if *squared < 1e-300 && rest > -1e-12 {
                0.0
            } else if rest <= 0.0 {
                f64::INFINITY
            } else {
                squared / rest
            }
        });
        across.fold(0.0, f64::max)
    };
    let best_shift = |inverse: f64| {
        least(front * inverse - 1.0, 1.0 - rear * inverse, |shift| {
            squared(inverse, shift)
        })
    };
    let narrowest = 2.0 / (front + rear);
    let inverse = least(0.3 * narrowest, narrowest, |inverse| {
        squared(inverse, best_shift(inverse)) / inverse
    });
    let shift = best_shift(inverse);
    let [ahead, behind] = extents(inverse, shift);
    [ahead, behind, squared(inverse, shift) / w(place)]
}

/// Where a convex function is least.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..50 {
        let third = (high - low) / 3.0;
        if f(low + third) <= f(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    0.5 * (low + high)
}
