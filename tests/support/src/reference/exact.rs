//! The same lobes in double-double arithmetic (about 31 digits), in which the rounding of the model
//! cannot hide what is looked for.

use std::ops::{Add, Mul, Sub};

use stochastic_light_culling::glam::Vec3;
use twofloat::TwoFloat as Real;
use twofloat::consts::PI;

use super::{Brdf, Fresnel, Masking, Vector, View, ltc_rows};

#[derive(Clone, Copy, Debug)]
pub struct Exact(pub [Real; 3]);

impl Exact {
    pub fn dot(self, other: Self) -> Real {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    pub fn unit(self) -> Self {
        self * (Real::from(1.0) / self.dot(self).sqrt())
    }

    /// `point` before the eye of `view`, with depth in the place of z.
    pub fn before(self, view: &View) -> Self {
        let [x, y, z] = self.0;
        Self(view.rows().map(|[a, b, c, d]| x * a + y * b + z * c + d))
    }
}

impl From<Vec3> for Exact {
    fn from(v: Vec3) -> Self {
        Self(v.to_array().map(|x| Real::from(f64::from(x))))
    }
}

impl Add for Exact {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Exact {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Mul<Real> for Exact {
    type Output = Self;
    fn mul(self, factor: Real) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

/// f·max(μ_o, 0) for unit directions.
pub fn value(brdf: Brdf, normal: Exact, incoming: Exact, outgoing: Exact) -> Real {
    let zero = Real::from(0.0);
    let (mu, mu_o) = (normal.dot(incoming), normal.dot(outgoing));
    match brdf {
        Brdf::Constant => Real::from(0.25) / PI,
        Brdf::Spot { versines, .. } => {
            let [inner, outer] = versines.map(|x| Real::from(f64::from(x)));
            let off = outgoing - normal;
            let versine = off.dot(off) * 0.5;
            if versine >= outer {
                return zero;
            }
            let peak = Real::from(0.25) / PI;
            if versine <= inner {
                return peak;
            }
            let transition = (outer - versine) / (outer - inner);
            peak * transition * transition
        }
        Brdf::SphericalGaussian {
            amplitude,
            sharpness,
        } => {
            let apart = outgoing - normal;
            let exponent = apart.dot(apart) * (0.5 * f64::from(sharpness));
            // e⁻ˣ = e⁻ʰⁱ e⁻ˡᵒ, to the 16 digits of the first.
            let rest = Real::from(1.0) - exponent.lo();
            rest * ((-exponent.hi()).exp() * f64::from(amplitude))
        }
        _ if mu_o <= zero => zero,
        Brdf::Lambert { albedo } => mu_o * f64::from(albedo) / PI,
        _ if mu <= zero => zero,
        Brdf::Ltc { lobe, .. } => {
            let exact = |row: Vector| Exact(row.0.map(Real::from));
            let [first, third] = ltc_rows(&lobe).map(exact);
            let height = third.dot(outgoing);
            if height <= zero {
                return zero;
            }
            let (side, across) = (first.dot(outgoing), third.cross(first).dot(outgoing));
            let squared = side * side + across * across + height * height;
            height * f64::from(lobe.amplitude()) / squared / squared
        }
        Brdf::Phong { albedo, exponent } => {
            let cosine = (normal * (mu * 2.0) - incoming).dot(outgoing);
            if cosine <= zero {
                return zero;
            }
            let peak = (Real::from(f64::from(exponent)) + 1.0) * f64::from(albedo) / (PI * 2.0);
            peak * power(cosine, exponent)
        }
        Brdf::Ggx {
            roughness,
            fresnel,
            masking,
        } => {
            let alpha = f64::from(roughness);
            let alpha_squared = Real::new_mul(alpha, alpha);
            let half = (incoming + outgoing).unit();
            let cosine = half.dot(normal);
            let across = half.cross(normal);
            let spread = alpha_squared * cosine * cosine + across.dot(across);
            let ndf = alpha_squared / (PI * spread * spread);
            let root = |c: Real| ((Real::from(1.0) - alpha_squared) * c * c + alpha_squared).sqrt();
            let g2 = g2_over_four_cosines(masking, [mu, mu_o], [mu, mu_o].map(root));
            reflectance(fresnel, incoming.dot(half)) * ndf * g2
        }
        Brdf::Anisotropic {
            roughness,
            tangent,
            fresnel,
            masking,
        } => {
            let [alpha_x, alpha_y] = roughness.map(|alpha| Real::from(f64::from(alpha)));
            let bitangent = normal.cross(Exact::from(*tangent)).unit();
            let tangent = bitangent.cross(normal);
            // (α_x x)² + (α_y y)² + z²
            let squared = |v: Exact, alpha_x: Real, alpha_y: Real| {
                let [x, y] = [alpha_x * tangent.dot(v), alpha_y * bitangent.dot(v)];
                let z = normal.dot(v);
                x * x + y * y + z * z
            };
            let half = (incoming + outgoing).unit();
            let one = Real::from(1.0);
            let spread = squared(half, one / alpha_x, one / alpha_y);
            let ndf = one / (PI * alpha_x * alpha_y * spread * spread);
            let roots = [incoming, outgoing].map(|v| squared(v, alpha_x, alpha_y).sqrt());
            let g2 = g2_over_four_cosines(masking, [mu, mu_o], roots);
            reflectance(fresnel, incoming.dot(half)) * ndf * g2
        }
    }
}

/// cosⁿ for an exponent n that is a multiple of 1/16: by roots and products, since logarithms lose digits.
fn power(cosine: Real, exponent: f32) -> Real {
    let sixteenths = 16.0 * exponent;
    assert_eq!(sixteenths, sixteenths.trunc(), "not a multiple of 1/16");
    let root = cosine.sqrt().sqrt().sqrt().sqrt();
    root.powi(sixteenths as i32)
}

/// G2/(4μ) for μ, μ_o and the roots of both.
fn g2_over_four_cosines(
    masking: Masking,
    [mu, mu_o]: [Real; 2],
    [root_i, root_o]: [Real; 2],
) -> Real {
    match masking {
        Masking::HeightCorrelated => mu_o * 0.5 / (mu_o * root_i + mu * root_o),
        Masking::Separable => mu_o / ((mu + root_i) * (mu_o + root_o)),
        Masking::MaskedAlone => Real::from(0.5) / (mu + root_i),
    }
}

/// F at the angle θ_h whose cosine is given.
pub fn reflectance(fresnel: Fresnel, cosine: Real) -> Real {
    let (zero, one) = (Real::from(0.0), Real::from(1.0));
    let cosine = cosine.max(zero).min(one);
    match fresnel {
        Fresnel::None => one,
        Fresnel::Schlick(f0) => {
            let (f0, rest) = (Real::from(f64::from(f0)), one - cosine);
            f0 + (one - f0) * (rest * rest * rest * rest * rest)
        }
        Fresnel::Dielectric(eta) => unpolarised(cosine, f64::from(eta), 0.0),
        Fresnel::Conductor(eta, kappa) => unpolarised(cosine, f64::from(eta), f64::from(kappa)),
    }
}

fn unpolarised(cosine: Real, eta: f64, kappa: f64) -> Real {
    let squared = (
        Real::new_mul(eta, eta) - Real::new_mul(kappa, kappa),
        Real::new_mul(2.0 * eta, kappa),
    );
    let sine_squared = Real::from(1.0) - cosine * cosine;
    let (a, b) = root((squared.0 - sine_squared, squared.1));
    let ratio_squared = |(x, y): (Real, Real)| {
        let of = |x: Real, y: Real| x * x + y * y;
        of(x - a, y - b) / of(x + a, y + b)
    };
    let perpendicular = ratio_squared((cosine, Real::from(0.0)));
    let parallel = ratio_squared((squared.0 * cosine, squared.1 * cosine));
    (perpendicular + parallel) * 0.5
}

/// The root of a complex number in the first quadrant, neither part by cancellation.
fn root((x, y): (Real, Real)) -> (Real, Real) {
    let zero = Real::from(0.0);
    let modulus = (x * x + y * y).sqrt();
    let larger = ((modulus + if x < zero { -x } else { x }) * 0.5).sqrt();
    if larger <= zero {
        return (zero, zero);
    }
    let smaller = y * 0.5 / larger;
    if x < zero {
        (smaller, larger)
    } else {
        (larger, smaller)
    }
}

/// The nearest `f32` at or below, and at or above.
pub fn outward(x: Real) -> [f32; 2] {
    let near = x.hi() as f32;
    let exact = Real::from(f64::from(near));
    if exact == x {
        [near, near]
    } else if exact < x {
        [near, next_up(near)]
    } else {
        [-next_up(-near), near]
    }
}

/// `f32::next_up`, which is newer than the crate's least Rust version.
fn next_up(x: f32) -> f32 {
    if x == 0.0 {
        f32::from_bits(1)
    } else if x > 0.0 {
        f32::from_bits(x.to_bits() + 1)
    } else {
        f32::from_bits(x.to_bits() - 1)
    }
}
