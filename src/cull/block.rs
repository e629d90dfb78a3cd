//! The recursion from blocks of tiles to smaller blocks to tiles.

use alloc::vec::Vec;

use fearless_simd::Simd;

use super::batch::grow;
use super::exact::append_list_exactly;
use super::filter::{bounds_touching, filter, touching};
use super::lanes::splat_tile;
use super::tile_depths::{Area, NONE};
use super::tile_list::{Row, append_list, fill_rows};
use super::{CullCounters, LightBatch, LightLists, TileDepths};
use crate::touch::BoxTest;
use crate::view::ViewBounds;

/// The memory and the settings of a culler.
#[derive(Clone, Debug)]
pub(super) struct Scratch<P: BoxTest> {
    /// For each level of the recursion, the lights of the current block. The largest block comes first.
    blocks: Vec<LightBatch<P>>,
    levels: usize,
    /// For each chunk, the intermediate results for the current row of tiles.
    rows: Vec<Row<P>>,
    /// Whether the exact test follows the box test.
    pub is_exact: bool,
    pub counters: CullCounters,
}

impl<P: BoxTest> Scratch<P> {
    pub fn new() -> Self {
        Self {
            blocks: Vec::new(),
            levels: 0,
            rows: Vec::new(),
            is_exact: false,
            counters: CullCounters::default(),
        }
    }

    /// The number of chunks that there is room for.
    #[cfg(all(test, feature = "rayon"))]
    pub fn chunks(&self) -> usize {
        self.blocks.iter().map(LightBatch::room).sum()
    }

    /// Prepares for `levels` levels of blocks, and resets the counters.
    pub fn begin(&mut self, levels: usize) {
        self.blocks
            .resize_with(levels.max(self.blocks.len()), LightBatch::new);
        self.levels = levels;
        self.counters = CullCounters::default();
    }

    /// Fills `lists`, which are for `area` alone, with the lists of its tiles.
    #[inline(always)]
    pub fn cull<S: Simd>(
        &mut self,
        simd: S,
        lights: &LightBatch<P>,
        tiles: &TileDepths,
        area: Area,
        lists: &mut LightLists,
    ) {
        // No block has more lights, so later frames need no more room. Workers have a share each.
        let reserves = area.is_all_of(tiles);
        if reserves {
            grow(&mut self.rows, lights.chunks().len(), Row::zero);
        }
        let mut walk = Walk {
            reserves,
            tiles,
            lists,
            origin: area.min,
            rows: &mut self.rows,
            is_exact: self.is_exact,
            counters: &mut self.counters,
        };
        let blocks = &mut self.blocks[..self.levels];
        if area.is_all_of(tiles) {
            walk.subdivide(simd, lights, area, blocks);
        } else {
            walk.filter(simd, lights, area, blocks);
        }
    }
}

/// The state of one walk over the tiles of an area.
struct Walk<'a, P: BoxTest> {
    /// Whether blocks have room for all lights, so that no later frame allocates.
    reserves: bool,
    tiles: &'a TileDepths,
    lists: &'a mut LightLists,
    /// The tile whose lists come first, \[column, row\].
    origin: [usize; 2],
    rows: &'a mut Vec<Row<P>>,
    is_exact: bool,
    counters: &'a mut CullCounters,
}

impl<P: BoxTest> Walk<'_, P> {
    /// Fills the lists of the tiles of `area`. All `lights` may touch it.
    fn subdivide<S: Simd>(
        &mut self,
        simd: S,
        lights: &LightBatch<P>,
        area: Area,
        blocks: &mut [LightBatch<P>],
    ) {
        if blocks.is_empty() {
            simd.vectorize(
                #[inline(always)]
                || self.fill_lists(simd, lights, area),
            );
        } else {
            for part in area.subdivide() {
                self.filter(simd, lights, part, blocks);
            }
        }
    }

    /// Filters `lights` by `area`, and fills the lists of its tiles.
    fn filter<S: Simd>(
        &mut self,
        simd: S,
        lights: &LightBatch<P>,
        area: Area,
        blocks: &mut [LightBatch<P>],
    ) {
        let Some(bounds) = self.tiles.bounds_of(area) else {
            self.counters.empty += 1;
            return;
        };
        let [block, smaller @ ..] = blocks else {
            return self.subdivide(simd, lights, area, blocks);
        };
        if self.reserves {
            block.reserve_for(lights);
        }
        simd.vectorize(
            #[inline(always)]
            || {
                let tile = splat_tile(simd, bounds);
                // Tiles follow, whose tests begin with the bounds again. To test boxes pays if smaller blocks do.
                self.counters.block_tests += if smaller.is_empty() {
                    filter(simd, lights, &tile, block, bounds_touching)
                } else {
                    filter(simd, lights, &tile, block, touching)
                };
            },
        );
        if !block.is_empty() {
            self.subdivide(simd, block, area, smaller);
        }
    }

    /// Fills the lists of the tiles of `area`, tile by tile.
    #[inline(always)]
    fn fill_lists<S: Simd>(&mut self, simd: S, lights: &LightBatch<P>, area: Area) {
        let chunks = lights.chunks();
        grow(self.rows, chunks.len(), Row::zero);
        let rows = &mut self.rows[..chunks.len()];
        for y in area.min[1]..area.max[1] {
            let down = self.tiles.down(y);
            fill_rows(simd, chunks, down, rows);
            for x in area.min[0]..area.max[0] {
                let across = self.tiles.across(x);
                let first = self.lists.slot([x - self.origin[0], y - self.origin[1]]);
                for (interval, depths) in self.tiles.depths_of(x, y).iter().enumerate() {
                    if *depths == NONE {
                        self.counters.empty += 1;
                        continue;
                    }
                    let start = self.lists.len();
                    let tile = ViewBounds {
                        across,
                        down,
                        depths: *depths,
                    };
                    if self.is_exact {
                        let tested = append_list_exactly(simd, lights, rows, tile, self.lists);
                        self.counters.tile_tests += tested.lights;
                        self.counters.rejected_exactly += tested.rejected;
                    } else {
                        let tile = splat_tile(simd, tile);
                        self.counters.tile_tests +=
                            append_list(simd, lights, rows, &tile, self.lists);
                    }
                    self.lists.set_range(first + interval, start);
                }
            }
        }
    }
}
