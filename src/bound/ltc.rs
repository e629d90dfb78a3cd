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
//! Let û be a vector of about unit length in the plane of r₃ and e₁ below, û⊥ its perpendicular in this plane,
//! and g = û·y/m. If α₁, α₂, ν > 0 and q are such that for all directions y/m with w ≥ 0
//!
//! (w − α₁w² − α₂g)₊² ≤ q(ω_2² + (û⊥·ω)² + νg²),  ω = y/m, ω_2 = ω·e₂ (A)
//!
//! then for any α₃ > 0
//!
//! **‖X‖² − α₃(y_2² + (û⊥·y)² + ν(û·y)²) − α₁p − α₂û·y ≤ q/(4α₃)**.
//!
//! For the left side is βm − κm² with β = w − α₁w² − α₂g and κ = α₃(ω_2² + …), at most β₊²/(4κ) for every m. It
//! is a quadratic inequality in y, and so an ellipsoid where its quadratic form is positive definite. As M need
//! not be orthogonal, the form has the term ‖M⁻¹y‖². The term of û penalises directions away from the axis of
//! the lobe, which M tilts away from r₃.
//!
//! (A) knows nothing of M but the angle between r₃ and û. So a row of numbers (α₁, α₂, û, ν, q) for which it
//! holds gives an ellipsoid for *every* M, and what chooses the row and α₃ needs no proof. The rows are tabulated
//! (`ltc_rows`) by m₁₁ and m₁₁b below, for the lobes that resemble GGX, and each is proved: for a fixed angle δ
//! between û and ω the right side is fixed, and the left side has a single maximum over w, so that (A) is a
//! matter of one variable and of intervals of it (`tests/ltc_bound.rs`).
//!
//! # The ellipsoid
//!
//! Let e₃ = r₃, e₂ along r₂ and e₁ = e₂ × e₃. Then r₁ = (e₁ + m₁₁b e₃)/m₁₁ and r₂ = e₂/m₂₂ for positive m₁₁ and
//! m₂₂. In terms of X, y = (m₁₁X₁ + kX₃, m₂₂X₂, X₃), k = −m₁₁b. With û = (s, 0, c) the inequality is
//! XᵀQX − ℓ·X ≤ q/(4α₃), where
//!
//! v = (cm₁₁, ck − s), t = (sm₁₁, sk + c), ℓ = (α₂t₁, α₁ + α₂t₃),
//!
//! Q is 1 − α₃(v vᵀ + νt tᵀ) in the plane of X₁ and X₃ and Q₂₂ = 1 − α₃m₂₂². Let T = ‖v‖² + ν‖t‖². α₃ is at most
//! 0.9 of 1/T and of 1/m₂₂², so Q is positive definite with eigenvalues of at least 0.1. The centre is ½Q⁻¹ℓ, and
//! the semi-axes are those of √V Q^{−½}, V = q/(4α₃) + ¼ℓᵀQ⁻¹ℓ. The light is inside.
//!
//! The lobe below the horizon is enclosed too, and so is what counts as the value rounds (docs/rounding.md).

use super::ellipsoid::Ellipsoids;
use super::principal_axes::ellipsoids_along;
use super::shape::{Quads, padded};
use super::{BoundStrategy, Bounded, Ellipsoid, Tight, ltc_rows};
use crate::lobe::LtcLobe;
use crate::num::{Double, Single, Vector3};

/// Pays for rounding axes and centre to `f32`, and for what the image of a direction is off by in the value, in units
/// of u times the farthest point's distance.
const POINT_ROUNDINGS: f64 = 10.0;
/// Pays for the rounding of K, for its product with a semi-axis, and for all else that is rounded in the value.
const SEMI_AXIS_ROUNDINGS: u16 = 64;

/// Bounds the lobe by an ellipsoid, with its part below the horizon. The volume is on average 1.03 times that of the
/// smallest around the isosurface, at most 1.1 times that at the knots of the lobes' table, up to 88°, and 1.15 times
/// beyond.
impl BoundStrategy<LtcLobe> for Tight {
    type Shape = Ellipsoid;

    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self, lobe: &LtcLobe) -> (Quads<f32>, ()) {
        let lobe = lobe.lanes();
        let (x, z) = (lobe.across, lobe.third);
        let quads = [[x.x, x.y, x.z, lobe.amplitude], [z.x, z.y, z.z, lobe.shear]];
        (padded(quads), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Ellipsoids<N> {
        let [[x_x, x_y, x_z, amplitude], [z_x, z_y, z_z, shear], ..] = *quads;
        let rows = [
            Vector3::new(x_x, x_y, x_z).widen(),
            Vector3::new(z_x, z_y, z_z).widen(),
        ];
        Transformed::of(rows, shear.widen()).ellipsoids(amplitude)
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
    /// Over the length of the third row before it is scaled.
    over: D,
}

impl<D: Double> Transformed<D> {
    /// From what of the first row of M⁻¹ is across the third, the third, and its factor in the first. The second is the
    /// cross product of the third and the first.
    #[inline(always)]
    fn of([aside, third]: [Vector3<D>; 2], shear: D) -> Self {
        let second = third.cross(aside);
        let (length, second_length) = (third.length(), second.length());
        let one = length.splat(1.0);
        let (over, over_second) = (one / length, one / second_length);
        let (e_3, e_2) = (third * over, second * over_second);
        let across = length * over_second;
        Self {
            frame: [e_2.cross(e_3), e_2, e_3],
            // The first row has the component ‖r₂‖/‖r₃‖ across the third.
            along: length * across,
            across,
            slant: aside.dot(e_3) * over + shear,
            over,
        }
    }

    /// The ellipsoid for a lobe with this factor of z/‖M⁻¹ω‖⁴.
    #[inline(always)]
    fn ellipsoids<N: Single<Double = D>>(&self, amplitude: N) -> Ellipsoids<N> {
        let (a, m_2) = (self.along, self.across);
        let k = -(a * self.slant);
        let row = Row::of::<N>(a, k);
        // Those of the module documentation.
        let v = [row.cosine * a, row.cosine * k - row.sine];
        let t = [row.sine * a, row.sine * k + row.cosine];
        let (p_11, p_13, p_33) = (
            v[0] * v[0] + row.nu * t[0] * t[0],
            v[0] * v[1] + row.nu * t[0] * t[1],
            v[1] * v[1] + row.nu * t[1] * t[1],
        );
        let second = m_2 * m_2;
        let alpha_3 = row.share / (p_11 + p_33).max(second);
        let (q_11, q_33) = (-(alpha_3 * p_11) + 1.0, -(alpha_3 * p_33) + 1.0);
        let (q_13, q_22) = (-(alpha_3 * p_13), -(alpha_3 * second) + 1.0);
        let determinant = q_11 * q_33 - q_13 * q_13;
        let (l_1, l_3) = (row.alpha_2 * t[0], row.alpha_2 * t[1] + row.alpha_1);
        let half = a.splat(0.5) / determinant;
        let (x_1, x_3) = (
            (q_33 * l_1 - q_13 * l_3) * half,
            (q_11 * l_3 - q_13 * l_1) * half,
        );
        let level = (row.q / (alpha_3 * 4.0) + (l_1 * x_1 + l_3 * x_3) * 0.5).sqrt();
        // The rows of [[m₁₁, k], [0, 1]]·√V A with a lower triangular A, A Aᵀ = Q⁻¹.
        let root = q_33.sqrt();
        let slope = level / (root * determinant.sqrt());
        let (first, second) = (q_33 * slope, -(q_13 * slope));
        let third = level / root;
        let plane = PlaneAxes::of(
            [[a * first + k * second, k * third], [second, third]],
            a * first * third,
        );
        let zero = a.zero();
        let center = Vector3::new(a * x_1 + k * x_3, zero, x_3);
        let scale = N::narrow((amplitude.widen() * (self.over * self.over * self.over)).sqrt());
        let [[x, z], [u, v]] = plane.axes;
        ellipsoids_along(
            &self.frame,
            center,
            (
                [
                    Vector3::new(x, zero, z),
                    Vector3::new(zero, a.splat(1.0), zero),
                    Vector3::new(u, zero, v),
                ],
                [
                    plane.semi_axes[0],
                    m_2 * level / q_22.sqrt(),
                    plane.semi_axes[1],
                ],
            ),
            scale,
            (POINT_ROUNDINGS, SEMI_AXIS_ROUNDINGS),
        )
    }
}

/// A row of the table in each lane. û is on the side of the lobe's axis.
struct Row<D> {
    alpha_1: D,
    alpha_2: D,
    sine: D,
    cosine: D,
    nu: D,
    q: D,
    share: D,
}

impl<D: Double> Row<D> {
    /// The row for m₁₁ = `along` and k = `slant`.
    #[inline(always)]
    fn of<N: Single<Double = D>>(along: D, slant: D) -> Self {
        let zero = N::narrow(along.zero());
        let numbers = [N::narrow(along), N::narrow(slant.abs()), zero, zero];
        let [[alpha_1, alpha_2, sine, cosine], [nu, q, share, _]] = N::per_lane_quads(
            numbers,
            zero.le(zero),
            #[inline(always)]
            |[along, slant, ..], _| {
                let [a, b, c, d, e, f, g, h] = *ltc_rows::row(along, slant);
                [[a, b, c, d], [e, f, g, h]]
            },
        );
        Self {
            alpha_1: alpha_1.widen(),
            alpha_2: alpha_2.widen(),
            sine: sine.widen().copysign(slant),
            cosine: cosine.widen(),
            nu: nu.widen(),
            q: q.widen(),
            share: share.widen(),
        }
    }
}

/// The axes of the image of a disc, and its semi-axes.
struct PlaneAxes<D> {
    axes: [[D; 2]; 2],
    semi_axes: [D; 2],
}

impl<D: Double> PlaneAxes<D> {
    /// From the rows of the matrix that the disc is the image under, and its positive determinant.
    ///
    /// The longer semi-axis is the root of the larger eigenvalue of the matrix times its transpose, which is a
    /// sum of positive terms. The shorter is the quotient of the determinant by it.
    #[inline(always)]
    fn of([[a, b], [c, d]]: [[D; 2]; 2], determinant: D) -> Self {
        let (first, second, in_common) = (a * a + b * b, c * c + d * d, a * c + b * d);
        let half = (first - second) * 0.5;
        let root = (half * half + in_common * in_common).sqrt();
        let longer = ((first + second) * 0.5 + root).sqrt();
        let shorter = determinant / longer;
        // Of the angle, at most 45°, by which the axes are turned.
        let least = half.splat(f64::MIN_POSITIVE);
        let tangent = in_common / (half.abs() + root).max(least);
        let cosine = half.splat(1.0) / (tangent * tangent + 1.0).sqrt();
        let is_first = half.zero().le(half);
        let sine = cosine * tangent;
        let sine = D::select(is_first, sine, -sine);
        let semi_axes = D::select_all(is_first, [longer, shorter], [shorter, longer]);
        Self {
            axes: [[cosine, sine], [-sine, cosine]],
            semi_axes,
        }
    }
}
