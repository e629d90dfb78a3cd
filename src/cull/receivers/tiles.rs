use alloc::vec::Vec;

use crate::base::Error;
use crate::lobe::LobeFamily;
use crate::view::{ReceiverCluster, TileGrid};

/// Tiles of a block, in each direction.
const BLOCK: usize = 2;
/// Upper limit of the clusters of all tiles, so that their indices fit a `u32`.
const MAX_CLUSTERS: u64 = 1 << 27;

/// The receivers of each depth interval of each tile, and of blocks of tiles.
///
/// ```
/// use stochastic_light_culling::{Blind, ReceiverCluster, TileGrid, TileReceivers, glam::Vec3};
///
/// let grid = TileGrid::new([64, 32], 16)?;
/// let mut tiles = TileReceivers::new(&grid, 1)?;
/// // A floor. In an engine: the positions and lobes of a G-buffer.
/// tiles.fill(|tile, _| {
///     let pixels = grid.pixels(tile).pixels();
///     ReceiverCluster::of(pixels.map(|[x, y]| (Vec3::new(x as f32, y as f32, 0.0), Blind)))
/// });
/// let corner = tiles.of([3, 1], 0).expect("has receivers");
/// assert_eq!(corner.center(), Vec3::new(55.5, 23.5, 0.0));
/// assert!(tiles.of([4, 0], 0).is_none());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct TileReceivers<F> {
    /// From the depth intervals of the tiles to the whole image.
    levels: Vec<Level<F>>,
    intervals: usize,
}

/// The clusters of the parts of the image of one size.
#[derive(Clone, Debug)]
pub(super) struct Level<F> {
    /// \[columns, rows\]
    size: [usize; 2],
    /// Row by row, those of a tile side by side.
    clusters: Vec<Option<ReceiverCluster<F>>>,
}

/// Where a cluster is: its level, and its index there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub level: usize,
    pub index: usize,
}

impl<F: LobeFamily> TileReceivers<F> {
    /// Creates the tiles of `grid`, each with room for `intervals` depth intervals, without any receivers.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if `intervals` is zero, or if there are more than 2²⁷ intervals in all tiles together.
    pub fn new(grid: &TileGrid, intervals: u32) -> Result<Self, Error> {
        let mut size = grid.size().map(|tiles| tiles as usize);
        let slots = size[0] as u64 * size[1] as u64;
        let slots = slots.saturating_mul(u64::from(intervals));
        if slots == 0 || slots > MAX_CLUSTERS {
            return Err(Error::Size {
                quantity: "grid of tiles",
                value: grid.size(),
                valid: "with 1 to 2²⁷ depth intervals in all",
            });
        }
        let intervals = intervals as usize;
        let mut levels = Vec::new();
        let mut add = |size: [usize; 2], of_each: usize| {
            let count = size[0] * size[1] * of_each;
            let clusters = (0..count).map(|_| None).collect();
            levels.push(Level { size, clusters });
        };
        add(size, intervals);
        if intervals > 1 {
            add(size, 1);
        }
        // A single tile is a block.
        let mut is_whole = intervals > 1 && size == [1; 2];
        while !is_whole {
            size = size.map(|parts| parts.div_ceil(BLOCK));
            add(size, 1);
            is_whole = size == [1; 2];
        }
        Ok(Self { levels, intervals })
    }

    /// Sets the receivers of all depth intervals of all tiles, and merges them to blocks. Does not allocate.
    ///
    /// `receivers` gives those of a tile = \[column, row\] and an interval; `None` is an interval without
    /// receivers, which needs no light.
    pub fn fill(&mut self, mut receivers: impl FnMut([u32; 2], u32) -> Option<ReceiverCluster<F>>) {
        let intervals = self.intervals;
        let Level { size, clusters } = &mut self.levels[0];
        for (slot, cluster) in clusters.iter_mut().enumerate() {
            let tile = slot / intervals;
            let tile = [tile % size[0], tile / size[0]].map(|n| n as u32);
            *cluster = receivers(tile, (slot % intervals) as u32);
        }
        self.merge();
    }

    /// Merges the clusters of each level to those of the next.
    fn merge(&mut self) {
        for level in 1..self.levels.len() {
            let (parts, blocks) = self.levels.split_at_mut(level);
            let parts = &parts[level - 1];
            let columns = blocks[0].size[0];
            let intervals = self.intervals;
            for (index, block) in blocks[0].clusters.iter_mut().enumerate() {
                let indices = parts_of(level, [index % columns, index / columns], parts, intervals);
                *block = ReceiverCluster::union(indices.filter_map(|part| parts.clusters[part]));
            }
        }
    }

    /// The receivers of a depth interval of `tile` = \[column, row\]. `None` if it has none, or if it does not
    /// exist.
    #[must_use]
    pub fn of(&self, tile: [u32; 2], interval: u32) -> Option<&ReceiverCluster<F>> {
        let ([x, y], interval) = (tile.map(|n| n as usize), interval as usize);
        let Level { size, clusters } = &self.levels[0];
        if x >= size[0] || y >= size[1] || interval >= self.intervals {
            return None;
        }
        clusters[(y * size[0] + x) * self.intervals + interval].as_ref()
    }

    /// The number of tiles, \[columns, rows\].
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.levels[0].size.map(|n| n as u32)
    }

    /// The number of depth intervals for which each tile has room.
    #[must_use]
    pub fn intervals(&self) -> u32 {
        self.intervals as u32
    }

    /// The number of levels.
    pub(super) fn depth(&self) -> usize {
        self.levels.len()
    }

    /// The whole image.
    pub(super) fn root(&self) -> Node {
        Node {
            level: self.levels.len() - 1,
            index: 0,
        }
    }

    /// The receivers of a node.
    pub(super) fn cluster(&self, node: Node) -> Option<&ReceiverCluster<F>> {
        self.levels[node.level].clusters[node.index].as_ref()
    }

    /// The parts of a node that have receivers.
    pub(super) fn parts(&self, node: Node) -> impl Iterator<Item = Node> {
        let level = node.level;
        let columns = self.levels[level].size[0];
        let parts = &self.levels[level - 1];
        let place = [node.index % columns, node.index / columns];
        let indices = parts_of(level, place, parts, self.intervals);
        let filled = indices.filter(|index| parts.clusters[*index].is_some());
        filled.map(move |index| Node {
            level: level - 1,
            index,
        })
    }
}

/// The indices of the parts of a block: the depth intervals of a tile, or a square of smaller blocks.
fn parts_of<F>(
    level: usize,
    [x, y]: [usize; 2],
    parts: &Level<F>,
    intervals: usize,
) -> impl Iterator<Item = usize> + Clone + use<F> {
    let [columns, rows] = parts.size;
    let are_intervals = level == 1 && intervals > 1;
    let first = (y * columns + x) * intervals;
    let of_tile = (first..first + intervals).take(if are_intervals { intervals } else { 0 });
    let side = if are_intervals { 0 } else { BLOCK };
    let [across, down] =
        [(x, columns), (y, rows)].map(|(first, end)| (BLOCK * first..end).take(side));
    let of_block = down.flat_map(move |y| across.clone().map(move |x| y * columns + x));
    of_tile.chain(of_block)
}
