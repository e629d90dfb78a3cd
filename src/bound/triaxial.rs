//! The triaxial bound: an ellipsoid in closed form, with three different semi-axes, around the surface that
//! the NDF alone gives.
//!
//! In the paper's spheroid the semi-axis across the plane of incidence is r. But the lobe becomes narrower in
//! that direction towards grazing incidence. This ellipsoid follows it.
//!
//! # The surface as the image of a sphere
//!
//! Let P = diag(α, α, 1) in the frame (tangent, bitangent, n), and let m be any unit vector. With F and G2 at
//! constant upper bounds, the isosurface is l = rα/(1 − k(ω_h·n)²) [Tokuyoshi & Harada 2017, Eq. 9]. With the
//! half vector along Pm it is, relative to the light,
//!
//! x(m) = (r/α) (2(ω_i·Pm) Pm − ω_i ‖Pm‖²),
//!
//! since l = (r/α)‖Pm‖² there. Write m = (cosψ p, sinψ), with p a unit vector in the plane of incidence, and
//! the last component across it. Then
//!
//! x(m) = cos²ψ X(p) + sin²ψ z + sin2ψ (r ω_i·Pp) ω_w, z = −αr ω_i,
//!
//! where X(p) traces the paper's ellipse in the plane of incidence.
//!
//! # Which ellipsoids enclose it
//!
//! Let q(ζ) ≤ 1 be an ellipse in that plane, with quadratic part q₂, and q(X(p)) = 1 − η for all p, η ≥ 0.
//! Since q(cos²ψ X + sin²ψ z) = cos²ψ q(X) + sin²ψ q(z) − cos²ψ sin²ψ q₂(X − z), the condition q + w²/ρ² ≤ 1,
//! divided by cos²ψ sin²ψ, reads
//!
//! 4(r ω_i·Pp)²/ρ² − q₂(X − z) ≤ η/sin²ψ + (1 − q(z))/cos²ψ,
//!
//! and the smallest value of the right-hand side over ψ is (√η + √(1 − q(z)))².
//!
//! Choose q as the paper's ellipse, enlarged about its centre by 1/√(1−x), so that η = x. In units of its
//! semi-axes X(p) traces a circle, at twice the angle of p. So both (ω_i·Pp)² and q₂(X − z) are sinusoids of
//! that angle. The smallest ρ that satisfies the condition for every p follows from the amplitude of their
//! sum. With the angle of incidence θ, L = kμ² + α², β = (1 + α²)/(1 + α² + k sin²θ), and d = ½(1 − Q), where
//! Q is the value at z of the unenlarged q,
//!
//! d = 2α²k sin²θ (1 + α² + k sin²θ)/(1 + α²)², y = x + √(x (2d + x(1 − 2d))),
//!
//! **ρ²/r² = (y L + (1−x) d β)/(y + (1−x) d)**:
//!
//! a weighted mean of L and β. √L is the half-width of the lobe across the plane of incidence, over r, and √β
//! is the semi-axis for the unenlarged ellipse. At normal incidence and for α = 1 both are 1.
//!
//! *Any* x in [0, 1) gives an enclosing ellipsoid. The volume is smallest where d ln(ρ²)/dx = −2/(1−x). For x
//! far above d, y ≈ 2x + d; far below it, y ≈ √(2dx). In both cases this is a quadratic equation, in the
//! second after its cubic term is dropped. The solution of the first is used if it is above d/3. The volume
//! is then within 3 % of the smallest.

use core::f32::consts::FRAC_1_PI;

use super::ellipsoid::Ellipsoids;
use super::shape::{Quads, padded};
use super::{BoundStrategy, Ellipsoid, Triaxial};
use crate::lobe::{Fresnel, GgxLobe, GgxLobes, MaskingShadowing};
use crate::num::{Matrix3, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for the rounding of the axes and of the centre, in units of u times longest over shortest semi-axis.
const AXES_TILT_ROUNDINGS: f32 = 4.0;
/// Pays for the rounding of the semi-axes.
const SEMI_AXIS_ROUNDINGS: u16 = 64;

/// Bounds the lobe by an ellipsoid around the paper's ellipse in the plane of incidence, which is as narrow
/// across that plane as the lobe allows. F and G2 are at their joint maximum
/// ([`max_reflected`](GgxLobe::max_reflected)).
///
/// The ellipsoid is in closed form, with a proof; [`Tight`](crate::Tight) is smaller and needs a table. But
/// for rounding, it is never larger than the paper's [`Spheroid`](crate::Spheroid). For metals it is about as
/// large at normal incidence, and a fraction of it at grazing incidence. For dielectrics it is always a
/// fraction.
impl<F: Fresnel, G: MaskingShadowing> BoundStrategy<GgxLobe<F, G>> for Triaxial {
    type Shape = Ellipsoid;

    type PerLight = F;

    const QUADS: usize = 3;

    #[inline(always)]
    fn to_quads(&self, lobe: &GgxLobe<F, G>) -> (Quads<f32>, F) {
        (padded(lobe.quads()), *lobe.fresnel())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, fresnels: &[F]) -> Ellipsoids<N> {
        let lobe = GgxLobes::from_quads([quads[0], quads[1], quads[2]]);
        let radius = ndf_radius_squared::<N, F, G>(&lobe, fresnels).sqrt();
        ellipsoids_around(&lobe, lobe.roughness, radius)
    }
}

/// r² for the joint maximum of F and G2.
#[inline(always)]
pub(super) fn ndf_radius_squared<N: Single, F: Fresnel, G: MaskingShadowing>(
    lobe: &GgxLobes<N>,
    fresnels: &[F],
) -> N {
    lobe.max_reflected::<F, G>(fresnels) * lobe.masking_over_four_cosines() * FRAC_1_PI
}

/// The ellipsoids around the surfaces with r = `radius` and α = `alpha`, for the directions of `lobe`.
#[inline(always)]
pub(super) fn ellipsoids_around<N: Single>(
    lobe: &GgxLobes<N>,
    alpha: N,
    radius: N,
) -> Ellipsoids<N> {
    let plane = lobe.plane_of_incidence();
    let shape = Proportions::new(alpha, lobe.incident_cosine, plane.sine);
    let (u, w) = (plane.mirror, plane.across);
    let distance = radius * (alpha.one_minus() * (alpha + 1.0) / (alpha * 2.0));
    let long = radius * ((alpha * alpha + 1.0) / (alpha * 2.0));
    let semi_axes = Vector3::new(
        long * shape.in_plane,
        radius * shape.in_plane,
        radius * shape.across,
    );
    let shortest = semi_axes.y.min(semi_axes.z);
    let tilt = semi_axes.x / shortest * (AXES_TILT_ROUNDINGS * UNIT_ROUNDOFF);
    Ellipsoids {
        light: None,
        offset: u * distance,
        axes: Matrix3::new(u, w.cross(u), w),
        semi_axes: semi_axes * (tilt + 1.0).round_up(SEMI_AXIS_ROUNDINGS),
    }
}

/// The semi-axes relative to those of the paper's spheroid.
#[derive(Clone, Copy)]
struct Proportions<N> {
    in_plane: N,
    across: N,
}

impl<N: Single> Proportions<N> {
    #[inline(always)]
    fn new(alpha: N, cosine: N, sine: N) -> Self {
        let (alpha_squared, sine_squared) = (alpha * alpha, sine * sine);
        let k = alpha.one_minus() * (alpha + 1.0);
        let bend = k * sine_squared;
        let sum = alpha_squared + 1.0;
        let exact = alpha_squared * sine_squared + cosine * cosine;
        let beta = sum / (sum + bend);
        // β − L, in a form that does not cancel at normal incidence.
        let excess = bend * (alpha_squared + bend) / (sum + bend);
        let d = alpha_squared * 2.0 * bend * (sum + bend) / (sum * sum);
        let one = d.splat(1.0);
        let bends = d.is_positive();
        if N::is_known_false(bends) {
            return Self {
                in_plane: one,
                across: one,
            };
        }
        let far_above = enlargement_far_above(d, exact, beta, excess);
        let is_far_above = (far_above * 3.0).gt(d);
        let x = if N::is_known_false(!is_far_above) {
            far_above
        } else {
            let far_below = enlargement_far_below(d, exact, beta, excess);
            N::select(is_far_above, far_above, far_below)
        };
        let y = x + (x * (d * 2.0 * x.one_minus() + x)).sqrt();
        let rest = x.one_minus() * d;
        let across = ((y * exact + rest * beta) / (y + rest)).sqrt();
        let in_plane = x.one_minus().sqrt().recip();
        let [in_plane, across] = N::select_all(bends, [in_plane, across], [one, one]);
        Self { in_plane, across }
    }
}

/// The positive root of ax² + bx = c, or zero for c ≤ 0.
#[inline(always)]
fn positive_root<N: Single>(a: N, b: N, c: N) -> N {
    let c = c.max(c.zero());
    c * 2.0 / (b + (b * b + a * 4.0 * c).sqrt())
}

/// The x of the smallest volume, if it is far above d.
#[inline(always)]
fn enlargement_far_above<N: Single>(d: N, exact: N, beta: N, excess: N) -> N {
    let twice = d * 2.0;
    let slope = twice * (exact * 5.0 + beta * 3.0);
    let height = twice * (excess - twice * (exact + beta));
    positive_root(exact * 8.0, slope, height).min(d.splat(0.5))
}

/// The x of the smallest volume, if it is far below d. With √(2dx) = 2ds, s solves
/// s(sL + β/2)(s + ½) = (β − L)/(16d).
#[inline(always)]
fn enlargement_far_below<N: Single>(d: N, exact: N, beta: N, excess: N) -> N {
    let twice = d * 2.0;
    let s = positive_root((beta + exact) * 0.5, beta * 0.25, excess / (twice * 8.0));
    let root = twice * s;
    // Solves y − x = root for x.
    let x = root * 2.0 * root
        / (twice + (twice * twice + twice.one_minus() * 4.0 * root * root).sqrt());
    x.min(d.splat(0.5))
}
