//! The walk from the whole image down to the tiles.

use alloc::vec::Vec;

use fearless_simd::{Simd, SimdBase};

use super::lists::WeightedLists;
use super::tiles::{Node, TileReceivers};
use crate::cull::batch::grow;
use crate::cull::lanes::{LANES, compress, mask_of_first, write_chosen};
use crate::cull::shading::{Lights, ShadingBatch};
use crate::light::{Roulette, TileProbability};
use crate::lobe::{Lobe, LobeFamily, Majorant};
use crate::num::{Real, Single, Twice};
use crate::touch::LitFrom;
use crate::view::ReceiverCluster;

/// Which of the lights that may light a tile are in its list.
pub(super) trait Rule: Copy {
    /// Whether the list has weights.
    const WEIGHS: bool;

    /// Lights whose ξ is at most this are in the list.
    fn probability<N: Single>(self, radiance: &TileRadiance<N>) -> N;
}

/// All lights that a receiver may accept.
#[derive(Clone, Copy)]
pub(super) struct MayBeAccepted;

impl Rule for MayBeAccepted {
    const WEIGHS: bool = false;

    #[inline(always)]
    fn probability<N: Single>(self, radiance: &TileRadiance<N>) -> N {
        radiance.greatest
    }
}

impl Rule for TileProbability {
    const WEIGHS: bool = true;

    #[inline(always)]
    fn probability<N: Single>(self, radiance: &TileRadiance<N>) -> N {
        self.in_lanes(radiance.greatest, radiance.mean_square)
    }
}

/// c/δ of a light in each lane, over the receivers of a tile.
#[derive(Clone, Copy)]
pub(super) struct TileRadiance<N> {
    /// An upper bound.
    greatest: N,
    /// An estimate of the mean of its square.
    mean_square: N,
}

/// The lights, the tiles, and how lights are chosen.
pub(super) struct Scene<'a, L, F, R> {
    pub lights: &'a ShadingBatch<L>,
    pub tiles: &'a TileReceivers<F>,
    pub roulette: Roulette,
    pub least_distance_squared: f32,
    pub rule: R,
}

/// A block of tiles, and what its lists are made of.
pub(super) struct Block<'a> {
    pub node: Node,
    /// The lights that may light it.
    pub lights: &'a [u32],
    /// One element for each level of blocks from that of the node down, after one for the parts of a tile.
    pub scratch: &'a mut [PieceLists],
}

/// Where the lists of tiles are written.
pub(super) struct Output<'a> {
    pub lists: &'a mut WeightedLists,
    /// The tiles of the lists, if these are in the order in which they are written. Else each list is in its place.
    pub tiles: Option<&'a mut Vec<usize>>,
    /// How many pairs of a light and a cluster have been tested.
    pub pair_tests: u64,
}

impl Output<'_> {
    /// The index of the list of a tile.
    fn slot(&mut self, tile: usize) -> usize {
        match &mut self.tiles {
            None => tile,
            Some(tiles) => {
                tiles.push(tile);
                tiles.len() - 1
            }
        }
    }
}

/// The lists of the pieces of a node.
#[derive(Clone, Debug, Default)]
pub(super) struct PieceLists {
    /// The lights of each piece, all with the same room.
    lights: Vec<u32>,
    weights: Vec<f32>,
    lens: Vec<usize>,
    /// The pieces.
    nodes: Vec<Node>,
    room: usize,
}

impl PieceLists {
    /// Makes room for lists of `len` lights, and for a vector after them.
    fn begin(&mut self, nodes: impl Iterator<Item = Node>, len: usize, weighs: bool) {
        self.nodes.clear();
        self.nodes.extend(nodes);
        self.lens.clear();
        self.lens.resize(self.nodes.len(), 0);
        self.room = len + LANES;
        let numbers = self.nodes.len() * self.room;
        grow(&mut self.lights, numbers, 0);
        if weighs {
            grow(&mut self.weights, numbers, 0.0);
        }
    }

    /// Appends the list of a piece, a tile.
    fn append_to<S: Simd>(&self, simd: S, piece: usize, output: &mut Output, weighs: bool) {
        let (first, len) = (piece * self.room, self.lens[piece]);
        let lights = &self.lights[first..][..len + LANES];
        let weights = if weighs {
            &self.weights[first..][..len]
        } else {
            &[]
        };
        let slot = output.slot(self.nodes[piece].index);
        output.lists.append(simd, slot, lights, len, weights);
    }
}

impl<L: Lobe, F: LobeFamily, R: Rule> Scene<'_, L, F, R> {
    /// Writes the lists of all tiles of a block, of whose lights not all may light it. One more element of `scratch`
    /// is for those that may.
    #[cfg(feature = "rayon")]
    pub fn enter<S: Simd>(
        &self,
        simd: S,
        Block {
            node,
            lights,
            scratch,
        }: Block,
        output: &mut Output,
    ) {
        let Some((own, scratch)) = scratch.split_last_mut() else {
            return;
        };
        own.begin([node].into_iter(), lights.len(), false);
        output.pair_tests += lights.len() as u64;
        simd.vectorize(
            #[inline(always)]
            || self.choose::<_, _, false>(simd, lights, own, MayBeAccepted),
        );
        let lights = &own.lights[..own.lens[0]];
        let block = Block {
            node,
            lights,
            scratch,
        };
        self.walk(simd, block, output);
    }

    /// Writes the lists of all tiles of a block.
    pub fn walk<S: Simd>(
        &self,
        simd: S,
        Block {
            node,
            lights,
            scratch,
        }: Block,
        output: &mut Output,
    ) {
        let Some((own, scratch)) = scratch.split_last_mut() else {
            return;
        };
        own.begin(self.tiles.pieces(node), lights.len(), R::WEIGHS);
        output.pair_tests += (own.nodes.len() * lights.len()) as u64;
        let level_of_tiles = self.tiles.level_of_tiles();
        let are_tiles = node.level == level_of_tiles + 1;
        let are_divided = level_of_tiles > 0;
        simd.vectorize(
            #[inline(always)]
            || {
                if are_tiles && !are_divided {
                    self.choose::<_, _, false>(simd, lights, own, self.rule);
                } else {
                    self.choose::<_, _, false>(simd, lights, own, MayBeAccepted);
                }
            },
        );
        for (piece, node) in own.nodes.iter().enumerate() {
            let len = own.lens[piece];
            let lights = &own.lights[piece * own.room..][..len];
            if len == 0 {
                continue;
            }
            if !are_tiles {
                let block = Block {
                    node: *node,
                    lights,
                    scratch: &mut *scratch,
                };
                self.walk(simd, block, output);
            } else if are_divided {
                let refined = &mut scratch[0];
                refined.begin([*node].into_iter(), len, R::WEIGHS);
                output.pair_tests += (self.tiles.undivided(*node).count() * len) as u64;
                simd.vectorize(
                    #[inline(always)]
                    || self.choose::<_, _, true>(simd, lights, refined, self.rule),
                );
                refined.append_to(simd, 0, output, R::WEIGHS);
            } else {
                own.append_to(simd, piece, output, R::WEIGHS);
            }
        }
    }

    /// Writes to the list of each piece those of the lights that `rule` chooses: by its own cluster, or by
    /// those of its parts.
    #[inline(always)]
    fn choose<S: Simd, Q: Rule, const BY_PARTS: bool>(
        &self,
        simd: S,
        lights: &[u32],
        lists: &mut PieceLists,
        rule: Q,
    ) {
        let PieceLists {
            lights: out,
            weights,
            lens,
            nodes,
            room,
        } = lists;
        let lanes = S::f32s::LEN;
        // A test is a long chain of roots and quotients. The processor works on one vector while the other waits.
        for step in lights.chunks(2 * lanes) {
            let mut indices = [step[0]; 2 * LANES];
            indices[..step.len()].copy_from_slice(step);
            let filled = Twice(
                mask_of_first::<S>(simd, step.len()),
                mask_of_first::<S>(simd, step.len().saturating_sub(lanes)),
            );
            let gathered = Lights::gathered_twice(simd, self.lights, &indices);
            let light = lit_from(
                &gathered,
                #[inline(always)]
                |lane| self.lights.lobes.get(indices[lane] as usize),
            );
            let (first_half, second_half) = indices.split_at(lanes);
            let first_half = S::u32s::from_slice(simd, &first_half[..lanes]);
            let second_half = S::u32s::from_slice(simd, &second_half[..lanes]);
            for (piece, node) in nodes.iter().enumerate() {
                let radiance = if BY_PARTS {
                    self.radiance(self.tiles.undivided(*node), &light)
                } else {
                    self.radiance(self.tiles.cluster(*node).into_iter(), &light)
                };
                let probability = rule.probability(&radiance);
                let chosen = filled & probability.is_positive() & gathered.xi.le(probability);
                let weight = probability.splat(1.0) / probability;
                for (half, weight, chosen) in [
                    (first_half, weight.0, chosen.0),
                    (second_half, weight.1, chosen.1),
                ] {
                    let first = piece * *room + lens[piece];
                    if Q::WEIGHS {
                        compress::<S>(weight, chosen).store_slice(&mut weights[first..][..lanes]);
                    }
                    lens[piece] += write_chosen::<S>(half, chosen, &mut out[first..]);
                }
            }
        }
    }

    /// c/δ of the light in each lane over the receivers of all `clusters`.
    #[inline(always)]
    fn radiance<'c, 'l, N: Single>(
        &self,
        clusters: impl Iterator<Item = &'c ReceiverCluster<F>>,
        light: &LitFrom<N, impl Fn(usize) -> Option<&'l L>>,
    ) -> TileRadiance<N>
    where
        L: 'l,
    {
        let (mut radiance, mut receivers) = (TileRadiance::none(light.flux), 0.0);
        for cluster in clusters {
            let Majorant { greatest, typical } =
                cluster.radiance_over_delta(light, &self.roulette, self.least_distance_squared);
            let count = cluster.len() as f32;
            receivers += count;
            radiance.greatest = Real::max(greatest, radiance.greatest);
            radiance.mean_square = greatest * typical * count + radiance.mean_square;
        }
        TileRadiance {
            mean_square: radiance.mean_square * (1.0 / receivers),
            ..radiance
        }
    }
}

impl<N: Single> TileRadiance<N> {
    #[inline(always)]
    fn none(like: N) -> Self {
        Self {
            greatest: like.zero(),
            mean_square: like.zero(),
        }
    }
}

/// The lights of all lanes, with their lobes.
#[inline(always)]
fn lit_from<N: Single, O>(lights: &Lights<N>, lobe_of: O) -> LitFrom<'_, N, O> {
    LitFrom {
        position: lights.position,
        flux: lights.flux,
        numbers: &lights.numbers,
        lobe_of,
    }
}
