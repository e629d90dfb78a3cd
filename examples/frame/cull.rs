//! Which lights may touch which tile.

use rayon::prelude::*;
use stochastic_light_culling::{BatchShape, Culler, Error, LightBatch, LightLists};

use super::Tiles;

/// The lists of each subregion's tiles, from the lights of each subregion.
pub fn cull<T: BatchShape + Send + Sync>(
    tiles: &Tiles,
    batches: &[LightBatch<T>],
) -> Result<Vec<LightLists>, Error> {
    let cull = |culler: &mut Culler<T>, (subregion, batch): (&super::tiles::Subregion, &_)| {
        let mut lists = LightLists::new();
        culler.cull(batch, &subregion.depths, &mut lists)?;
        Ok(lists)
    };
    let subregions = tiles.subregions().par_iter().zip(batches);
    subregions.map_init(Culler::new, cull).collect()
}
