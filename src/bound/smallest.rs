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

use glam::{Mat3, Vec3, Vec3A, Vec3Swizzles};

use super::{Bound, Ellipsoid, table};
use crate::{Fresnel, FresnelMajorant, GgxLobe, MaskingShadowing, Roulette, Vpl, Xi, math};

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// The tight bound for Φ/(δξ) = 1 and a light at the origin: an ellipsoid around what the lobe
    /// sends above the surface, with its Fresnel factor, masking and shadowing, that has nearly as
    /// little as can be of the surfaces around the light inside.
    ///
    /// For α ≤ 0.5 its volume is 1.08 times that of the smallest in the mean for metals, 1.18 times for
    /// dielectrics; never above that of the paper's [`Spheroid`](crate::Spheroid) but for rounding.
    pub fn tight_bound(&self) -> Ellipsoid {
        if self.incident_cosine() <= 0.0 {
            return Ellipsoid::EMPTY;
        }
        let ([u, w], sine) = self.mirror_and_across();
        let shape = Shape::of(self, sine);
        let radius = math::sqrt(
            shape.reflected * self.masking_over_four_cosines() * core::f32::consts::FRAC_1_PI,
        );
        let Axes {
            long,
            short,
            cosine,
            sine,
        } = shape.axes;
        // Down to the surface, where the lobe leans to.
        let [u, across] = [Vec3A::from(u), Vec3A::from(w)];
        // Spelled out, since glam's product is fused where the target has that.
        let down = (u.zxy() * across - u * across.zxy()).zxy();
        let rotation = Mat3::from_cols(
            Vec3::from(u * cosine + down * sine),
            Vec3::from(down * cosine - u * sine),
            -w,
        );
        let semi_axes = Vec3::new(long, short, shape.across);
        let (least, most) = (
            math::lesser(short, shape.across),
            math::greater(long, shape.across),
        );
        let tilt = 12.0 * math::UNIT_ROUNDOFF * (most / least);
        let semi_axes = semi_axes * (radius * math::round_up(1.0 + tilt, 96));
        let center = Vec3::from((u * shape.center[0] + down * shape.center[1]) * radius);
        Ellipsoid::from_parts(Vec3::ZERO, center, rotation, semi_axes)
    }
}

impl<F: Fresnel, G: MaskingShadowing> Vpl<GgxLobe<F, G>> {
    /// The [tight bound](GgxLobe::tight_bound) of everything that accepts this light in a frame with
    /// `roulette` and `xi`.
    pub fn tight_bound(&self, roulette: &Roulette, xi: Xi) -> Ellipsoid {
        let scale = roulette.scale(self.flux(), xi);
        self.lobe().tight_bound().placed(self.position(), scale)
    }
}

/// An ellipsoid in units of r, r² = `reflected`·G1/(4πμ).
#[derive(Clone, Copy)]
struct Shape {
    reflected: f32,
    /// Along (ω_u, −ω_v).
    center: [f32; 2],
    axes: Axes,
    across: f32,
}

/// Of an ellipse: the semi-axes, and the cosine and sine of the angle that the first of them is at.
#[derive(Clone, Copy)]
struct Axes {
    long: f32,
    short: f32,
    cosine: f32,
    sine: f32,
}

impl Shape {
    /// The smaller of the ellipsoid of the table and the paper's spheroid.
    #[inline]
    fn of<F: Fresnel, G: MaskingShadowing>(lobe: &GgxLobe<F, G>, sine: f32) -> Self {
        let (alpha, cosine) = (lobe.ggx().roughness(), lobe.incident_cosine());
        let root = lobe.incident_root();
        let half_incidence = sine / (1.0 + cosine);
        let half_delta = 2.0 * alpha * sine * lobe.masking_over_four_cosines();
        let FresnelMajorant { base, rise } = lobe.fresnel().majorant();
        let (base, reflectance) = if rise > 0.0 {
            // Below the table's least F0 the majorant is raised to it.
            let base = math::greater(base, math::round_up(rise * table::LEAST_SHARE, 2));
            let share = base / (base + rise);
            (base, Some(math::sqrt(math::sqrt(share))))
        } else {
            (base, None)
        };
        let [first, second] =
            table::ellipsoid(math::sqrt(alpha), half_incidence + half_delta, reflectance);
        // The majorant's 1 − μ is off by μ's eight roundings, against at least LEAST_F0.
        let reflected = math::round_up(
            base + rise * math::fifth_power((1.0 - cosine).max(0.0)),
            192,
        );

        let most = lobe.max_fresnel_at(sine);
        let over_spheroid = reflected / most;
        let over_alpha = 1.0 / alpha;
        let across = second.y * root;
        let volume = first.z * second.x * across;
        let along_of_spheroid = 0.5 + 0.5 * alpha * alpha;
        let is_smaller = volume * volume * (over_spheroid * over_spheroid * over_spheroid)
            <= along_of_spheroid * along_of_spheroid;
        if is_smaller {
            Self {
                reflected,
                center: [first.x * over_alpha, first.y],
                axes: Axes::of_ellipse(first.z * over_alpha, first.w, second.x),
                across,
            }
        } else {
            Self {
                reflected: most,
                center: [0.5 * (1.0 - alpha) * (1.0 + alpha) * over_alpha, 0.0],
                axes: Axes {
                    long: along_of_spheroid * over_alpha,
                    short: 1.0,
                    cosine: 1.0,
                    sine: 0.0,
                },
                across: 1.0,
            }
        }
    }
}

impl Axes {
    /// Of the ellipse with conjugate semi-diameters (`along`, `slant`) and (0, `aside`).
    ///
    /// The singular values of a triangular matrix: with T the trace of its square and h the difference of
    /// the eigenvalues of that, the longer is √((T + h)/2), and the shorter the determinant over it, which
    /// does not cancel. Its direction is along (D + h, 2m) or (2m, h − D), D and m being the difference on
    /// the diagonal and the element off it, of which again the one that does not cancel is taken. Half of
    /// that, (l, m) with 2l = |D| + h, has the length √(lh), since h² = D² + 4m².
    #[inline]
    fn of_ellipse(along: f32, slant: f32, aside: f32) -> Self {
        let (first, mixed) = (along * along, along * slant);
        let second = slant * slant + aside * aside;
        let difference = first - second;
        // Of a circle any axes will do.
        let apart = difference.abs().max(1e-15);
        let h = math::sqrt(apart * apart + 4.0 * mixed * mixed);
        let long = math::sqrt(0.5 * (first + second + h));
        let short = along * aside / long;
        let larger = 0.5 * (apart + h);
        let over = 1.0 / math::sqrt(larger * h);
        let (larger, smaller) = (larger * over, mixed * over);
        let is_along = difference >= 0.0;
        Self {
            long,
            short,
            cosine: if is_along { larger } else { smaller },
            sine: if is_along { smaller } else { larger },
        }
    }
}
