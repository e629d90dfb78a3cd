//! Which lights may touch which tile.

use rayon::prelude::*;
use stochastic_light_culling::{DepthInterval, TileTest};

use super::Tile;
use super::bounds::Candidates;

/// The numbers of the lights, in rising order, that may touch a tile's two depth intervals.
pub type TileLights = [Vec<u32>; 2];

/// The lists of all `tiles`, from the candidates of each subregion.
pub fn cull<T: TileTest + Sync>(tiles: &[Tile], candidates: &[Candidates<T>]) -> Vec<TileLights> {
    let lists = |tile: &Tile| {
        let candidates = &candidates[tile.subregion as usize];
        let touching = |depths: DepthInterval| {
            candidates
                .iter()
                .filter(|(_, test)| test.touches(&tile.rectangle, &depths))
                .map(|(number, _)| *number)
                .collect()
        };
        tile.depths
            .map(|depths| depths.map_or_else(Vec::new, touching))
    };
    tiles.par_iter().map(lists).collect()
}
