//! Culling on many cores: threads cull blocks of tiles, and their lists are concatenated.

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::block::Scratch;
use super::culler::finish;
use super::tile_depths::Area;
use super::{CullCounters, Culler, LightBatch, LightLists, TileDepths};
use crate::base::Error;
use crate::touch::BoxTest;

/// The memory and the lists of one block of tiles.
#[derive(Clone, Debug)]
pub(super) struct Worker<P: BoxTest> {
    area: Area,
    scratch: Scratch<P>,
    lists: LightLists,
}

impl<P: BoxTest + Send + Sync> Culler<P> {
    /// Does what [`cull`](Self::cull) does on the threads of rayon's current pool. The lists are the same, in
    /// the same order.
    ///
    /// Worth it for thousands of tiles. For a frame with many small grids, such as the subregions of
    /// interleaved sampling, let each thread cull some of the grids with a culler of its own.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Camera, Culler, DepthInterval, LightBatch, LightLists, Sphere, TileDepths,
    ///     TileGrid, glam::Vec3,
    /// };
    ///
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
    /// let grid = TileGrid::new([1024, 1024], 16)?;
    /// let mut tiles = TileDepths::new(&grid, &camera, 1)?;
    /// for tile in grid.tiles() {
    ///     tiles.set(tile, [DepthInterval::new(5.0, 20.0)?]);
    /// }
    /// let mut batch = LightBatch::new();
    /// let sphere = Sphere::new(Vec3::new(0.0, 0.0, -10.0), 1.0)?;
    /// batch.extend(sphere.project(&camera).map(|shape| (7, shape)));
    ///
    /// let (mut culler, [mut many, mut one]) = (Culler::new(), [LightLists::new(), LightLists::new()]);
    /// culler.cull_in_parallel(&batch, &tiles, &mut many)?;
    /// culler.cull(&batch, &tiles, &mut one)?;
    /// assert!(!one.is_empty());
    /// assert_eq!(many.of([32, 32], 0), one.of([32, 32], 0));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`cull`](Self::cull).
    pub fn cull_in_parallel(
        &mut self,
        batch: &LightBatch<P>,
        tiles: &TileDepths,
        lists: &mut LightLists,
    ) -> Result<CullCounters, Error> {
        let all = tiles.all();
        let levels = if self.use_blocks { all.levels() } else { 0 };
        let Some(levels) = levels.checked_sub(2) else {
            return self.cull(batch, tiles, lists);
        };
        let areas = all.subdivide().flat_map(Area::subdivide);
        let count = self.fill_workers(areas, levels + 1);
        let workers = &mut self.workers[..count];
        let (level, is_exact) = (self.level, self.scratch.is_exact);
        workers.par_iter_mut().for_each(|worker| {
            worker.scratch.is_exact = is_exact;
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
        finish(counters, batch, tiles, lists)
    }

    /// Assigns each of `areas`, which are to be subdivided `levels` times, to a worker. Returns their number.
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

impl<P: BoxTest> Worker<P> {
    /// Fills the lists of the area.
    fn cull(&mut self, level: Level, batch: &LightBatch<P>, tiles: &TileDepths) {
        let Self {
            area,
            scratch,
            lists,
        } = self;
        lists.reset(area.size(), tiles.intervals() as usize);
        dispatch!(level, simd => scratch.cull(simd, batch, tiles, *area, lists));
        lists.finish(batch.room_for_a_list());
    }
}
