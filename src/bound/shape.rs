use glam::Vec3;

use crate::num::{Quad, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for the product of a length and the scale.
const SCALED_LENGTH_ROUNDINGS: u16 = 1;
/// Pays for the rounding of a sum of vectors, in units of u times its largest component.
const SUM_ROUNDINGS: f32 = 2.0;

/// Quads that a shape or a lobe may have in a batch.
pub const MAX_QUADS: usize = 5;

/// The numbers of a shape or a lobe, of which the first so many quads are in use.
pub type Quads<N> = [Quad<N>; MAX_QUADS];

/// A shape around a light, for generic code; each has these functions itself: [`Spheroid`](crate::Spheroid),
/// [`Ellipsoid`](crate::Ellipsoid) and [`Sphere`](crate::Sphere).
pub trait Shape: Copy + 'static {
    /// The shape scaled by `scale ≥ 0` about the origin and then moved by `position`, rounded
    /// outward. Scaled by zero it is [empty](Self::is_empty).
    #[must_use]
    fn placed(self, position: Vec3, scale: f32) -> Self;

    /// Whether nothing lies inside: the light reaches nowhere.
    fn is_empty(&self) -> bool;

    #[doc(hidden)]
    const EMPTY: Self;

    /// One shape in each lane.
    #[doc(hidden)]
    type Lanes<N: Single>: ShapeLanes<N>;

    /// Quads in use.
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
    /// [`Shape::placed`], of shapes that are not empty, by a positive scale.
    fn placed(self, position: Vector3<N>, scale: N) -> Self;

    /// [`Shape::is_empty`].
    fn is_empty(&self) -> N::Mask;
}

/// `length` times `scale`, rounded up; zero only if one of them is, however small the product.
#[inline(always)]
pub(super) fn scaled<N: Single>(length: N, scale: N) -> N {
    let least = scale.splat(f32::MIN_POSITIVE);
    let product = (length * scale)
        .round_up(SCALED_LENGTH_ROUNDINGS)
        .max(least);
    let is_positive = length.is_positive() & scale.is_positive();
    N::select(is_positive, product, scale.zero())
}

/// Upper bound, in length, of the rounding error of a sum of two vectors, component by component.
#[inline(always)]
pub(super) fn rounding_of_sum<N: Single>(sum: Vector3<N>) -> N {
    sum.abs().max_element() * (SUM_ROUNDINGS * UNIT_ROUNDOFF)
}
