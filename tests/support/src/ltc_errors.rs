//! How far linearly transformed cosines are from GGX.

use std::f64::consts::TAU;

use stochastic_light_culling::{
    Direction, Error, Ggx, Incidence, Lobe, LtcLobe, Schlick,
    glam::{DVec3, Vec3},
};

use crate::ggx_nodes::nodes;

/// The errors of one lobe over the hemisphere.
#[derive(Clone, Copy, Debug)]
pub struct LtcErrors {
    /// The root of the integral of the squared error over that of the squared GGX lobe.
    pub relative_l2: f64,
    /// The root of the mean squared error over the hemisphere, in sr⁻¹.
    pub rmse: f64,
    /// The share that is reflected, over that of GGX.
    pub energy: f64,
}

impl LtcErrors {
    /// Those for Schlick's factor with this F0, by so many nodes along each of two coordinates.
    pub fn of(alpha: f64, degrees: f64, f0: f64, count: usize) -> Result<Self, Error> {
        let (sine, mu) = degrees.to_radians().sin_cos();
        let incidence = Incidence {
            normal: Direction::Z,
            incoming: Direction::new(DVec3::new(-sine, 0.0, mu).as_vec3())?,
        };
        let fresnel = Schlick::new(f0 as f32)?;
        let lobe = LtcLobe::new(Ggx::new(alpha as f32)?, fresnel, incidence);
        let (mut squares, mut of_errors, mut energy) = (0.0, 0.0, 0.0);
        for node in nodes(alpha, mu, count) {
            let exact = node.value * (f0 + (1.0 - f0) * node.grazing);
            let [x, y, z] = node.outgoing.map(|x| x as f32);
            let error = f64::from(lobe.value(Vec3::new(x, y, z))) - exact;
            squares += node.weight * exact * exact;
            of_errors += node.weight * error * error;
            energy += node.weight * exact;
        }
        Ok(Self {
            relative_l2: (of_errors / squares).sqrt(),
            rmse: (of_errors / TAU).sqrt(),
            energy: f64::from(lobe.reflected()) / energy,
        })
    }
}
