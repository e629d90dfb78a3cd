//! The ellipsoids at the knots, with as much margin as samples between the knots need, and more.
//!
//! In each frame a light's ellipsoid is scaled by 1/√ξ. A point at a distance d from the light is then
//! inside for a share ρ²/d² of all ξ, ρ being the distance to the ellipsoid along the same ray, and a
//! surface that it falls on takes the solid angle cos/d². However surfaces lie, what they have inside
//! grows with ρ² over the solid angle, unlike the volume, with ρ³: that sum over the directions above
//! the lit surface is made the least, and a little of the volume.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;
use stochastic_light_culling::glam::DVec3;
use support::certificate::{
    Angles, Interval, KNOTS, LEAST_ROOT, Lobe, NUMBERS, level, masked, place,
};
use support::reference::Smallest;

use crate::fit::{Aim, Fit, Held, Ray};

/// What ln V counts next to the logarithm of the sum of ρ².
const VOLUME: f64 = 0.1;

/// The share by which everything is scaled up about the ellipsoid's centre and yet inside.
///
/// By roughness, and by incidence or reflectance, whichever is more. Little where each per cent is up to
/// eight of the lights per pixel; more for rough surfaces and dielectrics, where the paper's spheroid is far
/// behind; more near normal incidence, where the spheroid of a metal is taken instead, and the surface
/// follows the ellipsoid so closely that the proof would need most boxes.
const MARGIN_BY_ROUGHNESS: [f64; KNOTS[0]] =
    [0.03, 0.004, 0.0, 0.003, 0.006, 0.02, 0.03, 0.03, 0.03];
const MARGIN_BY_INCIDENCE: [f64; KNOTS[1]] = [
    0.03, 0.02, 0.012, 0.005, 0.001, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.001, 0.002, 0.003, 0.005,
    0.005, 0.005, 0.005, 0.005, 0.005, 0.005,
];
const MARGIN_BY_REFLECTANCE: [f64; KNOTS[2]] = [0.016, 0.016, 0.018, 0.018, 0.012, 0.0, 0.0];
/// How strongly points are kept from the ellipsoid's surface, which makes the knots change smoothly.
const STRENGTH: [f64; KNOTS[0]] = [0.1, 0.05, 0.04, 0.06, 0.06, 0.06, 0.06, 0.06, 0.06];

type Knot = [f64; NUMBERS];

/// The table's numbers, in its order.
pub fn table() -> Vec<f32> {
    let places = all(KNOTS);
    let fit = |growths: &[f64]| -> Vec<Knot> {
        let knots = places.par_iter().zip(growths);
        knots
            .map(|(at, growth)| fitted(place(*at), growth.max(1.0)))
            .collect()
    };
    let first = fit(&vec![1.0; places.len()]);
    let mut knots = fit(&growths(&first));
    let growths = growths(&knots);
    for (knot, growth) in knots.iter_mut().zip(growths) {
        for number in &mut knot[2..] {
            *number *= growth.max(1.0);
        }
    }
    knots.into_iter().flatten().map(|x| x as f32).collect()
}

/// The largest growth of the cells around each knot.
fn growths(knots: &[Knot]) -> Vec<f64> {
    let cells = all(KNOTS.map(|knots| knots - 1));
    let of_cells: Vec<f64> = cells.par_iter().map(|cell| growth(knots, *cell)).collect();
    let mut most = vec![0.0_f64; knots.len()];
    for (cell, growth) in cells.iter().zip(of_cells) {
        for corner in corners(*cell) {
            most[index(corner)] = most[index(corner)].max(growth);
        }
    }
    most
}

fn all([x, y, z]: [usize; 3]) -> Vec<[usize; 3]> {
    let pairs = (0..x).flat_map(move |i| (0..y).map(move |j| [i, j]));
    pairs
        .flat_map(|[i, j]| (0..z).map(move |k| [i, j, k]))
        .collect()
}

fn index([i, j, k]: [usize; 3]) -> usize {
    (i * KNOTS[1] + j) * KNOTS[2] + k
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

/// What ‖y‖² may be at most, at the light and far from it, and the strength of the barrier.
struct Room {
    near: f64,
    far: f64,
    strength: f64,
}

impl Room {
    fn new([x, y, z]: [f64; 3]) -> Self {
        let incidence = y * 0.5 * (KNOTS[1] - 1) as f64;
        let reflectance = (z - LEAST_ROOT) / (1.0 - LEAST_ROOT) * (KNOTS[2] - 1) as f64;
        let roughness = x * (KNOTS[0] - 1) as f64;
        let more = between(&MARGIN_BY_INCIDENCE, incidence)
            .max(between(&MARGIN_BY_REFLECTANCE, reflectance));
        let margin = 1.0 + between(&MARGIN_BY_ROUGHNESS, roughness) + more;
        let far = margin.powi(-2);
        Self {
            near: 0.5 + 0.5 * far,
            far,
            strength: between(&STRENGTH, roughness),
        }
    }

    fn at(&self, point: [f64; 3]) -> f64 {
        let distance = DVec3::from(point).length().min(1.0);
        let over = (1.0 - distance) / self.near + distance / self.far;
        1.0 / over
    }
}

/// Between the values at whole numbers, and the last from there on.
fn between(values: &[f64], at: f64) -> f64 {
    let i = (at as usize).min(values.len() - 2);
    values[i] + (values[i + 1] - values[i]) * (at - i as f64).min(1.0)
}

/// Around the surface scaled up by `growth` about the ellipsoid's centre.
fn fitted(parameters: [f64; 3], growth: f64) -> Knot {
    let room = Room::new(parameters);
    let points = points(parameters, [100, 40]);
    let held: Vec<Held> = points
        .iter()
        .map(|point| Held {
            point: DVec3::from(*point),
            most: room.at(*point) / growth.powi(2),
        })
        .collect();
    let Smallest { center, shape } = Smallest::around(points, 1e-2);
    let shape = shape.map(|number| number * growth * 1.1 / room.far.sqrt());
    let [along, slant, aside, across] = shape;
    let aim = Aim {
        points: &held,
        rays: &rays(parameters),
        volume: VOLUME,
        strength: room.strength,
    };
    aim.reach(Fit::new([
        center[0], center[1], along, slant, aside, across,
    ]))
    .numbers()
}

/// Directions above the lit surface, by the solid angle that they stand for, so that Σ w ρ² in the
/// table's coordinates is the integral of ρ² in space.
///
/// A direction ν there is Dν in space, D = diag(1/α, 1, √L), and the integral ∫ ρ² ‖Dν‖⁻¹ dν. With
/// ν₁ = αm sinh t and m = ‖(cosφ, √L sinφ)‖ it is nearly even in t.
fn rays([x, y, _]: [f64; 3]) -> Vec<Ray> {
    const STEPS: [u32; 2] = [24, 48];
    /// Of the horizon, as a sine, so that no ray drops out at once.
    const WIDTH: f64 = 0.05;
    // For α → 0 all but what lies across the mirror direction would cease to count.
    let x = x.clamp(0.15, 0.95);
    let ((s, c), _) = angles(x, y);
    let alpha = x * x;
    let root = c.hypot(alpha * s);
    let mut rays = Vec::new();
    for j in 0..STEPS[0] {
        let (sine, cosine) = (PI * (f64::from(j) + 0.5) / f64::from(STEPS[0])).sin_cos();
        let m = cosine.hypot(root * sine);
        let most = (1.0 / (alpha * m)).asinh();
        for i in 0..STEPS[1] {
            let t = most * ((2.0 * f64::from(i) + 1.0) / f64::from(STEPS[1]) - 1.0);
            let first = alpha * m * t.sinh();
            let rest = (1.0 - first * first).max(0.0).sqrt();
            let along = DVec3::new(first, rest * cosine, rest * sine);
            let in_space = along * DVec3::new(1.0 / alpha, 1.0, root);
            let height = (c * in_space.x - s * in_space.y) / in_space.length();
            let above = (0.5 + height / WIDTH).clamp(0.0, 1.0);
            let weight = above * most * m * t.cosh() / in_space.length();
            if weight > 0.0 {
                rays.push(Ray { along, weight });
            }
        }
    }
    rays
}

/// Sine and cosine of θ and of δ, at √α and tan(θ/2) + tan(δ/2).
fn angles(x: f64, y: f64) -> ((f64, f64), (f64, f64)) {
    let Angles { tau, sigma } = Angles::new(Interval::at(x), Interval::at(y));
    let angle = |half: Interval| (2.0 * half.middle().atan()).sin_cos();
    (angle(tau), angle(sigma))
}

/// The factor by which the ellipsoids of a cell must grow to hold samples of the surface with their
/// margin.
fn growth(knots: &[Knot], cell: [usize; 3]) -> f64 {
    let ends = corners(cell).map(|corner| knots[index(corner)]);
    let (low, high) = (place(cell), place(cell.map(|i| i + 1)));
    let mut most = 0.0_f64;
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
        let room = Room::new(parameters);
        for point in points(parameters, [90, 36]) {
            most = most.max(level(1.0, point, &knot) / room.at(point));
        }
    }
    most.sqrt()
}

/// Points of the isosurface at √α, tan(θ/2) + tan(δ/2) and ∜F0, and the light.
fn points([x, y, z]: [f64; 3], [steps, steps_across]: [usize; 2]) -> Vec<[f64; 3]> {
    let ((s, c), (sd, cd)) = angles(x, y);
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
            let squared = masked(&lobe, &point) * fresnel(point.t.clamp(0.0, 1.0)) / fresnel(c);
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
