//! BRDFs at one incoming direction, and their isosurfaces.

use std::f64::consts::PI;

use super::{Fresnel, Vector};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Masking {
    HeightCorrelated,
    Separable,
}

#[derive(Clone, Copy, Debug)]
pub enum Brdf {
    Ggx {
        roughness: f32,
        fresnel: Fresnel,
        masking: Masking,
    },
    Lambert {
        albedo: f32,
    },
    /// No BRDF, but the intensity of a point light: 1/(4π) everywhere.
    Constant,
}

/// A surface point and the direction its light comes from.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub normal: Vector,
    pub incoming: Vector,
}

impl Surface {
    pub fn incident_cosine(self) -> f64 {
        self.normal.dot(self.incoming)
    }

    pub fn mirror(self) -> Vector {
        self.normal * (2.0 * self.incident_cosine()) - self.incoming
    }

    /// f·max(μ_o, 0).
    pub fn value(self, brdf: Brdf, outgoing: Vector) -> f64 {
        let (mu, mu_o) = (self.incident_cosine(), self.normal.dot(outgoing));
        match brdf {
            Brdf::Constant => 1.0 / (4.0 * PI),
            _ if mu_o <= 0.0 => 0.0,
            Brdf::Lambert { albedo } => f64::from(albedo) / PI * mu_o,
            Brdf::Ggx { .. } if mu <= 0.0 => 0.0,
            Brdf::Ggx {
                roughness,
                fresnel,
                masking,
            } => {
                let alpha = f64::from(roughness);
                let half = (self.incoming + outgoing).unit();
                let f = fresnel.at(self.incoming.dot(half).clamp(0.0, 1.0));
                let d = ggx_ndf(alpha, half, self.normal);
                f * d * smith_g2(alpha, masking, mu, mu_o) / (4.0 * mu * mu_o) * mu_o
            }
        }
    }
}

/// D as a function of tan²θ_m [Walter et al. 2007, Eq. 33].
pub fn ggx_ndf(alpha: f64, half: Vector, normal: Vector) -> f64 {
    let cosine = half.dot(normal);
    if cosine <= 0.0 {
        return 0.0;
    }
    let tangent = half.cross(normal).length() / cosine;
    let spread = 1.0 + (tangent / alpha).powi(2);
    1.0 / (PI * alpha * alpha * (cosine * spread.sqrt()).powi(4))
}

/// Λ(μ) [Heitz 2014, Eq. 72].
fn lambda(alpha: f64, cosine: f64) -> f64 {
    let tangent_squared = (1.0 - cosine) * (1.0 + cosine) / (cosine * cosine);
    0.5 * ((1.0 + alpha * alpha * tangent_squared.max(0.0)).sqrt() - 1.0)
}

pub fn smith_g1(alpha: f64, cosine: f64) -> f64 {
    1.0 / (1.0 + lambda(alpha, cosine))
}

pub fn smith_g2(alpha: f64, masking: Masking, mu: f64, mu_o: f64) -> f64 {
    match masking {
        Masking::HeightCorrelated => 1.0 / (1.0 + lambda(alpha, mu) + lambda(alpha, mu_o)),
        Masking::Separable => smith_g1(alpha, mu) * smith_g1(alpha, mu_o),
    }
}
