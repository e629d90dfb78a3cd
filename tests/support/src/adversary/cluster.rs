//! Clusters of lights from the whole domain.

use std::f64::consts::{FRAC_PI_2, TAU};

use fastrand::Rng;
use stochastic_light_culling::{Ellipsoid, Roulette, SphericalGaussian, Vsgl, Xi, glam::Vec3};
use twofloat::TwoFloat as Real;

use super::draw::sharpness;
use super::{Reach, chance, direction, log_uniform, unit_vector, up_to_one};
use crate::reference::exact::Exact;
use crate::reference::{Cluster, Vector};

/// A cluster in one frame.
#[derive(Clone, Copy, Debug)]
pub struct ClusterLight {
    pub light: Vsgl,
    pub delta: f32,
    pub xi: f32,
}

impl ClusterLight {
    /// Any cluster of the domain: √(c/(δξ)) from 1e-12 to 1e12, spreads up to where it reaches nothing, up to 1e6
    /// ranges from the origin.
    pub fn draw(rng: &mut Rng) -> Self {
        let range = log_uniform(rng, 1e-12, 1e12);
        let distance = range * log_uniform(rng, 1e-3, 1e6);
        let sharpness = sharpness(rng);
        let delta = log_uniform(rng, 1e-6, 1e3) as f32;
        let xi = up_to_one(rng, 2.0_f64.powi(-32)) as f32;
        let amplitude = (range * range * f64::from(delta) * f64::from(xi)).clamp(1e-37, 1e37);
        let range = (amplitude / (f64::from(delta) * f64::from(xi))).sqrt();
        let lambda = f64::from(sharpness).max(1e-9);
        // E(0) = c(1 − e^{−2λ})/(λσ²) = δξ.
        let most = (-(-2.0 * lambda).exp_m1() / lambda).sqrt() * range;
        let spread = match rng.u8(0..6) {
            0 => 0.0,
            1 => most * (1.0 - log_uniform(rng, 1e-7, 0.1)),
            2 => most * rng.f64(),
            _ => most * log_uniform(rng, 1e-6, 1.0),
        };
        let lobe = SphericalGaussian::new(direction(unit_vector(rng)), sharpness, amplitude as f32)
            .expect("in the domain");
        let position = (unit_vector(rng) * distance).to_f32();
        Self {
            light: Vsgl::new(position, spread.min(1e15) as f32, lobe).expect("in the domain"),
            delta,
            xi,
        }
    }

    pub fn bound(&self) -> Ellipsoid {
        let roulette = Roulette::new(self.delta).expect("in the domain");
        let xi = Xi::new(self.xi).expect("in the domain");
        self.light.bound(&roulette, xi)
    }
}

impl Reach for ClusterLight {
    fn position(&self) -> Vec3 {
        self.light.position()
    }

    /// About the axis at all angles that the lobe's width makes interesting, or anywhere.
    fn outgoing(&self, rng: &mut Rng) -> Exact {
        let axis = Vector::from(*self.light.lobe().axis()).unit();
        let side = axis.orthogonal();
        let side = side.turned(axis.cross(side), rng.f64() * TAU);
        let width = 1.0 / (1.0 + f64::from(self.light.lobe().sharpness())).sqrt();
        let tangent = match rng.u8(0..8) {
            0 => 0.0,
            1 => 1e9,
            2 => (0.5 * FRAC_PI_2 * rng.f64()).tan(),
            _ => width * (FRAC_PI_2 * rng.f64()).tan(),
        };
        let angle = 2.0 * f64::atan(tangent);
        let way = if chance(rng, 0.1) {
            unit_vector(rng)
        } else {
            axis.turned(side, angle)
        };
        Exact(way.0.map(Real::from)).unit()
    }

    /// In double precision, and short by more than what that loses.
    fn reach(&self, outgoing: Exact) -> Real {
        let direction = Vector(outgoing.0.map(|x| x.hi()));
        let least = f64::from(self.delta) * f64::from(self.xi);
        Real::from(Cluster::from(&self.light).reach(direction, least * (1.0 + 1e-8)))
    }
}
