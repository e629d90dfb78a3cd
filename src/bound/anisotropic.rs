//! The bound of an anisotropic GGX lobe: an ellipsoid whose axes follow the lobe, wherever the grain
//! turns it.
//!
//! # The surface
//!
//! With P = diag(α_x, α_y, 1) in the frame (tangent, bitangent, n), the surface l = r′/(ω_hᵀP⁻²ω_h) that
//! the joint maximum of F·G2 leaves, r′² = (F·G2/G1)_max G1(ω_i)/(4πμ α_xα_y), is
//!
//! x(m) = r′ (2(ω_i·Pm) Pm − ω_i ‖Pm‖²) for all unit vectors m,
//!
//! as for one roughness (see `triaxial`). Only the set of half vectors Pm counts, so any K with
//! K Kᵀ = P² serves as well as P. With ω_t the direction of the tangent part of ω_i and ω_w = n × ω_t
//! across the plane of incidence, take the triangular one: Km = τm₁ω_t + (σm₁ + νm₂)ω_w + m₃n, where
//!
//! τ² = ω_tᵀP²ω_t, ν = α_xα_y/τ, σ = ω_tᵀP²ω_w/τ.
//!
//! Then no component of what follows is a difference of larger numbers. Collected by the products of m,
//! with s = sin θ_i and ω_v = ω_w × ω_u, and in units of r′,
//!
//! x(m) = m₃²ω_u + m₁²x₁ + m₂²x₂ + 2m₁m₃c₁ + 2m₂m₃c₂ + 2m₁m₂c₃,
//!
//! x₁ = −τ²ω_u + 2τσs ω_w − σ²ω_i, x₂ = −ν²ω_i,
//! c₁ = τω_v + μσω_w, c₂ = μνω_w, c₃ = τνs ω_w − νσω_i.
//!
//! # What encloses it
//!
//! With x̄ = ½(x₁ + x₂), y = m₁² + m₂² and m₃² = 1 − y this is, for any e > 0,
//!
//! x(m) = ½(ω_u + x̄) − e a + (1 − 2y + e) a + 2m₁m₃c₁ + 2m₂m₃c₂ + (m₁² − m₂²) b + 2m₁m₂c₃,
//!
//! a = ½(ω_u − x̄), b = ½(x₁ − x₂): a constant, and five vectors whose factors fulfil
//!
//! (1 − 2y + e)²/(1+e)² + 4y(1−y)/(1+e) + 4e y²/(1+e)² = 1,
//!
//! identically in y. So all points x(m) − (½(ω_u + x̄) − e a) lie in the image of the ball of five
//! dimensions under the matrix with the columns
//!
//! (1+e) a, √(1+e) c₁, √(1+e) c₂, (1+e)/(2√e) b, (1+e)/(2√e) c₃,
//!
//! **an ellipsoid for every e**. b and c₃ are small, of the order of the roughness squared, and e takes
//! the room for them from where they vanish, ahead of the light. Its volume squared is, to first order
//! in e, (1 + 4e)(A + p/e), with A the squared volume of (a, c₁, c₂), and p ¼ of the sum of those with b
//! or c₃ in the place of one of them; it is least for 4Ae² + 4pe = p. So the volume is within 15 % of
//! the least one, and mostly within 0.1 %.
//!
//! # Where roughness is nearly even
//!
//! A lobe lies within that of its greater roughness α at the same r′, since ω_hᵀP⁻²ω_h falls as α_x and
//! α_y grow. So the tighter bound of that isotropic surface encloses it too; the smaller of both is
//! taken, and for α_x = α_y always the isotropic lobe's own.

use core::f32::consts::FRAC_1_PI;

use glam::{Mat3, Vec3};

use super::principal_axes::principal_axes;
use super::{Bounded, Ellipsoid, triaxial};
use crate::wide::{self, Vector};
use crate::{AnisotropicGgxLobe, Fresnel, MaskingShadowing, math};

impl<F: Fresnel, G: MaskingShadowing> Bounded for AnisotropicGgxLobe<F, G> {
    type Bound = Ellipsoid;

    /// An ellipsoid for Φ/(δξ) = 1, with the joint maximum of F and G2
    /// ([`max_reflected`](AnisotropicGgxLobe::max_reflected)).
    ///
    /// It follows the grain: along each of its axes it is about as narrow as the lobe. Never larger than
    /// the paper's [`Spheroid`](crate::Spheroid) for the greater of α_x and α_y around this lobe, but for
    /// rounding, and [`GgxLobe::triaxial_bound`](crate::GgxLobe::triaxial_bound) for α_x = α_y.
    fn unit_bound(&self) -> Ellipsoid {
        let isotropic = self.at_any_azimuth();
        if self.ggx().is_isotropic() {
            return isotropic.triaxial_bound();
        }
        if self.incident_cosine() <= 0.0 {
            return Ellipsoid::EMPTY;
        }
        let [along, across] = self.ggx().roughness();
        let radius_squared =
            self.max_reflected() * isotropic.masking_over_four_cosines() * FRAC_1_PI;
        let scale = math::sqrt(radius_squared / (along * across));

        let following = Incidence::new(self).ellipsoid(scale);
        let rougher = along.max(across);
        let around_rougher = triaxial::ellipsoid_around(isotropic, rougher, scale * rougher);
        if volume(&following) <= volume(&around_rougher) {
            following
        } else {
            around_rougher
        }
    }
}

fn volume(ellipsoid: &Ellipsoid) -> f64 {
    let semi_axes = ellipsoid.semi_axes().to_array();
    semi_axes.into_iter().map(f64::from).product()
}

/// How the grain lies to the plane of incidence.
struct Incidence {
    /// ω_u, ω_v, ω_w.
    frame: [Vector; 3],
    /// μ.
    cosine: f64,
    /// sin θ_i.
    sine: f64,
    /// τ, σ, ν.
    roughness: [f64; 3],
}

impl Incidence {
    fn new<F: Fresnel, G: MaskingShadowing>(lobe: &AnisotropicGgxLobe<F, G>) -> Self {
        let [tangent, bitangent, normal] = lobe.surface_axes();
        let [n, incoming] = [lobe.normal(), lobe.incoming()];
        let lengths = math::length(n.as_f64()) * math::length(incoming.as_f64());
        // Of the f32 vectors, whose products are exact: of the unit vectors it may be all rounding.
        let cosine = math::exact_dot(*n, *incoming) / lengths;
        let product = math::cross(*n, *incoming);
        let length = math::length(product);
        // At normal incidence any plane will do.
        let across = if length > 0.0 {
            product.map(|x| x / length)
        } else {
            bitangent
        };
        let (along, sine) = (wide::cross(across, normal), length / lengths);

        let [alpha_x, alpha_y] = lobe.ggx().roughness().map(f64::from);
        let [x, y] = [tangent, bitangent].map(|axis| wide::dot(axis, along));
        let in_plane = math::length([alpha_x * x, alpha_y * y, 0.0]);
        let difference = (alpha_y - alpha_x) * (alpha_y + alpha_x);
        Self {
            frame: [
                wide::sum([(cosine, normal), (-sine, along)]),
                wide::sum([(sine, normal), (cosine, along)]),
                across,
            ],
            cosine,
            sine,
            roughness: [
                in_plane,
                difference * x * y / in_plane,
                alpha_x * alpha_y / in_plane,
            ],
        }
    }

    /// The ellipsoid that follows the grain, for r′ = `scale`.
    ///
    /// Its semi-axes hold a ball besides, of the radius by which the rounding to `f32` moves a point:
    /// the sum of an ellipsoid of squared semi-axes aᵢ² and a ball of radius d lies in that of
    /// (1+t)aᵢ² + (1+1/t)d², for any t > 0.
    fn ellipsoid(&self, scale: f32) -> Ellipsoid {
        let (center, columns) = self.image_of_ball();
        let rows = [0, 1, 2].map(|i| columns.map(|column| column[i]));
        let (axes, semi_axes) = principal_axes(rows);

        let [shortest, longest] =
            [f64::min, f64::max].map(|pick| semi_axes.into_iter().reduce(pick).unwrap_or_default());
        // Half an ulp in each component of three axes, 1.5u, and of the centre.
        let moved = 4.0 * f64::from(math::UNIT_ROUNDOFF) * (longest + math::length(center));
        let share = (moved / shortest).min(1.0);
        let semi_axes = semi_axes.map(|a| {
            math::sqrt_of_wide((1.0 + share) * a * a + (1.0 + 1.0 / share) * moved * moved) as f32
        });

        let [x, y, z] = axes.map(|axis| self.to_world(axis, 1.0));
        Ellipsoid::from_parts(
            Vec3::ZERO,
            self.to_world(center, scale.into()),
            Mat3::from_cols(x, y, z),
            Vec3::from_array(semi_axes.map(|a| math::round_up(a * scale, 24))),
        )
    }

    fn to_world(&self, v: Vector, scale: f64) -> Vec3 {
        let [a, b, c] = [0, 1, 2].map(|i| (scale * v[i], self.frame[i]));
        Vec3::from_array(wide::sum([a, b, c]).map(|x| x as f32))
    }

    /// The centre and the five columns that the module's text derives, in the frame (ω_u, ω_v, ω_w).
    fn image_of_ball(&self) -> (Vector, [Vector; 5]) {
        let (mu, s) = (self.cosine, self.sine);
        let [tau, sigma, nu] = self.roughness;
        let ahead = [1.0, 0.0, 0.0];
        let across = [0.0, 0.0, 1.0];
        let incoming = [(mu - s) * (mu + s), 2.0 * s * mu, 0.0];

        let x_1 = wide::sum([
            (-tau * tau, ahead),
            (2.0 * tau * sigma * s, across),
            (-sigma * sigma, incoming),
        ]);
        let x_2 = incoming.map(|x| -nu * nu * x);
        let mean = wide::sum([(0.5, x_1), (0.5, x_2)]);
        let long = wide::sum([(0.5, ahead), (-0.5, mean)]);
        let sides = [[0.0, tau, mu * sigma], [0.0, 0.0, mu * nu]];
        let bends = [
            wide::sum([(0.5, x_1), (-0.5, x_2)]),
            wide::sum([(tau * nu * s, across), (-nu * sigma, incoming)]),
        ];

        let e = enlargement(long, sides, bends);
        let center = wide::sum([(0.5, ahead), (0.5, mean), (-e, long)]);
        let side = math::sqrt_of_wide(1.0 + e);
        let bend = (1.0 + e) / (2.0 * math::sqrt_of_wide(e));
        let columns = [
            (1.0 + e, long),
            (side, sides[0]),
            (side, sides[1]),
            (bend, bends[0]),
            (bend, bends[1]),
        ];
        (center, columns.map(|column| wide::sum([column])))
    }
}

/// The e of nearly the least volume; positive.
fn enlargement(long: Vector, sides: [Vector; 2], bends: [Vector; 2]) -> f64 {
    let [first, second] = sides;
    let faces = [
        wide::cross(first, second),
        wide::cross(second, long),
        wide::cross(long, first),
    ];
    let squared = |a: Vector, b: Vector| {
        let product = wide::dot(a, b);
        product * product
    };
    let whole = squared(long, faces[0]);
    let bent: f64 = bends
        .iter()
        .map(|bend| faces.iter().map(|face| squared(*bend, *face)).sum::<f64>())
        .sum();
    let p = 0.25 * bent;
    let e = p / (2.0 * (p + math::sqrt_of_wide(p * (p + whole))));
    // Where nothing bends, any e does; and 0/0 is none.
    e.max(1e-100)
}
