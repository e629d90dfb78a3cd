//! The triaxial bound: an ellipsoid with three different axes around what the NDF alone gives, in closed
//! form.
//!
//! The paper's spheroid takes the third semi-axis, across the plane of incidence, to be r, though
//! the lobe is narrower there the more the light grazes the surface. This ellipsoid follows it.
//!
//! # The surface as the image of a sphere
//!
//! Let P = diag(α, α, 1) in the frame (tangent, bitangent, n) and m any unit vector. With the half
//! vector along Pm, the surface l = rα/(1 − k(ω_h·n)²) that F_max and G1 leave [Tokuyoshi & Harada
//! 2017, Eq. 9] is, relative to the light,
//!
//! x(m) = (r/α) (2(ω_i·Pm) Pm − ω_i ‖Pm‖²),
//!
//! since l = (r/α)‖Pm‖² there. Write m = (cosψ p, sinψ), with p a unit vector of the plane of
//! incidence and the last component across it. The products mix into
//!
//! x(m) = cos²ψ X(p) + sin²ψ z + sin2ψ (r ω_i·Pp) ω_w, z = −αr ω_i,
//!
//! where X(p) runs over the paper's ellipse in the plane of incidence.
//!
//! # Which ellipsoids enclose it
//!
//! Let q(ζ) ≤ 1 be an ellipse in that plane, with quadratic part q₂ and q(X(p)) = 1 − η for all p,
//! η ≥ 0. As q(cos²ψ X + sin²ψ z) = cos²ψ q(X) + sin²ψ q(z) − cos²ψ sin²ψ q₂(X − z), the condition
//! q + w²/ρ² ≤ 1, divided by cos²ψ sin²ψ, reads
//!
//! 4(r ω_i·Pp)²/ρ² − q₂(X − z) ≤ η/sin²ψ + (1 − q(z))/cos²ψ,
//!
//! and the least value of the right-hand side over ψ is (√η + √(1 − q(z)))².
//!
//! Take for q the paper's ellipse enlarged about its centre so that η = x, that is, by 1/√(1−x). In
//! units of its semi-axes X(p) runs over a circle, at twice the angle of p; so both (ω_i·Pp)² and
//! q₂(X − z) are sinusoids of that angle, and the least ρ that fulfils the condition for every p
//! follows from the amplitude of their sum. With θ the angle of incidence, L = kμ² + α²,
//! β = (1 + α²)/(1 + α² + k sin²θ), and d = ½(1 − Q), where Q is the value at z of the unenlarged q,
//!
//! d = 2α²k sin²θ (1 + α² + k sin²θ)/(1 + α²)², y = x + √(x (2d + x(1 − 2d))),
//!
//! **ρ²/r² = (y L + (1−x) d β)/(y + (1−x) d)**:
//!
//! a weighted mean of L, the square of how far the lobe really extends across the plane of incidence,
//! and β, which is what the unenlarged ellipse needs. At normal incidence and for α = 1 both are 1.
//!
//! *Any* x in [0, 1) encloses. The volume is least where d ln(ρ²)/dx = −2/(1−x). For x far above d,
//! where y ≈ 2x + d, and far below it, where y ≈ √(2dx), this is a quadratic equation, the latter
//! after its cubic term is dropped. The first is taken if it comes out above d/3: within 3 % of the least
//! volume.

use glam::Vec3;

use super::{Bound, Ellipsoid};
use crate::{Fresnel, GgxLobe, MaskingShadowing, Roulette, Vpl, Xi, math};

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// The triaxial bound for Φ/(δξ) = 1 and a light at the origin: an ellipsoid around the paper's
    /// ellipse in the plane of incidence that is as narrow across it as the lobe allows, for a lobe
    /// scaled by the joint maximum of F and G2 ([`max_reflected`](GgxLobe::max_reflected)).
    ///
    /// In closed form and proved, where [`tight_bound`](GgxLobe::tight_bound) is smaller, and from a table.
    /// Never larger than the paper's [`Spheroid`](crate::Spheroid) but for rounding; for metals about as
    /// large at normal incidence and a fraction of it at grazing, for dielectrics a fraction throughout.
    pub fn triaxial_bound(&self) -> Ellipsoid {
        if self.incident_cosine() <= 0.0 {
            return Ellipsoid::EMPTY;
        }
        let radius_squared =
            self.max_reflected() * self.masking_over_four_cosines() * core::f32::consts::FRAC_1_PI;
        ellipsoid_around(self, self.ggx().roughness(), math::sqrt(radius_squared))
    }
}

impl<F: Fresnel, G: MaskingShadowing> Vpl<GgxLobe<F, G>> {
    /// The [triaxial bound](GgxLobe::triaxial_bound) of everything that accepts this light in a frame with
    /// `roulette` and `xi`.
    pub fn triaxial_bound(&self, roulette: &Roulette, xi: Xi) -> Ellipsoid {
        let scale = roulette.scale(self.flux(), xi);
        self.lobe().triaxial_bound().placed(self.position(), scale)
    }
}

/// The ellipsoid around the surface of r = `radius` and α = `alpha`, for the directions of `lobe`.
pub(super) fn ellipsoid_around<F: Fresnel, G>(
    lobe: &GgxLobe<F, G>,
    alpha: f32,
    radius: f32,
) -> Ellipsoid {
    let shape = Triaxial::new(alpha, lobe.incident_cosine(), lobe.incident_sine());
    let rotation = lobe.rotation();
    let distance = radius * ((1.0 - alpha) * (1.0 + alpha) / (2.0 * alpha));
    let long = radius * ((1.0 + alpha * alpha) / (2.0 * alpha));
    let semi_axes = Vec3::new(
        long * shape.in_plane,
        radius * shape.in_plane,
        radius * shape.across,
    );
    // The rounding of the axes to f32 tilts them by √3·1.5u at most.
    let shortest = semi_axes.y.min(semi_axes.z);
    let tilt = 4.0 * math::UNIT_ROUNDOFF * (semi_axes.x / shortest);
    let semi_axes = semi_axes * math::round_up(1.0 + tilt, 64);
    Ellipsoid::from_parts(Vec3::ZERO, rotation.x_axis * distance, rotation, semi_axes)
}

/// The semi-axes over those of the paper's spheroid.
#[derive(Clone, Copy)]
struct Triaxial {
    in_plane: f32,
    across: f32,
}

impl Triaxial {
    fn new(alpha: f32, cosine: f32, sine: f32) -> Self {
        let (alpha_squared, sine_squared) = (alpha * alpha, sine * sine);
        let k = (1.0 - alpha) * (1.0 + alpha);
        let bend = k * sine_squared;
        let sum = 1.0 + alpha_squared;
        let exact = alpha_squared * sine_squared + cosine * cosine;
        let beta = sum / (sum + bend);
        // β − L, which cancels at normal incidence if it is subtracted.
        let excess = bend * (alpha_squared + bend) / (sum + bend);
        let d = 2.0 * alpha_squared * bend * (sum + bend) / (sum * sum);
        if d <= 0.0 {
            return Self {
                in_plane: 1.0,
                across: 1.0,
            };
        }
        let across_squared = |x: f32| {
            let y = x + math::sqrt(x * (2.0 * d * (1.0 - x) + x));
            let rest = (1.0 - x) * d;
            (y * exact + rest * beta) / (y + rest)
        };
        let far = enlargement_far_above(d, exact, beta, excess);
        let x = if 3.0 * far > d {
            far
        } else {
            enlargement_far_below(d, exact, beta, excess)
        };
        Self {
            in_plane: 1.0 / math::sqrt(1.0 - x),
            across: math::sqrt(across_squared(x)),
        }
    }
}

/// The positive root of ax² + bx = c, or zero for c ≤ 0.
fn positive_root(a: f32, b: f32, c: f32) -> f32 {
    let c = c.max(0.0);
    2.0 * c / (b + math::sqrt(b * b + 4.0 * a * c))
}

/// The x of least volume, if it is far above d.
fn enlargement_far_above(d: f32, exact: f32, beta: f32, excess: f32) -> f32 {
    let twice = 2.0 * d;
    let slope = twice * (5.0 * exact + 3.0 * beta);
    let height = twice * (excess - twice * (exact + beta));
    positive_root(8.0 * exact, slope, height).min(0.5)
}

/// The x of least volume, if it is far below d. With √(2dx) = 2ds: s(sL + β/2)(s + ½) = (β − L)/(16d).
fn enlargement_far_below(d: f32, exact: f32, beta: f32, excess: f32) -> f32 {
    let twice = 2.0 * d;
    let s = positive_root(0.5 * (beta + exact), 0.25 * beta, excess / (8.0 * twice));
    let root = twice * s;
    // From y − x = root back to x.
    let x =
        2.0 * root * root / (twice + math::sqrt(twice * twice + 4.0 * (1.0 - twice) * root * root));
    x.min(0.5)
}
