use core::fmt::Debug;

use crate::num::{Single, UNIT_ROUNDOFF};

/// Budget for both ends of a range of depths, in [`outward`].
const OUTWARD_ROUNDINGS: f32 = 8.0;

/// A projected shape that batches can hold: [`ProjectedEllipsoid`](crate::ProjectedEllipsoid) or
/// [`ProjectedSphere`](crate::ProjectedSphere).
pub trait Projected: Copy + Debug {
    /// The fields of a shape, each of type `T`.
    #[doc(hidden)]
    type Fields<T: Field>: Field + AsRef<[T]> + AsMut<[T]>;

    /// The fields of a shape that touches nothing.
    #[doc(hidden)]
    const NOWHERE: Self::Fields<f32>;

    /// `value` in each field.
    #[doc(hidden)]
    fn fields_of<T: Field>(value: T) -> Self::Fields<T>;

    #[doc(hidden)]
    fn to_fields(&self) -> Self::Fields<f32>;

    #[doc(hidden)]
    fn from_fields(fields: Self::Fields<f32>) -> Self;

    /// Bounds of the near and far depths of the tiles that the shape touches.
    #[doc(hidden)]
    fn reach_of_fields<N: Single>(fields: &Self::Fields<N>) -> [N; 2];
}

/// The type of a field: a number, an array of numbers, or a vector of lanes.
pub trait Field: Copy + Debug + Send + Sync {}

impl<T: Copy + Debug + Send + Sync> Field for T {}

/// A projected shape in each lane, and the range of depths that it reaches.
#[derive(Clone, Copy)]
pub struct ProjectedLanes<N: Single, P: Projected> {
    pub fields: P::Fields<N>,
    pub reach: [N; 2],
}

/// The range from `near` to `far`, widened by [`OUTWARD_ROUNDINGS`]. All depths if an end is NaN.
#[inline(always)]
pub(super) fn outward<N: Single>([near, far]: [N; 2]) -> [N; 2] {
    const SHARE: f32 = OUTWARD_ROUNDINGS * UNIT_ROUNDOFF;
    let (near, far) = (near - near.abs() * SHARE, far + far.abs() * SHARE);
    N::select_all(
        near.le(far),
        [near, far],
        [near.splat(f32::NEG_INFINITY), near.splat(f32::INFINITY)],
    )
}
