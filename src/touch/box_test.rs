//! The box test: a unit sphere against the bounding box of the image of a tile.
//!
//! # Frustums
//!
//! M takes the tile's rectangle, at depth 1, to a parallelogram. The bounding rectangle of that, scaled by
//! all depths that tile and shape have in common, has an axis-aligned bounding box. The test rejects a tile if
//! the point of the box that is nearest to the centre lies outside the unit sphere
//! [Tokuyoshi & Harada 2017, Sec. 5.2]. In the paper the box is that of all depths of the tile.
//!
//! # Boxes
//!
//! A tile of an orthographic projection is a box, and the same rectangle at each depth. M takes the rectangle, at depth 0,
//! to a parallelogram, and the depths move that along a line. So the bounding box of the image is that of the parallelogram,
//! plus the way along the line. Of the tile only what lies within the bounds of the shape counts, in all three directions.
//! For a sphere M is the identity, and the test is exact.
//!
//! # Bounds
//!
//! Before it, the bounds of the shape are compared with the slopes and depths of the tile: six comparisons,
//! which reject most tiles. Neither test alone is enough. A long shape at a slant fills little of its bounds,
//! and the box of a tile off the axis is larger than its image.
//!
//! # Blocks
//!
//! Each operation is monotone, and so is rounding. So if a tile lies inside a larger one, whatever touches
//! the tile also touches the larger one, bit for bit. Blocks of tiles are tested first for this reason.

use super::TileTest;
use super::frustum::Image;
use crate::num::{Double, Real, Single};
use crate::project::{Projected, ProjectedEllipsoid, ProjectedSphere};
use crate::view::{Projection, ViewBounds, common};

/// The bounding rectangle of the image of a tile's rectangle at depth 1, or of a box at depth 0: the least and the
/// greatest x, and y.
pub type Outline<N> = [N; 4];

/// A projected shape that a `Culler` can test: [`ProjectedEllipsoid`] or [`ProjectedSphere`].
pub trait BoxTest: Projected + TileTest {
    /// The projection of the tiles.
    #[doc(hidden)]
    type Projection: Projection;

    /// Computes the outline of the tiles with the slopes x/z = `across` and y/z = `down`, or with these x and y, which all
    /// their depth intervals share.
    #[doc(hidden)]
    fn outline<N: Single>(fields: &Self::Fields<N>, across: [N; 2], down: [N; 2]) -> Outline<N>;

    /// Whether the shape, whose bounds touch a tile with this outline and these depths, misses the bounding box
    /// of the tile's image at the depths that both have. False if an overflow makes NaN.
    #[doc(hidden)]
    fn misses<N: Single>(fields: &Self::Fields<N>, outline: &Outline<N>, depths: [N; 2])
    -> N::Mask;

    /// The shape in the form that the exact test takes.
    #[doc(hidden)]
    fn image<D: Double>(fields: &Self::Fields<D>) -> Image<D>;

    /// The tile that the exact test takes in the place of `tile`, which the bounds of the shape touch: of a box, the part
    /// within these bounds.
    #[doc(hidden)]
    #[inline(always)]
    fn clipped<N: Single>(fields: &Self::Fields<N>, tile: &ViewBounds<N>) -> ViewBounds<N> {
        if Self::Projection::IS_PERSPECTIVE {
            *tile
        } else {
            Self::bounds_of(fields).common(tile)
        }
    }
}

impl<P: Projection> BoxTest for ProjectedEllipsoid<P> {
    type Projection = P;

    #[inline(always)]
    fn outline<N: Single>(fields: &[N; 16], across: [N; 2], down: [N; 2]) -> Outline<N> {
        let [m_11, m_12, m_13, m_21, m_22, m_23, ..] = *fields;
        if !P::IS_PERSPECTIVE {
            let bounds = Self::bounds_of(fields);
            let (across, down) = (common(bounds.across, across), common(bounds.down, down));
            let [x0, x1] = sum(scaled(m_11, across), scaled(m_12, down));
            let [y0, y1] = sum(scaled(m_21, across), scaled(m_22, down));
            return [x0, x1, y0, y1];
        }
        let (x, y) = (scaled(m_12, down), scaled(m_22, down));
        let (x, y) = ([x[0] + m_13, x[1] + m_13], [y[0] + m_23, y[1] + m_23]);
        let (x, y) = (sum(scaled(m_11, across), x), sum(scaled(m_21, across), y));
        [x[0], x[1], y[0], y[1]]
    }

    #[inline(always)]
    fn misses<N: Single>(fields: &[N; 16], outline: &Outline<N>, depths: [N; 2]) -> N::Mask {
        let [_, _, m_13, _, _, m_23, m, x, y, z, ..] = *fields;
        let [x0, x1, y0, y1] = *outline;
        let depths = common(Self::bounds_of(fields).depths, depths);
        let (x, y) = if P::IS_PERSPECTIVE {
            (
                distance_at_depths(x, [x0, x1], depths),
                distance_at_depths(y, [y0, y1], depths),
            )
        } else {
            (
                distance(x, sum([x0, x1], scaled(m_13, depths))),
                distance(y, sum([y0, y1], scaled(m_23, depths))),
            )
        };
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

impl<P: Projection> BoxTest for ProjectedSphere<P> {
    type Projection = P;

    #[inline(always)]
    fn outline<N: Single>(_: &[N; 11], across: [N; 2], down: [N; 2]) -> Outline<N> {
        [across[0], across[1], down[0], down[1]]
    }

    #[inline(always)]
    fn misses<N: Single>(fields: &[N; 11], outline: &Outline<N>, depths: [N; 2]) -> N::Mask {
        let [x, y, z, .., radius_squared] = *fields;
        let [x0, x1, y0, y1] = *outline;
        let depths = common(Self::bounds_of(fields).depths, depths);
        let (x, y) = if P::IS_PERSPECTIVE {
            (
                distance_at_depths(x, [x0, x1], depths),
                distance_at_depths(y, [y0, y1], depths),
            )
        } else {
            (distance(x, [x0, x1]), distance(y, [y0, y1]))
        };
        let z = distance(z, depths);
        (x * x + y * y + z * z).gt(radius_squared)
    }

    #[inline(always)]
    fn image<D: Double>(fields: &[D; 11]) -> Image<D> {
        let [x, y, z, .., radius_squared] = *fields;
        Image::of_sphere([x, y, z], radius_squared)
    }
}

/// The range of the products of `factor` and a number in `range`.
#[inline(always)]
fn scaled<N: Real>(factor: N, range: [N; 2]) -> [N; 2] {
    let (a, b) = (factor * range[0], factor * range[1]);
    [a.min(b), a.max(b)]
}

/// The range of the sums of a number in one range and one in another.
#[inline(always)]
fn sum<N: Real>(a: [N; 2], b: [N; 2]) -> [N; 2] {
    [a[0] + b[0], a[1] + b[1]]
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
