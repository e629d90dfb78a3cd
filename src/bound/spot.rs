//! An ellipsoid around a spot light's lobe, the smallest or nearly.
//!
//! In units of the range on the axis the isosurface is the cap l = 1 of the inner cone, cosγ ≥ c₁, and the
//! snail l = (cosγ − c₂)/d of the rest, d = c₁ − c₂: the root of a squared transition is linear in the
//! cosine. Both are surfaces of revolution, and so is the smallest ellipsoid. At the height z = l cosγ along
//! the axis, a point is at the distance y from it, y² = l² − z². Three ellipsoids are used.
//!
//! # From the light: c₂ ≥ 0 and c₁ ≥ 2/3
//!
//! An ellipsoid with the light as a pole, semi-axes a along and b across the axis, and k = a²/b² encloses a
//! point if and only if k y² + z² ≤ 2az. So it encloses the surface if and only if 2a is at least the largest
//! G = l(k sin²γ/cosγ + cosγ), which is l(k/c + (1 − k)c) with c = cosγ.
//!
//! - *On the cap* G is convex in c. It is largest at the rim, c = c₁, where the snail begins, or at the tip,
//!   where it is 1. So 2a ≥ 1 is required.
//! - *On the snail* d G = k − c₂(k/c + (1 − k)c) + (1 − k)c². For k ≤ 1 it increases with c, since its
//!   derivative (1 − k)(2c − c₂) + kc₂/c² is positive: it is largest at the rim. For k ≥ 1 its second
//!   derivative −2(k − 1) − 2kc₂/c³ is not positive: it is largest where it is stationary, or at the rim if it
//!   still increases there.
//!
//! G is stationary at a ring c for **1/k = 1 − c₂/(c²(2c − c₂))**, which is at most 1, and still increases for
//! a larger 1/k. So with any ring c ≤ c₁ the ellipsoid with that k, and 2a = max(G, 1) there, encloses. So it
//! does with the ring at the rim for any larger 1/k.
//!
//! The volume is a³/k. The least is that around a cone: the light as a pole, and the ring at 4a/3 from it. Then
//! 1/k = 2 sin²γ/cos²γ, so the best ring solves 6c³ − 3c₂c² − 4c + c₂ = 0. It is found in y = 1 − c, which
//! does not cancel: y/(1 − c₂) falls from 1/4 for a narrow cone to 1 − √(2/3) for c₂ = 0, and a parabola is
//! within 2·10⁻⁴. If that ring is not on the snail, the best one is the rim. Since G = 3c₁/2 ≥ 1 there, the
//! ellipsoid is the smallest but for the error of the parabola.
//!
//! # From the tip: c₁ ≤ 2/3, or beyond 90°
//!
//! An ellipsoid with the tip z = 1 as a pole encloses a point if and only if k y² + (1 − z)² ≤ 2a(1 − z). It
//! passes through the rim for **k = (2a − 1 + c₁)/(1 + c₁)**.
//!
//! - *On the cap* y² = (1 − z)(1 + z), so the condition is (1 − k)(1 − z) ≤ 2(a − k). It is affine, an
//!   equality at the rim, and at the tip k ≤ a, which is a ≤ 1.
//! - *On the snail* it becomes 2(1 − a)r ≤ 1 + c₁ with r = 1 + (1 − z)(c₁ − z)/(1 − l²), since z = l(dl + c₂)
//!   there. As c₁ − z = (1 − l)(d(1 + l) + c₂), r is 1 + (1 + wl − dl²)(c₁ + wl/(1 + l)) with w = −c₂. If R is
//!   at least the largest r for l in \[0, 1\], **a ≥ 1 − (1 + c₁)/(2R)** encloses.
//!
//! For c₂ ≥ 0, r is largest at l = 0, where it is 1 + c₁, so a ≥ ½. For c₂ < 0 and c₁ ≥ 0 both factors of r − 1
//! are not negative. The tangent at l = 0.3 bounds the second, which is concave, and the maximum of the cubic
//! that is left is known. For c₁ < 0 the next bound of a decides: with a = ¾(1 − c₁) the condition is
//! r ≤ 2(1 + c₁)/(1 + 3c₁), which is at least 2; and r − 1 ≤ 0 if w ≤ 2|c₁|, else d ≥ w/2, so
//! r − 1 ≤ (1 + w²/(4d))(c₁ + w/2) ≤ 3/4.
//!
//! The volume a³/k increases with a from a = ¾(1 − c₁) on, as for a cone with its apex at the tip. So a is the
//! largest of that, ½ and the bound above. From c₁ = −1/3 on a = 1 and k = 1: the ball around the light.
//!
//! With a = ½ light and tip are both poles. For a hard edge with c₁ in \[1/3, 2/3\] this is the smallest: the
//! two poles and the ring have weights that satisfy John's condition. So all ellipsoids of hard edges are the
//! smallest, and all others that are determined by the rim.
//!
//! # A ball: c₂ < 0 and a small inner cone
//!
//! A point of the snail has the squared distance m² + 2mwl − nl² from the height m, with n = 2md − 1. For n > 0
//! it is at most **m²(1 + w²/n)**, whatever l is, and so for the cap, whose points are nearer than its rim. The
//! least is at 2n² + w²n = w², n = w(√(w² + 8) − w)/4. It is 1.03 to 1.08 times as large as the smallest
//! ellipsoid. It is taken if it is smaller than the one from the tip.

use super::ellipsoid::Ellipsoids;
use super::revolved::Revolved;
use super::shape::{Quads, Shape, padded};
use super::{BoundStrategy, Bounded, Ellipsoid, Tight};
use crate::lobe::{Lobe, SpotLobe};
use crate::num::{Single, Vector3, round_down, round_up};

/// √(1/4π), rounded up.
const REACH: f32 = 0.282_094_8;
/// The least 1 − cosγ_o, 2⁻²¹. The bound of a narrower lobe is that of a cone of 0.056°, since the rounding of
/// the axis would count more than what is saved.
const LEAST_OUTER: f32 = 4.768_371_6e-7;
/// Pays for the width of the transition that is left of a cut lobe.
const CUT_WIDTH_ROUNDINGS: u16 = 3;
/// Pays for 1 − cosγ at the inner cone of a cut lobe.
const CUT_ROUNDINGS: u16 = 1;
/// Where the tangent touches that bounds l/(1 + l).
const TOUCHED: f32 = 0.3;

/// Bounds the lobe by an ellipsoid that follows both cones. It is the smallest, to 10⁻⁴, for outer cones up to
/// 90°, for hard edges, and for inner cones that are wide enough. Else its volume is at most 1.08 times the
/// smallest.
///
/// Up to 90° the ellipsoid is within the half-space in front of the light. Of an inner cone of 109.5° or more it
/// is the ball around the light.
impl BoundStrategy<SpotLobe> for Tight {
    type Shape = Ellipsoid;

    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self, lobe: &SpotLobe) -> (Quads<f32>, ()) {
        let ([inner, outer], axis) = (lobe.versines(), lobe.axis());
        let rest = [outer, 0.0, 0.0, 0.0];
        (padded([[axis.x, axis.y, axis.z, inner], rest]), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Ellipsoids<N> {
        let [[x, y, z, inner], [outer, ..], ..] = *quads;
        ellipsoids(Vector3::new(x, y, z), [inner, outer])
    }
}

impl SpotLobe {
    /// Bounds the unit isosurface where it is cut off at the share `share` of its range on the axis, in units in
    /// which it is cut at the full range: the unit bound of a light that ends at a
    /// [`DistanceWindow`](crate::DistanceWindow), which is placed with the scale of its
    /// [`limit`](crate::DistanceWindow::limit).
    ///
    /// The range is linear in the cosine between the cones. So what is left is the surface of a lobe whose inner
    /// cone is wider, with 1 − cosγ = 1 − cosγ_o − `share` · (cosγ_i − cosγ_o), and the bound is as tight as that
    /// of a whole lobe. With a share of 1 or more it is the [unit bound](Bounded::unit_bound), with 0 or NaN that
    /// of the [hard edge](Self::hard_edged).
    #[must_use]
    pub fn unit_bound_cut_at(&self, share: f32) -> Ellipsoid {
        if self.is_empty() {
            return Ellipsoid::EMPTY;
        }
        if share >= 1.0 {
            return self.unit_bound();
        }
        let [inner, outer] = self.versines();
        let width = round_down((outer - inner) * share.max(0.0), CUT_WIDTH_ROUNDINGS);
        let cut = round_up(outer - width, CUT_ROUNDINGS).min(outer);
        Ellipsoid::from_lanes(ellipsoids(self.axis().into(), [cut, outer]))
    }
}

/// The ellipsoids for 1 − cosγ_i and 1 − cosγ_o.
#[inline(always)]
fn ellipsoids<N: Single>(axis: Vector3<N>, [inner, outer]: [N; 2]) -> Ellipsoids<N> {
    let outer = outer.max(outer.splat(LEAST_OUTER));
    let revolved = Candidate::around_spot(inner, outer).revolved();
    revolved.along(axis, outer.splat(REACH))
}

impl Bounded for SpotLobe {
    type Shape = Ellipsoid;
    type Strategy = Tight;

    #[inline]
    fn unit_bound(&self) -> Ellipsoid {
        self.unit_bound_by(Tight)
    }
}

/// An ellipsoid of revolution, before the only root that all kinds need.
#[derive(Clone, Copy)]
struct Candidate<N> {
    /// The distance of the centre from the light, along the axis.
    center: N,
    /// a
    along: N,
    /// 1/k = b²/a²
    inverse: N,
}

impl<N: Single> Candidate<N> {
    /// The ellipsoid around a spot light's lobe for `inner` = 1 − c₁ and `outer` = 1 − c₂.
    #[inline(always)]
    fn around_spot(inner: N, outer: N) -> Self {
        let is_wide = outer.gt(outer.splat(1.0));
        let is_from_tip = is_wide | inner.gt(inner.splat(1.0 / 3.0));
        // What no lane needs is skipped: most scenes have one kind of spot light.
        if !N::any(is_from_tip) {
            return Self::from_light(inner, outer);
        }
        let from_tip = Self::from_tip(inner, outer);
        let mut bound = from_tip;
        if N::any(!is_from_tip) {
            bound = Self::select(is_from_tip, from_tip, Self::from_light(inner, outer));
        }
        if N::any(is_wide) {
            let ball = Self::ball(inner, outer);
            bound = Self::select(is_wide & !from_tip.is_smaller(ball), ball, bound);
        }
        bound
    }

    #[inline(always)]
    fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let [center, along, inverse] = N::select_all(
            mask,
            [yes.center, yes.along, yes.inverse],
            [no.center, no.along, no.inverse],
        );
        Self {
            center,
            along,
            inverse,
        }
    }

    #[inline(always)]
    fn is_smaller(self, other: Self) -> N::Mask {
        let volume = |it: Self| it.along * it.along * (it.along * it.inverse);
        volume(other).gt(volume(self))
    }

    #[inline(always)]
    fn revolved(self) -> Revolved<N> {
        Revolved {
            center: self.center,
            along: self.along,
            across: self.along * self.inverse.sqrt(),
        }
    }

    /// The ellipsoid with the light as a pole, for `inner` ≤ 1/3 and `outer` ≤ 1.
    #[inline(always)]
    fn from_light(inner: N, outer: N) -> Self {
        /// The best ring as a share of `outer`, a parabola in it. The coefficient of the highest power is first.
        const RING: [f32; 3] = [6.337_904e-3, -7.309_715e-2, 2.501_532_4e-1];
        let [second, first, constant] = RING;
        let best = outer * ((outer * second + first) * outer + constant);
        let is_rim = inner.gt(best);
        let ring = best.max(inner);
        let (one, cosine) = (outer.splat(1.0), ring.one_minus());
        let length = N::select(is_rim, one, (outer - ring) / (outer - inner));
        let (cosine_squared, sine_squared) = (cosine * cosine, ring * (-ring + 2.0));
        // 1/k of a stationary ring, and of the smallest ellipsoid around a cone.
        let numerator =
            outer * 2.0 - ring * (outer * 2.0 + 4.0 - ring * (outer + 5.0) + ring * ring * 2.0);
        let stationary = numerator / (cosine_squared * (outer - ring * 2.0 + 1.0));
        let least = sine_squared * 2.0 / cosine_squared;
        let inverse = N::select(is_rim, stationary.max(least), stationary);
        let twice_along = length * (cosine + sine_squared / (cosine * inverse));
        let along = twice_along.max(one) * 0.5;
        Self {
            center: along,
            along,
            inverse,
        }
    }

    /// The ellipsoid with the tip as a pole, through the rim.
    #[inline(always)]
    fn from_tip(inner: N, outer: N) -> Self {
        let (zero, one) = (outer.zero(), outer.splat(1.0));
        let tiny = outer.splat(f32::MIN_POSITIVE);
        let cosine = inner.one_minus().max(zero);
        let wide = (outer - 1.0).max(zero);
        let d = cosine + wide;
        // The tangent of c₁ + wl/(1 + l), and the larger root of the derivative of (1 + wl − dl²) times it.
        let slope = wide * (1.0 / ((1.0 + TOUCHED) * (1.0 + TOUCHED)));
        let start = slope * (TOUCHED * TOUCHED) + cosine;
        let constant = wide * start + slope;
        let half_linear = wide * slope - d * start;
        let root = (half_linear * half_linear + d * slope * constant * 3.0).sqrt();
        let length = constant / (root - half_linear).max(tiny);
        let product = (length * (wide - d * length) + 1.0) * (length * slope + start);
        let along = ((cosine + 1.0) * 0.5 / (product + 1.0))
            .one_minus()
            .max(inner * 0.75)
            .max(one * 0.5)
            .min(one);
        let inverse = (-inner + 2.0).max(tiny) / (along * 2.0 - inner).max(tiny);
        Self {
            center: along.one_minus(),
            along,
            inverse,
        }
    }

    /// The ball around the snail, for `outer` > 1. Infinite for a hard edge.
    #[inline(always)]
    fn ball(inner: N, outer: N) -> Self {
        let wide = outer - 1.0;
        let rest = (wide * wide + 8.0).sqrt() - wide;
        let center = (wide * rest * 0.25 + 1.0) * 0.5 / (outer - inner);
        let radius = center * (wide * 4.0 / rest + 1.0).sqrt();
        Self {
            center,
            along: radius,
            inverse: radius.splat(1.0),
        }
    }
}
