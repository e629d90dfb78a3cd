//! The principal axes of an ellipsoid that is the image of a ball.

use crate::num::{Double, Vector3};

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
