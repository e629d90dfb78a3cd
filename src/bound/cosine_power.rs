//! The smallest ellipsoid around a power of the cosine, the lobe of Lambert and of Phong.
//!
//! The surface l = cosᵐγ, γ the angle to its axis, m = n/2, is one of revolution, and so is the smallest
//! ellipsoid around it, since that is unique. At the height z = cos^{m+1}γ along the axis the squared
//! distance from the axis is
//!
//! h(z) = z^p − z², p = 2m/(m+1), 0 ≤ z ≤ 1.
//!
//! An ellipsoid with centre c and semi-axes a along and b across the axis encloses it if and only if
//! f(z) = (z − c)²/a² + h(z)/b² − 1 ≤ 0 on all of that interval. For a cone, a point and a circle that it
//! is the axis of, the smallest ellipsoid is that for which the point is a pole and the circle lies at a
//! third of a on the other side of the centre, as of a sphere around a regular tetrahedron. So an ellipsoid
//! around the surface that touches it in such a cone is the smallest.
//!
//! # Narrow lobes, m ≥ 1: the light and a ring
//!
//! With the light as a pole, c = a, and the ring at z₁ = 4a/3, b² = (9/8)h(z₁), which is tangent if
//! h′(z₁) = −h(z₁)/(2a − z₁). With q = p − 1 = (m−1)/(m+1) this is (q+2)z₁^q = 3z₁, or
//!
//! cos²γ₁ = (3m+1)/(3m+3), **z₁ = (1 − d/3)^{1/d}, a = ¾z₁, b² = 4a²/(3m+1)**, d = 2/(m+1).
//!
//! It encloses: f(z) ≤ 0 says a²(z^q − z)/(2a − z) ≤ b², and the quotient of a concave and a positive affine
//! function has no maximum but where it is stationary, at z₁. m = 1 is a sphere.
//!
//! z₁, from 2/3 for m = 1 to e^{−1/3}, is a polynomial in d rather than a power, whose error would grow with
//! m; scaling the ellipsoid about the light, which it contains, makes up for what is rounded. In |d| ≤ 3,
//! ln z₁ = −⅓∫₀¹ ds/(1 − sd/3) has a real part below −1/6, so |z₁| < 0.85, and the polynomial that agrees
//! with z₁ in Chebyshev's points of \[0, 1\] is, with ρ = 5 + √24 for the ellipse with the foci 0 and 1
//! through 3, off by 4·0.85 ρ⁻⁶/(ρ − 1) = 4.1·10⁻⁷ at most [Trefethen 2013, Theorem 8.2].
//!
//! # Broad lobes, m < 1: the tip and a ring
//!
//! With the tip, z = 1, as a pole, c = 1 − a. For *any* z₁ in (0, 1) the a and b of the ellipsoid that is
//! tangent to the surface at z₁ follow from f(z₁) = f′(z₁) = 0: with s = 2a − (1 − z₁),
//!
//! 1/s = h′(z₁)/h(z₁) + 1/(1 − z₁), b² = h(z₁) a²/((1 − z₁) s).
//!
//! *Any* encloses: f″ = 2/a² − (2 + p(1−p)z^{p−2})/b² rises with z. Were it positive at z₁, f would
//! rise from f(z₁) = 0 to f(1) = 0. So f is concave up to some point behind z₁, and there at most f(z₁);
//! behind that point it is convex, and at most what it is at both ends. The volume is least at a root of
//! (1+p)z^p − pz^{p−1} + 2z − 3z²; z₁ = p/(1 + 2p + 0.6p(1−p)) leaves it within 4·10⁻⁵. For m = 0, half a
//! ball, z₁ = 0, a = ¾ and b² = 9/8.

use super::Ellipsoids;
use crate::num::{Matrix3, Single, UNIT_ROUNDOFF, Vector3, power};

/// Pays for the error of the polynomial for z₁.
const RING_ROUNDINGS: u16 = 24;
/// Pays for the rounding of axis, frame and centre, in units of u times longest over shortest semi-axis.
const AXES_TILT_ROUNDINGS: f32 = 16.0;
/// Pays for the rounding of the semi-axes and of the reach.
const SEMI_AXIS_ROUNDINGS: u16 = 64;

/// An ellipsoid of revolution in each lane, for lobes that reach as far as 1 along their axis.
#[derive(Clone, Copy)]
pub(super) struct Revolved<N> {
    /// From the light, along the axis.
    center: N,
    along: N,
    across: N,
}

impl<N: Single> Revolved<N> {
    /// The smallest ellipsoid around √cosθ: z₁ = w³ for the root w = 0.6496 of
    /// 9w⁶ + 9w⁵ + 9w⁴ + 3w³ − 2w² − 2w − 2. In as many lanes as `like` has.
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
        let at_light = Self::at_light(exponent);
        let [center, along, across] = N::select_all(
            is_broad,
            [at_tip.center, at_tip.along, at_tip.across],
            [at_light.center, at_light.along, at_light.across],
        );
        Self {
            center,
            along,
            across,
        }
    }

    #[inline(always)]
    fn at_light(exponent: N) -> Self {
        /// Agrees with (1 − d/3)^{1/d} in seven of Chebyshev's points; from the highest power on.
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

    /// For p in [0, 1).
    #[inline(always)]
    fn at_tip(p: N) -> Self {
        let one = p.splat(1.0);
        let over_ring = p * (p.one_minus() * 0.6 + 2.0) + 1.0;
        let ring = p / over_ring;
        let power = N::per_lane(
            [ring.max(p.splat(f32::MIN_POSITIVE)), p],
            #[inline(always)]
            |_, [ring, p]| {
                // Lanes with another exponent need none.
                if p < 1.0 { power(ring, p) } else { 1.0 }
            },
        );
        let share = (ring * ring / power).one_minus();
        // h′/h, with p/z₁ as a number that p = 0 has too.
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

    /// The ellipsoid along `axis` for a lobe that reaches as far as `reach` > 0, rounded outward.
    #[inline(always)]
    pub fn along(self, axis: Vector3<N>, reach: N) -> Ellipsoids<N> {
        let (v, w) = axis.any_orthonormal_pair();
        let semi_axes = Vector3::new(self.along, self.across, self.across);
        // What the rounding of the axis, its frame and the centre moves, over the shortest semi-axis.
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        let moved = longest * (AXES_TILT_ROUNDINGS * UNIT_ROUNDOFF) / shortest;
        Ellipsoids {
            parts: [Vector3::zero(reach), axis * (self.center * reach)],
            axes: Matrix3::new(axis, v, w),
            semi_axes: semi_axes * (reach * (moved + 1.0)).round_up(SEMI_AXIS_ROUNDINGS),
        }
    }
}
