use core::fmt::Debug;

use crate::num::{Single, UNIT_ROUNDOFF};

/// A shape in camera space, as a tile test takes it: [`ProjectedEllipsoid`](crate::ProjectedEllipsoid) and
/// [`ProjectedSphere`](crate::ProjectedSphere).
pub trait Projected: Copy + Debug {
    /// The numbers of a shape, each of type `T`.
    #[doc(hidden)]
    type Fields<T: Field>: Field + AsRef<[T]> + AsMut<[T]>;

    /// A shape that touches nothing.
    #[doc(hidden)]
    const NOWHERE: Self::Fields<f32>;

    #[doc(hidden)]
    fn fields_of<T: Field>(value: T) -> Self::Fields<T>;

    #[doc(hidden)]
    fn to_fields(&self) -> Self::Fields<f32>;

    #[doc(hidden)]
    fn from_fields(fields: Self::Fields<f32>) -> Self;

    /// The nearest and the farthest depth of a tile that the shape touches, or a little more.
    #[doc(hidden)]
    fn reach_of_fields<N: Single>(fields: &Self::Fields<N>) -> [N; 2];
}

/// A number, many of them, or a vector.
pub trait Field: Copy + Debug + Send + Sync {}

impl<T: Copy + Debug + Send + Sync> Field for T {}

/// A projected shape in each lane, and the depths that it reaches.
#[derive(Clone, Copy)]
pub struct ProjectedLanes<N: Single, P: Projected> {
    pub fields: P::Fields<N>,
    pub reach: [N; 2],
}

/// `range`, a few roundings wider; everything where it is not a range.
#[inline(always)]
pub(super) fn outward<N: Single>([near, far]: [N; 2]) -> [N; 2] {
    const SHARE: f32 = 8.0 * UNIT_ROUNDOFF;
    let (near, far) = (near - near.abs() * SHARE, far + far.abs() * SHARE);
    N::select_all(
        near.le(far),
        [near, far],
        [near.splat(f32::NEG_INFINITY), near.splat(f32::INFINITY)],
    )
}
