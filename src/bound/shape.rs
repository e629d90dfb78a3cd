use glam::Vec3;

use crate::num::{Quad, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for the product of a length and the scale.
const SCALED_LENGTH_ROUNDINGS: u16 = 1;
/// Pays for the rounding of a sum of vectors, in units of u times its largest component.
const SUM_ROUNDINGS: f32 = 2.0;

/// The largest number of quads of a shape or a lobe in a batch.
pub const MAX_QUADS: usize = 5;

/// The numbers of a shape or a lobe. Only the first `QUADS` of them are in use.
pub type Quads<N> = [Quad<N>; MAX_QUADS];

/// The quads in use, `used`, followed by zeros.
#[inline(always)]
pub fn padded<const QUADS: usize>(used: [Quad<f32>; QUADS]) -> Quads<f32> {
    let mut quads = [[0.0; 4]; MAX_QUADS];
    quads[..QUADS].copy_from_slice(&used);
    quads
}

/// A bounding shape around a light: [`Spheroid`](crate::Spheroid), [`Ellipsoid`](crate::Ellipsoid) or
/// [`Sphere`](crate::Sphere).
///
/// The trait is for generic code. Each shape also has these functions as its own.
pub trait Shape: Copy + 'static {
    /// Scales the shape by `scale` ≥ 0 about the origin, then moves it by `position`, rounded outward. Scaled
    /// by zero it is [empty](Self::is_empty).
    #[must_use]
    fn placed(self, position: Vec3, scale: f32) -> Self;

    /// Whether the shape is empty: the light reaches nothing.
    fn is_empty(&self) -> bool;

    #[doc(hidden)]
    const EMPTY: Self;

    /// One shape in each lane.
    #[doc(hidden)]
    type Lanes<N: Single>: ShapeLanes<N>;

    /// The number of quads in use.
    #[doc(hidden)]
    const QUADS: usize;

    #[doc(hidden)]
    fn to_quads(&self) -> Quads<f32>;

    #[doc(hidden)]
    fn from_quads<N: Single>(quads: &Quads<N>) -> Self::Lanes<N>;

    #[doc(hidden)]
    fn from_lanes(lanes: Self::Lanes<f32>) -> Self;
}

/// One shape in each lane.
pub trait ShapeLanes<N: Single>: Copy {
    /// Computes [`Shape::placed`] for shapes that are not empty and a positive scale.
    fn placed(self, position: Vector3<N>, scale: N) -> Self;

    /// Computes [`Shape::is_empty`].
    fn is_empty(&self) -> N::Mask;
}

/// `length` times `scale`, both positive, rounded up. A product that underflows is clamped.
#[inline(always)]
pub(super) fn scaled<N: Single>(length: N, scale: N) -> N {
    let product = (length * scale).round_up(SCALED_LENGTH_ROUNDINGS);
    product.max(scale.splat(f32::MIN_POSITIVE))
}

/// Upper bound of the length of the rounding error of `sum`, a vector whose components are rounded once.
#[inline(always)]
pub(super) fn rounding_of_sum<N: Single>(sum: Vector3<N>) -> N {
    sum.abs().max_element() * (SUM_ROUNDINGS * UNIT_ROUNDOFF)
}
