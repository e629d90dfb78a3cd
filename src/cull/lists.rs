use alloc::vec::Vec;
use core::ops::Range;

use fearless_simd::{Simd, SimdBase};

use super::lanes::LANES;
use super::tile_depths::Area;
use crate::base::Error;

/// For each depth interval of each tile, the indices of the lights that may touch it.
///
/// Stored as two arrays, which a GPU can read: [`ranges`](Self::ranges) holds where each list begins and ends
/// in [`lights`](Self::lights). Keeps its memory from frame to frame.
///
/// ```
/// use stochastic_light_culling::{
///     Camera, Culler, DepthInterval, LightBatch, LightLists, Sphere, TileDepths,
///     TileGrid, glam::Vec3,
/// };
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 2.0, 0.1..100.0)?;
/// let grid = TileGrid::new([32, 16], 16)?;
/// let mut tiles = TileDepths::new(&grid, &camera, 1)?;
/// for tile in grid.tiles() {
///     tiles.set(tile, [DepthInterval::new(5.0, 20.0)?]);
/// }
/// // One to the left, one to the right, and one in the middle of a view of two tiles.
/// let mut batch = LightBatch::new();
/// for (light, x) in [(7, -3.0), (8, 3.0), (9, 0.0)] {
///     let sphere = Sphere::new(Vec3::new(x, 0.0, -10.0), 1.0)?;
///     batch.extend(sphere.project(&camera).map(|sphere| (light, sphere)));
/// }
/// let mut lists = LightLists::new();
/// Culler::new().cull(&batch, &tiles, &mut lists)?;
/// assert_eq!(lists.ranges(), [[0, 2], [2, 4]]);
/// assert_eq!(lists.lights(), [7, 9, 8, 9]);
/// assert_eq!(lists.of([1, 0], 0), [8, 9]);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct LightLists {
    columns: usize,
    intervals: usize,
    ranges: Vec<[u32; 2]>,
    /// Longer than `len`, so that whole vectors can be written.
    lights: Vec<u32>,
    len: usize,
    /// Whether `lights` grew since [`finish`](Self::finish).
    has_grown: bool,
}

impl LightLists {
    /// Creates lists for no tiles. Does not allocate.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            columns: 0,
            intervals: 0,
            ranges: Vec::new(),
            lights: Vec::new(),
            len: 0,
            has_grown: false,
        }
    }

    /// The indices of the lights that may touch `tile` = \[column, row\] in its `interval`-th depth interval,
    /// in the order of the batch. Empty for a tile or an interval that does not exist.
    #[inline]
    #[must_use]
    pub fn of(&self, tile: [u32; 2], interval: u32) -> &[u32] {
        &self.lights[self.range_of(tile, interval)]
    }

    /// The range of [`of`](Self::of) in `lights`.
    #[inline]
    pub(super) fn range_of(&self, tile: [u32; 2], interval: u32) -> Range<usize> {
        let ([x, y], interval) = (tile.map(|n| n as usize), interval as usize);
        if x >= self.columns || interval >= self.intervals {
            return 0..0;
        }
        // Of a row that does not exist the slot may overflow. There is none at the largest number either.
        let slot = y.saturating_mul(self.columns).saturating_add(x);
        let slot = slot.saturating_mul(self.intervals).saturating_add(interval);
        if slot < self.ranges.len() {
            self.range(slot)
        } else {
            0..0
        }
    }

    /// The start and end of each list in [`lights`](Self::lights).
    ///
    /// With w tiles in a row and n intervals in a tile, the list of the k-th interval of tile (x, y) is at
    /// index (y w + x) n + k. An empty list is \[0, 0\].
    #[must_use]
    pub fn ranges(&self) -> &[[u32; 2]] {
        &self.ranges
    }

    /// The indices of the lights of all lists, one list after the other, in no particular order of the tiles.
    #[must_use]
    pub fn lights(&self) -> &[u32] {
        &self.lights[..self.len]
    }

    /// The number of lights in all lists together.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether all lists are empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Clears the lists and creates an empty one for each slot of a grid.
    pub(super) fn reset(&mut self, [columns, rows]: [usize; 2], intervals: usize) {
        self.columns = columns;
        self.intervals = intervals;
        self.len = 0;
        self.ranges.clear();
        self.ranges.resize(columns * rows * intervals, [0; 2]);
    }

    /// Appends `lists`, which are of the tiles of `areas`, one after the other, to these, which are of the whole
    /// grid.
    #[cfg(feature = "rayon")]
    pub(super) fn append(&mut self, areas: &[Area], lists: &Self) {
        let start = self.len;
        self.room_for(lists.len)[..lists.len].copy_from_slice(lists.lights());
        self.len += lists.len;
        let window = Window::all(self.columns);
        let mut ranges = &lists.ranges[..];
        for area in areas {
            for y in area.min[1]..area.max[1] {
                let (row, rest) = ranges.split_at(area.size()[0] * self.intervals);
                ranges = rest;
                let first = window.slot([area.min[0], y], self.intervals);
                for (range, moved) in row.iter().zip(&mut self.ranges[first..]) {
                    if range[0] < range[1] {
                        *moved = range.map(|end| (start + end as usize) as u32);
                    }
                }
            }
        }
    }

    /// Appends `lists` to these: each to the slot that `slots` gives, in which nothing is.
    #[cfg(feature = "rayon")]
    pub(super) fn append_at(&mut self, slots: &[usize], lists: &Self) {
        let start = self.len;
        self.room_for(lists.len)[..lists.len].copy_from_slice(lists.lights());
        self.len += lists.len;
        for (slot, range) in slots.iter().zip(&lists.ranges) {
            self.ranges[*slot] = range.map(|end| (start + end as usize) as u32);
        }
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.ranges[..]) + size_of_val(&self.lights[..])
    }

    /// The range of the list of `slot` in `lights`.
    #[inline]
    pub(super) fn range(&self, slot: usize) -> Range<usize> {
        let [start, end] = self.ranges[slot].map(|n| n as usize);
        start..end
    }

    /// The part of `lights` that is not in use, at least `count` long.
    #[inline(always)]
    pub(super) fn room_for(&mut self, count: usize) -> &mut [u32] {
        let end = self.len + count;
        if self.lights.len() < end {
            self.grow(end);
        }
        &mut self.lights[self.len..]
    }

    /// Grows `lights` to at least `len`.
    #[cold]
    fn grow(&mut self, len: usize) {
        self.lights.resize(len.max(2 * self.lights.len()), 0);
        self.has_grown = true;
    }

    /// Reserves room for half as many lights again if the lists grew. So frames after the first seldom allocate.
    pub(super) fn finish(&mut self) {
        let room = self.len + self.len / 2 + LANES;
        if self.has_grown && self.lights.len() < room {
            self.lights.resize(room, 0);
        }
        self.has_grown = false;
    }

    /// Returns an error, and clears the lists, if they hold too many lights for their ranges. `size` is that of the
    /// grid of tiles.
    pub(super) fn check_size(&mut self, size: [u32; 2]) -> Result<(), Error> {
        if u32::try_from(self.len).is_ok() {
            return Ok(());
        }
        self.reset([0; 2], 0);
        Err(Error::Size {
            quantity: "grid of tiles",
            value: size,
            valid: "such that all lists together hold less than 2³² lights",
        })
    }

    /// Appends the list of `slot`: the first `len` of `lights`, which is longer than that by a vector.
    #[inline(always)]
    pub(super) fn append_list<S: Simd>(
        &mut self,
        simd: S,
        slot: usize,
        lights: &[u32],
        len: usize,
    ) {
        let room = self.room_for(len + S::u32s::LEN);
        // A call to copy so few takes longer than this loop. No branch tells an empty list from a short one.
        let mut start = 0;
        loop {
            let vector = S::u32s::from_slice(simd, &lights[start..][..S::u32s::LEN]);
            vector.store_slice(&mut room[start..][..S::u32s::LEN]);
            start += S::u32s::LEN;
            if start >= len {
                break;
            }
        }
        self.set_range(slot, 0..len);
        self.advance(len);
    }

    /// Sets the list of `slot` to this range of the elements that are not in use.
    #[inline(always)]
    pub(super) fn set_range(&mut self, slot: usize, range: Range<usize>) {
        // An empty list is [0, 0], so that it does not depend on the lists before it. Not a branch.
        let if_any = 0_u32.wrapping_sub(u32::from(range.start < range.end));
        let ends = [self.len + range.start, self.len + range.end];
        self.ranges[slot] = [ends[0] as u32 & if_any, ends[1] as u32 & if_any];
    }

    /// Adds the first `count` elements that are not in use to the lists.
    #[inline(always)]
    pub(super) fn advance(&mut self, count: usize) {
        self.len += count;
    }
}

/// Where lists hold the tiles of an area: row by row, the depth intervals of each tile side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// The slot of the first tile.
    first: usize,
    /// The first tile, \[column, row\].
    min: [usize; 2],
    columns: usize,
}

impl Window {
    /// The whole of a grid with so many columns.
    pub fn all(columns: usize) -> Self {
        Self {
            first: 0,
            min: [0; 2],
            columns,
        }
    }

    /// The tiles of `area` from slot `first` on.
    pub fn of(area: Area, first: usize) -> Self {
        Self {
            first,
            min: area.min,
            columns: area.size()[0],
        }
    }

    /// The slot of the first depth interval of a tile: its index in `ranges`.
    pub fn slot(&self, [x, y]: [usize; 2], intervals: usize) -> usize {
        self.first + ((y - self.min[1]) * self.columns + x - self.min[0]) * intervals
    }
}

/// Equal if `ranges` and `lights` are.
impl PartialEq for LightLists {
    fn eq(&self, other: &Self) -> bool {
        let shape = |lists: &Self| [lists.columns, lists.intervals];
        shape(self) == shape(other)
            && self.ranges == other.ranges
            && self.lights() == other.lights()
    }
}
