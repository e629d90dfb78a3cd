//! Which lights may touch which tile.

use rayon::prelude::*;
use stochastic_light_culling::{BoxTest, Culler, Error, LightBatch, LightLists};

use super::Subregion;

/// Cullers of a group of subregions, with the lists that they fill: memory that is used group after group.
pub struct Cullers<T: BoxTest> {
    cullers: Vec<Culler<T>>,
    pub lists: Vec<LightLists>,
}

impl<T: BoxTest + Send + Sync> Cullers<T> {
    /// For groups of at most `count` subregions.
    pub fn new(count: usize) -> Self {
        Self {
            cullers: vec![Culler::new(); count],
            lists: vec![LightLists::new(); count],
        }
    }

    /// The lists of the tiles of each of `subregions`, from the lights of each.
    pub fn cull(
        &mut self,
        subregions: &[Subregion],
        batches: &[LightBatch<T>],
    ) -> Result<(), Error> {
        let results = self.cullers.par_iter_mut().zip(&mut self.lists);
        let frame = subregions.par_iter().zip(batches);
        results
            .zip(frame)
            .try_for_each(|((culler, lists), (subregion, batch))| {
                culler.cull(batch, &subregion.depths, lists).map(drop)
            })
    }
}
