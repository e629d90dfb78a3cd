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
        // Not room for a longest list, which each of many workers would have.
        lists.finish(0);
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::bound::Sphere;
    use crate::project::ProjectedSphere;
    use crate::view::{Camera, DepthInterval, TileRectangle};

    /// The workers together need little more room than one culler, though they are many.
    #[test]
    fn workers_have_a_share_of_the_lights() {
        let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.5, 1.0, 0.1..100.0);
        let camera = camera.expect("in range");
        let mut batch = LightBatch::<ProjectedSphere>::new();
        for light in 0..100_000_u32 {
            // Spread over the view.
            let [x, y] =
                [0.618_034, 0.754_878].map(|step: f32| (step * light as f32).fract() - 0.5);
            let sphere = Sphere::new(Vec3::new(16.0 * x, 16.0 * y, -10.0), 0.05);
            batch.extend(
                sphere
                    .expect("in range")
                    .project(&camera)
                    .map(|shape| (light, shape)),
            );
        }
        let corner = |[x, y]: [u32; 2]| Vec2::new(x as f32, y as f32) / 64.0 - 1.0;
        let tile = |[x, y]: [u32; 2]| {
            TileRectangle::new(corner([x, y]), corner([x + 1, y + 1])).expect("in order")
        };
        let mut tiles = TileDepths::from_rectangles([128, 128], 1, tile).expect("not empty");
        for y in 0..128 {
            for x in 0..128 {
                tiles.set([x, y], [DepthInterval::new(9.0, 11.0).ok()]);
            }
        }

        let (mut one, mut many) = (Culler::new(), Culler::new());
        let [mut lists, mut lists_of_many] = [LightLists::new(), LightLists::new()];
        let counters = one.cull(&batch, &tiles, &mut lists);
        assert!(counters.expect("few").pairs > 0);
        let counters = many.cull_in_parallel(&batch, &tiles, &mut lists_of_many);
        counters.expect("few");
        assert!(lists == lists_of_many);
        let room: usize = many
            .workers
            .iter()
            .map(|worker| worker.scratch.chunks())
            .sum();
        assert!(many.workers.len() > 50);
        assert!(
            room < 2 * one.scratch.chunks(),
            "{room} chunks, {}",
            one.scratch.chunks()
        );
    }
}
