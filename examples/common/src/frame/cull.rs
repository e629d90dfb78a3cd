//! Which lights may touch which tile.

use rayon::prelude::*;
use stochastic_light_culling::{BoxTest, Culler, Error, LightBatch, LightLists};

use super::Tiles;

/// A culler for each subregion, with the lists that it fills: memory that is used frame after frame.
pub struct Cullers<T: BoxTest> {
    cullers: Vec<Culler<T>>,
    pub lists: Vec<LightLists>,
}

impl<T: BoxTest + Send + Sync> Cullers<T> {
    pub fn new(tiles: &Tiles) -> Self {
        let count = tiles.subregions().len();
        Self {
            cullers: vec![Culler::new(); count],
            lists: vec![LightLists::new(); count],
        }
    }

    /// The lists of each subregion's tiles, from the lights of each subregion.
    pub fn cull(&mut self, tiles: &Tiles, batches: &[LightBatch<T>]) -> Result<(), Error> {
        let results = self.cullers.par_iter_mut().zip(&mut self.lists);
        let frame = tiles.subregions().par_iter().zip(batches);
        results
            .zip(frame)
            .try_for_each(|((culler, lists), (subregion, batch))| {
                culler.cull(batch, &subregion.depths, lists).map(drop)
            })
    }
}
