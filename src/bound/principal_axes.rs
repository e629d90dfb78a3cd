//! The principal axes of an ellipsoid that is the image of a ball.

use super::Ellipsoids;
use crate::num::{Double, Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for rounding axes and centre to `f32`, in units of u times the longest semi-axis and the centre's
/// length.
pub(super) const POINT_ROUNDINGS: f64 = 4.0;

/// The orthonormal axes and the semi-axes of an ellipsoid that contains {Az : ‖z‖ ≤ 1} tightly, where `rows`
/// are the rows of A, none of them zero.
///
/// The method is one-sided Jacobi: rotations of pairs of rows make the rows orthogonal, and their lengths are
/// then the semi-axes [Hestenes 1958]. Each semi-axis is as accurate as its row, however much shorter than
/// the others, unlike an eigenvalue of A Aᵀ. The number of rotations is fixed. What they leave enlarges the
/// semi-axes: if unit rows have the cosines cᵢⱼ between them, no eigenvalue of A Aᵀ exceeds 1 + Σ|cᵢⱼ|.
#[inline(always)]
pub(super) fn principal_axes<D: Double, const K: usize>(
    mut rows: [[D; K]; 3],
) -> ([Vector3<D>; 3], [D; 3]) {
    const SWEEPS: usize = 4;
    const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];
    let (zero, one) = (rows[0][0].zero(), rows[0][0].splat(1.0));
    let mut axes = [[one, zero, zero], [zero, one, zero], [zero, zero, one]];
    for (i, j) in [PAIRS; SWEEPS].into_iter().flatten() {
        let in_common = dot(&rows[i], &rows[j]);
        let squares = [dot(&rows[i], &rows[i]), dot(&rows[j], &rows[j])];
        let counts = !(in_common * in_common).le(squares[0] * 1e-20 * squares[1]);
        if D::is_known_false(counts) {
            continue;
        }
        let cotangent = (squares[1] - squares[0]) / (in_common * 2.0);
        // The smaller of the two angles, at most 45°.
        let root = (cotangent * cotangent + 1.0).sqrt();
        let tangent = one.copysign(cotangent) / (cotangent.abs() + root);
        let cosine = one / (tangent * tangent + 1.0).sqrt();
        let sine = cosine * tangent;
        let turned_rows = turned(cosine, sine, rows[i], rows[j]);
        let turned_axes = turned(cosine, sine, axes[i], axes[j]);
        rows[i] = D::select_all(counts, turned_rows.0, rows[i]);
        rows[j] = D::select_all(counts, turned_rows.1, rows[j]);
        axes[i] = D::select_all(counts, turned_axes.0, axes[i]);
        axes[j] = D::select_all(counts, turned_axes.1, axes[j]);
    }
    let mut lengths = [zero; 3];
    for (length, row) in lengths.iter_mut().zip(&rows) {
        *length = dot(row, row).sqrt();
    }
    let mut in_common = zero;
    for (i, j) in PAIRS {
        in_common = in_common + dot(&rows[i], &rows[j]).abs() / (lengths[i] * lengths[j]);
    }
    let growth = (in_common + 1.0).sqrt();
    let [a, b, c] = axes;
    (
        [vector(a), vector(b), vector(c)],
        [
            lengths[0] * growth,
            lengths[1] * growth,
            lengths[2] * growth,
        ],
    )
}

/// The ellipsoids with these principal axes around `center`, whose coordinates are those of `frame`, times
/// `scale`. They are rounded outward; `roundings` pay for the rounding of `scale` and of its products.
///
/// A ball is added, whose radius d is the distance by which rounding moves a point: `point_roundings` times u times the
/// longest semi-axis and the length of the centre, at least [`POINT_ROUNDINGS`] of them. For any t > 0,
/// the sum of an ellipsoid with the semi-axes aᵢ and this ball lies in the ellipsoid with the squared
/// semi-axes (1+t)aᵢ² + (1+1/t)d².
#[inline(always)]
pub(super) fn ellipsoids_along<N: Single>(
    frame: &[Vector3<N::Double>; 3],
    center: Vector3<N::Double>,
    (axes, semi_axes): ([Vector3<N::Double>; 3], [N::Double; 3]),
    scale: N,
    (point_roundings, roundings): (f64, u16),
) -> Ellipsoids<N> {
    let [a, b, c] = semi_axes;
    let (shortest, longest) = (a.min(b).min(c), a.max(b).max(c));
    let moved = (longest + center.length()) * (point_roundings * f64::from(UNIT_ROUNDOFF));
    let one = moved.splat(1.0);
    let share = (moved / shortest).min(one);
    Ellipsoids {
        light: None,
        offset: to_world(frame, center, scale.widen()),
        axes: Matrix3::new(
            to_world(frame, axes[0], one),
            to_world(frame, axes[1], one),
            to_world(frame, axes[2], one),
        ),
        semi_axes: Vector3::new(
            (enlarged::<N>(a, moved, share) * scale).round_up(roundings),
            (enlarged::<N>(b, moved, share) * scale).round_up(roundings),
            (enlarged::<N>(c, moved, share) * scale).round_up(roundings),
        ),
    }
}

/// The semi-axis for a = `semi_axis`, d = `moved` and t = `share`.
#[inline(always)]
fn enlarged<N: Single>(semi_axis: N::Double, moved: N::Double, share: N::Double) -> N {
    let a = semi_axis;
    let one = moved.splat(1.0);
    let squared = (share + 1.0) * a * a + (one / share + 1.0) * moved * moved;
    N::narrow(squared.sqrt())
}

/// `factor` times the vector whose coordinates are those of `frame`.
#[inline(always)]
fn to_world<N: Single>(
    frame: &[Vector3<N::Double>; 3],
    v: Vector3<N::Double>,
    factor: N::Double,
) -> Vector3<N> {
    let [x, y, z] = *frame;
    let terms = [(factor * v.x, x), (factor * v.y, y), (factor * v.z, z)];
    Vector3::narrow(Vector3::combine(terms))
}

#[inline(always)]
fn turned<D: Double, const K: usize>(
    cosine: D,
    sine: D,
    mut a: [D; K],
    mut b: [D; K],
) -> ([D; K], [D; K]) {
    for (a, b) in a.iter_mut().zip(&mut b) {
        (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
    }
    (a, b)
}

#[inline(always)]
fn dot<D: Double, const K: usize>(a: &[D; K], b: &[D; K]) -> D {
    let mut sum = a[0] * b[0];
    for (a, b) in a.iter().zip(b).skip(1) {
        sum = sum + *a * *b;
    }
    sum
}

#[inline(always)]
fn vector<D: Double>([x, y, z]: [D; 3]) -> Vector3<D> {
    Vector3::new(x, y, z)
}
