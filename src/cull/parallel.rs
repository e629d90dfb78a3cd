//! Culling on many cores: threads sort shares of the lights into blocks of tiles, then cull shares of the blocks.
//! Their lists are concatenated.

use alloc::vec::Vec;
use core::ops::Range;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::bins::{Bins, Blocks};
use super::block::{BLOCK, By, Numbers, Output, Scene, Scratch};
use super::culler::finish;
use super::lists::Window;
use super::{CullCounters, Culler, LightBatch, LightLists, TileDepths};
use crate::base::Error;
use crate::touch::BoxTest;

/// The memory and the lists of some of the blocks.
#[derive(Clone, Debug)]
pub(super) struct Worker<P: BoxTest> {
    blocks: Range<usize>,
    /// The places of the lights of one block.
    places: Vec<u32>,
    scratch: Scratch<P>,
    /// The tiles of the first block come first.
    lists: LightLists,
}

/// The number of workers for each thread. With several, threads end at about the same time though blocks differ.
const WORKERS_PER_THREAD: usize = 4;

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
        if !self.use_blocks || !all.exceeds(BLOCK) {
            return self.cull(batch, tiles, lists);
        }
        self.blocks.set(tiles);
        let (level, blocks) = (self.level, &self.blocks);

        let threads = rayon::current_num_threads();
        let share = batch.len().div_ceil(threads);
        self.bins_of_threads.resize_with(threads, Bins::default);
        let bins = self.bins_of_threads.par_iter_mut().enumerate();
        bins.for_each(|(thread, bins)| {
            let lights = (thread * share).min(batch.len())..((thread + 1) * share).min(batch.len());
            dispatch!(level, simd => bins.fill(simd, batch, lights, blocks));
        });
        let bins = &self.bins_of_threads[..];

        let share = blocks.areas.len().div_ceil(WORKERS_PER_THREAD * threads);
        let count = blocks.areas.len().div_ceil(share);
        let new_worker = || Worker::new(&self.scratch);
        self.workers
            .resize_with(count.max(self.workers.len()), new_worker);
        let workers = &mut self.workers[..count];
        let scene = Scene { batch, tiles };
        workers
            .par_iter_mut()
            .enumerate()
            .for_each(|(index, worker)| {
                worker.blocks = index * share..((index + 1) * share).min(blocks.areas.len());
                worker.cull(level, &scene, blocks, bins);
            });

        lists.reset(all.size(), tiles.intervals() as usize);
        let mut counters = CullCounters::default();
        for worker in workers {
            lists.append(&blocks.areas[worker.blocks.clone()], &worker.lists);
            counters.add(&worker.scratch.counters);
        }
        finish(counters, tiles, lists)
    }
}

impl CullCounters {
    /// Adds the counts of another part of the work.
    fn add(&mut self, other: &Self) {
        self.block_tests += other.block_tests;
        self.tile_tests += other.tile_tests;
        self.box_tests += other.box_tests;
        self.empty += other.empty;
        self.rejected_exactly += other.rejected_exactly;
    }
}

impl<P: BoxTest> Worker<P> {
    /// Creates a worker that tests as `scratch` does.
    fn new(scratch: &Scratch<P>) -> Self {
        Self {
            blocks: 0..0,
            places: Vec::new(),
            scratch: scratch.with_same_tests(),
            lists: LightLists::new(),
        }
    }

    /// The memory in use, with what is to spare.
    #[cfg(test)]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.places[..]) + self.scratch.bytes() + self.lists.bytes()
    }

    /// Writes the lists of the worker's blocks.
    fn cull(&mut self, level: Level, scene: &Scene<P>, blocks: &Blocks, bins: &[Bins]) {
        let areas = &blocks.areas[self.blocks.clone()];
        let tiles = areas.iter().map(|area| area.len()).sum();
        let intervals = scene.tiles.intervals() as usize;
        self.lists.reset([tiles, 1], intervals);
        self.scratch.counters = CullCounters::default();
        let (lists, scratch) = (&mut self.lists, &mut self.scratch);
        let mut first = 0;
        for (block, area) in self.blocks.clone().zip(areas) {
            self.places.clear();
            for bins in bins {
                self.places.extend_from_slice(bins.of(block));
            }
            let mut output = Output {
                lists,
                window: Window::of(*area, first),
                numbers: Numbers::Lights,
            };
            let places = &self.places;
            dispatch!(level, simd => scratch.cull(simd, scene, places, *area, By::BoundsAndBoxes, &mut output));
            first += area.len() * intervals;
        }
        self.lists.finish();
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::bound::Sphere;
    use crate::project::ProjectedSphere;
    use crate::view::{Camera, DepthInterval, TileRectangle};

    /// The workers have a share of the lights each, so that many need little more memory than one culler.
    #[test]
    fn many_workers_take_at_most_twice_the_memory_of_one_culler() {
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
        let threads = rayon::ThreadPoolBuilder::new().num_threads(8).build();
        let counters = (threads.expect("few"))
            .install(|| many.cull_in_parallel(&batch, &tiles, &mut lists_of_many));
        counters.expect("few");
        assert!(lists == lists_of_many);
        let serial = batch.bytes() + one.bytes() + lists.bytes();
        let parallel = batch.bytes() + many.bytes() + lists_of_many.bytes();
        assert!(parallel < 2 * serial, "{parallel} bytes, {serial}");
    }
}
