//! Clusters of lights, and how far they reach.

use stochastic_light_culling::Vsgl;

use super::Vector;

/// A cluster about the origin.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    pub axis: Vector,
    pub sharpness: f64,
    pub spread: f64,
    pub amplitude: f64,
}

impl From<&Vsgl> for Cluster {
    fn from(light: &Vsgl) -> Self {
        let lobe = light.lobe();
        Self {
            axis: Vector::from(*lobe.axis()).unit(),
            sharpness: lobe.sharpness().into(),
            spread: light.spread().into(),
            amplitude: lobe.amplitude().into(),
        }
    }
}

impl Cluster {
    /// E = 2c e^{−S} sinh(μ)/(σ²μ), the integral of Eq. 7 of the 2016 supplemental, at the distance `l` in the unit
    /// `direction`. μ − S = −2ab(1 − cosγ)/(μ + S), where 1 − cosγ is half of the squared length of a difference.
    pub fn irradiance(&self, direction: Vector, l: f64) -> f64 {
        let apart = direction - self.axis;
        let versine = 0.5 * apart.dot(apart);
        if self.spread == 0.0 {
            return self.amplitude * (-self.sharpness * versine).exp() / (l * l);
        }
        let variance = self.spread * self.spread;
        let (a, b) = (self.sharpness, l * l / variance);
        let sum = a + b;
        let mu = (sum * sum - 2.0 * a * b * versine).max(0.0).sqrt();
        let power = (-2.0 * a * b * versine / (mu + sum).max(1e-300)).exp();
        let share = if mu < 1e-8 {
            2.0
        } else {
            -(-2.0 * mu).exp_m1() / mu
        };
        self.amplitude * power * share / variance
    }

    /// The distance up to which E is at least `least`: zero if it is nowhere.
    pub fn reach(&self, direction: Vector, least: f64) -> f64 {
        // E ≤ c/l² everywhere.
        let (mut near, mut far) = (0.0, (self.amplitude / least).sqrt() * (1.0 + 1e-9));
        for _ in 0..90 {
            let middle = 0.5 * (near + far);
            if self.irradiance(direction, middle) >= least {
                near = middle;
            } else {
                far = middle;
            }
        }
        near
    }
}
