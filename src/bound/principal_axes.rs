//! The axes of an ellipsoid that is given as the image of a ball.

use crate::math;
use crate::wide::Vector;

/// The axes, of unit length and at right angles, and semi-axes of the ellipsoid {Az : ‖z‖ ≤ 1} or of one
/// around it, where `rows` are the rows of A, none of them zero.
///
/// Rows that are turned against each other until they are at right angles have the semi-axes as their
/// lengths [Hestenes 1958]; each is as accurate as its row was, however much shorter than the others,
/// which an eigenvalue of A Aᵀ would not be. Where the fixed number of turns ends, the semi-axes are
/// enlarged by what the rows still have in common: for unit rows Aᵀ with cosines cᵢⱼ between them no
/// eigenvalue of A Aᵀ exceeds 1 + Σ|cᵢⱼ|.
pub(super) fn principal_axes<const N: usize>(mut rows: [[f64; N]; 3]) -> ([Vector; 3], [f64; 3]) {
    const SWEEPS: usize = 4;
    const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (i, j) in [PAIRS; SWEEPS].into_iter().flatten() {
        let in_common = dot(rows[i], rows[j]);
        let squares = [i, j].map(|k| dot(rows[k], rows[k]));
        // Too little in common to count.
        if in_common * in_common <= 1e-20 * squares[0] * squares[1] {
            continue;
        }
        let cotangent = (squares[1] - squares[0]) / (2.0 * in_common);
        // Of the two angles the one below 45°.
        let root = math::length([1.0, cotangent, 0.0]);
        let tangent = 1.0_f64.copysign(cotangent) / (cotangent.abs() + root);
        let cosine = 1.0 / math::length([1.0, tangent, 0.0]);
        let turn = (cosine, cosine * tangent);
        (rows[i], rows[j]) = turned(turn, rows[i], rows[j]);
        (axes[i], axes[j]) = turned(turn, axes[i], axes[j]);
    }
    let lengths = rows.map(|row| math::sqrt_of_wide(dot(row, row)));
    let in_common: f64 = PAIRS
        .iter()
        .map(|&(i, j)| dot(rows[i], rows[j]).abs() / (lengths[i] * lengths[j]))
        .sum();
    let growth = math::sqrt_of_wide(1.0 + in_common);
    (axes, lengths.map(|length| length * growth))
}

fn turned<const N: usize>(
    (cosine, sine): (f64, f64),
    a: [f64; N],
    b: [f64; N],
) -> ([f64; N], [f64; N]) {
    (
        core::array::from_fn(|i| cosine * a[i] - sine * b[i]),
        core::array::from_fn(|i| sine * a[i] + cosine * b[i]),
    )
}

fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    (0..N).map(|i| a[i] * b[i]).sum()
}
