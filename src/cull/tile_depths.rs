use alloc::vec::Vec;
use core::ops::Range;

use crate::base::Error;
use crate::view::{Camera, DepthInterval, Projection, TileGrid, TileRectangle};

/// A grid of tiles, and for each tile one or more depth intervals that hold its surfaces.
///
/// For *tiled* culling each tile has its own intervals, such as the two of
/// [`modified_half_z`](DepthInterval::modified_half_z). For *clustered* culling all tiles have the same
/// slices, such as [`exponential_slices`](DepthInterval::exponential_slices). Those without surfaces can be
/// `None`.
///
/// ```
/// use stochastic_light_culling::{Camera, DepthInterval, TileDepths, TileGrid, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.5, 0.1..100.0)?;
/// let grid = TileGrid::new([96, 64], 16)?;
/// let mut tiles = TileDepths::new(&grid, &camera, 2)?;
/// for tile in grid.tiles() {
///     let depths = grid.pixels(tile).pixels().map(|[x, y]| (x + y) as f32); // of a depth buffer
///     tiles.set(tile, DepthInterval::modified_half_z(depths));
/// }
/// assert_eq!((tiles.size(), tiles.intervals()), ([6, 4], 2));
/// assert_eq!(tiles.interval_of([1, 1], 60.0), Some(1));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TileDepths {
    intervals: usize,
    /// The slopes x/z of each column.
    columns: Vec<[f32; 2]>,
    /// The slopes y/z of each row.
    rows: Vec<[f32; 2]>,
    /// The depth intervals, tile by tile and row by row.
    depths: Vec<[f32; 2]>,
    /// For each tile, the hull of its depth intervals.
    hulls: Vec<[f32; 2]>,
}

/// Upper limit of the tiles in a row or a column.
const MAX_TILES_IN_A_ROW: u32 = 1 << 16;
/// Upper limit of the depth intervals of all tiles. A vector can hold as many if pointers have 32 bits.
const MAX_SLOTS: u64 = 1 << 27;
/// The interval of no depths, which ends before it begins.
pub(super) const NONE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

impl TileDepths {
    /// Creates the tiles of `grid` in the view of `camera`, each with room for `intervals` depth intervals.
    /// At first all intervals are missing, and no light touches any tile.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if `intervals` is zero, or there are more than 2¹⁶ tiles in a row or a column, or more
    /// than 2²⁷ intervals in all tiles together. So many intervals take at most 2 GiB.
    pub fn new<P: Projection>(
        grid: &TileGrid,
        camera: &Camera<P>,
        intervals: u32,
    ) -> Result<Self, Error> {
        Self::from_rectangles(grid.size(), intervals, |tile| camera.tile(grid, tile))
    }

    /// Creates a grid of `size` = \[columns, rows\] tiles whose slopes are given by `rectangle`.
    ///
    /// All tiles of a column have the same slopes x/z, and all tiles of a row the same slopes y/z. So
    /// `rectangle` is called only for the tiles of the first row and the first column.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if there are no tiles or no intervals, or more than [`new`](Self::new) accepts.
    pub fn from_rectangles(
        size: [u32; 2],
        intervals: u32,
        rectangle: impl Fn([u32; 2]) -> TileRectangle,
    ) -> Result<Self, Error> {
        let mut tiles = Self {
            intervals: intervals as usize,
            columns: Vec::new(),
            rows: Vec::new(),
            depths: Vec::new(),
            hulls: Vec::new(),
        };
        tiles.set_rectangles(size, rectangle)?;
        Ok(tiles)
    }

    /// Replaces the tiles for a frame with another grid or camera, such as with jitter, zoom or dynamic
    /// resolution. All depth intervals are missing afterwards. Allocates only if there are more tiles than
    /// ever before.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); the tiles are then unchanged.
    pub fn set_view<P: Projection>(
        &mut self,
        grid: &TileGrid,
        camera: &Camera<P>,
    ) -> Result<(), Error> {
        self.set_rectangles(grid.size(), |tile| camera.tile(grid, tile))
    }

    /// Replaces the tiles by those that [`from_rectangles`](Self::from_rectangles) creates, as
    /// [`set_view`](Self::set_view) does.
    ///
    /// # Errors
    ///
    /// As [`from_rectangles`](Self::from_rectangles); the tiles are then unchanged.
    pub fn set_rectangles(
        &mut self,
        size: [u32; 2],
        rectangle: impl Fn([u32; 2]) -> TileRectangle,
    ) -> Result<(), Error> {
        let tiles = u64::from(size[0]) * u64::from(size[1]);
        // The product of two `u32` fits a `u64`. That of three can overflow.
        let slots = tiles.saturating_mul(self.intervals as u64);
        if slots == 0 || slots > MAX_SLOTS || size[0].max(size[1]) > MAX_TILES_IN_A_ROW {
            return Err(Error::Size {
                quantity: "grid of tiles",
                value: size,
                valid: "at least 1×1 and at most 65536×65536, with 1 to 2²⁷ depth intervals in all",
            });
        }
        let columns = (0..size[0]).map(|x| rectangle([x, 0]));
        let rows = (0..size[1]).map(|y| rectangle([0, y]));
        self.columns.clear();
        self.columns
            .extend(columns.map(|tile| [tile.min().x, tile.max().x]));
        self.rows.clear();
        self.rows
            .extend(rows.map(|tile| [tile.min().y, tile.max().y]));
        self.depths.clear();
        self.depths.resize(slots as usize, NONE);
        self.hulls.clear();
        self.hulls.resize(tiles as usize, NONE);
        Ok(())
    }

    /// The least and greatest slope x/z of each column.
    #[must_use]
    pub fn columns(&self) -> &[[f32; 2]] {
        &self.columns
    }

    /// The least and greatest slope y/z of each row.
    #[must_use]
    pub fn rows(&self) -> &[[f32; 2]] {
        &self.rows
    }

    /// The near and far depth of each interval of each tile, in the order of
    /// [`LightLists::ranges`](crate::LightLists::ranges). \[∞, −∞\] for an interval that is missing.
    #[must_use]
    pub fn depths(&self) -> &[[f32; 2]] {
        &self.depths
    }

    /// The number of tiles, \[columns, rows\].
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.columns.len() as u32, self.rows.len() as u32]
    }

    /// The number of depth intervals for which each tile has room.
    #[must_use]
    pub fn intervals(&self) -> u32 {
        self.intervals as u32
    }

    /// Replaces the depth intervals of `tile` = \[column, row\], in this order.
    ///
    /// `None` is an interval without surfaces, which no light touches; so are intervals that the iterator
    /// does not give. Those after the first [`intervals`](Self::intervals) are ignored.
    ///
    /// # Panics
    ///
    /// If `tile` is outside the grid.
    #[track_caller]
    pub fn set(
        &mut self,
        tile: [u32; 2],
        intervals: impl IntoIterator<Item = impl Into<Option<DepthInterval>>>,
    ) {
        let [x, y] = self.index_of(tile);
        let index = y * self.columns.len() + x;
        let first = index * self.intervals;
        let mut hull = NONE;
        let mut intervals = intervals.into_iter();
        for depths in &mut self.depths[first..][..self.intervals] {
            let interval: Option<DepthInterval> = intervals.next().and_then(Into::into);
            *depths = interval.map_or(NONE, |interval| [interval.near(), interval.far()]);
            hull = hull_of(hull, *depths);
        }
        self.hulls[index] = hull;
    }

    /// The index of the first interval of `tile` = \[column, row\] that holds `depth`. `None` if there is
    /// none, or `depth` is NaN.
    ///
    /// # Panics
    ///
    /// If `tile` is outside the grid.
    #[inline]
    #[track_caller]
    #[must_use]
    pub fn interval_of(&self, tile: [u32; 2], depth: f32) -> Option<u32> {
        let [x, y] = self.index_of(tile);
        let mut intervals = self.depths_of(x, y).iter();
        let holds = |[near, far]: &[f32; 2]| (*near..=*far).contains(&depth);
        intervals.position(holds).map(|interval| interval as u32)
    }

    #[inline]
    #[track_caller]
    fn index_of(&self, tile: [u32; 2]) -> [usize; 2] {
        let [x, y] = tile.map(|n| n as usize);
        let (columns, rows) = (self.columns.len(), self.rows.len());
        assert!(
            x < columns && y < rows,
            "there is no tile ({x}, {y}) of {columns}×{rows}"
        );
        [x, y]
    }

    /// Whether all depth intervals of all tiles are missing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.hulls.iter().all(|depths| *depths == NONE)
    }

    /// The area of the whole grid.
    pub(super) fn all(&self) -> Area {
        Area {
            min: [0; 2],
            max: [self.columns.len(), self.rows.len()],
        }
    }

    /// The slopes x/z of column `x`.
    pub(super) fn across(&self, x: usize) -> [f32; 2] {
        self.columns[x]
    }

    /// The slopes y/z of row `y`.
    pub(super) fn down(&self, y: usize) -> [f32; 2] {
        self.rows[y]
    }

    /// The depth intervals of the tile at column `x` and row `y`.
    #[inline]
    pub(super) fn depths_of(&self, x: usize, y: usize) -> &[[f32; 2]] {
        let first = (y * self.columns.len() + x) * self.intervals;
        &self.depths[first..][..self.intervals]
    }

    /// The depths of all intervals of the tile at column `x` and row `y`.
    pub(super) fn hull(&self, x: usize, y: usize) -> [f32; 2] {
        self.hulls[y * self.columns.len() + x]
    }

    /// The slopes x/z of these columns.
    pub(super) fn columns_of(&self, columns: Range<usize>) -> [f32; 2] {
        self.columns[columns].iter().copied().fold(NONE, hull_of)
    }

    /// The slopes y/z of these rows.
    pub(super) fn rows_of(&self, rows: Range<usize>) -> [f32; 2] {
        self.rows[rows].iter().copied().fold(NONE, hull_of)
    }

    /// The depths of all tiles of `area`.
    pub(super) fn depths_of_area(&self, area: Area) -> [f32; 2] {
        let mut depths = NONE;
        for y in area.min[1]..area.max[1] {
            let first = y * self.columns.len();
            for tile in &self.hulls[first + area.min[0]..first + area.max[0]] {
                depths = hull_of(depths, *tile);
            }
        }
        depths
    }
}

/// Whether `depths` is [`NONE`]. Any other interval ends where it begins, or later.
#[inline(always)]
pub(super) fn is_none([near, far]: [f32; 2]) -> bool {
    near > far
}

/// The smallest range that holds both. Faster than `f32::min` and `f32::max`, since there is no NaN here.
#[inline(always)]
pub(super) fn hull_of([near, far]: [f32; 2], other: [f32; 2]) -> [f32; 2] {
    let near = if other[0] < near { other[0] } else { near };
    let far = if other[1] > far { other[1] } else { far };
    [near, far]
}

/// A rectangle of tiles, from `min` (inclusive) to `max` (exclusive), each \[column, row\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub min: [usize; 2],
    pub max: [usize; 2],
}

impl Area {
    pub fn size(self) -> [usize; 2] {
        [0, 1].map(|i| self.max[i] - self.min[i])
    }

    /// Whether there are more than `longest` tiles in a row or in a column.
    pub fn exceeds(self, longest: usize) -> bool {
        self.size().iter().any(|tiles| *tiles > longest)
    }

    /// The number of tiles.
    pub fn len(self) -> usize {
        let [columns, rows] = self.size();
        columns * rows
    }

    /// Cuts the area into parts of about the same size. Each has at most `longest` tiles in a row and in a column.
    pub fn cut(self, longest: usize) -> Cut {
        let part = self
            .size()
            .map(|tiles| tiles.div_ceil(tiles.div_ceil(longest)));
        Cut { area: self, part }
    }
}

/// An area that is cut into parts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    area: Area,
    /// The size of all parts but the last ones.
    part: [usize; 2],
}

impl Cut {
    /// The number of parts, \[columns, rows\].
    pub fn size(&self) -> [usize; 2] {
        let [columns, rows] = self.area.size();
        [columns.div_ceil(self.part[0]), rows.div_ceil(self.part[1])]
    }

    /// A part, by its column and row.
    #[inline]
    pub fn part(&self, column: usize, row: usize) -> Area {
        let ([width, height], Area { min, max }) = (self.part, self.area);
        let min = [min[0] + column * width, min[1] + row * height];
        Area {
            min,
            max: [(min[0] + width).min(max[0]), (min[1] + height).min(max[1])],
        }
    }
}
