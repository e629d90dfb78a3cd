//! The box test: a unit sphere against the bounding box of the image of a tile.
//!
//! M takes the tile's rectangle, at depth 1, to a parallelogram. The bounding rectangle of that, scaled by
//! all depths that tile and shape have in common, has an axis-aligned bounding box. The test rejects a tile if
//! the point of the box that is nearest to the centre lies outside the unit sphere
//! [Tokuyoshi & Harada 2017, Sec. 5.2]. In the paper the box is that of all depths of the tile.
//!
//! Before it, the bounds of the shape are compared with the slopes and depths of the tile: six comparisons,
//! which reject most tiles. Neither test alone is enough. A long shape at a slant fills little of its bounds,
//! and the box of a tile off the axis is larger than its image.
//!
//! Each operation is monotone, and so is rounding. So if a tile lies inside a larger one, whatever touches
//! the tile also touches the larger one, bit for bit. Blocks of tiles are tested first for this reason.

use super::TileTest;
use super::frustum::Image;
use crate::num::{Double, Real, Single};
use crate::project::{Field, Projected, ProjectedEllipsoid, ProjectedSphere};
use crate::view::ViewBounds;

/// A projected shape that a `Culler` can test: [`ProjectedEllipsoid`] or [`ProjectedSphere`].
pub trait BoxTest: Projected + TileTest {
    /// Intermediate results that are the same for all tiles of a row of the grid.
    #[doc(hidden)]
    type Row<T: Field>: Field + AsRef<[T]> + AsMut<[T]>;

    /// `value` in each component of a row.
    #[doc(hidden)]
    fn row_of<T: Field>(value: T) -> Self::Row<T>;

    /// Computes the intermediate results for the row of tiles with the slopes y/z = `down`.
    #[doc(hidden)]
    fn row<N: Single>(fields: &Self::Fields<N>, down: [N; 2]) -> Self::Row<N>;

    /// Whether the shape, whose bounds touch `tile`, misses the bounding box of the tile's image at the depths
    /// that both have. False if an overflow makes NaN.
    #[doc(hidden)]
    fn misses<N: Single>(
        fields: &Self::Fields<N>,
        row: &Self::Row<N>,
        tile: &ViewBounds<N>,
    ) -> N::Mask;

    /// The shape in the form that the exact test takes.
    #[doc(hidden)]
    fn image<D: Double>(fields: &Self::Fields<D>) -> Image<D>;
}

impl BoxTest for ProjectedEllipsoid {
    /// M₁₂y + M₁₃ and M₂₂y + M₂₃, each as \[least, greatest\].
    type Row<T: Field> = [T; 4];

    fn row_of<T: Field>(value: T) -> [T; 4] {
        [value; 4]
    }

    #[inline(always)]
    fn row<N: Single>(fields: &[N; 16], down: [N; 2]) -> [N; 4] {
        let [_, m_12, m_13, _, m_22, m_23, ..] = *fields;
        let (x, y) = (scaled(m_12, down), scaled(m_22, down));
        [x[0] + m_13, x[1] + m_13, y[0] + m_23, y[1] + m_23]
    }

    #[inline(always)]
    fn misses<N: Single>(fields: &[N; 16], row: &[N; 4], tile: &ViewBounds<N>) -> N::Mask {
        let [m_11, _, _, m_21, _, _, m, x, y, z, ..] = *fields;
        let across = shifted(scaled(m_11, tile.across), [row[0], row[1]]);
        let down = shifted(scaled(m_21, tile.across), [row[2], row[3]]);
        let depths = common_depths::<N, Self>(fields, tile);
        let x = distance_at_depths(x, across, depths);
        let y = distance_at_depths(y, down, depths);
        let z = distance(z, [m * depths[0], m * depths[1]]);
        (x * x + y * y + z * z).gt(m.splat(1.0))
    }

    #[inline(always)]
    fn image<D: Double>(fields: &[D; 16]) -> Image<D> {
        let [m_11, m_12, m_13, m_21, m_22, m_23, m, x, y, z, ..] = *fields;
        let one = m.splat(1.0);
        Image {
            a: [m_11, m_21],
            b: [m_12, m_22],
            d: [m_13, m_23, m],
            center: [x, y, z],
            radius: one,
            radius_squared: one,
        }
    }
}

impl BoxTest for ProjectedSphere {
    type Row<T: Field> = [T; 0];

    fn row_of<T: Field>(_: T) -> [T; 0] {
        []
    }

    #[inline(always)]
    fn row<N: Single>(_: &[N; 10], _: [N; 2]) -> [N; 0] {
        []
    }

    #[inline(always)]
    fn misses<N: Single>(fields: &[N; 10], _: &[N; 0], tile: &ViewBounds<N>) -> N::Mask {
        let [x, y, z, radius_squared, ..] = *fields;
        let depths = common_depths::<N, Self>(fields, tile);
        let x = distance_at_depths(x, tile.across, depths);
        let y = distance_at_depths(y, tile.down, depths);
        let z = distance(z, depths);
        (x * x + y * y + z * z).gt(radius_squared)
    }

    #[inline(always)]
    fn image<D: Double>(fields: &[D; 10]) -> Image<D> {
        let [x, y, z, radius_squared, ..] = *fields;
        Image::of_sphere([x, y, z], radius_squared)
    }
}

/// The depths that both the shape and the tile have. Reversed if there are none.
#[inline(always)]
fn common_depths<N: Single, P: Projected>(fields: &P::Fields<N>, tile: &ViewBounds<N>) -> [N; 2] {
    let [near, far] = P::bounds_of(fields).depths;
    [near.max(tile.depths[0]), far.min(tile.depths[1])]
}

/// The range of the products of `factor` and a number in `range`.
#[inline(always)]
fn scaled<N: Real>(factor: N, range: [N; 2]) -> [N; 2] {
    let (a, b) = (factor * range[0], factor * range[1]);
    [a.min(b), a.max(b)]
}

/// The range of the sums of a number in `range` and one in `by`.
#[inline(always)]
fn shifted<N: Real>(range: [N; 2], by: [N; 2]) -> [N; 2] {
    [range[0] + by[0], range[1] + by[1]]
}

/// The signed distance of `center` from the range of the products of a number in `range` and one in `depths`.
#[inline(always)]
fn distance_at_depths<N: Real>(center: N, range: [N; 2], depths: [N; 2]) -> N {
    let [low, _] = scaled(range[0], depths);
    let [_, high] = scaled(range[1], depths);
    distance(center, [low, high])
}

/// The signed distance of `center` from `range`. Zero inside.
#[inline(always)]
fn distance<N: Real>(center: N, range: [N; 2]) -> N {
    center - center.max(range[0]).min(range[1])
}
