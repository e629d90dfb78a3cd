//! The tight bound: nearly the smallest ellipsoid around the lobe, from a table.
//!
//! The paper's spheroid bounds F, G2 and the NDF separately, in all directions. This ellipsoid bounds their
//! product above the surface, and tilts with it in the plane of incidence.
//!
//! # The surface as the image of a sphere
//!
//! Let P = diag(α, α, 1) in the frame (tangent, bitangent, n), and let m be any unit vector. With the half
//! vector along Pm, the surface l = (r/α)‖Pm‖² that the NDF alone gives is, relative to the light,
//! x(m) = (r/α) (2(ω_i·Pm) Pm − ω_i ‖Pm‖²). With the angle of incidence θ and L = kμ² + α², let
//!
//! cosδ = μ/√L, sinδ = α sinθ/√L, that is, tanδ = α tanθ.
//!
//! With m₁ pointing away from ω_i, x(m) along (ω_u, −ω_v, ω_w) in units of (r/α, r, r√L) is
//!
//! ζ₁ = m₃² − α²m₁² − α² cos2θ m₂², ζ₂ = 2m₁m₃ + α sin2θ m₂², ζ₃ = 2m₂ (cosδ m₃ − sinδ m₁).
//!
//! Above the surface the isosurface is this times s, where s² = F G2/(F(μ) G1(μ)) and r² = F(μ) G1(μ)/(4πμ).
//! With N = α²(1−m₃²) + m₃² and a = cosδ m₃ − sinδ m₁, the cosine of the half angle is a√(L/N), and
//! μ_o/√L = 2am₃/N − cosδ. √L is also the root in G1, and μ/√L = cosδ, α/√L = sinδ/sinθ. So for small α the
//! shape depends on μ and α only through δ, which determines how much of the lobe the horizon cuts off.
//!
//! # The table
//!
//! For F = A (F0 + (1 − F0)(1 − cosθ_h)⁵) the shape has three parameters: α, θ and F0. The table holds an
//! ellipsoid in ζ, a centre and a triangular matrix, at 1323 knots, and is interpolated linearly. Its
//! coordinates √α, tan(θ/2) + tan(δ/2) and ∜F0 make the ellipsoid nearly linear. The second resolves grazing
//! incidence on rough surfaces, and also for α → 0, where the shape changes at μ ~ α. Any other Fresnel
//! factor is bounded by one of this form ([`Fresnel::majorant`]). Separable masking is bounded by
//! height-correlated masking.
//!
//! # Which ellipsoid
//!
//! In each frame the ellipsoid is scaled by 1/√ξ, with ξ uniform. Let ρ be the radius of the ellipsoid from
//! the light towards a point at the distance d. The point is inside for a share ρ²/d² of all ξ, and a surface
//! there has the area d² dω/cos. So the expected area inside, for surfaces of any orientation, is
//! proportional to ∫ ρ² dω. The knots minimise that integral over the directions above the surface. The
//! volume, ∫ ρ³ dω/3, is a worse measure: the ellipsoids of smallest volume extend farther behind the light,
//! and in the ring of `examples/render` they let up to 7 % more lights through. For α = 0.05 each per cent of
//! margin costs as much: the section across the lobe at the light, which is near the end of the ellipsoid,
//! grows with the root of the margin.
//!
//! # Enclosure
//!
//! So each knot has only as much margin as the samples in the cells around it need, and an extra that depends
//! on roughness, incidence and F0. The extra is up to 6 %. For smooth metals at oblique incidence it is
//! nearly zero, besides the margin of the fit itself (`examples/tabulate`).
//!
//! The interpolated ellipsoids are proved to enclose the surface for every √α in \[0, 1\],
//! tan(θ/2) + tan(δ/2) in \[0, 2\] and ∜F0 in \[1/4, 1\]. The statement is ‖y‖² ≤ 1 − 2·10⁻⁴ for each point
//! c + A y of the surface. It has five variables, and `certificate` in `tests/support` proves it box by box. Over a box
//! ‖y‖² is enclosed by a quadratic polynomial and a bound of its remainder, rounded outward in every step.
//! The 960 cells take 14 million boxes, little more than a minute on one core. The gap of 10⁻⁴ of a radius
//! pays for the rounding to `f32` of the three coordinates and of the interpolation.
//!
//! ```text
//! cargo run --release --example tabulate -- --prove
//! ```
//!
//! Where the paper's spheroid is smaller, near normal incidence, it is used instead.

use core::f32::consts::FRAC_1_PI;

use glam::Vec4;

use super::ellipsoid::Ellipsoids;
use super::shape::{Quads, padded};
use super::table::{self, Axis, INCIDENCES, KNOTS, REFLECTANCES, TABLE};
use super::{BoundStrategy, Bounded, Ellipsoid, Tight, Triaxial};
use crate::lobe::{
    Fresnel, FresnelMajorant, GgxLobe, GgxLobes, MaskingShadowing, PlaneOfIncidence,
};
use crate::num::{Matrix3, Quad, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for the rounding of the least base that the table covers.
const LEAST_BASE_ROUNDINGS: u16 = 2;
/// Pays for the rounding of base + rise (1 − μ)⁵.
const REFLECTED_ROUNDINGS: u16 = 192;
/// Pays for the rounding of the axes and of the centre, in units of u times longest over shortest semi-axis.
const AXES_TILT_ROUNDINGS: f32 = 12.0;
/// Pays for the rounding of the semi-axes.
const SEMI_AXIS_ROUNDINGS: u16 = 96;

/// Bounds the part of the lobe above the surface, with its Fresnel factor, masking and shadowing, by an
/// ellipsoid that contains nearly as little as possible of the surfaces around the light.
///
/// For α ≤ 0.5 its volume is on average 1.08 times that of the smallest ellipsoid for metals, and 1.18 times
/// for dielectrics. But for rounding, it is never above that of the paper's [`Spheroid`](crate::Spheroid).
///
/// The table is valid only for masking functions that are [nowhere
/// above](MaskingShadowing::IS_AT_MOST_HEIGHT_CORRELATED) the height-correlated one. For others this is the
/// [triaxial bound](Triaxial).
impl<F: Fresnel, G: MaskingShadowing> BoundStrategy<GgxLobe<F, G>> for Tight {
    type Shape = Ellipsoid;

    type PerLight = F;

    const QUADS: usize = 3;

    #[inline(always)]
    fn to_quads(&self, lobe: &GgxLobe<F, G>) -> (Quads<f32>, F) {
        let FresnelMajorant { base, rise } = lobe.fresnel().majorant();
        let [normal, incoming, [roughness, ..]] = lobe.quads();
        let quads = [normal, incoming, [roughness, base, rise, 0.0]];
        (padded(quads), *lobe.fresnel())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, fresnels: &[F]) -> Ellipsoids<N> {
        if !G::IS_AT_MOST_HEIGHT_CORRELATED {
            return BoundStrategy::<GgxLobe<F, G>>::unit_bounds(&Triaxial, quads, fresnels);
        }
        let [_, base, rise, _] = quads[2];
        let lobe = GgxLobes::from_quads([quads[0], quads[1], quads[2]]);
        let plane = lobe.plane_of_incidence();
        Section::of(&lobe, plane.sine, [base, rise], fresnels).ellipsoids(&lobe, &plane)
    }
}

impl<F: Fresnel, G: MaskingShadowing> Bounded for GgxLobe<F, G> {
    type Shape = Ellipsoid;
    type Strategy = Tight;

    fn unit_bound(&self) -> Ellipsoid {
        self.unit_bound_by(Tight)
    }
}

/// An ellipsoid in each lane, in units of r, r² = `reflected`·G1/(4πμ).
#[derive(Clone, Copy)]
struct Section<N> {
    reflected: N,
    /// Along (ω_u, −ω_v).
    center: [N; 2],
    axes: Axes<N>,
    across: N,
}

/// The semi-axes of an ellipse, and the cosine and sine of the angle of the first.
#[derive(Clone, Copy)]
struct Axes<N> {
    long: N,
    short: N,
    cosine: N,
    sine: N,
}

impl<N: Single> Section<N> {
    /// The smaller of the ellipsoid of the table and the paper's spheroid, for √(1 − μ²) = `sine`.
    #[inline(always)]
    fn of<F: Fresnel>(lobe: &GgxLobes<N>, sine: N, [base, rise]: [N; 2], fresnels: &[F]) -> Self {
        let (alpha, cosine) = (lobe.roughness, lobe.incident_cosine);
        let (zero, one) = (alpha.zero(), alpha.splat(1.0));
        let half_incidence = sine / (cosine + 1.0);
        let half_delta = alpha * 2.0 * sine * lobe.masking_over_four_cosines();
        let rises = rise.is_positive();
        let (base, reflectance) = if N::is_known_false(rises) {
            (base, one)
        } else {
            // A majorant with an F0 below the range of the table is raised to it.
            let least = (rise * table::LEAST_SHARE).round_up(LEAST_BASE_ROUNDINGS);
            let base = N::select(rises, base.max(least), base);
            (base, (base / (base + rise)).sqrt().sqrt())
        };
        let coordinates = [alpha.sqrt(), half_incidence + half_delta, reflectance];
        let [c_1, c_2, a_11, a_21, a_22, a_33] = interpolated(coordinates, rises);
        let grazing = (one - cosine).max(zero).fifth_power();
        let reflected = (base + rise * grazing).round_up(REFLECTED_ROUNDINGS);

        let most = lobe.max_fresnel_at(sine, fresnels);
        let over_spheroid = reflected / most;
        let over_alpha = one / alpha;
        let across = a_33 * lobe.incident_root;
        let volume = a_11 * a_22 * across;
        let along_of_spheroid = alpha * 0.5 * alpha + 0.5;
        let is_smaller = (volume * volume * (over_spheroid * over_spheroid * over_spheroid))
            .le(along_of_spheroid * along_of_spheroid);
        let spheroid = Self {
            reflected: most,
            center: [(one - alpha) * 0.5 * (alpha + 1.0) * over_alpha, zero],
            axes: Axes {
                long: along_of_spheroid * over_alpha,
                short: one,
                cosine: one,
                sine: zero,
            },
            across: one,
        };
        if N::is_known_false(is_smaller) {
            return spheroid;
        }
        let from_table = Self {
            reflected,
            center: [c_1 * over_alpha, c_2],
            axes: Axes::of_ellipse(a_11 * over_alpha, a_21, a_22),
            across,
        };
        Self::select(is_smaller, from_table, spheroid)
    }

    #[inline(always)]
    fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        let numbers = |section: Self| {
            let Axes {
                long,
                short,
                cosine,
                sine,
            } = section.axes;
            let [u, v] = section.center;
            [
                section.reflected,
                u,
                v,
                long,
                short,
                cosine,
                sine,
                section.across,
            ]
        };
        let [reflected, u, v, long, short, cosine, sine, across] =
            N::select_all(mask, numbers(yes), numbers(no));
        Self {
            reflected,
            center: [u, v],
            axes: Axes {
                long,
                short,
                cosine,
                sine,
            },
            across,
        }
    }

    /// The ellipsoids, for lights at the origin.
    #[inline(always)]
    fn ellipsoids(self, lobe: &GgxLobes<N>, plane: &PlaneOfIncidence<N>) -> Ellipsoids<N> {
        let radius = (self.reflected * lobe.masking_over_four_cosines() * FRAC_1_PI).sqrt();
        let Axes {
            long,
            short,
            cosine,
            sine,
        } = self.axes;
        let (u, across) = (plane.mirror, plane.across);
        // −ω_v, towards the surface, to which the lobe tilts.
        let down = u.cross(across);
        let semi_axes = Vector3::new(long, short, self.across);
        let (least, most) = (short.min(self.across), long.max(self.across));
        let tilt = most / least * (AXES_TILT_ROUNDINGS * UNIT_ROUNDOFF);
        let center = u * self.center[0] + down * self.center[1];
        Ellipsoids {
            light: None,
            offset: center * radius,
            axes: Matrix3::new(u * cosine + down * sine, down * cosine - u * sine, -across),
            semi_axes: semi_axes * (radius * (tilt + 1.0).round_up(SEMI_AXIS_ROUNDINGS)),
        }
    }
}

impl<N: Single> Axes<N> {
    /// The axes of the ellipse with the conjugate semi-diameters (`along`, `slant`) and (0, `aside`).
    ///
    /// The semi-axes are the singular values of the triangular matrix M with these columns. Let T be the
    /// trace of M Mᵀ, D the difference on its diagonal, m its element off the diagonal, and h = √(D² + 4m²)
    /// the difference of its eigenvalues. The longer semi-axis is √((T + h)/2). The shorter is the
    /// determinant of M over the longer, which does not cancel. The longer lies along (D + h, 2m) and
    /// (2m, h − D); the one that does not cancel is used. Half of it, (l, m) with 2l = |D| + h, has the
    /// length √(lh).
    #[inline(always)]
    fn of_ellipse(along: N, slant: N, aside: N) -> Self {
        let (first, mixed) = (along * along, along * slant);
        let second = slant * slant + aside * aside;
        let difference = first - second;
        // For a circle the axes are arbitrary.
        let apart = difference.abs().max(difference.splat(1e-15));
        let h = (apart * apart + mixed * 4.0 * mixed).sqrt();
        let long = ((first + second + h) * 0.5).sqrt();
        let short = along * aside / long;
        let larger = (apart + h) * 0.5;
        let over = (larger * h).sqrt().recip();
        let (larger, smaller) = (larger * over, mixed * over);
        let is_along = difference.zero().le(difference);
        let [cosine, sine] = N::select_all(is_along, [larger, smaller], [smaller, larger]);
        Self {
            long,
            short,
            cosine,
            sine,
        }
    }
}

/// Interpolates the table at √α, tan(θ_i/2) + tan(δ/2) and ∜F0. The last is ignored where F does not rise,
/// and F0 = 1.
#[inline(always)]
fn interpolated<N: Single>(
    [roughness, incidence, reflectance]: [N; 3],
    rises: N::Mask,
) -> [N; table::NUMBERS] {
    let (i, u) = knot_and_rest(Axis::ROUGHNESS, roughness);
    let (j, v) = knot_and_rest(Axis::INCIDENCE, incidence);
    let (k, w) = knot_and_rest(Axis::REFLECTANCE, reflectance);
    let k = N::select(rises, k, k.splat((REFLECTANCES - 1) as f32));
    let first = (i * INCIDENCES as f32 + j) * REFLECTANCES as f32 + k;
    let [[c_1, c_2, a_11, a_21], [a_22, a_33, ..]] = N::per_lane_quads(
        [first + WHOLE, u, v, w],
        rises,
        #[inline(always)]
        |[first, u, v, w], rises| between(first_knot(first), [u, v], rises.then_some(w)),
    );
    [c_1, c_2, a_11, a_21, a_22, a_33]
}

/// The knot at or below `x`, and the position of `x` between it and the next, in \[0, 1\] but for rounding.
#[inline(always)]
fn knot_and_rest<N: Single>(axis: Axis, x: N) -> (N, N) {
    let x = (x - axis.first) * axis.scale;
    let nearest = (x - 0.5).max(x.zero()).min(x.splat(axis.last));
    let knot = nearest + WHOLE - WHOLE;
    (knot, x - knot)
}

/// 1.5·2²³, around which only integers are representable. A sum with it is rounded to an integer, which its
/// lowest bits hold. This is faster than a conversion.
const WHOLE: f32 = 12_582_912.0;

/// The index of a knot from a sum with [`WHOLE`], clamped so that the next knots exist.
#[inline(always)]
fn first_knot(sum: f32) -> usize {
    const LAST: usize = KNOTS - 1 - TOWARDS_ROUGHNESS - TOWARDS_INCIDENCE;
    usize::from(sum.to_bits() as u16).min(LAST)
}

/// The step to the next knot of tan(θ_i/2) + tan(δ/2).
const TOWARDS_INCIDENCE: usize = REFLECTANCES;
/// The step to the next knot of √α.
const TOWARDS_ROUGHNESS: usize = INCIDENCES * REFLECTANCES;

/// The numbers of a knot: (c₁, c₂, A₁₁, A₂₁) and (A₂₂, A₃₃, 0, 0).
#[derive(Clone, Copy)]
struct Knot(Vec4, Vec4);

impl Knot {
    #[inline(always)]
    fn at(i: usize) -> Self {
        let [a, b, c, d, e, f, ..] = TABLE[i];
        Self(Vec4::new(a, b, c, d), Vec4::new(e, f, 0.0, 0.0))
    }

    /// Interpolates linearly: `self` at t = 0, `other` at t = 1.
    #[inline(always)]
    fn towards(self, other: Self, t: f32) -> Self {
        Self(
            self.0 + (other.0 - self.0) * t,
            self.1 + (other.1 - self.1) * t,
        )
    }
}

/// Interpolates between the `first` knot and the next ones, at the positions u along √α, v along
/// tan(θ_i/2) + tan(δ/2), and w along ∜F0. `None` is the last knot of ∜F0. Returns the numbers of a [`Knot`].
#[inline(always)]
fn between(first: usize, [u, v]: [f32; 2], w: Option<f32>) -> [Quad<f32>; 2] {
    let at = |i: usize| match w {
        Some(w) => Knot::at(i).towards(Knot::at(i + 1), w),
        None => Knot::at(i),
    };
    let [a, b] = [at(first), at(first + TOWARDS_INCIDENCE)];
    let next = first + TOWARDS_ROUGHNESS;
    let [c, d] = [at(next), at(next + TOWARDS_INCIDENCE)];
    let Knot(first, second) = a.towards(b, v).towards(c.towards(d, v), u);
    [first.into(), second.into()]
}
