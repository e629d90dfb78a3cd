//! The tight bound: nearly the smallest ellipsoid around the lobe, from a table.
//!
//! The paper's spheroid bounds F, G2 and the NDF each on its own, and all around the light. This
//! ellipsoid bounds their product above the surface, and leans with it in the plane of incidence.
//!
//! # The surface as the image of a sphere
//!
//! Let P = diag(α, α, 1) in the frame (tangent, bitangent, n) and m any unit vector. With the half
//! vector along Pm, the surface l = (r/α)‖Pm‖² that the NDF alone gives is, relative to the light,
//! x(m) = (r/α) (2(ω_i·Pm) Pm − ω_i ‖Pm‖²). Of the angle of incidence θ and L = kμ² + α², let
//!
//! cosδ = μ/√L, sinδ = α sinθ/√L, that is, tanδ = α tanθ.
//!
//! With m₁ away from ω_i, x(m) along (ω_u, −ω_v, ω_w) in units of (r/α, r, r√L) is
//!
//! ζ₁ = m₃² − α²m₁² − α² cos2θ m₂², ζ₂ = 2m₁m₃ + α sin2θ m₂², ζ₃ = 2m₂ (cosδ m₃ − sinδ m₁).
//!
//! The isosurface is this times s, s² = F G2/(F(μ) G1(μ)) for r² = F(μ) G1(μ)/(4πμ), above the surface.
//! With N = α²(1−m₃²) + m₃² and a = cosδ m₃ − sinδ m₁, the half angle's cosine is a√(L/N), and
//! μ_o/√L = 2am₃/N − cosδ; as √L is also the root in G1, μ and α over it are cosδ and sinδ/sinθ. Nothing
//! here depends on μ and α apart where α is small: δ is what tells how far the horizon cuts the lobe.
//!
//! # The table
//!
//! For F = A (F0 + (1 − F0)(1 − cosθ_h)⁵) the shape has three parameters: α, θ and F0. An ellipsoid in
//! ζ at 1323 of them, a centre and a triangular matrix, is interpolated between; √α,
//! tan(θ/2) + tan(δ/2) and ∜F0 are what it is nearly linear in. The second resolves grazing light both
//! where the surface is rough and where α → 0 and all happens at μ ~ α. Other Fresnel factors are put
//! under one of this form ([`Fresnel::majorant`]). Separable masking is below height-correlated.
//!
//! # Which ellipsoid
//!
//! A frame scales the ellipsoid by 1/√ξ, ξ uniform. A point at a distance d from the light is then inside
//! for a share ρ²/d² of all ξ, ρ being the radius of the ellipsoid from the light towards it, and of a
//! surface an area d² dω/cos lies there: what surfaces have inside, however they lie, goes with ∫ ρ² dω.
//! The knots make that the least, over the directions above the surface. The volume, ∫ ρ³ dω/3, says
//! less: the smallest ellipsoids reach farther behind the light, and in the ring of `examples/render`
//! they let up to 7 % more lights through. So does, for α = 0.05, each per cent of margin: across the
//! lobe the section through the light, which is near the ellipsoid's end, grows with its root.
//!
//! # Enclosure
//!
//! So each knot has as much margin as samples in the cells around it need, and more by roughness,
//! incidence and F0: up to 6 %, and where smooth metals reflect at an angle next to none, but for what
//! the fit itself keeps away from the samples (`examples/tabulate`).
//!
//! That the interpolated ellipsoids then enclose the surface, for every √α in \[0, 1\],
//! tan(θ/2) + tan(δ/2) in \[0, 2\] and ∜F0 in \[1/4, 1\], is proved: ‖y‖² ≤ 1 − 2·10⁻⁴ for each point
//! c + A y of the surface, a statement on five variables, which `tests/certificate` shows box by box. Over
//! a box ‖y‖² is a polynomial of the second degree and a bound of what is left, rounded outward in every
//! step; all 960 cells take 14 million boxes, little more than a minute of one core. The rest, 10⁻⁴ of a
//! radius, is for the rounding to `f32` of the three coordinates and of the interpolation.
//!
//! ```text
//! cargo run --release --example tabulate -- --prove
//! ```
//!
//! Where the paper's spheroid is smaller, near normal incidence, it is taken instead.

use core::f32::consts::FRAC_1_PI;

use glam::Vec4;

use super::ellipsoid::Ellipsoids;
use super::shape::{MAX_QUADS, Quads};
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

/// An ellipsoid around what the lobe sends above the surface, with its Fresnel factor, masking and shadowing,
/// that has nearly as little as can be of the surfaces around the light inside.
///
/// The [triaxial bound](Triaxial) instead if the lobe's masking function may be above the height-correlated
/// one, which the table is for.
///
/// For α ≤ 0.5 its volume is 1.08 times that of the smallest in the mean for metals, 1.18 times for
/// dielectrics; never above that of the paper's [`Spheroid`](crate::Spheroid) but for rounding.
impl<F: Fresnel, G: MaskingShadowing> BoundStrategy<GgxLobe<F, G>> for Tight {
    type Shape = Ellipsoid;

    type PerLight = F;

    const QUADS: usize = 3;

    #[inline(always)]
    fn to_quads(&self, lobe: &GgxLobe<F, G>) -> (Quads<f32>, F) {
        let FresnelMajorant { base, rise } = lobe.fresnel().majorant();
        let mut quads = [[0.0; 4]; MAX_QUADS];
        [quads[0], quads[1]] = lobe.quads();
        quads[2] = [lobe.ggx().roughness(), base, rise, 0.0];
        (quads, *lobe.fresnel())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, fresnels: &[F]) -> Ellipsoids<N> {
        if !G::IS_AT_MOST_HEIGHT_CORRELATED {
            return BoundStrategy::<GgxLobe<F, G>>::unit_bounds(&Triaxial, quads, fresnels);
        }
        let [roughness, base, rise, _] = quads[2];
        let lobe = GgxLobes::from_quads([quads[0], quads[1]], roughness);
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

/// Of an ellipse: the semi-axes, and the cosine and sine of the angle that the first of them is at.
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
            // Below the table's least F0 the majorant is raised to it.
            let least = (rise * table::LEAST_SHARE).round_up(LEAST_BASE_ROUNDINGS);
            let base = N::select(rises, base.max(least), base);
            (base, (base / (base + rise)).sqrt().sqrt())
        };
        let coordinates = [alpha.sqrt(), half_incidence + half_delta, reflectance];
        let [c_1, c_2, a_11, a_21, a_22, a_33] = interpolated(coordinates, rises);
        // The majorant's 1 − μ is off by μ's eight roundings, against at least LEAST_F0.
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

    /// The ellipsoids around lights at the origin.
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
        // Down to the surface, where the lobe leans to.
        let down = u.cross(across);
        let semi_axes = Vector3::new(long, short, self.across);
        let (least, most) = (short.min(self.across), long.max(self.across));
        let tilt = most / least * (AXES_TILT_ROUNDINGS * UNIT_ROUNDOFF);
        let center = u * self.center[0] + down * self.center[1];
        Ellipsoids {
            parts: [Vector3::zero(radius), center * radius],
            axes: Matrix3::new(u * cosine + down * sine, down * cosine - u * sine, -across),
            semi_axes: semi_axes * (radius * (tilt + 1.0).round_up(SEMI_AXIS_ROUNDINGS)),
        }
    }
}

impl<N: Single> Axes<N> {
    /// Of the ellipse with conjugate semi-diameters (`along`, `slant`) and (0, `aside`).
    ///
    /// The singular values of a triangular matrix: with T the trace of its square and h the difference of
    /// the eigenvalues of that, the longer is √((T + h)/2), and the shorter the determinant over it, which
    /// does not cancel. Its direction is along (D + h, 2m) or (2m, h − D), D and m being the difference on
    /// the diagonal and the element off it, of which again the one that does not cancel is taken. Half of
    /// that, (l, m) with 2l = |D| + h, has the length √(lh), since h² = D² + 4m².
    #[inline(always)]
    fn of_ellipse(along: N, slant: N, aside: N) -> Self {
        let (first, mixed) = (along * along, along * slant);
        let second = slant * slant + aside * aside;
        let difference = first - second;
        // Of a circle any axes will do.
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

/// The numbers of the table at √α, tan(θ_i/2) + tan(δ/2) and ∜F0, the last only where F `rises`: elsewhere
/// F0 = 1.
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

/// A knot that `x` is at or past, and how far `x` is from there to the next.
#[inline(always)]
fn knot_and_rest<N: Single>(axis: Axis, x: N) -> (N, N) {
    let x = (x - axis.first) * axis.scale;
    let nearest = (x - 0.5).max(x.zero()).min(x.splat(axis.last));
    let knot = nearest + WHOLE - WHOLE;
    (knot, x - knot)
}

/// 1.5·2²³, next to which only integers are representable: a sum with it is rounded to one, which its lowest
/// bits hold. That takes less than a conversion.
const WHOLE: f32 = 12_582_912.0;

/// The index of a knot from a sum with [`WHOLE`], clamped so that those between which the table is
/// interpolated exist.
#[inline(always)]
fn first_knot(sum: f32) -> usize {
    const LAST: usize = KNOTS - 1 - TOWARDS_ROUGHNESS - TOWARDS_INCIDENCE;
    usize::from(sum.to_bits() as u16).min(LAST)
}

const TOWARDS_INCIDENCE: usize = REFLECTANCES;
const TOWARDS_ROUGHNESS: usize = INCIDENCES * REFLECTANCES;

#[derive(Clone, Copy)]
struct Knot(Vec4, Vec4);

impl Knot {
    #[inline(always)]
    fn at(i: usize) -> Self {
        let [a, b, c, d, e, f, ..] = TABLE[i];
        Self(Vec4::new(a, b, c, d), Vec4::new(e, f, 0.0, 0.0))
    }

    #[inline(always)]
    fn towards(self, other: Self, t: f32) -> Self {
        Self(
            self.0 + (other.0 - self.0) * t,
            self.1 + (other.1 - self.1) * t,
        )
    }
}

/// The numbers between the `first` knot and the next ones, by these shares of the way along √α,
/// tan(θ_i/2) + tan(δ/2), and ∜F0 if that is not at its last knot: (c₁, c₂, A₁₁, A₂₁) and (A₂₂, A₃₃, 0, 0).
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
