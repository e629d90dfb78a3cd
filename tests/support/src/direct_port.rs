//! The papers' formulas as printed, in `f32` over glam, with nothing guarded: the baseline that the
//! crate's own forms are measured against.
//!
//! [Tokuyoshi & Harada 2017, Eqs. 7, 8, 12–17 and Sec. 5; supplemental Eqs. 1–6]. It loses lights, and
//! is NaN at normal incidence.

use std::f32::consts::PI;

use stochastic_light_culling::glam::{Mat3, Vec2, Vec3, Vec3Swizzles};

/// D(cosθ_m), Eq. 7, with sin²θ_m = 1 − cos²θ_m.
pub fn ndf(alpha: f32, cosine: f32) -> f32 {
    let cosine_squared = cosine * cosine;
    let spread = alpha * alpha * cosine_squared + (1.0 - cosine_squared);
    alpha * alpha / (PI * spread * spread)
}

/// cosθ_m = ω_h·n of a half vector that is yet to be normalised.
pub fn half_cosine(half_vector: Vec3, normal: Vec3) -> f32 {
    half_vector.normalize().dot(normal)
}

/// G1(μ), Eq. 8.
pub fn masking(alpha: f32, mu: f32) -> f32 {
    2.0 * mu / (mu + ((1.0 - alpha * alpha) * mu * mu + alpha * alpha).sqrt())
}

#[derive(Clone, Copy, Debug)]
pub enum Fresnel {
    None,
    Schlick(f32),
    Dielectric(f32),
}

impl Fresnel {
    /// F(cosθ_h), supplemental Eqs. 1 and 3–5.
    pub fn reflectance(self, cosine: f32) -> f32 {
        match self {
            Self::None => 1.0,
            Self::Schlick(f0) => f0 + (1.0 - f0) * (1.0 - cosine).powi(5),
            Self::Dielectric(eta) => {
                let under_root = eta * eta - (1.0 - cosine * cosine);
                if under_root < 0.0 {
                    return 1.0; // Both amplitudes are complex, of modulus 1.
                }
                let root = under_root.sqrt();
                let perpendicular = (cosine - root) / (cosine + root);
                let parallel = (root - eta * eta * cosine) / (root + eta * eta * cosine);
                0.5 * (perpendicular * perpendicular + parallel * parallel)
            }
        }
    }

    /// F_max, supplemental Eqs. 2 and 6.
    pub fn maximum(self, mu: f32) -> f32 {
        let smallest_cosine = ((1.0 - (1.0 - mu * mu).sqrt()) / 2.0).sqrt();
        match self {
            Self::Dielectric(_) => self.reflectance(1.0).max(self.reflectance(smallest_cosine)),
            _ => self.reflectance(smallest_cosine),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Light {
    pub position: Vec3,
    pub normal: Vec3,
    pub incoming: Vec3,
    pub alpha: f32,
    pub fresnel: Fresnel,
    pub flux: f32,
    pub delta: f32,
    pub xi: f32,
}

impl Light {
    /// r, below Eq. 12.
    pub fn radius(&self) -> f32 {
        let mu = self.incoming.dot(self.normal);
        let numerator = self.flux * self.fresnel.maximum(mu) * masking(self.alpha, mu);
        (numerator / (4.0 * PI * self.delta * self.xi * mu)).sqrt()
    }

    /// Eqs. 13–15.
    pub fn ellipsoid(&self) -> Ellipsoid {
        let (alpha, r) = (self.alpha, self.radius());
        let mu = self.incoming.dot(self.normal);
        let u = 2.0 * mu * self.normal - self.incoming;
        let w = u.cross(self.normal).normalize();
        Ellipsoid {
            center: self.position + (1.0 - alpha * alpha) / (2.0 * alpha) * r * u,
            axes: Mat3::from_cols(u, w.cross(u), w),
            semi_axes: Vec3::new((1.0 + alpha * alpha) / (2.0 * alpha) * r, r, r),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid {
    pub center: Vec3,
    pub axes: Mat3,
    pub semi_axes: Vec3,
}

/// M = BS and Mc′.
#[derive(Clone, Copy, Debug)]
pub struct Stretched {
    pub matrix: Mat3,
    pub center: Vec3,
}

impl Stretched {
    /// Eqs. 16 and 17, for the view c′ = Vc + o.
    pub fn new(ellipsoid: &Ellipsoid, view: Mat3, offset: Vec3) -> Self {
        let axes = view * ellipsoid.axes;
        let center = view * ellipsoid.center + offset;
        let s = axes * Mat3::from_diagonal(1.0 / ellipsoid.semi_axes) * axes.transpose();
        let (x, y) = (s.x_axis, s.y_axis);
        let z = x.cross(y);
        let b = if x.length() > y.length() {
            Mat3::from_cols(x.normalize(), z.cross(x).normalize(), z.normalize())
        } else {
            Mat3::from_cols(y.cross(z).normalize(), y.normalize(), z.normalize())
        };
        let matrix = b.transpose() * s;
        Self {
            matrix,
            center: matrix * center,
        }
    }

    /// The test of Sec. 5: the box of the stretched part of the tile's frustum between two depths
    /// against the unit sphere. The tile's corners are slopes, points of the plane at depth 1.
    pub fn touches(&self, [min, max]: [Vec2; 2], [near, far]: [f32; 2]) -> bool {
        let corners = [
            (min.x, min.y),
            (max.x, min.y),
            (min.x, max.y),
            (max.x, max.y),
        ];
        let [a, b, c, d] = corners.map(|(x, y)| (self.matrix * Vec3::new(x, y, 1.0)).xy());
        let (low, high) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        let m = self.matrix.z_axis.z;
        let low = (low * near).min(low * far).extend(m * near);
        let high = (high * near).max(high * far).extend(m * far);
        let apart = (low - self.center).max(self.center - high).max(Vec3::ZERO);
        apart.length_squared() <= 1.0
    }
}
