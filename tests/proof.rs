//! The interval proof of the tight bound's table proves what is so, and refuses what is not.
//!
//! Some of the cells here; all of them, in minutes, with
//!
//! ```text
//! cargo run --release --example tabulate -- --prove
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

use fastrand::Rng;
use rayon::prelude::*;
use support::certificate::{
    Angles, Box5, Cell, Interval, Lobe, Parameters, Point, Verdict, level, masked, prove,
};
use support::reference::{Brdf, Fresnel, Masking, Surface, Vector, smith_g1};

#[test]
fn ellipsoids_of_cells_enclose() {
    let cells: Vec<Cell> = Cell::all().into_iter().step_by(31).collect();
    cells.par_iter().for_each(|cell| {
        let proved = prove(cell, 1_000_000);
        assert!(proved.is_ok(), "{proved:?}");
    });
}

#[test]
fn shrunken_ellipsoids_are_not_proved() {
    for knot in [[7, 18, 4], [1, 3, 5], [4, 6, 0]] {
        let mut cell = Cell::at(knot);
        for knot in &mut cell.knots {
            for number in &mut knot[2..] {
                *number *= 0.95;
            }
        }
        assert!(prove(&cell, 100_000).is_err(), "{knot:?}");
    }
}

/// F/F(μ) G2/G1 and the rest, in numbers, at √α, tan(θ/2) + tan(δ/2), ∜F0, and the tangents of φ/2 and ψ/2.
struct There {
    lobe: Lobe<f64>,
    point: Point<f64>,
    /// Negative below the horizon.
    squared: f64,
}

impl There {
    fn new([x, y, z, p, q]: [f64; 5]) -> Self {
        let angles = Angles::new(Interval::at(x), Interval::at(y));
        let angle = |half: f64| (2.0 * half.atan()).sin_cos();
        let [(s, c), (sd, cd), (sin_phi, cos_phi), (sin_psi, cos_psi)] =
            [angles.tau.middle(), angles.sigma.middle(), p, q].map(angle);
        let alpha = x * x;
        let rl = c.hypot(alpha * s);
        let lobe = Lobe {
            alpha,
            c,
            s,
            cd,
            sd,
            rl,
            aol: if s > 0.2 { sd / s } else { alpha / rl },
        };
        let m = [cos_psi * sin_phi, sin_psi, cos_psi * cos_phi];
        let n = alpha.powi(2) + (1.0 - alpha.powi(2)) * m[2].powi(2);
        let point = lobe.point(n, m);
        let fresnel = |cosine: f64| z.powi(4) + (1.0 - z.powi(4)) * (1.0 - cosine).powi(5);
        let squared = masked(&lobe, &point) * fresnel(point.t) / fresnel(c);
        Self {
            lobe,
            point,
            squared,
        }
    }
}

/// What the certificate takes for the isosurface is that of the reference's BRDF.
#[test]
fn surface_is_that_of_the_brdf() {
    let mut rng = Rng::with_seed(1);
    let mut above = 0;
    for _ in 0..10_000 {
        let (roughness, f0) = (0.01 + 0.99 * rng.f32(), 0.01 + 0.99 * rng.f32());
        let (alpha, theta) = (f64::from(roughness), 0.01 + (FRAC_PI_2 - 0.02) * rng.f64());
        let delta = (alpha * theta.tan()).atan();
        let y = (0.5 * theta).tan() + (0.5 * delta).tan();
        let z = f64::from(f0).powf(0.25);
        let (p, q) = (2.0 * rng.f64() - 1.0, rng.f64());
        let there = There::new([alpha.sqrt(), y, z, p, q]);
        if there.point.e <= 0.0 {
            continue;
        }
        above += 1;
        let s = there.squared.sqrt();

        let normal = Vector([0.0, 0.0, 1.0]);
        let incoming = Vector([theta.sin(), 0.0, theta.cos()]);
        let surface = Surface { normal, incoming };
        let fresnel = Fresnel::Schlick(f0);
        let mu = surface.incident_cosine();
        let r = (fresnel.at(mu) * smith_g1(alpha, mu) / (4.0 * PI * mu)).sqrt();
        let (u, w) = (surface.mirror(), Vector([0.0, 1.0, 0.0]));
        let down = u.cross(w);
        let [z1, z2, z3] = there.point.z.map(|zeta| s * zeta);
        let reached = u * (r / alpha * z1) + down * (r * z2) + w * (r * there.lobe.rl * z3);
        let brdf = Brdf::Ggx {
            roughness,
            fresnel,
            masking: Masking::HeightCorrelated,
        };
        let value = surface.value(brdf, reached.unit());
        let squared = reached.dot(reached);
        assert!(
            (value - squared).abs() <= 1e-6 * squared,
            "α {alpha}, θ {theta}, F0 {f0}: {value} and {squared}"
        );
    }
    assert!(above > 3000, "{above}");
}

/// Over boxes of any size the verdict, or what is known of the light, is no less than what is in them.
#[test]
fn verdicts_hold_for_samples() {
    let mut rng = Rng::with_seed(2);
    let cells = Cell::all();
    let (mut below, mut finite) = (0, 0);
    for _ in 0..4000 {
        let cell = &cells[rng.usize(..cells.len())];
        let b = random_box(&mut rng, cell);
        let parameters = Parameters::new(cell, &b);
        let (verdict, light) = (parameters.verdict(&b), parameters.level_of_light());
        for _ in 0..50 {
            let at = b.map(|side| match rng.u8(..3) {
                0 => side.low,
                1 => side.high,
                _ => side.low + side.width() * rng.f64(),
            });
            let there = There::new(at);
            match verdict {
                Verdict::BelowHorizon => {
                    assert!(there.point.e < 1e-12, "{at:?} in {b:?}");
                }
                Verdict::Level { most, .. } if there.point.e > 1e-12 => {
                    let ellipsoid = interpolated(cell, &at);
                    let level = level(there.squared.sqrt(), there.point.z, &ellipsoid);
                    let most = most.max(light) + 1e-9;
                    assert!(level <= most, "{level} at {at:?}, {most} in {b:?}");
                }
                Verdict::Level { .. } => {}
            }
        }
        match verdict {
            Verdict::BelowHorizon => below += 1,
            Verdict::Level { most, .. } => finite += usize::from(most.is_finite()),
        }
    }
    assert!(below > 100 && finite > 1000, "{below} and {finite}");
}

fn random_box(rng: &mut Rng, cell: &Cell) -> Box5 {
    std::array::from_fn(|i| {
        let (low, high) = match i {
            0..3 => (cell.low[i], cell.high[i]),
            3 => (-1.0, 1.0),
            _ => (0.0, 1.0),
        };
        let parts = f64::from(1_u32 << rng.u32(..8));
        let start = (rng.f64() * parts).floor() / parts;
        let share = |t: f64| low + (high - low) * t;
        Interval::new(share(start), share(start + 1.0 / parts))
    })
}

fn interpolated(cell: &Cell, at: &[f64; 5]) -> [f64; 6] {
    std::array::from_fn(|number| {
        let corners = cell.knots.iter().enumerate().map(|(corner, knot)| {
            let weights = (0..3).map(|i| {
                let t = (at[i] - cell.low[i]) / (cell.high[i] - cell.low[i]);
                if corner >> i & 1 == 1 { t } else { 1.0 - t }
            });
            knot[number] * weights.product::<f64>()
        });
        corners.sum()
    })
}
