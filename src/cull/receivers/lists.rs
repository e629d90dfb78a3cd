use alloc::vec::Vec;

use fearless_simd::Simd;

use super::TileReceivers;
use crate::base::Error;
use crate::cull::LightLists;
use crate::cull::batch::grow;
use crate::lobe::LobeFamily;

/// For each depth interval of each tile, the lights that are drawn for all its receivers, each with its weight.
///
/// Keeps its memory from frame to frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WeightedLists {
    pub(super) lists: LightLists,
    /// The weights of [`LightLists::lights`].
    pub(super) weights: Vec<f32>,
}

/// The lights that are drawn for the receivers of a tile, with their weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WeightedList<'a> {
    /// The indices of the lights.
    pub lights: &'a [u32],
    /// The weight 1/p_T ≥ 1 of each light.
    pub weights: &'a [f32],
}

impl WeightedLists {
    /// Creates lists for no tiles. Does not allocate.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            lists: LightLists::new(),
            weights: Vec::new(),
        }
    }

    /// The lights of `tile` = \[column, row\] and its `interval`-th depth interval, in the order of the batch.
    /// Empty for a tile or an interval that does not exist.
    #[inline]
    #[must_use]
    pub fn of(&self, tile: [u32; 2], interval: u32) -> WeightedList<'_> {
        let range = self.lists.range_of(tile, interval);
        WeightedList {
            lights: &self.lists.lights()[range.clone()],
            weights: &self.weights[range],
        }
    }

    /// Lets `write` fill `lists`, which get no weights.
    pub(super) fn without_weights(
        lists: &mut LightLists,
        write: impl FnOnce(&mut Self) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut weighted = Self {
            lists: core::mem::take(lists),
            weights: Vec::new(),
        };
        let result = write(&mut weighted);
        *lists = weighted.lists;
        result
    }

    /// Clears the lists and creates an empty one for each slot of `tiles`.
    pub(super) fn reset<F: LobeFamily>(&mut self, tiles: &TileReceivers<F>) {
        let size = tiles.size().map(|n| n as usize);
        self.lists.reset(size, tiles.intervals() as usize);
    }

    /// Appends the list of `slot`: the first `len` of `lights`, which is longer than that by a vector.
    pub(super) fn append<S: Simd>(
        &mut self,
        simd: S,
        slot: usize,
        lights: &[u32],
        len: usize,
        weights: &[f32],
    ) {
        let start = self.lists.len();
        self.lists.append_list(simd, slot, lights, len);
        if !weights.is_empty() {
            grow(&mut self.weights, start + len, 0.0);
            self.weights[start..][..len].copy_from_slice(weights);
        }
    }

    /// Clears the lists and creates `count` empty ones.
    #[cfg(feature = "rayon")]
    pub(super) fn reset_to(&mut self, count: usize) {
        self.lists.reset([count, 1], 1);
    }

    /// Appends the lists of these tiles.
    #[cfg(feature = "rayon")]
    pub(super) fn append_all(&mut self, tiles: &[usize], other: &Self, weighs: bool) {
        let (start, len) = (self.lists.len(), other.lists.len());
        self.lists.append_at(tiles, &other.lists);
        if weighs {
            grow(&mut self.weights, start + len, 0.0);
            self.weights[start..start + len].copy_from_slice(&other.weights[..len]);
        }
    }

    /// Finishes the lists.
    pub(super) fn finish<F: LobeFamily>(&mut self, tiles: &TileReceivers<F>) -> Result<(), Error> {
        self.lists.finish();
        self.lists.check_size(tiles.size())
    }

    /// The lists without weights.
    #[must_use]
    pub fn lists(&self) -> &LightLists {
        &self.lists
    }

    /// The weights of the lights of all lists, in the order of [`LightLists::lights`].
    #[must_use]
    pub fn weights(&self) -> &[f32] {
        &self.weights[..self.lists.len()]
    }
}
