//! How far linearly transformed cosines are from GGX.

use std::f64::consts::TAU;

use common::command::say;
use rayon::prelude::*;
use stochastic_light_culling::{
    Direction, Ggx, Incidence, Lobe, LtcLobe, Schlick,
    glam::{DVec3, Vec3},
};

use crate::ltc::nodes;

/// Nodes along each of two coordinates, of each of two sets.
const NODES: usize = 96;

/// The errors of one lobe.
struct Errors {
    /// The root of the integral of the squared error over that of the squared GGX lobe.
    relative_l2: f64,
    /// The root of the mean squared error over the hemisphere, in sr⁻¹.
    rmse: f64,
    /// The share that is reflected, over that of GGX.
    energy: f64,
}

impl Errors {
    /// The errors for Schlick's factor with this F0.
    fn of(alpha: f64, degrees: f64, f0: f64) -> Option<Self> {
        let (sine, mu) = degrees.to_radians().sin_cos();
        let incidence = Incidence {
            normal: Direction::Z,
            incoming: Direction::new(DVec3::new(-sine, 0.0, mu).as_vec3()).ok()?,
        };
        let fresnel = Schlick::new(f0 as f32).ok()?;
        let lobe = LtcLobe::new(Ggx::new(alpha as f32).ok()?, fresnel, incidence);
        let (mut squares, mut of_errors, mut energy) = (0.0, 0.0, 0.0);
        for node in nodes(alpha, mu, NODES) {
            let exact = node.value * (f0 + (1.0 - f0) * node.grazing);
            let [x, y, z] = node.outgoing.map(|x| x as f32);
            let error = f64::from(lobe.value(Vec3::new(x, y, z))) - exact;
            squares += node.weight * exact * exact;
            of_errors += node.weight * error * error;
            energy += node.weight * exact;
        }
        Some(Self {
            relative_l2: (of_errors / squares).sqrt(),
            rmse: (of_errors / TAU).sqrt(),
            energy: f64::from(lobe.reflected()) / energy,
        })
    }
}

/// Prints a line for each of some roughnesses, angles of incidence and reflectances.
pub fn print() {
    const ROUGHNESSES: [f64; 12] = [
        1.0, 0.8, 0.7, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05, 0.01, 0.001, 0.0001,
    ];
    const DEGREES: [f64; 12] = [
        0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0, 88.0, 89.0, 89.9,
    ];
    say(format_args!(
        "alpha,incidence_degrees,f0,relative_l2,rmse,energy"
    ));
    let mut cases = Vec::new();
    for f0 in [1.0, 0.04] {
        for alpha in ROUGHNESSES {
            cases.extend(DEGREES.map(|degrees| (alpha, degrees, f0)));
        }
    }
    let lines: Vec<_> = cases
        .into_par_iter()
        .filter_map(|(alpha, degrees, f0)| {
            let errors = Errors::of(alpha, degrees, f0)?;
            let Errors {
                relative_l2,
                rmse,
                energy,
            } = errors;
            Some(format!(
                "{alpha},{degrees},{f0},{relative_l2:.4},{rmse:.5},{energy:.4}"
            ))
        })
        .collect();
    for line in lines {
        if !say(format_args!("{line}")) {
            return;
        }
    }
}
