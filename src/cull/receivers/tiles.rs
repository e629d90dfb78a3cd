use alloc::vec::Vec;

#[cfg(feature = "rayon")]
use rayon::prelude::*;

use crate::base::Error;
use crate::light::{Roulette, Vpl};
use crate::lobe::{Lobe, LobeFamily};
use crate::view::{ReceiverCluster, TileGrid};

/// Tiles of a block, in each direction.
const BLOCK: usize = 2;
/// Upper limit of the clusters of all parts of tiles, so that their indices fit a `u32`.
const MAX_CLUSTERS: u64 = 1 << 27;

/// The receivers of each depth interval of each tile, and of blocks of tiles.
///
/// A tile may have parts: a light is then in its list if it may light one of them. Lists are shorter, since the
/// receivers of a part are more alike. The larger a tile and the glossier its receivers, the more it pays.
///
/// ```
/// use stochastic_light_culling::{Blind, ReceiverCluster, TileGrid, TileReceivers, glam::Vec3};
///
/// // Tiles of 16×16 pixels, of which each has 2×2 parts.
/// let grid = TileGrid::new([64, 32], 16)?;
/// let mut tiles = TileReceivers::new(&grid, 2, 1)?;
/// // A floor. In an engine: the positions and lobes of a G-buffer.
/// let parts = tiles.parts_grid();
/// tiles.fill(|part, _| {
///     let pixels = parts.pixels(part).pixels();
///     ReceiverCluster::of(pixels.map(|[x, y]| (Vec3::new(x as f32, y as f32, 0.0), Blind)))
/// });
/// let corner = tiles.of([3, 1], 0).expect("has receivers");
/// assert_eq!(corner.center(), Vec3::new(55.5, 23.5, 0.0));
/// assert!(tiles.of([4, 0], 0).is_none());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct TileReceivers<F> {
    /// From the depth intervals of the parts of tiles to the whole image.
    levels: Vec<Level<F>>,
    intervals: usize,
    /// The parts of all tiles.
    parts_grid: TileGrid,
}

/// The clusters of the pieces of the image of one size.
#[derive(Clone, Debug)]
struct Level<F> {
    /// \[columns, rows\]
    size: [usize; 2],
    /// What the pieces are divided into: those of the level before.
    division: Division,
    /// Row by row, those of a tile side by side.
    clusters: Vec<Option<ReceiverCluster<F>>>,
}

/// How the pieces of a level are divided.
#[derive(Clone, Copy, Debug)]
enum Division {
    /// Not at all.
    Undivided,
    /// Depth intervals of tiles, into those of the parts of tiles. With the parts in each direction.
    Parts(usize),
    /// Tiles into their depth intervals.
    Intervals,
    /// Blocks into smaller ones, or into tiles.
    Blocks,
}

/// Where a cluster is: its level, and its index there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Node {
    pub level: usize,
    pub index: usize,
}

impl<F: LobeFamily> TileReceivers<F> {
    /// Creates the tiles of `grid`, each with `parts`² parts and room for `intervals` depth intervals, without any
    /// receivers.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if `parts` is zero or does not divide the size of a tile in pixels, if `intervals` is zero, or
    /// if there are more than 2²⁷ intervals in all parts together.
    pub fn new(grid: &TileGrid, parts: u32, intervals: u32) -> Result<Self, Error> {
        let part_size = grid.tile_size().checked_div(parts).unwrap_or(0);
        if part_size * parts != grid.tile_size() || parts == 0 {
            return Err(Error::Size {
                quantity: "parts of a tile",
                value: [parts; 2],
                valid: "such that a part has a whole number of pixels",
            });
        }
        let parts_grid = TileGrid::new(grid.image_size(), part_size)?;
        let slots = parts_grid.size().map(u64::from).iter().product::<u64>();
        let slots = slots.saturating_mul(u64::from(intervals));
        if slots == 0 || slots > MAX_CLUSTERS {
            return Err(Error::Size {
                quantity: "grid of tiles",
                value: grid.size(),
                valid: "with 1 to 2²⁷ depth intervals in all parts of tiles",
            });
        }
        let (parts, intervals) = (parts as usize, intervals as usize);
        let mut levels = Vec::new();
        let mut add = |size: [usize; 2], of_each: usize, division| {
            let count = size[0] * size[1] * of_each;
            let clusters = (0..count).map(|_| None).collect();
            levels.push(Level {
                size,
                division,
                clusters,
            });
        };
        let mut size = grid.size().map(|tiles| tiles as usize);
        if parts > 1 {
            let parts_size = parts_grid.size().map(|parts| parts as usize);
            add(parts_size, intervals, Division::Undivided);
            add(size, intervals, Division::Parts(parts));
        } else {
            add(size, intervals, Division::Undivided);
        }
        if intervals > 1 {
            add(size, 1, Division::Intervals);
        }
        // A single tile is a block, unless it is divided already.
        let mut is_whole = intervals > 1 && size == [1; 2];
        while !is_whole {
            size = size.map(|parts| parts.div_ceil(BLOCK));
            add(size, 1, Division::Blocks);
            is_whole = size == [1; 2];
        }
        Ok(Self {
            levels,
            intervals,
            parts_grid,
        })
    }

    /// The grid of the parts of all tiles: that of the tiles if they are not divided.
    #[must_use]
    pub fn parts_grid(&self) -> TileGrid {
        self.parts_grid
    }

    /// Sets the receivers of all depth intervals of all parts of tiles, and merges them to tiles and blocks. Does not
    /// allocate.
    ///
    /// `receivers` gives those of a part = \[column, row\] of [`parts_grid`](Self::parts_grid) and an interval;
    /// `None` is an interval without receivers, which needs no light.
    pub fn fill(&mut self, mut receivers: impl FnMut([u32; 2], u32) -> Option<ReceiverCluster<F>>) {
        let (intervals, Level { size, clusters, .. }) = (self.intervals, &mut self.levels[0]);
        for (slot, cluster) in clusters.iter_mut().enumerate() {
            let (part, interval) = place_of(slot, size[0], intervals);
            *cluster = receivers(part, interval);
        }
        self.merge();
    }

    /// Does what [`fill`](Self::fill) does on the threads of rayon's current pool.
    #[cfg(feature = "rayon")]
    pub fn fill_in_parallel(
        &mut self,
        receivers: impl Fn([u32; 2], u32) -> Option<ReceiverCluster<F>> + Sync,
    ) {
        let (intervals, Level { size, clusters, .. }) = (self.intervals, &mut self.levels[0]);
        let clusters = clusters.par_iter_mut().enumerate();
        clusters.for_each(|(slot, cluster)| {
            let (part, interval) = place_of(slot, size[0], intervals);
            *cluster = receivers(part, interval);
        });
        self.merge();
    }

    /// Merges the clusters of each level to those of the next.
    fn merge(&mut self) {
        let intervals = self.intervals;
        for level in 1..self.levels.len() {
            let (lesser, greater) = self.levels.split_at_mut(level);
            let (
                pieces,
                Level {
                    size,
                    division,
                    clusters,
                },
            ) = (&lesser[level - 1], &mut greater[0]);
            for (index, cluster) in clusters.iter_mut().enumerate() {
                let indices = division.indices(index, *size, pieces.size, intervals);
                *cluster = ReceiverCluster::union(indices.filter_map(|i| pieces.clusters[i]));
            }
        }
    }

    /// The receivers of a depth interval of `tile` = \[column, row\]. `None` if it has none, or if it does not
    /// exist.
    #[must_use]
    pub fn of(&self, tile: [u32; 2], interval: u32) -> Option<&ReceiverCluster<F>> {
        self.cluster(self.node_of(tile, interval)?)
    }

    /// An upper bound of c/δ at all receivers of a depth interval of `tile`, by its parts:
    /// [`ReceiverCluster::greatest_radiance`]. Zero if it has none, or if it does not exist.
    #[must_use]
    pub fn greatest_radiance<L: Lobe>(
        &self,
        tile: [u32; 2],
        interval: u32,
        light: &Vpl<L>,
        roulette: &Roulette,
        least_distance_squared: f32,
    ) -> f32 {
        let Some(node) = self.node_of(tile, interval) else {
            return 0.0;
        };
        let of_parts = self
            .undivided(node)
            .map(|cluster| cluster.greatest_radiance(light, roulette, least_distance_squared));
        of_parts.fold(0.0, f32::max)
    }

    /// The number of tiles, \[columns, rows\].
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.levels[self.level_of_tiles()].size.map(|n| n as u32)
    }

    /// The number of depth intervals for which each tile has room.
    #[must_use]
    pub fn intervals(&self) -> u32 {
        self.intervals as u32
    }

    /// The level of the depth intervals of tiles, which have lists.
    pub(super) fn level_of_tiles(&self) -> usize {
        match self.levels[1].division {
            Division::Parts(_) => 1,
            _ => 0,
        }
    }

    /// The number of levels above that of the tiles.
    pub(super) fn levels_of_blocks(&self) -> usize {
        self.levels.len() - 1 - self.level_of_tiles()
    }

    /// The nodes of the greatest pieces of the image of which there are at least `count`, but that are blocks.
    #[cfg(feature = "rayon")]
    pub(super) fn blocks(&self, count: usize) -> impl Iterator<Item = Node> {
        let blocks = self.level_of_tiles() + 1..self.levels.len();
        let is_enough = |level: &usize| self.levels[*level].clusters.len() >= count;
        let level = blocks.clone().rev().find(is_enough).unwrap_or(blocks.start);
        (0..self.levels[level].clusters.len()).map(move |index| Node { level, index })
    }

    /// The number of depth intervals of tiles in a node that is a block, or more.
    #[cfg(feature = "rayon")]
    pub(super) fn most_tiles(&self, node: Node) -> usize {
        let divisions = self.levels[self.level_of_tiles() + 1..=node.level].iter();
        let pieces = divisions.map(|level| match level.division {
            Division::Intervals => self.intervals,
            _ => BLOCK * BLOCK,
        });
        pieces.product()
    }

    /// The whole image.
    pub(super) fn root(&self) -> Node {
        Node {
            level: self.levels.len() - 1,
            index: 0,
        }
    }

    fn node_of(&self, tile: [u32; 2], interval: u32) -> Option<Node> {
        let ([x, y], interval) = (tile.map(|n| n as usize), interval as usize);
        let level = self.level_of_tiles();
        let [columns, rows] = self.levels[level].size;
        (x < columns && y < rows && interval < self.intervals).then(|| Node {
            level,
            index: (y * columns + x) * self.intervals + interval,
        })
    }

    /// The receivers of a node.
    pub(super) fn cluster(&self, node: Node) -> Option<&ReceiverCluster<F>> {
        self.levels[node.level].clusters[node.index].as_ref()
    }

    /// The pieces of a node that have receivers.
    pub(super) fn pieces(&self, node: Node) -> impl Iterator<Item = Node> {
        let Level { size, division, .. } = &self.levels[node.level];
        let level = node.level - 1;
        let pieces = &self.levels[level];
        let indices = division.indices(node.index, *size, pieces.size, self.intervals);
        let filled = indices.filter(|index| pieces.clusters[*index].is_some());
        filled.map(move |index| Node { level, index })
    }

    /// The receivers of the parts of a depth interval of a tile: its own, if it is not divided.
    pub(super) fn undivided(&self, node: Node) -> impl Iterator<Item = &ReceiverCluster<F>> {
        let parts = (node.level > 0).then(|| self.pieces(node));
        let itself = if parts.is_none() { Some(node) } else { None };
        let nodes = itself.into_iter().chain(parts.into_iter().flatten());
        nodes.filter_map(|node| self.cluster(node))
    }
}

/// The part of a tile, and the interval, whose receivers are in a slot.
fn place_of(slot: usize, columns: usize, intervals: usize) -> ([u32; 2], u32) {
    let (part, interval) = (slot / intervals, slot % intervals);
    let part = [part % columns, part / columns].map(|n| n as u32);
    (part, interval as u32)
}

impl Division {
    /// The indices of the pieces of what has this index, in levels of these sizes.
    fn indices(
        self,
        index: usize,
        [columns, _]: [usize; 2],
        size: [usize; 2],
        intervals: usize,
    ) -> impl Iterator<Item = usize> + Clone {
        // A square of pieces, of which `step` are side by side; the first of them, or as many as `step`.
        let (place, interval, side, step, taken) = match self {
            Self::Undivided => (0, 0, 0, 1, 0),
            Self::Parts(side) => (index / intervals, index % intervals, side, intervals, 1),
            Self::Intervals => (index, 0, 1, intervals, intervals),
            Self::Blocks => (index, 0, BLOCK, 1, 1),
        };
        let place = [place % columns, place / columns];
        let [across, down] = [0, 1].map(|i| place[i] * side..((place[i] + 1) * side).min(size[i]));
        let squares = down.flat_map(move |y| across.clone().map(move |x| y * size[0] + x));
        squares.flat_map(move |square| {
            let first = square * step + interval;
            first..first + taken
        })
    }
}
