use core::fmt::Debug;

use super::slopes::unbounded;
use crate::num::{Single, UNIT_ROUNDOFF, Vector3};
use crate::view::ViewBounds;

/// Budget for both ends of a range of depths, or of coordinates, in [`outward`].
const OUTWARD_ROUNDINGS: f32 = 8.0;

/// A projected shape that batches can hold: [`ProjectedEllipsoid`](crate::ProjectedEllipsoid) or
/// [`ProjectedSphere`](crate::ProjectedSphere).
pub trait Projected: Copy + Debug {
    /// The fields of a shape, each of type `T`.
    #[doc(hidden)]
    type Fields<T: Field>: Field + AsRef<[T]> + AsMut<[T]>;

    /// The number of fields, the first ones, from which the others follow: eight or sixteen.
    #[doc(hidden)]
    const STORED: usize;

    /// The fields of a shape that touches nothing.
    #[doc(hidden)]
    const NOWHERE: Self::Fields<f32>;

    /// `value` in each field.
    #[doc(hidden)]
    fn fields_of<T: Field>(value: T) -> Self::Fields<T>;

    /// Computes the fields that follow from the first [`STORED`](Self::STORED).
    #[doc(hidden)]
    fn complete<N: Single>(fields: &mut Self::Fields<N>);

    #[doc(hidden)]
    fn to_fields(&self) -> Self::Fields<f32>;

    #[doc(hidden)]
    fn from_fields(fields: Self::Fields<f32>) -> Self;

    /// Bounds of the slopes and depths of the shape, which are among its fields.
    #[doc(hidden)]
    fn bounds_of<N: Single>(fields: &Self::Fields<N>) -> ViewBounds<N>;
}

/// The type of a field: a number, an array of numbers, or a vector of lanes.
pub trait Field: Copy + Debug + Send + Sync {}

impl<T: Copy + Debug + Send + Sync> Field for T {}

/// Bounds of the coordinates of the points that are within `reach` of `center` along each axis.
#[inline(always)]
pub(super) fn bounds_around<N: Single>(center: Vector3<N>, reach: Vector3<N>) -> ViewBounds<N> {
    ViewBounds {
        across: outward([center.x - reach.x, center.x + reach.x]),
        down: outward([center.y - reach.y, center.y + reach.y]),
        depths: outward([center.z - reach.z, center.z + reach.z]),
    }
}

/// The range from `near` to `far`, widened by [`OUTWARD_ROUNDINGS`]. All depths if an end is NaN.
#[inline(always)]
pub(super) fn outward<N: Single>([near, far]: [N; 2]) -> [N; 2] {
    const SHARE: f32 = OUTWARD_ROUNDINGS * UNIT_ROUNDOFF;
    let (near, far) = (near - near.abs() * SHARE, far + far.abs() * SHARE);
    N::select_all(near.le(far), [near, far], unbounded(near))
}
