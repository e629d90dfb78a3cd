//! The bound of a cluster of lights.
//!
//! A [`Vsgl`] about μ with c, λ and σ is accepted where E ≥ δξ. Let x be the way from μ, l its length, γ its angle to
//! the axis, a = λ, b = l²/σ², S = a + b, A = λσ², and r² = c/(δξ).
//!
//! # An upper bound of E
//!
//! E = 2c e^{−S} sinh(μ)/(σ²μ) with μ² = S² − 2ab(1 − cosγ). The logarithm of sinh(√q)/√q is concave in q, since its
//! derivative is L(√q)/(2√q), where L(S) = coth S − 1/S, and L(S)/S falls. So it is below its tangent at q = S²:
//!
//! **E ≤ c (1 − e^{−2S})/u · exp(−λ L(S) l²(1 − cosγ)/u)**, u = l² + A = σ²S,
//!
//! which is E itself on the axis. Both factors fall with l, and the exponent's factor λL(S)l²/u rises. So the points
//! where the right side is at least δξ are a star about the light.
//!
//! # Two parameters
//!
//! Let u₁ be the largest root of u = r²(1 − e^{−2u/σ²}), the largest u at which E = δξ on the axis, or more than
//! that. Then r²(1 − e^{−2u/σ²}) ≤ u₁(1 − e^{−2S})/(1 − e^{−2λ/t}) with t = A/u₁, where now S = λu/(u₁t). In units of
//! √u₁ the star therefore lies within the points where
//!
//! ln((1 − e^{−2S})/(1 − e^{−2λ/t})) − ln u ≥ λL(S) l²(1 − cosγ)/u, u = l² + t, S = λu/t,
//!
//! and depends on λ and t alone. It reaches R = √(1 − t) ahead. It is empty for t ≥ 1. For t = 0 it is that of the SG.
//! For A = 0 there is no u₁ if σ² ≥ 2r². Newton's
//! method for u₁, on a convex function, comes down from above, so it may end after any step.
//!
//! # The ellipsoid
//!
//! It is one of revolution. How far it extends ahead of the light and behind it, and its squared semi-axis across over
//! w = 1/(1 + λ/2), are interpolated linearly in √w and √t, in units of R, from a table (`cluster_table`) of 486 bytes.
//! Its knots are the smallest ellipsoids, enlarged so that they enclose between the knots too. That they do is proved
//! by a computer, box by box in √w, √t and the height (`tests/cluster_bound.rs`). Without spread it is the ellipsoid
//! of the SG.

use super::Ellipsoid;
use super::cluster_table::{KNOTS, TABLE};
use super::ellipsoid::Ellipsoids;
use super::revolved::Revolved;
use super::shape::{Quads, Shape, padded};
use super::spherical_gaussian::around_gaussian;
use crate::light::{Roulette, Vsgl, Xi};
use crate::num::{Quad, Real, Single, Vector3, exponential};

/// Pays for the rounding of the coordinates and of the interpolation: 2⁻¹⁴.
const TABLE_ROUNDINGS: u16 = 1024;
/// Pays for the rounding of E and of δξ, and of u₁: 2⁻²⁰.
const ROOT_GROWTH: f64 = 1.0 + 16.0 / 16_777_216.0;
/// The steps of Newton's method.
const STEPS: u32 = 2;
/// The least 2r²/σ² from which on Newton's method is used. Below, its terms cancel, and its start is near.
const LEAST_QUOTIENT: f64 = 1.01;
/// The largest 2r²/σ² that counts, 200. From there on u₁ is r² but for rounding.
const LARGEST_QUOTIENT: f64 = 200.0;

impl Vsgl {
    /// The bound of all points that accept this light in a frame with `roulette` and `xi`: where
    /// [`scalar_irradiance`](Self::scalar_irradiance) E ≥ δξ.
    ///
    /// δ is in W/m² here. Where E counts as the intensity of a light at unit distance, the [`Roulette`] has the
    /// probability min(E/δ, 1): `roulette.accepts(e, 1.0, xi)`.
    ///
    /// The ellipsoid is empty if the lobe is zero, and if the spread is so large that E < δξ even at the centre, but
    /// for lights that are about to be. It is always inside the sphere of radius 1.1√(c/(δξ)) about the position.
    /// Without spread it is the bound of a point light with that lobe. Its volume is at most 1.2 times that of the
    /// smallest ellipsoid around the points, and 1.06 times in the median.
    ///
    /// ```
    /// use stochastic_light_culling::{Direction, Roulette, Seed, SphericalGaussian, Vsgl, glam::Vec3};
    ///
    /// let lobe = SphericalGaussian::with_integral(Direction::Z, 20.0, 5.0)?;
    /// let light = Vsgl::new(Vec3::ZERO, 0.5, lobe)?;
    /// let (roulette, xi) = (Roulette::new(0.05)?, Seed(0).frame(0).xi(0));
    /// let bound = light.bound(&roulette, xi);
    ///
    /// let point = Vec3::new(0.0, 0.2, 3.0);
    /// if roulette.accepts(light.scalar_irradiance(point), 1.0, xi) {
    ///     let local = bound.rotation().transpose() * (point - bound.center()) / bound.semi_axes();
    ///     assert!(local.length() < 1.0);
    /// }
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[must_use]
    pub fn bound(&self, roulette: &Roulette, xi: Xi) -> Ellipsoid {
        let scale = roulette.scale(self.lobe().amplitude(), xi);
        let unit = around_clusters::<f32>(&quads_of_cluster(self), scale);
        Ellipsoid::from_lanes(unit).placed(self.position(), scale)
    }
}

/// The quads of a cluster: ξ and λ, and σ.
#[inline(always)]
pub(crate) fn quads_of_cluster(light: &Vsgl) -> Quads<f32> {
    let lobe = light.lobe();
    let axis = lobe.axis();
    padded([
        [axis.x, axis.y, axis.z, lobe.sharpness()],
        [light.spread(), 0.0, 0.0, 0.0],
    ])
}

/// The ellipsoids around clusters at the origin, in units of r = `scale`.
#[inline(always)]
pub(crate) fn around_clusters<N: Single>(quads: &Quads<N>, scale: N) -> Ellipsoids<N> {
    let [[x, y, z, sharpness], [spread, ..], ..] = *quads;
    let least = sharpness.splat(f32::MIN_POSITIVE);
    let relative = spread.widen() / scale.max(least).widen();
    let spread_squared = relative * relative;
    let lambda = sharpness.widen();
    let moved = lambda * spread_squared;
    let root = largest_root(spread_squared) * ROOT_GROWTH;
    let one = lambda.splat(1.0);
    let w = one / (lambda * 0.5 + 1.0);
    let reach_squared = root - moved;
    let t = (moved / root).min(one);
    let shape = from_table(N::narrow(w.sqrt()), N::narrow(t.sqrt()), N::narrow(w));
    let reach = N::narrow(reach_squared.max(one.zero()).sqrt());
    let is_point = spread.eq(spread.zero());
    let reach = N::select(is_point, reach.splat(1.0), reach);
    let shape = if N::is_known_false(is_point) {
        shape
    } else {
        Revolved::select(is_point, around_gaussian(sharpness), shape)
    };
    shape.along(Vector3::new(x, y, z), reach)
}

/// The largest root of v = 1 − e^{−kv}, k = 2/`spread_squared`, or more: positive, and at most 1.
///
/// e^{−x} ≥ (2 − x)/(2 + x) says that the root is at most 2(k − 1)/k, where Newton's method starts.
#[inline(always)]
fn largest_root<D: Real<Element = f64>>(spread_squared: D) -> D {
    let one = spread_squared.splat(1.0);
    let k = (one * 2.0 / spread_squared.max(one.splat(f64::MIN_POSITIVE)))
        .min(one.splat(LARGEST_QUOTIENT));
    let start = ((k - 1.0) * 2.0 / k).min(one);
    let mut v = start;
    for _ in 0..STEPS {
        let power = exponential(-(k * v));
        v = (one - power * (k * v + 1.0)) / (one - k * power);
    }
    let root = D::select(k.gt(one.splat(LEAST_QUOTIENT)), v, start);
    root.max(one.splat(f64::MIN_POSITIVE))
}

/// The ellipsoid of the table at √w and √t, in units of R.
#[inline(always)]
fn from_table<N: Single>(root_w: N, root_t: N, w: N) -> Revolved<N> {
    let zero = w.zero();
    let places = [root_w, root_t].map(|root| root * (KNOTS - 1) as f32);
    let [[front, rear, across, _], _] = N::per_lane_quads(
        [places[0], places[1], zero, zero],
        zero.is_positive(),
        #[inline(always)]
        |[i, j, ..], _| [between(i, j), [0.0; 4]],
    );
    Revolved {
        center: (front - rear) * 0.5,
        along: ((front + rear) * 0.5).round_up(TABLE_ROUNDINGS),
        across: (across * w).sqrt().round_up(TABLE_ROUNDINGS),
    }
}

/// Interpolates the table at two places in \[0, [`KNOTS`] − 1\].
#[inline(always)]
fn between(i: f32, j: f32) -> Quad<f32> {
    // Zero for what is negative or NaN.
    let [first, next] = [i, j].map(|place| (place as usize).min(KNOTS - 2));
    let [u, v] = [i - first as f32, j - next as f32];
    let knot = next * KNOTS + first;
    let [a, b, c, d] = [0, 1, KNOTS, KNOTS + 1].map(|step| TABLE[knot + step]);
    let mut numbers = [0.0; 4];
    for n in 0..4 {
        let near = a[n] + (b[n] - a[n]) * u;
        let far = c[n] + (d[n] - c[n]) * u;
        numbers[n] = near + (far - near) * v;
    }
    numbers
}
