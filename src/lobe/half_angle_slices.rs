//! A bound of F·D within a cap where the Fresnel factor F is steep, in each lane: by slices of the half angle.
//!
//! # Why
//!
//! Where glass begins to reflect all light, F is infinitely steep: it varies within the narrowest cap. On a smooth surface
//! D does so too, and both may be greatest in different directions. So the half angles of the cap are cut into slices. In
//! each of them F is at most its greatest value up to the slice's end, and D at most that for the least sine from the
//! slice's start on. The greatest of these products bounds F·D. Since F is nearly linear in the root of the distance from
//! the critical cosine, the slices have equal steps of that root. Glass that absorbs a little reflects more still beyond,
//! so that there are some slices there, too.
//!
//! # The least sine from an angle on
//!
//! With one incoming direction i, the cosine of the half angle is ω_h·i. Let d be a vector across n, by which the least
//! scaled sine is bounded (`half_vectors`, two scales), and λ ≥ 0. For the half vectors with ω_h·i ≤ x
//!
//! d·ω_h ≥ (d + λi)·ω_h − λx,
//!
//! where the first term is a linear function over the whole cone. Let m, k̂ and a be the unit vectors along h, along k, and
//! across both. Then i = ½‖h‖m + ½‖k‖k̂, and ω_h = zm + uk̂ + va with 4u² + ‖h‖²v² ≤ c² and z₀ = √(1 − c²/‖h‖²) ≤ z ≤ 1.
//! So the right-hand side is at least
//!
//! min(d_m, d_m z₀) + λ(½‖h‖z₀ − x) − (c/‖h‖)√(¼‖h‖²(d_k + ½λ‖k‖)² + d_a²).
//!
//! Any d and λ are safe. The best d is the gradient at the nearest half vector with ω_h·i = x. This has the u where
//! ½‖h‖ + ½u‖k‖ = x, and the best v of those in the cone. The best λ makes d + λi perpendicular to the ellipse there, or
//! to u where the ellipse does not confine v.

use super::facets::Facets;
use super::fresnel_of_one::FresnelOfOne;
use super::half_vectors::{HalfVectors, LENGTH_ROUNDINGS, SINE_ROUNDINGS};
use crate::num::{Real, Single, UNIT_ROUNDOFF, round_down};

/// The number of slices up to the critical angle. With 16 the bound is up to 1.9 % above the lobe for α ≥ 0.003 and caps of
/// 10⁻³, with 20 up to 1.7 %.
const SLICES: u16 = 20;
/// The number of slices beyond it, where F still rises if glass absorbs light.
const SLICES_BEYOND: u16 = 10;
/// The least share by which F varies in a cap that is sliced.
const LEAST_VARIATION: f32 = 1.0 / 128.0;
/// Budget for the half angle's cosine of a value, in units of u.
const COSINE_ROUNDINGS: f32 = 10.0;
/// Budget for a bound of d·ω_h, in units of u times ‖d‖/‖h‖.
const LINEAR_ROUNDINGS: f32 = 192.0;
/// Budget for the terms with λ in that bound, in units of uλ.
const MULTIPLIER_ROUNDINGS: f32 = 32.0;
/// The least |v| in λ, as a share of c. Where the ellipse ends, v is zero, and the best λ infinite, as is its rounding.
const LEAST_ACROSS: f32 = 1.0 / 32.0;

/// Half vectors of one incoming direction, for slices by their half angle.
struct Slices<'a, N> {
    facets: &'a Facets<N>,
    /// α_x²/(1 − α_x²) and α_y²/(1 − α_y²)
    squares: [N; 2],
    /// m, k̂ and a in the surface's frame, without their components along n.
    axes: [[N; 2]; 3],
    /// ‖h‖
    length: N,
    /// ½‖k‖
    half_difference: N,
    chord: N,
    /// c/‖h‖
    ratio: N,
    /// z₀
    least: N,
}

impl<'a, N: Single> Slices<'a, N> {
    #[inline(always)]
    fn new(half_vectors: &HalfVectors<N>, facets: &'a Facets<N>) -> Self {
        let HalfVectors { length, chord, .. } = *half_vectors;
        let difference = half_vectors.difference.length();
        let middle = facets.to_surface_frame * half_vectors.middle * half_vectors.inverse_length;
        let along = facets.to_surface_frame * half_vectors.difference * difference.recip();
        let across = middle.cross(along);
        let zero = length.zero();
        let ratio = chord / (length - LENGTH_ROUNDINGS * UNIT_ROUNDOFF).max(zero);
        let least = (ratio.one_minus() * (ratio + 1.0)).max(zero).sqrt();
        Self {
            facets,
            squares: facets.inverse_squared_scales(),
            axes: [
                [middle.x, middle.y],
                [along.x, along.y],
                [across.x, across.y],
            ],
            length,
            half_difference: difference * 0.5,
            chord,
            ratio,
            least,
        }
    }

    /// D for the least scaled sine of half vectors whose half angle has at most this cosine.
    #[inline(always)]
    fn ndf_from(&self, cosine: N) -> N {
        let [p, q] = self.squares;
        let dot = |[a, b]: [N; 2], [c, d]: [N; 2]| a * c + b * d;
        let [middle, along, across] = self.axes;
        let (zero, half_length, half_chord) = (cosine.zero(), self.length * 0.5, self.chord * 0.5);
        let cosine = cosine + COSINE_ROUNDINGS * UNIT_ROUNDOFF;

        // The nearest half vector. The clamps discard NaN.
        let u = (cosine - half_length) / self.half_difference;
        let u = Real::max(-half_chord, Real::min(u, half_chord));
        let edge = ((half_chord - u) * (half_chord + u)).max(zero).sqrt() / half_length;
        let start = [middle[0] + along[0] * u, middle[1] + along[1] * u];
        let step = [across[0] / p, across[1] / q];
        let v = -dot(start, step) / dot(across, step);
        let v = Real::max(-edge, Real::min(v, edge));
        let d @ [x, y] = [
            (start[0] + across[0] * v) / p,
            (start[1] + across[1] * v) / q,
        ];
        let [of_middle, of_along, of_across] = [dot(d, middle), dot(d, along), dot(d, across)];

        let confined = (self.chord * LEAST_ACROSS).max(v.abs()).copysign(v);
        let multiplier = u * of_across / (half_length * half_length * confined) - of_along;
        let multiplier = (multiplier / self.half_difference).max(zero);
        let tilted = (of_along + multiplier * self.half_difference) * half_length;
        let width = (tilted * tilted + of_across * of_across).sqrt();
        let least = of_middle.min(of_middle * self.least)
            + multiplier * (half_length * self.least - cosine)
            - self.ratio * width;
        let rounding = (x * x + y * y).sqrt() * (LINEAR_ROUNDINGS * UNIT_ROUNDOFF) / self.length
            + multiplier * (MULTIPLIER_ROUNDINGS * UNIT_ROUNDOFF);
        let least = (least - rounding) / (x * x * p + y * y * q).sqrt();
        // NaN where there is no d.
        let least = Real::max(least * round_down(1.0, SINE_ROUNDINGS), zero);
        self.facets.ndf_of_scaled_sine(least)
    }
}

impl<N: Single> HalfVectors<N> {
    /// An upper bound of F·D, for the greatest D of all half vectors, and the product `whole` of that and the greatest F. Of
    /// lobes with one incoming direction.
    #[inline(always)]
    pub(super) fn greatest_reflected(
        &self,
        fresnel: &FresnelOfOne<N, impl Fn(N) -> N>,
        facets: impl FnOnce() -> Facets<N>,
        ndf: N,
        whole: N,
    ) -> N {
        let (zero, one) = (ndf.zero(), ndf.splat(1.0));
        let [least, most] = self.sharp_half_angle_cosines();
        let critical_cosine = fresnel.critical_cosine;
        let difference = self.difference.length();
        let may_be_steep = critical_cosine.is_positive() & self.chord.le(difference);
        if !N::any(may_be_steep) {
            return whole;
        }
        // The greatest cosine of a half vector in the cone, but for terms in c².
        let greatest = ((self.length + self.chord * difference * 0.5) * 0.5).min(most);
        let least_reflected = fresnel.at(greatest) * (1.0 + LEAST_VARIATION);
        let is_steep = may_be_steep & fresnel.at(least).gt(least_reflected);
        if !N::any(is_steep) {
            return whole;
        }
        let facets = facets();
        let slices = Slices::new(self, &facets);
        let ranges = [greatest - critical_cosine, critical_cosine - least];
        let [range, beyond] = [ranges[0].max(zero), ranges[1].max(zero)];
        let last_root = ((least - critical_cosine).max(zero) / range)
            .sqrt()
            .min(one);
        // The first slice begins with the greatest cosine of all, so that any steps are safe.
        let (mut sliced, mut ndf_of_rest) = (zero, ndf);
        for slice in 1..SLICES + SLICES_BEYOND {
            let before = f32::from(slice.min(SLICES)) / f32::from(SLICES);
            let root = last_root.one_minus() * -before + 1.0;
            let after = f32::from(slice.saturating_sub(SLICES)) / f32::from(SLICES_BEYOND);
            let end = critical_cosine + range * root * root - beyond * (after * after);
            let end = end.max(least);
            sliced = (fresnel.maximum([end, most]) * ndf_of_rest).max(sliced);
            ndf_of_rest = slices.ndf_from(end).min(ndf);
        }
        let sliced = (fresnel.maximum([least, most]) * ndf_of_rest).max(sliced);
        N::select(is_steep, sliced.min(whole), whole)
    }
}
