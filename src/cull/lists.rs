use alloc::vec::Vec;

/// For each tile and depth interval the indices of the lights that may touch it.
///
/// Two arrays, as a GPU reads them: [`ranges`](Self::ranges) says where each list begins and ends in
/// [`lights`](Self::lights). Keeps its memory from frame to frame.
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
    /// Longer than what is in use, so that whole vectors can be written.
    lights: Vec<u32>,
    len: usize,
    /// Whether `lights` became longer since the lists were empty.
    has_grown: bool,
}

impl LightLists {
    /// Lists of no tiles.
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

    /// The lights that may touch `tile` in its `interval`-th depth interval, in the order of their batch.
    /// Empty for a tile or an interval that does not exist.
    #[must_use]
    pub fn of(&self, tile: [u32; 2], interval: u32) -> &[u32] {
        let ([x, y], interval) = (tile.map(|n| n as usize), interval as usize);
        if x >= self.columns || interval >= self.intervals {
            return &[];
        }
        // Before the place is reckoned, which could overflow.
        if y >= self.ranges.len() / (self.columns * self.intervals) {
            return &[];
        }
        let [start, end] = self.ranges[self.slot([x, y]) + interval].map(|n| n as usize);
        &self.lights[start..end]
    }

    /// Where the list of each depth interval of each tile, row by row, begins and ends in
    /// [`lights`](Self::lights): the `k`-th of n intervals of tile (x, y), with `w` tiles across, is at
    /// `(y w + x) n + k`.
    #[must_use]
    pub fn ranges(&self) -> &[[u32; 2]] {
        &self.ranges
    }

    /// The lists, one after the other, in no particular order of the tiles.
    #[must_use]
    pub fn lights(&self) -> &[u32] {
        &self.lights[..self.len]
    }

    /// How many lights all lists hold together.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether all lists are empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Empties the lists and makes one for each slot of a grid.
    pub(super) fn reset(&mut self, [columns, rows]: [usize; 2], intervals: usize) {
        self.columns = columns;
        self.intervals = intervals;
        self.len = 0;
        self.ranges.clear();
        self.ranges.resize(columns * rows * intervals, [0; 2]);
    }

    /// Appends the lists of `area` alone to these, which are of a grid.
    #[cfg(feature = "rayon")]
    pub(super) fn append(&mut self, area: super::tile_depths::Area, lists: &Self) {
        let start = self.len;
        self.room_for(lists.len)[..lists.len].copy_from_slice(lists.lights());
        self.take(lists.len);
        for (y, row) in lists
            .ranges
            .chunks(lists.columns * lists.intervals)
            .enumerate()
        {
            let first = self.slot([area.min[0], area.min[1] + y]);
            for (range, moved) in row.iter().zip(&mut self.ranges[first..]) {
                if range[0] < range[1] {
                    *moved = range.map(|end| (start + end as usize) as u32);
                }
            }
        }
    }

    /// Where the ranges of a tile begin.
    pub(super) fn slot(&self, [x, y]: [usize; 2]) -> usize {
        (y * self.columns + x) * self.intervals
    }

    /// The places not yet in use, at least `count` of them.
    pub(super) fn room_for(&mut self, count: usize) -> &mut [u32] {
        let end = self.len + count;
        if self.lights.len() < end {
            self.lights.resize(end.max(2 * self.lights.len()), 0);
            self.has_grown = true;
        }
        &mut self.lights[self.len..]
    }

    /// Leaves room for frames with half as many lights again, if there was none for this one.
    pub(super) fn finish(&mut self) {
        if self.has_grown {
            self.room_for(self.len / 2);
            self.has_grown = false;
        }
    }

    /// Takes the first `count` of the places not yet in use.
    pub(super) fn take(&mut self, count: usize) {
        self.len += count;
    }

    /// Says that the list of `slot` begins at `start` and ends here. Empty lists are all at the beginning,
    /// whether they were looked into or not.
    pub(super) fn end(&mut self, slot: usize, start: usize) {
        let range = [start as u32, self.len as u32];
        self.ranges[slot] = if start < self.len { range } else { [0; 2] };
    }
}

/// Equal if the same lights are in the same places.
impl PartialEq for LightLists {
    fn eq(&self, other: &Self) -> bool {
        let of = |lists: &Self| [lists.columns, lists.intervals];
        of(self) == of(other) && self.ranges == other.ranges && self.lights() == other.lights()
    }
}
