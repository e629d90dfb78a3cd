//! The same on many cores: blocks of tiles side by side, their lists put one after the other.

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::block::Scratch;
use super::culler::counted;
use super::shape::BatchShape;
use super::tile_depths::Area;
use super::{CullCounters, Culler, LightBatch, LightLists, TileDepths};
use crate::Error;

/// What culls one block at a time.
#[derive(Clone, Debug)]
pub(super) struct Worker<T: BatchShape> {
    area: Area,
    scratch: Scratch<T>,
    lists: LightLists,
}

impl<T: BatchShape + Send + Sync> Culler<T> {
    /// What [`cull`](Self::cull) does, on the threads of rayon's pool: the same lists in the same order.
    ///
    /// Worth it for thousands of tiles. Where a frame has many small grids, such as the subregions of
    /// interleaved sampling, let each thread cull some of them with a culler of its own.
    ///
    /// # Errors
    ///
    /// As [`cull`](Self::cull).
    pub fn cull_in_parallel(
        &mut self,
        batch: &LightBatch<T>,
        tiles: &TileDepths,
        lists: &mut LightLists,
    ) -> Result<CullCounters, Error> {
        let all = tiles.all();
        let levels = if self.blocks { all.levels() } else { 0 };
        let Some(levels) = levels.checked_sub(2) else {
            return self.cull(batch, tiles, lists);
        };
        let areas = all.parts().flat_map(Area::parts);
        let count = self.fill_workers(areas, levels + 1);
        let workers = &mut self.workers[..count];
        let (level, exact) = (self.level, self.scratch.exact);
        workers.par_iter_mut().for_each(|worker| {
            worker.scratch.exact = exact;
            worker.cull(level, batch, tiles);
        });
        lists.reset(all.size(), tiles.intervals() as usize);
        let mut counters = CullCounters::default();
        for worker in workers {
            lists.append(worker.area, &worker.lists);
            counters.block_tests += worker.scratch.counters.block_tests;
            counters.tile_tests += worker.scratch.counters.tile_tests;
            counters.empty += worker.scratch.counters.empty;
            counters.rejected_exactly += worker.scratch.counters.rejected_exactly;
        }
        counted(counters, tiles, lists)
    }

    /// Gives each of `areas`, which are to be cut `levels` times, to a worker; how many there are.
    fn fill_workers(&mut self, areas: impl Iterator<Item = Area>, levels: usize) -> usize {
        let mut count = 0;
        for area in areas {
            if count == self.workers.len() {
                self.workers.push(Worker {
                    area,
                    scratch: Scratch::new(),
                    lists: LightLists::new(),
                });
            }
            let worker = &mut self.workers[count];
            worker.area = area;
            worker.scratch.begin(levels);
            count += 1;
        }
        count
    }
}

impl<T: BatchShape> Worker<T> {
    fn cull(&mut self, level: Level, batch: &LightBatch<T>, tiles: &TileDepths) {
        let Self {
            area,
            scratch,
            lists,
        } = self;
        lists.reset(area.size(), tiles.intervals() as usize);
        dispatch!(level, simd => scratch.cull(simd, batch, tiles, *area, lists));
    }
}
