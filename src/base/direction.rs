use core::ops::{Deref, Neg};

use glam::Vec3;

use super::Error;
use crate::num::{self, Single, Vector3, dot_f64};

/// Largest error of the squared length of a saved direction that is read unchanged, in units of u.
#[cfg(feature = "serde")]
const UNIT_LENGTH_ROUNDINGS: f64 = 8.0;

/// A unit vector.
///
/// The constructor normalises; nothing after it checks again. The length differs from 1 by at most 2.4·10⁻⁷.
/// A `Direction` dereferences to its [`Vec3`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(Vec3);

impl Direction {
    /// The direction along +x.
    pub const X: Self = Self(Vec3::X);
    /// The direction along +y.
    pub const Y: Self = Self(Vec3::Y);
    /// The direction along +z.
    pub const Z: Self = Self(Vec3::Z);

    /// Normalises `vector`, which may have any finite length but zero, from subnormal numbers to the largest.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `vector` is zero or has a NaN or infinite component.
    ///
    /// ```
    /// use stochastic_light_culling::{Direction, glam::Vec3};
    ///
    /// assert_eq!(*Direction::new(Vec3::new(0.0, 0.0, 1e-40))?, Vec3::Z);
    /// assert!(Direction::new(Vec3::ZERO).is_err());
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn new(vector: Vec3) -> Result<Self, Error> {
        Self::of("direction", vector)
    }

    /// Like [`new`](Self::new), with `quantity` as the name of the vector in an error.
    pub(crate) fn of(quantity: &'static str, vector: Vec3) -> Result<Self, Error> {
        let largest = vector.abs().max_element();
        if !vector.is_finite() || largest == 0.0 {
            return Err(Error::Vector {
                quantity,
                value: vector,
                valid: "finite and not zero",
            });
        }
        // Scaled in two steps: the reciprocal of a subnormal length overflows.
        let lifted = if largest < f32::MIN_POSITIVE {
            vector * (1.0 / f32::MIN_POSITIVE)
        } else {
            vector
        };
        let scaled = lifted / lifted.abs().max_element();
        Ok(Self(scaled / num::sqrt(scaled.length_squared())))
    }

    /// Wraps `vector`, which must have unit length.
    #[inline]
    pub(crate) fn from_unit(vector: Vec3) -> Self {
        debug_assert!((dot_f64(vector, vector) - 1.0).abs() < 1e-6);
        Self(vector)
    }

    /// Like [`new`](Self::new), but keeps a `vector` whose length is as close to 1 as that of a direction, so
    /// that a saved direction is read bit for bit.
    #[cfg(feature = "serde")]
    pub(crate) fn of_unit_or_any_length(vector: Vec3) -> Result<Self, Error> {
        let tolerance = UNIT_LENGTH_ROUNDINGS * f64::from(num::UNIT_ROUNDOFF);
        if (dot_f64(vector, vector) - 1.0).abs() <= tolerance {
            Ok(Self(vector))
        } else {
            Self::new(vector)
        }
    }

    /// Mirrors the direction at a surface with the given `normal`; see [`mirrored`].
    #[inline]
    pub(crate) fn mirrored(self, normal: Self) -> Self {
        Self::from_unit(mirrored(Vector3::from(self), normal.into()).into())
    }
}

/// Mirrors `direction` = ω at a surface with the given `normal` = n: 2(n·ω)n − ω.
///
/// Computed in `f64`, so that only the rounding to `f32` tilts it: half an ulp in each component.
#[inline(always)]
pub(crate) fn mirrored<N: Single>(direction: Vector3<N>, normal: Vector3<N>) -> Vector3<N> {
    let (w, n) = (direction.widen(), normal.widen());
    let twice = n.dot(w) * 2.0 / n.dot(n);
    Vector3::narrow(n * twice - w)
}

impl Deref for Direction {
    type Target = Vec3;

    fn deref(&self) -> &Vec3 {
        &self.0
    }
}

impl Neg for Direction {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl From<Direction> for Vec3 {
    fn from(direction: Direction) -> Self {
        direction.0
    }
}

impl From<Direction> for Vector3<f32> {
    #[inline(always)]
    fn from(direction: Direction) -> Self {
        direction.0.into()
    }
}
