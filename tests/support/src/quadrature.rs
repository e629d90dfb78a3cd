//! Integrals over all directions.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::reference::Vector;

/// The nodes of Gauss and Legendre in [−1, 1], and their weights.
const GAUSS: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.236_926_885_056_189],
    [-0.538_469_310_105_683, 0.478_628_670_499_366],
    [0.0, 0.568_888_888_888_889],
    [0.538_469_310_105_683, 0.478_628_670_499_366],
    [0.906_179_845_938_664, 0.236_926_885_056_189],
];

/// ∫ f dω about `axis`, for an f that changes over the angle `width` near the axis and slower beyond.
pub fn integral(axis: Vector, width: f64, f: impl Fn(Vector) -> f64) -> f64 {
    const RINGS: u32 = 100;
    const SECTORS: u32 = 128;
    let side = axis.orthogonal();
    let across = axis.cross(side);
    let most = (FRAC_PI_2 / width).atan();
    let mut sum = 0.0;
    for ring in 0..RINGS {
        for [node, weight] in GAUSS {
            let even = most * (f64::from(ring) + 0.5 + 0.5 * node) / f64::from(RINGS);
            let angle = 2.0 * width * even.tan();
            let slope = 2.0 * width / even.cos().powi(2);
            let ring_weight = 0.5 * weight * most / f64::from(RINGS) * slope * angle.sin();
            for sector in 0..SECTORS {
                let phi = TAU * (f64::from(sector) + 0.5) / f64::from(SECTORS);
                let off = side * phi.cos() + across * phi.sin();
                sum += ring_weight * f(axis.turned(off, angle));
            }
        }
    }
    sum * TAU / f64::from(SECTORS)
}
