//! The box test: a unit sphere against the box around the image of a tile.
//!
//! M takes the tile's rectangle, at depth 1, to a parallelogram; the box of that, drawn out over the depths,
//! is an axis-aligned box, which is apart from the unit sphere if its nearest point is
//! [Tokuyoshi & Harada 2017, Sec. 5.2].
//!
//! Each operation is monotone, and rounding is too: of two tiles, one inside the other, the larger is touched
//! by whatever touches the smaller, bit for bit. That is what lets blocks of tiles be tested first.

use super::TileTest;
use super::frustum::Image;
use crate::num::{Double, Real, Single};
use crate::project::{Field, Projected, ProjectedEllipsoid, ProjectedSphere};
use crate::view::{DepthInterval, TileRectangle};

/// The slopes across and down that a tile covers, and its depths, each from the least to the greatest.
#[derive(Clone, Copy, Debug)]
pub struct TileBounds<N> {
    pub across: [N; 2],
    pub down: [N; 2],
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
        let widen = |[least, most]: [N; 2]| [least.widen(), most.widen()];
        TileBounds {
            across: widen(self.across),
            down: widen(self.down),
            depths: widen(self.depths),
        }
    }
}

/// A projected shape that batches hold and a `Culler` tests:
/// [`ProjectedEllipsoid`] and [`ProjectedSphere`].
pub trait BoxTest: Projected + TileTest {
    /// What a shape has in common with all tiles of a row: a part of its box.
    #[doc(hidden)]
    type Row<T: Field>: Field + AsRef<[T]> + AsMut<[T]>;

    #[doc(hidden)]
    fn row_of<T: Field>(value: T) -> Self::Row<T>;

    /// The row of tiles with these slopes down.
    #[doc(hidden)]
    fn row<N: Single>(fields: &Self::Fields<N>, down: [N; 2]) -> Self::Row<N>;

    /// Whether the shape does not touch the box around `tile`. An overflow to NaN does not lose it.
    #[doc(hidden)]
    fn misses<N: Single>(
        fields: &Self::Fields<N>,
        row: &Self::Row<N>,
        tile: &TileBounds<N>,
    ) -> N::Mask;

    /// The shape as the exact test takes it.
    #[doc(hidden)]
    fn image<D: Double>(fields: &Self::Fields<D>) -> Image<D>;
}

impl BoxTest for ProjectedEllipsoid {
    /// M₁₂y + M₁₃ and M₂₂y + M₂₃, from the least to the greatest.
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
        let x = apart_at_depths(x, across, tile.depths);
        let y = apart_at_depths(y, down, tile.depths);
        let z = apart(z, [m * tile.depths[0], m * tile.depths[1]]);
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
        let x = apart_at_depths(x, tile.across, tile.depths);
        let y = apart_at_depths(y, tile.down, tile.depths);
        let z = apart(z, tile.depths);
        (x * x + y * y + z * z).gt(radius_squared)
    }

    #[inline(always)]
    fn image<D: Double>(fields: &[D; 4]) -> Image<D> {
        let [x, y, z, radius_squared] = *fields;
        Image::of_sphere([x, y, z], radius_squared)
    }
}

/// The range of `factor` times a number in `range`.
#[inline(always)]
fn scaled<N: Real>(factor: N, range: [N; 2]) -> [N; 2] {
    let (a, b) = (factor * range[0], factor * range[1]);
    [a.min(b), a.max(b)]
}

#[inline(always)]
fn shifted<N: Real>(range: [N; 2], by: [N; 2]) -> [N; 2] {
    [range[0] + by[0], range[1] + by[1]]
}

/// The distance of `center` from `range` times a number in `depths`.
#[inline(always)]
fn apart_at_depths<N: Real>(center: N, range: [N; 2], depths: [N; 2]) -> N {
    let [low, _] = scaled(range[0], depths);
    let [_, high] = scaled(range[1], depths);
    apart(center, [low, high])
}

/// The distance of `center` from `range`.
#[inline(always)]
fn apart<N: Real>(center: N, range: [N; 2]) -> N {
    center - center.max(range[0]).min(range[1])
}
