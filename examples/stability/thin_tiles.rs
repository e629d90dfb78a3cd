//! How many lights a direct port loses by roughness, well inside the isosurface.

use std::f64::consts::TAU;

use fastrand::Rng;
use rayon::prelude::*;
use support::adversary::{Light, Reach, Tile, log_uniform};
use support::reference::{Brdf, Fresnel, Masking, Vector, exact::Exact};
use twofloat::TwoFloat as Real;

use crate::port;

/// Inside the isosurface by this share.
pub const INSIDE: f64 = 1e-3;
pub const ALPHAS: [f32; 6] = [0.5, 0.1, 0.01, 0.003, 0.001, 0.0001];

/// Where the points lie: about the lobe's peak at the angles its width makes likely, or in any
/// direction above the surface.
const POPULATIONS: [fn(&mut Rng, &Light) -> Exact; 2] =
    [|rng, light| light.outgoing(rng), anywhere];

/// What is lost at one roughness, in each population.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub alpha: f32,
    /// By the crate and by the direct port.
    pub lost: [[u64; 2]; 2],
    /// Of each population.
    pub cases: u64,
}

/// About as many as `cases` in all.
pub fn measure(cases: u64) -> Vec<Row> {
    let cases = (cases / 12).clamp(100, 100_000);
    let row = |alpha| Row {
        alpha,
        lost: POPULATIONS.map(|outgoing| losses(alpha, outgoing, cases)),
        cases,
    };
    ALPHAS.into_par_iter().map(row).collect()
}

fn losses(alpha: f32, outgoing: fn(&mut Rng, &Light) -> Exact, cases: u64) -> [u64; 2] {
    let mut rng = Rng::with_seed(1);
    let (mut lost, mut lost_by_port, mut tested) = (0, 0, 0);
    while tested < cases {
        let light = draw(&mut rng, alpha);
        let outgoing = outgoing(&mut rng, &light);
        let distance = log_uniform(&mut rng, 0.1, 10.0);
        let Some((tile, _)) = Tile::thin(&mut rng, &light, outgoing, INSIDE, distance) else {
            continue;
        };
        let port = port::light(&light).expect("GGX without Fresnel");
        tested += 1;
        lost += u64::from(!light.bound().that_lose(&tile).is_empty());
        lost_by_port += u64::from(!port::touches(&port, &tile));
    }
    [lost, lost_by_port]
}

/// Any direction above the surface, uniformly.
fn anywhere(rng: &mut Rng, light: &Light) -> Exact {
    let normal = Vector::from(*light.normal);
    let side = normal.orthogonal();
    let (height, azimuth) = (rng.f64(), rng.f64() * TAU);
    let around = side.turned(normal.cross(side), azimuth);
    let direction = normal * height + around * (1.0 - height * height).sqrt();
    Exact(direction.0.map(Real::from)).unit()
}

/// A light that nothing but its roughness makes hard: about as far from the origin as it reaches, at
/// incidences away from both ends.
fn draw(rng: &mut Rng, roughness: f32) -> Light {
    let brdf = Brdf::Ggx {
        roughness,
        fresnel: Fresnel::None,
        masking: Masking::HeightCorrelated,
    };
    let mu = 0.1 + 0.85 * rng.f64();
    Light::with(rng, brdf, mu, 1.0, 1.0)
}
