//! The box test: a unit sphere against the bounding box of the image of a tile.
//!
//! M takes the tile's rectangle, at depth 1, to a parallelogram. The bounding rectangle of that, scaled by
//! all depths of the tile, has an axis-aligned bounding box. The test rejects a tile if the point of the box
//! that is nearest to the centre lies outside the unit sphere [Tokuyoshi & Harada 2017, Sec. 5.2].
//!
//! Each operation is monotone, and so is rounding. So if a tile lies inside a larger one, whatever touches
//! the tile also touches the larger one, bit for bit. Blocks of tiles are tested first for this reason.

use super::TileTest;
use super::frustum::Image;
use crate::num::{Double, Real, Single};
use crate::project::{Field, Projected, ProjectedEllipsoid, ProjectedSphere};
use crate::view::{DepthInterval, TileRectangle};

/// The bounds of a tile, each as \[least, greatest\].
#[derive(Clone, Copy, Debug)]
pub struct TileBounds<N> {
    /// Slopes x/z.
    pub across: [N; 2],
    /// Slopes y/z.
    pub down: [N; 2],
    /// Depths z.
    pub depths: [N; 2],
}

impl TileBounds<f32> {
    #[inline(always)]
    pub fn new(rectangle: &TileRectangle, depths: &DepthInterval) -> Self {
        let (min, max) = (rectangle.min(), rectangle.max());
        Self {
            across: [min.x, max.x],
            down: [min.y, max.y],
            depths: [depths.near(), depths.far()],
        }
    }
}

impl<N: Single> TileBounds<N> {
    #[inline(always)]
    pub fn widen(self) -> TileBounds<N::Double> {
        let widen = |[min, max]: [N; 2]| [min.widen(), max.widen()];
        TileBounds {
            across: widen(self.across),
            down: widen(self.down),
            depths: widen(self.depths),
        }
    }
}

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

    /// Whether the shape misses the bounding box of `tile`. False if an overflow makes NaN.
    #[doc(hidden)]
    fn misses<N: Single>(
        fields: &Self::Fields<N>,
        row: &Self::Row<N>,
        tile: &TileBounds<N>,
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
    fn row<N: Single>(fields: &[N; 10], down: [N; 2]) -> [N; 4] {
        let [_, m_12, m_13, _, m_22, m_23, ..] = *fields;
        let (x, y) = (scaled(m_12, down), scaled(m_22, down));
        [x[0] + m_13, x[1] + m_13, y[0] + m_23, y[1] + m_23]
    }

    #[inline(always)]
    fn misses<N: Single>(fields: &[N; 10], row: &[N; 4], tile: &TileBounds<N>) -> N::Mask {
        let [m_11, _, _, m_21, _, _, m, x, y, z] = *fields;
        let across = shifted(scaled(m_11, tile.across), [row[0], row[1]]);
        let down = shifted(scaled(m_21, tile.across), [row[2], row[3]]);
        let x = distance_at_depths(x, across, tile.depths);
        let y = distance_at_depths(y, down, tile.depths);
        let z = distance(z, [m * tile.depths[0], m * tile.depths[1]]);
        (x * x + y * y + z * z).gt(m.splat(1.0))
    }

    #[inline(always)]
    fn image<D: Double>(fields: &[D; 10]) -> Image<D> {
        let [m_11, m_12, m_13, m_21, m_22, m_23, m, x, y, z] = *fields;
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
    fn row<N: Single>(_: &[N; 4], _: [N; 2]) -> [N; 0] {
        []
    }

    #[inline(always)]
    fn misses<N: Single>(fields: &[N; 4], _: &[N; 0], tile: &TileBounds<N>) -> N::Mask {
        let [x, y, z, radius_squared] = *fields;
        let x = distance_at_depths(x, tile.across, tile.depths);
        let y = distance_at_depths(y, tile.down, tile.depths);
        let z = distance(z, tile.depths);
        (x * x + y * y + z * z).gt(radius_squared)
    }

    #[inline(always)]
    fn image<D: Double>(fields: &[D; 4]) -> Image<D> {
        let [x, y, z, radius_squared] = *fields;
        Image::of_sphere([x, y, z], radius_squared)
    }
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
