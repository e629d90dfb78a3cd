use alloc::vec::Vec;

use crate::base::Error;
use crate::touch::TileBounds;
use crate::view::{Camera, DepthInterval, TileGrid, TileRectangle};

/// A grid of tiles and the depths that each of them sees, in one interval or in several.
///
/// For *tiled* culling each tile has its own intervals, such as the two of
/// [`modified_half_z`](DepthInterval::modified_half_z). For *clustered* culling all tiles share their
/// slices, such as [`exponential_slices`](DepthInterval::exponential_slices), of which those without
/// surfaces may be left out.
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
    /// The slopes of each column, and of each row.
    columns: Vec<[f32; 2]>,
    rows: Vec<[f32; 2]>,
    /// Tile by tile, row by row.
    depths: Vec<[f32; 2]>,
    /// Around all of a tile's.
    around: Vec<[f32; 2]>,
}

/// Tiles in a row or a column.
const MOST_IN_A_ROW: u32 = 1 << 16;
/// Depth intervals of all tiles together: within what a vector can hold where pointers have 32 bits.
const MOST_SLOTS: u64 = 1 << 27;

/// No interval: it ends before it begins.
pub(super) const NONE: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

impl TileDepths {
    /// The tiles of `grid` that `camera` sees, each with room for `intervals` depth intervals, all of
    /// which are missing at first.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if there are no intervals, more than 2¹⁶ tiles in a row or a column, or more than 2²⁷
    /// intervals in all tiles together. That many take 2 GiB at most.
    pub fn new(grid: &TileGrid, camera: &Camera, intervals: u32) -> Result<Self, Error> {
        Self::from_rectangles(grid.size(), intervals, |tile| camera.tile(grid, tile))
    }

    /// A grid of `size` = \[columns, rows\] tiles of which `rectangle` says what they cover.
    ///
    /// Only the tiles of the first row and of the first column are asked for: those of a column share their
    /// slopes across, those of a row their slopes down.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if there are no tiles or no intervals, or more than [`new`](Self::new) takes.
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
            around: Vec::new(),
        };
        tiles.set_rectangles(size, rectangle)?;
        Ok(tiles)
    }

    /// Renews the tiles for a frame with another grid or camera: jitter, zoom, dynamic resolution. All depth
    /// intervals are missing afterwards. Allocates nothing unless there are more tiles than ever before.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); the tiles are then unchanged.
    pub fn set_view(&mut self, grid: &TileGrid, camera: &Camera) -> Result<(), Error> {
        self.set_rectangles(grid.size(), |tile| camera.tile(grid, tile))
    }

    /// [`set_view`](Self::set_view) for tiles of which `rectangle` says what they cover, as
    /// [`from_rectangles`](Self::from_rectangles) has it.
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
        // The product of two fits, but not of three.
        let slots = tiles.saturating_mul(self.intervals as u64);
        if slots == 0 || slots > MOST_SLOTS || size[0].max(size[1]) > MOST_IN_A_ROW {
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
        self.around.clear();
        self.around.resize(tiles as usize, NONE);
        Ok(())
    }

    /// From the least to the greatest slope x/z of each column.
    #[must_use]
    pub fn columns(&self) -> &[[f32; 2]] {
        &self.columns
    }

    /// From the least to the greatest slope y/z of each row.
    #[must_use]
    pub fn rows(&self) -> &[[f32; 2]] {
        &self.rows
    }

    /// The near and far depth of each interval of each tile, in the order of
    /// [`LightLists::ranges`](crate::LightLists::ranges); \[∞, −∞\] of one that is missing.
    #[must_use]
    pub fn depths(&self) -> &[[f32; 2]] {
        &self.depths
    }

    /// How many tiles there are, across and down.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.columns.len() as u32, self.rows.len() as u32]
    }

    /// How many depth intervals a tile has room for.
    #[must_use]
    pub fn intervals(&self) -> u32 {
        self.intervals as u32
    }

    /// Gives `tile` these depth intervals, in their order, and no others; `None` is one without
    /// surfaces, which no light touches. Intervals beyond [`intervals`](Self::intervals) are left out.
    ///
    /// # Panics
    ///
    /// If there is no such tile.
    #[track_caller]
    pub fn set(
        &mut self,
        tile: [u32; 2],
        intervals: impl IntoIterator<Item = impl Into<Option<DepthInterval>>>,
    ) {
        let [x, y] = self.index_of(tile);
        let index = y * self.columns.len() + x;
        let first = index * self.intervals;
        let mut around = NONE;
        let mut intervals = intervals.into_iter();
        for depths in &mut self.depths[first..][..self.intervals] {
            let interval: Option<DepthInterval> = intervals.next().and_then(Into::into);
            *depths = interval.map_or(NONE, |interval| [interval.near(), interval.far()]);
            around = joined(around, *depths);
        }
        self.around[index] = around;
    }

    /// Which of the intervals of `tile` holds `depth`, the first of them if there are several.
    ///
    /// # Panics
    ///
    /// If there is no such tile.
    #[track_caller]
    #[must_use]
    pub fn interval_of(&self, tile: [u32; 2], depth: f32) -> Option<u32> {
        let [x, y] = self.index_of(tile);
        let mut intervals = self.depths_of(x, y).iter();
        let holds = |[near, far]: &[f32; 2]| (*near..=*far).contains(&depth);
        intervals.position(holds).map(|interval| interval as u32)
    }

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

    /// Whether no interval of any tile has surfaces.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.around.iter().all(|depths| *depths == NONE)
    }

    pub(super) fn all(&self) -> Area {
        Area {
            min: [0; 2],
            max: [self.columns.len(), self.rows.len()],
        }
    }

    pub(super) fn across(&self, x: usize) -> [f32; 2] {
        self.columns[x]
    }

    pub(super) fn down(&self, y: usize) -> [f32; 2] {
        self.rows[y]
    }

    /// The depth intervals of the tile at column `x` and row `y`.
    pub(super) fn depths_of(&self, x: usize, y: usize) -> &[[f32; 2]] {
        let first = (y * self.columns.len() + x) * self.intervals;
        &self.depths[first..][..self.intervals]
    }

    /// The slopes across and down, and the depths, that hold those of all tiles of `area`, if there are
    /// any depths.
    pub(super) fn around(&self, area: Area) -> Option<TileBounds<f32>> {
        let [columns, rows] = [0, 1].map(|i| area.min[i]..area.max[i]);
        let mut depths = NONE;
        for y in rows.clone() {
            let first = y * self.columns.len();
            let row = &self.around[first + columns.start..first + columns.end];
            depths = row.iter().copied().fold(depths, joined);
        }
        let across = self.columns[columns].iter().copied();
        let down = self.rows[rows].iter().copied();
        (depths != NONE).then(|| TileBounds {
            across: across.fold(NONE, joined),
            down: down.fold(NONE, joined),
            depths,
        })
    }
}

/// The range that holds both. There is no NaN here, which `f32::min` would take care of.
fn joined(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [
        if b[0] < a[0] { b[0] } else { a[0] },
        if b[1] > a[1] { b[1] } else { a[1] },
    ]
}

/// A block of tiles: from `min`, included, to `max`, not included.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub min: [usize; 2],
    pub max: [usize; 2],
}

impl Area {
    pub fn size(self) -> [usize; 2] {
        [0, 1].map(|i| self.max[i] - self.min[i])
    }

    pub fn is_all_of(self, tiles: &TileDepths) -> bool {
        self.size() == tiles.all().size()
    }

    /// How many times it is cut until its parts have few tiles.
    pub fn levels(self) -> usize {
        let mut levels = 0;
        let mut size = self.size();
        while size.iter().any(|n| *n > FEW_TILES) {
            levels += 1;
            size = size.map(part_of);
        }
        levels
    }

    /// Its parts, row by row.
    pub fn parts(self) -> impl Iterator<Item = Self> {
        let part = self.size().map(part_of);
        let cuts = move |i: usize| {
            (self.min[i]..self.max[i])
                .step_by(part[i])
                .map(move |min| [min, (min + part[i]).min(self.max[i])])
        };
        cuts(1).flat_map(move |[top, bottom]| {
            cuts(0).map(move |[left, right]| Self {
                min: [left, top],
                max: [right, bottom],
            })
        })
    }
}

/// A block of no more tiles than this, across and down, is not cut into smaller blocks.
const FEW_TILES: usize = 5;

/// How long the parts of `tiles` tiles in a row are: a third, as nearly as may be, but not too few.
fn part_of(tiles: usize) -> usize {
    tiles.div_ceil(tiles.div_ceil(FEW_TILES).min(3))
}
