//! Vectors of `f64`, for what `f32` cannot resolve.

use crate::{Direction, math};

pub(crate) type Vector = [f64; 3];

/// The vector of unit length along `direction`.
pub(crate) fn unit(direction: Direction) -> Vector {
    let v = direction.as_f64();
    let length = math::length(v);
    v.map(|x| x / length)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Σ factorᵢ·vectorᵢ.
pub(crate) fn sum<const N: usize>(terms: [(f64, Vector); N]) -> Vector {
    terms.into_iter().fold([0.0; 3], |sum, (factor, vector)| {
        core::array::from_fn(|i| sum[i] + factor * vector[i])
    })
}
