//! BRDFs at one incoming direction, and their isosurfaces.

use std::f64::consts::PI;

use stochastic_light_culling::{Direction, Ggx, Incidence, Lobe as _, LtcLobe, Schlick, SpotLobe};

use super::{Fresnel, Vector};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Masking {
    HeightCorrelated,
    Separable,
    /// G2 = G1(μ_i): more than height-correlated, the most that a caller may state.
    MaskedAlone,
}

#[derive(Clone, Copy, Debug)]
pub enum Brdf {
    Ggx {
        roughness: f32,
        fresnel: Fresnel,
        masking: Masking,
    },
    /// The tangent is in the plane of `tangent` and the normal, and at right angles to the normal.
    Anisotropic {
        roughness: [f32; 2],
        tangent: Direction,
        fresnel: Fresnel,
        masking: Masking,
    },
    Lambert {
        albedo: f32,
    },
    Phong {
        albedo: f32,
        exponent: f32,
    },
    /// No BRDF either, but a lobe about the normal that no horizon cuts.
    SphericalGaussian {
        amplitude: f32,
        sharpness: f32,
    },
    /// A transformed cosine. Its matrix is the crate's: `lobe` says what it is for a normal and an incoming
    /// direction, see [`Brdf::lit_by`].
    Ltc {
        roughness: f32,
        /// A reflectance, or, with a matrix, the magnitude.
        share: f32,
        /// A matrix of a caller's own.
        matrix: Option<[f32; 4]>,
        lobe: LtcLobe,
    },
    /// No BRDF, but the intensity of a point light: 1/(4π) everywhere.
    Constant,
    /// No BRDF either, but a spot light along the normal: its inner and outer angle, and 1 − cos of both as
    /// the crate has them.
    Spot {
        angles: [f32; 2],
        versines: [f32; 2],
    },
}

impl Brdf {
    /// A spot light with the half angles `angles`, the first no larger than the second.
    pub fn spot(angles: [f32; 2]) -> Self {
        let [inner, outer] = angles;
        let lobe = SpotLobe::new(inner, outer, Direction::Z).expect("angles in order");
        Self::Spot {
            angles,
            versines: lobe.versines(),
        }
    }

    pub fn ltc(roughness: f32, share: f32, matrix: Option<[f32; 4]>) -> Self {
        let incidence = Incidence::head_on(Direction::Z);
        Self::Ltc {
            roughness,
            share,
            matrix,
            lobe: ltc_lobe(roughness, share, matrix, incidence),
        }
    }

    /// The same for another incidence, if that is a part of it.
    pub fn lit_by(self, normal: Direction, incoming: Direction) -> Self {
        match self {
            Self::Ltc {
                roughness,
                share,
                matrix,
                ..
            } => Self::Ltc {
                roughness,
                share,
                matrix,
                lobe: ltc_lobe(roughness, share, matrix, Incidence { normal, incoming }),
            },
            other => other,
        }
    }

    /// The same with another tangent, if it has one that is nearly parallel to `normal`.
    pub fn laid_on(self, normal: Vector) -> Self {
        match self {
            Self::Anisotropic {
                roughness,
                tangent,
                fresnel,
                masking,
            } if normal.cross(Vector::from(*tangent)).length() < 2e-6 => Self::Anisotropic {
                roughness,
                tangent: Direction::new(normal.orthogonal().to_f32()).expect("of unit length"),
                fresnel,
                masking,
            },
            other => other,
        }
    }
}

fn ltc_lobe(roughness: f32, share: f32, matrix: Option<[f32; 4]>, incidence: Incidence) -> LtcLobe {
    if let Some(matrix) = matrix {
        return LtcLobe::with_matrix(matrix, share, incidence).expect("in range");
    }
    let ggx = Ggx::new(roughness).expect("in range");
    LtcLobe::new(ggx, Schlick::new(share).expect("in range"), incidence)
}

/// The first and the third row of M⁻¹. The second is the cross product of the third and the first.
pub fn ltc_rows(lobe: &LtcLobe) -> [Vector; 2] {
    let [_, _, _, _, x, y, z, third_x, third_y, third_z, shear, ..] = lobe.numbers().map(f64::from);
    let third = Vector([third_x, third_y, third_z]);
    [Vector([x, y, z]) + third * shear, third]
}

/// The value of a transformed cosine without a horizon.
pub fn ltc_value(lobe: &LtcLobe, outgoing: Vector) -> f64 {
    let [first, third] = ltc_rows(lobe);
    let height = third.dot(outgoing);
    let transformed = [first, third.cross(first), third].map(|row| row.dot(outgoing));
    let squared = Vector(transformed).dot(Vector(transformed));
    f64::from(lobe.amplitude()) * height.max(0.0) / (squared * squared)
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

    /// Where facets that are evenly spread for their roughness mirror the light.
    pub fn mirrored_by_facets(
        self,
        roughness: [f32; 2],
        tangent: Direction,
    ) -> impl Iterator<Item = Vector> {
        const NUMBER: u32 = 300;
        let [along, across] = SurfaceFrame::new(self.normal, tangent).tangents;
        let [alpha_x, alpha_y] = roughness.map(f64::from);
        (0..NUMBER).map(move |i| {
            let height = (f64::from(i) + 0.5) / f64::from(NUMBER);
            let (radius, azimuth) = ((1.0 - height * height).sqrt(), 2.399_963 * f64::from(i));
            let facet = along * (alpha_x * radius * azimuth.cos())
                + across * (alpha_y * radius * azimuth.sin())
                + self.normal * height;
            let facet = facet.unit();
            facet * (2.0 * facet.dot(self.incoming)) - self.incoming
        })
    }

    /// f·max(μ_o, 0).
    pub fn value(self, brdf: Brdf, outgoing: Vector) -> f64 {
        let (mu, mu_o) = (self.incident_cosine(), self.normal.dot(outgoing));
        match brdf {
            Brdf::Constant => 1.0 / (4.0 * PI),
            Brdf::Spot { versines, .. } => {
                let [inner, outer] = versines.map(f64::from);
                // Of the angle's half, since the cosine has few digits near the axis.
                let versine = 0.5 * (outgoing - self.normal).length().powi(2);
                let transition = ((outer - versine) / (outer - inner)).min(1.0);
                if versine < outer {
                    transition.powi(2) / (4.0 * PI)
                } else {
                    0.0
                }
            }
            Brdf::SphericalGaussian {
                amplitude,
                sharpness,
            } => {
                let apart = outgoing - self.normal;
                let exponent = 0.5 * f64::from(sharpness) * apart.dot(apart);
                f64::from(amplitude) * (-exponent).exp()
            }
            _ if mu_o <= 0.0 => 0.0,
            Brdf::Lambert { albedo } => f64::from(albedo) / PI * mu_o,
            _ if mu <= 0.0 => 0.0,
            Brdf::Ltc { lobe, .. } => ltc_value(&lobe, outgoing),
            Brdf::Phong { albedo, exponent } => {
                let [albedo, exponent] = [albedo, exponent].map(f64::from);
                match self.mirror().dot(outgoing) {
                    cosine if cosine <= 0.0 => 0.0,
                    cosine => albedo * (exponent + 1.0) / (2.0 * PI) * cosine.powf(exponent),
                }
            }
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
            Brdf::Anisotropic {
                roughness,
                tangent,
                fresnel,
                masking,
            } => {
                let frame = SurfaceFrame::new(self.normal, tangent);
                let direction = outgoing;
                let [incoming, outgoing] = [self.incoming, direction].map(|v| frame.slopes(v));
                let half = (self.incoming + direction).unit();
                let f = fresnel.at(self.incoming.dot(half).clamp(0.0, 1.0));
                let d = anisotropic_ndf(roughness, frame.slopes(half), half.dot(self.normal));
                let g2 = anisotropic_g2(roughness, masking, incoming, outgoing);
                f * d * g2 / (4.0 * mu * mu_o) * mu_o
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
    lambda_of_slope(alpha * alpha * tangent_squared.max(0.0))
}

fn lambda_of_slope(stretched_slope_squared: f64) -> f64 {
    0.5 * ((1.0 + stretched_slope_squared).sqrt() - 1.0)
}

/// Tangent and bitangent of a surface with a grain.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceFrame {
    pub normal: Vector,
    pub tangents: [Vector; 2],
}

impl SurfaceFrame {
    pub fn new(normal: Vector, tangent: Direction) -> Self {
        let tangent = Vector::from(*tangent);
        let tangent = (tangent - normal * tangent.dot(normal)).unit();
        Self {
            normal,
            tangents: [tangent, normal.cross(tangent)],
        }
    }

    /// How far `direction` runs along the tangents for each step along the normal.
    pub fn slopes(self, direction: Vector) -> [f64; 2] {
        let height = direction.dot(self.normal);
        self.tangents.map(|tangent| tangent.dot(direction) / height)
    }
}

/// Σ (αᵢ slopeᵢ)²
fn stretched_squared(factors: [f64; 2], slopes: [f64; 2]) -> f64 {
    (factors[0] * slopes[0]).powi(2) + (factors[1] * slopes[1]).powi(2)
}

/// D as a function of the slopes of the half vector along both tangents [Heitz 2014].
pub fn anisotropic_ndf(roughness: [f32; 2], slopes: [f64; 2], cosine: f64) -> f64 {
    if cosine <= 0.0 {
        return 0.0;
    }
    let [alpha_x, alpha_y] = roughness.map(f64::from);
    let spread = 1.0 + stretched_squared([1.0 / alpha_x, 1.0 / alpha_y], slopes);
    1.0 / (PI * alpha_x * alpha_y * (cosine * spread.sqrt()).powi(4))
}

pub fn anisotropic_g2(
    roughness: [f32; 2],
    masking: Masking,
    incoming: [f64; 2],
    outgoing: [f64; 2],
) -> f64 {
    let [a, b] = [incoming, outgoing]
        .map(|slopes| lambda_of_slope(stretched_squared(roughness.map(f64::from), slopes)));
    match masking {
        Masking::HeightCorrelated => 1.0 / (1.0 + a + b),
        Masking::Separable => 1.0 / ((1.0 + a) * (1.0 + b)),
        Masking::MaskedAlone => 1.0 / (1.0 + a),
    }
}

pub fn smith_g1(alpha: f64, cosine: f64) -> f64 {
    1.0 / (1.0 + lambda(alpha, cosine))
}

pub fn smith_g2(alpha: f64, masking: Masking, mu: f64, mu_o: f64) -> f64 {
    match masking {
        Masking::HeightCorrelated => 1.0 / (1.0 + lambda(alpha, mu) + lambda(alpha, mu_o)),
        Masking::Separable => smith_g1(alpha, mu) * smith_g1(alpha, mu_o),
        Masking::MaskedAlone => smith_g1(alpha, mu),
    }
}
