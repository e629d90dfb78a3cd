//! From blocks to smaller blocks to tiles.

use alloc::vec::Vec;

use fearless_simd::Simd;

use super::batch::grow;
use super::exact::list_exactly;
use super::filter::{filter, load_fields};
use super::lanes::{parts, splat_tile, store};
use super::tile_depths::{Area, NONE};
use super::tile_list::{Row, list};
use super::{CullCounters, LightBatch, LightLists, TileDepths};
use crate::num::F32Lanes;
use crate::touch::{BoxTest, TileBounds};

/// The memory of a culler.
#[derive(Clone, Debug)]
pub(super) struct Scratch<P: BoxTest> {
    /// The lights of a block of each size, from the largest.
    blocks: Vec<LightBatch<P>>,
    levels: usize,
    /// Chunk by chunk, what the lights share with all tiles of a row.
    rows: Vec<Row<P>>,
    /// Whether lists are of the exact test.
    pub exact: bool,
    pub counters: CullCounters,
}

impl<P: BoxTest> Scratch<P> {
    pub fn new() -> Self {
        Self {
            blocks: Vec::new(),
            levels: 0,
            rows: Vec::new(),
            exact: false,
            counters: CullCounters::default(),
        }
    }

    /// Makes ready to cut the grid `levels` times.
    pub fn begin(&mut self, levels: usize) {
        self.blocks
            .resize_with(levels.max(self.blocks.len()), LightBatch::new);
        self.levels = levels;
        self.counters = CullCounters::default();
    }

    /// Puts the lists of the tiles of `area` into `lists`, which are those of this area alone.
    #[inline(always)]
    pub fn cull<S: Simd>(
        &mut self,
        simd: S,
        lights: &LightBatch<P>,
        tiles: &TileDepths,
        area: Area,
        lists: &mut LightLists,
    ) {
        let mut walk = Walk {
            tiles,
            lists,
            origin: area.min,
            rows: &mut self.rows,
            exact: self.exact,
            counters: &mut self.counters,
        };
        let blocks = &mut self.blocks[..self.levels];
        if area.is_all_of(tiles) {
            walk.block(simd, lights, area, blocks);
        } else {
            walk.part(simd, lights, area, blocks);
        }
    }
}

struct Walk<'a, P: BoxTest> {
    tiles: &'a TileDepths,
    lists: &'a mut LightLists,
    /// The tile whose lists come first.
    origin: [usize; 2],
    rows: &'a mut Vec<Row<P>>,
    exact: bool,
    counters: &'a mut CullCounters,
}

impl<P: BoxTest> Walk<'_, P> {
    /// The lists of the tiles of `area`, which `lights` may all touch.
    fn block<S: Simd>(
        &mut self,
        simd: S,
        lights: &LightBatch<P>,
        area: Area,
        blocks: &mut [LightBatch<P>],
    ) {
        if blocks.is_empty() {
            simd.vectorize(
                #[inline(always)]
                || self.tiles(simd, lights, area),
            );
        } else {
            for part in area.parts() {
                self.part(simd, lights, part, blocks);
            }
        }
    }

    /// The lists of the tiles of `area`, whose lights are among `lights`.
    fn part<S: Simd>(
        &mut self,
        simd: S,
        lights: &LightBatch<P>,
        area: Area,
        blocks: &mut [LightBatch<P>],
    ) {
        let Some(around) = self.tiles.around(area) else {
            self.counters.empty += 1;
            return;
        };
        let [block, smaller @ ..] = blocks else {
            return self.block(simd, lights, area, blocks);
        };
        simd.vectorize(
            #[inline(always)]
            || {
                let tile = splat_tile(simd, around);
                self.counters.block_tests += filter(simd, lights, &tile, block);
            },
        );
        if !block.is_empty() {
            self.block(simd, block, area, smaller);
        }
    }

    /// The lists of the tiles of `area`, one by one.
    #[inline(always)]
    fn tiles<S: Simd>(&mut self, simd: S, lights: &LightBatch<P>, area: Area) {
        let chunks = lights.chunks();
        grow(self.rows, chunks.len(), Row::none);
        let rows = &mut self.rows[..chunks.len()];
        for y in area.min[1]..area.max[1] {
            let down = self.tiles.down(y);
            let down_in_lanes = [F32Lanes::new(simd, down[0]), F32Lanes::new(simd, down[1])];
            for (chunk, row) in chunks.iter().zip(&mut *rows) {
                for part in 0..parts::<S>() {
                    let fields = load_fields(simd, chunk, part);
                    let shared = P::row(&fields, down_in_lanes);
                    for (lanes, vector) in row.0.as_mut().iter_mut().zip(shared.as_ref()) {
                        store(lanes, part, *vector);
                    }
                }
            }
            for x in area.min[0]..area.max[0] {
                let across = self.tiles.across(x);
                let first = self.lists.slot([x - self.origin[0], y - self.origin[1]]);
                for (interval, depths) in self.tiles.depths_of(x, y).iter().enumerate() {
                    if *depths == NONE {
                        self.counters.empty += 1;
                        continue;
                    }
                    let start = self.lists.len();
                    let tile = TileBounds {
                        across,
                        down,
                        depths: *depths,
                    };
                    if self.exact {
                        let tested = list_exactly(simd, lights, rows, tile, self.lists);
                        self.counters.tile_tests += tested.lights;
                        self.counters.rejected_exactly += tested.rejected;
                    } else {
                        let tile = splat_tile(simd, tile);
                        self.counters.tile_tests += list(simd, lights, rows, &tile, self.lists);
                    }
                    self.lists.end(first + interval, start);
                }
            }
        }
    }
}
