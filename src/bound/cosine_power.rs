//! The smallest ellipsoid around a power of the cosine, the lobe of Lambert and of Phong.
//!
//! Let γ be the angle to the axis, and m = n/2. The surface l = cosᵐγ is a surface of revolution. So is the
//! smallest ellipsoid around it, since it is unique. At the height z = cos^{m+1}γ along the axis the squared
//! distance from the axis is
//!
//! h(z) = z^p − z², p = 2m/(m+1), 0 ≤ z ≤ 1.
//!
//! An ellipsoid with centre c and semi-axes a along and b across the axis encloses the surface if and only if
//! f(z) = (z − c)²/a² + h(z)/b² − 1 ≤ 0 on the whole interval. Consider a cone: a point on the axis, and a
//! circle around the axis. In the smallest ellipsoid around it the point is a pole, and the plane of the
//! circle is at the distance a/3 from the centre, on the other side of it, as in the sphere around a regular
//! tetrahedron. So an ellipsoid around the surface that touches it in such a cone is the smallest.
//!
//! # Narrow lobes, m ≥ 1: the light and a ring
//!
//! With the light as a pole, c = a, and the ring at z₁ = 4a/3, b² = (9/8)h(z₁). It is tangent if
//! h′(z₁) = −h(z₁)/(2a − z₁). With q = p − 1 = (m−1)/(m+1) this is (q+2)z₁^q = 3z₁, or
//!
//! cos²γ₁ = (3m+1)/(3m+3), **z₁ = (1 − d/3)^{1/d}, a = ¾z₁, b² = 4a²/(3m+1)**, d = 2/(m+1).
//!
//! It encloses the surface: f(z) ≤ 0 means a²(z^q − z)/(2a − z) ≤ b², and the quotient of a concave and a
//! positive affine function is largest where it is stationary, at z₁. For m = 1 it is a sphere.
//!
//! z₁ is between 2/3 for m = 1 and e^{−1/3} for m = ∞. It is computed by a polynomial in d, since the error
//! of a power would grow with m. Scaling the ellipsoid about the light, which it contains, pays for the
//! error. For |d| ≤ 3 the real part of ln z₁ = −⅓∫₀¹ ds/(1 − sd/3) is below −1/6, so |z₁| < 0.85. The
//! polynomial interpolates z₁ at the Chebyshev points of \[0, 1\]. With ρ = 5 + √24, for the ellipse through
//! 3 with the foci 0 and 1, it is off by at most 4·0.85 ρ⁻⁶/(ρ − 1) = 4.1·10⁻⁷ [Trefethen 2013, Theorem 8.2].
//!
//! # Broad lobes, m < 1: the tip and a ring
//!
//! With the tip, z = 1, as a pole, c = 1 − a. For *any* z₁ in (0, 1) the a and b of the ellipsoid that is
//! tangent to the surface at z₁ follow from f(z₁) = f′(z₁) = 0: with s = 2a − (1 − z₁),
//!
//! 1/s = h′(z₁)/h(z₁) + 1/(1 − z₁), b² = h(z₁) a²/((1 − z₁) s).
//!
//! *Any* of them encloses the surface: f″ = 2/a² − (2 + p(1−p)z^{p−2})/b² increases with z. If it were
//! positive at z₁, f would increase from f(z₁) = 0 to f(1) = 0, a contradiction. So f is concave up to some
//! point beyond z₁, and at most f(z₁) there. Beyond that point it is convex, and at most the larger of its
//! values at both ends. The volume is smallest at a root of (1+p)z^p − pz^{p−1} + 2z − 3z². With
//! z₁ = p/(1 + 2p + 0.6p(1−p)) it is within 4·10⁻⁵ of that. For m = 0, half a ball, z₁ = 0, a = ¾ and
//! b² = 9/8.

use super::revolved::Revolved;
use crate::num::{Single, power};

/// Pays for the error of the polynomial for z₁.
const RING_ROUNDINGS: u16 = 24;

impl<N: Single> Revolved<N> {
    /// The smallest ellipsoid around √cosθ, in as many lanes as `like` has. z₁ = w³, where w = 0.6496 is the
    /// root of 9w⁶ + 9w⁵ + 9w⁴ + 3w³ − 2w² − 2w − 2.
    #[inline(always)]
    pub fn around_lambert(like: N) -> Self {
        Self {
            center: like.splat(0.455_624_55),
            along: like.splat(0.544_375_5),
            across: like.splat(0.624_675_8),
        }
    }

    /// The ellipsoid around cos^{n/2}γ for `exponent` = n ≥ 0.
    #[inline(always)]
    pub fn around_cosine_power(exponent: N) -> Self {
        let is_broad = exponent.splat(2.0).gt(exponent);
        if N::is_known_false(is_broad) {
            return Self::at_light(exponent);
        }
        let at_tip = Self::at_tip(exponent * 2.0 / (exponent + 2.0));
        if N::is_known_false(!is_broad) {
            return at_tip;
        }
        Self::select(is_broad, at_tip, Self::at_light(exponent))
    }

    /// The ellipsoid with the light as a pole, for `exponent` = n ≥ 2.
    #[inline(always)]
    fn at_light(exponent: N) -> Self {
        /// Interpolates (1 − d/3)^{1/d} at seven Chebyshev points. The coefficient of the highest power is
        /// first.
        const RING: [f32; 7] = [
            -8.912_604e-5,
            -1.005_383e-5,
            -5.004_785e-4,
            -1.712_935e-3,
            -7.745_05e-3,
            -3.980_699_4e-2,
            7.165_313e-1,
        ];
        let d = exponent.splat(4.0) / (exponent + 2.0);
        let mut ring = d.zero();
        for coefficient in RING {
            ring = ring * d + coefficient;
        }
        let along = ring.round_up(RING_ROUNDINGS) * 0.75;
        Self {
            center: along,
            along,
            across: along * (d.splat(8.0) / (exponent * 3.0 + 2.0)).sqrt(),
        }
    }

    /// The ellipsoid with the tip as a pole, for p in [0, 1).
    #[inline(always)]
    fn at_tip(p: N) -> Self {
        let one = p.splat(1.0);
        let over_ring = p * (p.one_minus() * 0.6 + 2.0) + 1.0;
        let ring = p / over_ring;
        let power = N::per_lane(
            [ring.max(p.splat(f32::MIN_POSITIVE)), p],
            #[inline(always)]
            |_, [ring, p]| {
                // Lanes with n ≥ 2 discard the result.
                if p < 1.0 { power(ring, p) } else { 1.0 }
            },
        );
        let share = (ring * ring / power).one_minus();
        // h′/h, with p/z₁ in a form that is finite for p = 0.
        let slope = (over_ring - ring * 2.0 / power) / share;
        let rest = ring.one_minus();
        let s = one / (slope + one / rest);
        let along = (rest + s) * 0.5;
        Self {
            center: along.one_minus(),
            along,
            across: along * (power * share / (rest * s)).sqrt(),
        }
    }
}
