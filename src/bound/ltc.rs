//! The bound of a linearly transformed cosine: an ellipsoid in closed form.
//!
//! # The surface
//!
//! Let M⁻¹ be scaled so that its third row r₃ is a unit vector; the lobe is then K² max(z, 0)/‖M⁻¹ω‖⁴ with
//! z = r₃·ω and a factor K². Let x = K y be a point of the isosurface, ‖x‖² = v(ω), and X = M⁻¹y. Then
//!
//! ‖X‖⁴ = p m, m = ‖y‖, p = X₃ = r₃·y ≤ m.
//!
//! With w = √(p/m) in \[0, 1\] this is ‖X‖² = wm and p = w²m.
//!
//! # The inequality
//!
//! For any α₃ > 0, α₁, ν > 0 and q with w²(1 − α₁w)² ≤ q(1 − (1−ν)w⁴) on \[0, 1\],
//!
//! **‖X‖² − α₃m² + α₃(1−ν)p² − α₁p ≤ q/(4α₃)**.
//!
//! For the left side is bm − am² with b = w(1 − α₁w) and a = α₃(1 − (1−ν)w⁴) > 0, at most b²/(4a) for
//! every m. It is a quadratic inequality in y, and so an ellipsoid where its
//! quadratic form is positive definite. As M need not be orthogonal, the form has the term ‖M⁻¹y‖².
//!
//! # The choice of α₁, ν and q
//!
//! With ν = (1 − α₁)²/q both sides of the condition are equal at w = 1. Their difference over 1 − w is then
//! q(1 + w)(1 + w²) − w² + γw³ with γ = 2α₁ − 1, which is not negative if
//!
//! q ≥ h(w) = w²(1 − γw)/((1 + w)(1 + w²)) for all w in \[0, 1\].
//!
//! The sign of h′(w) is that of g(w) − γ, g(w) = (2 + w − w³)/(w(3 + 2w + w²)). g decreases: the numerator of
//! its derivative is −6 − 8w − 8w² − 8w³ − 2w⁴. So for γ = g(w₁) the largest value is q = h(w₁), and it is
//! positive, since g(w)w < 1. ν is positive unless γ = 1, which is so for w₁ = 0.5437 alone, the root of
//! w³ + w² + w = 1. So *each* other w₁ in (0, 1) gives an ellipsoid, and what chooses w₁ and α₃ needs no
//! proof. Three pairs are tried, and the one with the smallest volume is taken: a polynomial for lobes along
//! r₃, and two constants for lobes that M tilts far from r₃.
//!
//! # The ellipsoid
//!
//! Let e₃ = r₃, e₂ along r₂ and e₁ = e₂ × e₃. Then r₁ = (e₁ + m₁₁b e₃)/m₁₁ and r₂ = e₂/m₂₂ for positive m₁₁ and
//! m₂₂. With y = m₁₁Y₁e₁ + m₂₂Y₂e₂ + Y₃e₃ the inequality is YᵀQY − α₁Y₃ ≤ q/(4α₃), where Q has the elements
//!
//! Q₁₁ = 1 − α₃m₁₁², Q₁₃ = b, Q₃₃ = 1 + b² − α₃ν, Q₂₂ = 1 − α₃m₂₂²,
//!
//! and others zero. Q₁₁Q₃₃ − b² = 1 − α₃T + α₃²m₁₁²ν, T = ν + m₁₁²(1 + b²). α₃ is at most 0.9 of 1/T and of
//! 1/m₂₂², so Q is positive definite, and no difference below cancels by more than a factor of ten. The centre
//! is ½α₁Q⁻¹e₃, and the semi-axes are those of √V Q^{−½}, V = q/(4α₃) + ¼α₁²(Q⁻¹)₃₃. The light is inside.
//!
//! The lobe below the horizon is enclosed too.

use super::ellipsoid::Ellipsoids;
use super::principal_axes::{ellipsoids_along, principal_axes};
use super::shape::{Quads, padded};
use super::{BoundStrategy, Bounded, Ellipsoid, Tight};
use crate::lobe::{Lobe, LtcLobe};
use crate::num::{Double, Single, Vector3};

/// Pays for the rounding of K and of its product with a semi-axis.
const SEMI_AXIS_ROUNDINGS: u16 = 8;
/// The largest share of 1/T and 1/m₂₂² that α₃ takes.
const LARGEST_SHARE: f64 = 0.9;
/// w₁ and α₃ times the squared spread, for lobes that M tilts.
const TILTED: [(f64, f64); 2] = [(0.52, 0.44), (0.4, 0.44)];
/// Pays for the rounding of q in `f64`.
const Q_GROWTH: f64 = 1.0 + 1e-14;

/// Bounds the lobe by an ellipsoid, with its part below the horizon. The volume is on average 1.05 times that
/// of the smallest around the isosurface. For smooth surfaces at 80° and more it is up to 1.8 times that.
impl BoundStrategy<LtcLobe> for Tight {
    type Shape = Ellipsoid;

    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self, lobe: &LtcLobe) -> (Quads<f32>, ()) {
        let [_, _, _, amplitude, x_x, x_y, x_z, z_x, z_y, z_z, ..] = lobe.numbers();
        (
            padded([[x_x, x_y, x_z, amplitude], [z_x, z_y, z_z, 0.0]]),
            (),
        )
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Ellipsoids<N> {
        let [[x_x, x_y, x_z, amplitude], [z_x, z_y, z_z, _], ..] = *quads;
        let rows = [
            Vector3::new(x_x, x_y, x_z).widen(),
            Vector3::new(z_x, z_y, z_z).widen(),
        ];
        Transformed::of(rows).ellipsoids(amplitude)
    }
}

impl Bounded for LtcLobe {
    type Shape = Ellipsoid;
    type Strategy = Tight;

    fn unit_bound(&self) -> Ellipsoid {
        self.unit_bound_by(Tight)
    }
}

/// M in each lane, in the frame of the module documentation.
struct Transformed<D> {
    /// e₁, e₂, e₃
    frame: [Vector3<D>; 3],
    /// m₁₁
    along: D,
    /// m₂₂
    across: D,
    /// b
    slant: D,
    /// The length of the third row before it is scaled.
    length: D,
}

impl<D: Double> Transformed<D> {
    /// From the first and the third row of M⁻¹. The second is the cross product of the third and the first.
    #[inline(always)]
    fn of([first, third]: [Vector3<D>; 2]) -> Self {
        let second = third.cross(first);
        let (length, second_length) = (third.length(), second.length());
        let (e_3, e_2) = (third / length, second / second_length);
        Self {
            frame: [e_2.cross(e_3), e_2, e_3],
            // The first row has the component ‖r₂‖/‖r₃‖ across the third.
            along: length * length / second_length,
            across: length / second_length,
            slant: first.dot(e_3) / length,
            length,
        }
    }

    /// The ellipsoid for a lobe with this factor of z/‖M⁻¹ω‖⁴.
    #[inline(always)]
    fn ellipsoids<N: Single<Double = D>>(&self, amplitude: N) -> Ellipsoids<N> {
        let (b, m_1, m_2) = (self.slant, self.along, self.across);
        let zero = b.zero();
        let (first, second) = (m_1 * m_1, m_2 * m_2);
        let tilted = first * b * b;
        let oblique = first + tilted;
        let spread = ((first + second) * 0.5 + tilted * 2.0).sqrt();
        let skewed = Skewed {
            first,
            second,
            oblique,
        };
        let mut best = skewed.quadric(Choice::along_axis(spread));
        for (w, share) in TILTED {
            let w = spread.splat(w);
            let next = skewed.quadric(Choice::of(w, w.splat(share) / (spread * spread)));
            best = Quadric::smaller(best, next);
        }
        let Quadric {
            alpha_1,
            determinant,
            q_11,
            q_22,
            level,
        } = best;
        let level = level.sqrt();
        let q_33 = (determinant + b * b) / q_11;
        let half = alpha_1 * 0.5;
        let center = Vector3::new(
            -m_1 * b * half / determinant,
            zero,
            q_11 / determinant * half,
        );
        // The rows of diag(m₁₁, m₂₂, 1) √V A with A Aᵀ = Q⁻¹.
        let rows = [
            [m_1 * (q_33 / determinant).sqrt() * level, zero, zero],
            [zero, m_2 * level / q_22.sqrt(), zero],
            [
                -b * level / (q_33 * determinant).sqrt(),
                zero,
                level / q_33.sqrt(),
            ],
        ];
        let scale =
            N::narrow((amplitude.widen() / (self.length * self.length * self.length)).sqrt());
        ellipsoids_along(
            &self.frame,
            center,
            principal_axes(rows),
            scale,
            SEMI_AXIS_ROUNDINGS,
        )
    }
}

/// The squared sizes of M that Q depends on.
struct Skewed<D> {
    /// m₁₁²
    first: D,
    /// m₂₂²
    second: D,
    /// m₁₁²(1 + b²)
    oblique: D,
}

impl<D: Double> Skewed<D> {
    #[inline(always)]
    fn quadric(&self, choice: Choice<D>) -> Quadric<D> {
        let Choice {
            alpha_1,
            alpha_3,
            nu,
            q,
        } = choice;
        let (first, second) = (self.first, self.second);
        let trace = nu + self.oblique;
        let largest = trace.splat(LARGEST_SHARE) / trace.max(second);
        let alpha_3 = alpha_3.min(largest);
        let determinant = alpha_3 * first * (alpha_3 * nu) - alpha_3 * trace + 1.0;
        let q_11 = -(alpha_3 * first) + 1.0;
        let half = alpha_1 * 0.5;
        Quadric {
            alpha_1,
            determinant,
            q_11,
            q_22: -(alpha_3 * second) + 1.0,
            level: q / (alpha_3 * 4.0) + half * half * (q_11 / determinant),
        }
    }
}

/// Q and V of the module documentation.
#[derive(Clone, Copy)]
struct Quadric<D> {
    alpha_1: D,
    /// Q₁₁Q₃₃ − b²
    determinant: D,
    q_11: D,
    q_22: D,
    /// V
    level: D,
}

impl<D: Double> Quadric<D> {
    /// V³/(Q₂₂(Q₁₁Q₃₃ − b²)), which grows with the volume.
    #[inline(always)]
    fn size(&self) -> D {
        self.level * self.level * self.level / (self.determinant * self.q_22)
    }

    #[inline(always)]
    fn smaller(one: Self, other: Self) -> Self {
        let [alpha_1, determinant, q_11, q_22, level] = D::select_all(
            one.size().le(other.size()),
            [one.alpha_1, one.determinant, one.q_11, one.q_22, one.level],
            [
                other.alpha_1,
                other.determinant,
                other.q_11,
                other.q_22,
                other.level,
            ],
        );
        Self {
            alpha_1,
            determinant,
            q_11,
            q_22,
            level,
        }
    }
}

/// α₁, α₃, ν and q of the module documentation.
#[derive(Clone, Copy)]
struct Choice<D> {
    alpha_1: D,
    alpha_3: D,
    nu: D,
    q: D,
}

impl<D: Double> Choice<D> {
    /// The choice for a lobe of this `spread`, the root of (m₁₁² + m₂₂²)/2 + 2m₁₁²b².
    #[inline(always)]
    fn along_axis(spread: D) -> Self {
        /// Spreads above it are as good as this one.
        const BROAD: f64 = 1.6;
        let t = spread.min(spread.splat(BROAD));
        let w = t * (t * (t * -0.005 - 0.1649) + 0.3246) + 0.5437;
        let narrowed = t / spread;
        let cubic = t * (t * (t * -0.0318 - 0.0331) + 0.1804) + 0.1564;
        Self::of(w, cubic / t * narrowed * narrowed)
    }

    /// The choice of w₁ = `w` and α₃.
    #[inline(always)]
    fn of(w: D, alpha_3: D) -> Self {
        /// The root of w³ + w² + w = 1, where γ is 1.
        const ROOT: f64 = 0.543_689_012_692_076_4;
        let over = w * (w * (w + 2.0) + 3.0);
        // 1 − γ, with w₁³ + w₁² + w₁ − 1 as a product. 1 − α₁ is half of it.
        let gap = (w - ROOT) * 2.0 * (w * (w + (1.0 + ROOT)) + 1.0 / ROOT) / over;
        let half_gap = gap * 0.5;
        let gamma = -gap + 1.0;
        let q = w * w * (-(gamma * w) + 1.0) / ((w + 1.0) * (w * w + 1.0));
        let q = q * Q_GROWTH;
        Self {
            alpha_1: -half_gap + 1.0,
            alpha_3,
            nu: half_gap * half_gap / q,
            q,
        }
    }
}
