//! Culling against receivers on many cores: each thread walks down from blocks of its own.

use alloc::vec::Vec;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::culler::ReceiverCuller;
use super::lists::WeightedLists;
use super::tiles::{Node, TileReceivers};
use super::walk::{Block, MayBeAccepted, Output, PieceLists, Rule, Scene};
use crate::base::Error;
use crate::cull::{LightLists, ShadingBatch};
use crate::light::TileProbability;
use crate::lobe::{Lobe, LobeFamily};

/// The number of blocks for each thread, at least. With several, threads end at about the same time though blocks
/// differ.
const BLOCKS_PER_THREAD: usize = 4;

/// The memory and the lists of a block.
#[derive(Clone, Debug, Default)]
pub(super) struct Worker {
    node: Node,
    scratch: Vec<PieceLists>,
    lists: WeightedLists,
    /// The tiles of the lists.
    tiles: Vec<usize>,
    pair_tests: u64,
}

impl Worker {
    fn walk<L: Lobe, F: LobeFamily, R: Rule>(
        &mut self,
        level: Level,
        scene: &Scene<L, F, R>,
        lights: &[u32],
    ) {
        let Self {
            node,
            scratch,
            lists,
            tiles,
            pair_tests,
        } = self;
        lists.reset_to(scene.tiles.most_tiles(*node));
        tiles.clear();
        // One for the parts of a tile, one for each level of blocks, and one for the lights of the block itself.
        let steps = node.level - scene.tiles.level_of_tiles() + 2;
        scratch.resize_with(steps.max(scratch.len()), PieceLists::default);
        let mut output = Output {
            lists,
            tiles: Some(tiles),
            pair_tests: 0,
        };
        dispatch!(level, simd => {
            let block = Block {
                node: *node,
                lights,
                scratch: &mut scratch[..steps],
            };
            scene.enter(simd, block, &mut output);
        });
        *pair_tests = output.pair_tests;
    }
}

impl ReceiverCuller {
    /// Does what [`cull`](Self::cull) does on the threads of rayon's current pool. The lists are the same, in another
    /// order of the tiles.
    ///
    /// Worth it for a thousand tiles or more. For a frame with many small grids, such as the subregions of
    /// interleaved sampling, let each thread cull some of the grids with a culler of its own.
    ///
    /// # Errors
    ///
    /// As [`cull`](Self::cull).
    pub fn cull_in_parallel<L: Lobe + Sync, F: LobeFamily>(
        &mut self,
        lights: &ShadingBatch<L>,
        tiles: &TileReceivers<F>,
        lists: &mut LightLists,
    ) -> Result<(), Error> {
        WeightedLists::without_weights(lists, |lists| {
            self.write_in_parallel(MayBeAccepted, lights, tiles, lists)
        })
    }

    /// Does what [`draw`](Self::draw) does on the threads of rayon's current pool. The lists are the same, in another
    /// order of the tiles.
    ///
    /// # Errors
    ///
    /// As [`cull`](Self::cull).
    pub fn draw_in_parallel<L: Lobe + Sync, F: LobeFamily>(
        &mut self,
        probability: TileProbability,
        lights: &ShadingBatch<L>,
        tiles: &TileReceivers<F>,
        lists: &mut WeightedLists,
    ) -> Result<(), Error> {
        self.write_in_parallel(probability, lights, tiles, lists)
    }

    fn write_in_parallel<L: Lobe + Sync, F: LobeFamily, R: Rule + Sync>(
        &mut self,
        rule: R,
        lights: &ShadingBatch<L>,
        tiles: &TileReceivers<F>,
        lists: &mut WeightedLists,
    ) -> Result<(), Error> {
        lists.reset(tiles);
        self.number(lights.len());
        let scene = self.scene(rule, lights, tiles);
        let (level, all) = (self.level, &self.lights[..lights.len()]);
        let mut count = 0;
        for node in tiles.blocks(BLOCKS_PER_THREAD * rayon::current_num_threads()) {
            if tiles.cluster(node).is_none() {
                continue;
            }
            if self.workers.len() == count {
                self.workers.push(Worker::default());
            }
            self.workers[count].node = node;
            count += 1;
        }
        let workers = &mut self.workers[..count];
        workers
            .par_iter_mut()
            .for_each(|worker| worker.walk(level, &scene, all));
        self.pair_tests = workers.iter().map(|worker| worker.pair_tests).sum();
        for worker in workers {
            lists.append_all(&worker.tiles, &worker.lists, R::WEIGHS);
        }
        lists.finish(tiles)
    }
}
