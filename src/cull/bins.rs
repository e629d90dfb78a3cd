//! The lights of each block of a grid that has many.
//!
//! A light is written to the blocks of a rectangle that holds its slopes, if they have a depth that it reaches.
//! That takes one look at each light, however many blocks there are.
//!
//! # No block is missed
//!
//! A *cell* is an interval of slopes, and all cells of an axis have the same length. The cell of a slope is a
//! monotone function, rounding included. A light with the least slope l touches no block whose greatest slope g
//! has a cell before that of l, since then g < l. So tables of the blocks for each cell lose no light, whatever
//! the lengths and the order of the columns, and need no margin.

use alloc::vec::Vec;
use core::ops::Range;

use fearless_simd::{Simd, SimdBase, SimdCvtTruncate, SimdMask};

use super::batch::grow;
use super::block::BLOCK;
use super::lanes::{LANES, Lanes, load, mask_of_first, splat_bounds, store};
use super::tile_depths::{Area, NONE, hull_of};
use super::{LightBatch, TileDepths};
use crate::num::Real;
use crate::touch::BoxTest;
use crate::view::{ViewBounds, meet};

/// The blocks of a grid, with what is needed to find those of a light.
#[derive(Clone, Debug, Default)]
pub(super) struct Blocks {
    /// The tiles of each block, row by row.
    pub areas: Vec<Area>,
    /// The depths of the tiles of each block.
    depths: Vec<[f32; 2]>,
    /// For each window, the depths of the blocks that a light may touch whose least slopes are in its first cells
    /// and whose greatest slopes are in no later cells than those of the next window.
    windows: Vec<[f32; 2]>,
    columns: Axis,
    rows: Axis,
    /// The depths of all tiles.
    hull: [f32; 2],
}

impl Blocks {
    /// Replaces the blocks by those of `tiles`.
    pub fn set(&mut self, tiles: &TileDepths) {
        let all = tiles.all();
        self.areas.clear();
        let cut = all.cut(BLOCK);
        let [columns, rows] = cut.size();
        let row = |row| (0..columns).map(move |column| cut.part(column, row));
        self.areas.extend((0..rows).flat_map(row));
        self.depths.clear();
        let depths_of = |area: &Area| tiles.depths_of_area(*area);
        self.depths.extend(self.areas.iter().map(depths_of));
        self.hull = self.depths.iter().copied().fold(NONE, hull_of);
        let column = |area: &Area| tiles.columns_of(area.min[0]..area.max[0]);
        let row = |area: &Area| tiles.rows_of(area.min[1]..area.max[1]);
        self.columns
            .set(self.areas.iter().take(columns).map(column));
        self.rows.set(self.areas.iter().step_by(columns).map(row));
        self.windows.clear();
        for row in 0..self.rows.windows() {
            for column in 0..self.columns.windows() {
                let (columns, rows) = (self.columns.of_window(column), self.rows.of_window(row));
                let mut hull = NONE;
                for row in rows {
                    let first = row * self.columns.len;
                    // A window without columns begins anywhere.
                    let columns = first + columns.start..first + columns.end;
                    for depths in self.depths.get(columns).unwrap_or_default() {
                        hull = hull_of(hull, *depths);
                    }
                }
                self.windows.push(hull);
            }
        }
    }
}

/// The columns or the rows of blocks.
#[derive(Clone, Debug, Default)]
struct Axis {
    len: usize,
    /// The least and the greatest slope of all.
    hull: [f32; 2],
    cells_per_slope: f32,
    /// For each cell, the blocks that lights with their least slope in it may touch.
    of_least: Vec<Span>,
    /// For each cell, the blocks that lights with their greatest slope in it may touch.
    of_greatest: Vec<Span>,
    /// The slopes of each block.
    slopes: Vec<[f32; 2]>,
}

/// The first and the last of a range of blocks. Reversed if there are none.
type Span = [u16; 2];

/// The number of cells for each block. With more, fewer lights are written to blocks beside their own.
const CELLS_PER_BLOCK: usize = 8;
/// The number of cells in a window is two to this power.
const WINDOW_SHIFT: u32 = 2;

impl Axis {
    fn set(&mut self, slopes: impl Iterator<Item = [f32; 2]>) {
        self.slopes.clear();
        self.slopes.extend(slopes);
        self.len = self.slopes.len();
        let cells = self.len * CELLS_PER_BLOCK;
        self.hull = self.slopes.iter().copied().fold(NONE, hull_of);
        let [least, greatest] = self.hull;
        let per_slope = cells as f32 / (greatest - least);
        // Where all slopes are the same, all are in the first cell.
        self.cells_per_slope = if per_slope.is_finite() {
            per_slope
        } else {
            0.0
        };
        for spans in [&mut self.of_least, &mut self.of_greatest] {
            spans.clear();
            spans.resize(cells, [u16::MAX, 0]);
        }
        for (block, [min, max]) in (0..).zip(&self.slopes) {
            let [min, max] = [min, max].map(|slope| self.cell(*slope) as usize);
            for span in &mut self.of_least[..=max] {
                *span = [span[0].min(block), span[1].max(block)];
            }
            for span in &mut self.of_greatest[min..] {
                *span = [span[0].min(block), span[1].max(block)];
            }
        }
    }

    /// The cell of `slope`, as a whole number.
    #[inline(always)]
    fn cell<N: Real<Element = f32>>(&self, slope: N) -> N {
        let last = (self.of_least.len() - 1) as f32;
        let cell = (slope - self.hull[0]) * self.cells_per_slope;
        cell.max(slope.zero()).min(slope.splat(last))
    }

    /// The number of windows.
    fn windows(&self) -> usize {
        self.of_least.len() >> WINDOW_SHIFT
    }

    /// The blocks that a light may touch whose least slope is in this window, and whose greatest slope is in this
    /// one or the next.
    fn of_window(&self, window: usize) -> Range<usize> {
        let first = window << WINDOW_SHIFT;
        let last = (first + (2 << WINDOW_SHIFT) - 1).min(self.of_least.len() - 1);
        self.span(first as u32, last as u32)
    }

    /// The blocks that a light may touch, from the cells of its least and its greatest slope.
    #[inline(always)]
    fn span(&self, least: u32, greatest: u32) -> Range<usize> {
        let (least, greatest) = (
            self.of_least[least as usize],
            self.of_greatest[greatest as usize],
        );
        let first = usize::from(least[0].max(greatest[0]));
        first..(usize::from(least[1].min(greatest[1])) + 1).max(first)
    }
}

/// The places of the lights of each block, in the order of the batch.
#[derive(Clone, Debug, Default)]
pub(super) struct Bins {
    /// The index of a block and the place of a light, for each pair of them.
    pairs: Vec<[u32; 2]>,
    /// The end of the places of each block.
    ends: Vec<u32>,
    places: Vec<u32>,
}

impl Bins {
    /// Sorts the lights at places in `range` into blocks.
    #[inline(always)]
    pub fn fill<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        batch: &LightBatch<P>,
        range: Range<usize>,
        blocks: &Blocks,
    ) {
        // Counts first; one place in front of the first block.
        self.ends.clear();
        self.ends.resize(blocks.areas.len() + 1, 0);
        let count = self.find_pairs(simd, batch, range, blocks);
        let mut start = 0;
        for end in &mut self.ends {
            start += core::mem::replace(end, start);
        }
        grow(&mut self.places, count, 0);
        for [block, place] in &self.pairs[..count] {
            let end = &mut self.ends[*block as usize + 1];
            self.places[*end as usize] = *place;
            *end += 1;
        }
    }

    /// Finds the pairs, and counts those of each block. Returns their number.
    #[inline(always)]
    fn find_pairs<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        batch: &LightBatch<P>,
        range: Range<usize>,
        blocks: &Blocks,
    ) -> usize {
        let (columns, rows) = (&blocks.columns, &blocks.rows);
        let hull = ViewBounds {
            across: columns.hull,
            down: rows.hull,
            depths: blocks.hull,
        };
        let hull = splat_bounds(simd, &hull);
        let mut count = 0;
        for first in range.clone().step_by(S::f32s::LEN) {
            let bounds = batch.bounds(simd, first);
            let touching = bounds.meet(&hull) & mask_of_first(simd, range.end - first);
            let ([left, right], [bottom, top]) = (bounds.across, bounds.down);
            let cells = [
                S::u32s::truncate_from(columns.cell(left).0),
                S::u32s::truncate_from(columns.cell(right).0),
                S::u32s::truncate_from(rows.cell(bottom).0),
                S::u32s::truncate_from(rows.cell(top).0),
            ];
            let [left, right, bottom, top] = [
                cells[0] >> WINDOW_SHIFT,
                cells[1] >> WINDOW_SHIFT,
                cells[2] >> WINDOW_SHIFT,
                cells[3] >> WINDOW_SHIFT,
            ];
            let window = to_lanes::<S>(bottom * columns.windows() as u32 + left);
            let [mut nearest, mut farthest] = [[0.0; LANES]; 2];
            for lane in 0..S::u32s::LEN {
                [nearest[lane], farthest[lane]] = blocks.windows[window[lane] as usize];
            }
            let is_small = right.simd_le(left + 1) & top.simd_le(bottom + 1);
            let depths = [load(simd, &nearest, 0), load(simd, &farthest, 0)];
            // Most lights reach no depth in their window.
            let touching = touching & (meet(bounds.depths, depths) | !is_small);
            let mut touching = touching.to_bitmask();
            let cells = [
                to_lanes::<S>(cells[0]),
                to_lanes::<S>(cells[1]),
                to_lanes::<S>(cells[2]),
                to_lanes::<S>(cells[3]),
            ];
            let [mut near, mut far] = [[0.0; LANES]; 2];
            store(&mut near, 0, bounds.depths[0]);
            store(&mut far, 0, bounds.depths[1]);
            while touching != 0 {
                let lane = touching.trailing_zeros() as usize % LANES;
                touching &= touching - 1;
                let [left, right, bottom, top] = cells.map(|cells| cells[lane]);
                let (columns, rows) = (columns.span(left, right), rows.span(bottom, top));
                let (near, far) = (near[lane], far[lane]);
                let place = (first + lane) as u32;
                grow(&mut self.pairs, count + columns.len() * rows.len(), [0; 2]);
                for row in rows {
                    let first = row * blocks.columns.len;
                    for block in first + columns.start..first + columns.end {
                        let depths = blocks.depths[block];
                        // Not `&&`, which is a branch.
                        let reaches = u32::from(near <= depths[1]) & u32::from(depths[0] <= far);
                        // The next pair overwrites this one unless it counts.
                        self.pairs[count] = [block as u32, place];
                        self.ends[block + 1] += reaches;
                        count += reaches as usize;
                    }
                }
            }
        }
        count
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.pairs[..]) + size_of_val(&self.places[..])
    }

    /// The places of the lights of a block.
    pub fn of(&self, block: usize) -> &[u32] {
        let [start, end] = [self.ends[block], self.ends[block + 1]];
        &self.places[start as usize..end as usize]
    }
}

/// The indices in the lanes of a vector.
#[inline(always)]
fn to_lanes<S: Simd>(vector: S::u32s) -> Lanes<u32> {
    let mut lanes = [0; LANES];
    vector.store_slice(&mut lanes[..S::u32s::LEN]);
    lanes
}
