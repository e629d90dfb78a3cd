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
use crate::num::{Real, Single};
use crate::touch::LitFrom;
use crate::view::ReceiverCluster;

/// Which of the lights that may light a tile are in its list.
pub(super) trait Rule: Copy {
    /// Whether the list has weights.
    const WEIGHS: bool;

    /// Lights whose ξ is at most this are in the list.
    fn probability<N: Single>(self, radiance_over_delta: Majorant<N>) -> N;
}

/// All lights that a receiver may accept.
#[derive(Clone, Copy)]
pub(super) struct MayBeAccepted;

impl Rule for MayBeAccepted {
    const WEIGHS: bool = false;

    #[inline(always)]
    fn probability<N: Single>(self, radiance_over_delta: Majorant<N>) -> N {
        radiance_over_delta.greatest
    }
}

impl Rule for TileProbability {
    const WEIGHS: bool = true;

    #[inline(always)]
    fn probability<N: Single>(self, radiance_over_delta: Majorant<N>) -> N {
        self.of(radiance_over_delta)
    }
}

/// The lights, the tiles, and how lights are chosen.
pub(super) struct Scene<'a, L, F, R> {
    pub lights: &'a ShadingBatch<L>,
    pub tiles: &'a TileReceivers<F>,
    pub roulette: Roulette,
    pub least_distance_squared: f32,
    pub rule: R,
}

/// The lists of the parts of a node.
#[derive(Clone, Debug, Default)]
pub(super) struct PartLists {
    /// The lights of each part, all with the same room.
    lights: Vec<u32>,
    weights: Vec<f32>,
    lens: Vec<usize>,
    /// The parts.
    nodes: Vec<Node>,
    room: usize,
}

impl PartLists {
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
}

impl<L: Lobe, F: LobeFamily, R: Rule> Scene<'_, L, F, R> {
    /// Writes the lists of all tiles of `node` for these of the lights. `scratch` has one element for each level below.
    pub fn walk<S: Simd>(
        &self,
        simd: S,
        node: Node,
        lights: &[u32],
        scratch: &mut [PartLists],
        output: &mut WeightedLists,
        pair_tests: &mut u64,
    ) {
        let Some((own, scratch)) = scratch.split_last_mut() else {
            return;
        };
        own.begin(self.tiles.parts(node), lights.len(), R::WEIGHS);
        *pair_tests += (own.nodes.len() * lights.len()) as u64;
        let are_tiles = node.level == 1;
        simd.vectorize(
            #[inline(always)]
            || {
                if are_tiles {
                    self.choose(simd, lights, own, self.rule);
                } else {
                    self.choose(simd, lights, own, MayBeAccepted);
                }
            },
        );
        for (part, node) in own.nodes.iter().enumerate() {
            let (first, len) = (part * own.room, own.lens[part]);
            let lights = &own.lights[first..][..len + LANES];
            if len == 0 {
                continue;
            }
            if are_tiles {
                let weights = if R::WEIGHS {
                    &own.weights[first..][..len]
                } else {
                    &[]
                };
                output.append(simd, node.index, lights, len, weights);
            } else {
                self.walk(simd, *node, &lights[..len], scratch, output, pair_tests);
            }
        }
    }

    /// Writes to the list of each part those of the lights that `rule` chooses.
    #[inline(always)]
    fn choose<S: Simd, Q: Rule>(&self, simd: S, lights: &[u32], lists: &mut PartLists, rule: Q) {
        let PartLists {
            lights: out,
            weights,
            lens,
            nodes,
            room,
        } = lists;
        for step in lights.chunks(S::f32s::LEN) {
            let mut indices = [step[0]; LANES];
            indices[..step.len()].copy_from_slice(step);
            let filled = mask_of_first::<S>(simd, step.len());
            let gathered = Lights::gathered(simd, self.lights, &indices);
            let light = LitFrom {
                position: gathered.position,
                flux: gathered.flux,
                numbers: &gathered.numbers,
                lobe_of: |lane: usize| self.lights.lobes.get(indices[lane] as usize),
            };
            let indices = S::u32s::from_slice(simd, &indices[..S::u32s::LEN]);
            for (part, node) in nodes.iter().enumerate() {
                let Some(cluster) = self.tiles.cluster(*node) else {
                    continue;
                };
                let probability = rule.probability(self.radiance_over_delta(cluster, &light));
                let chosen = filled & probability.is_positive() & gathered.xi.le(probability);
                let first = part * *room + lens[part];
                if Q::WEIGHS {
                    let weight = probability.splat(1.0) / probability;
                    compress::<S>(weight, chosen)
                        .store_slice(&mut weights[first..][..S::f32s::LEN]);
                }
                lens[part] += write_chosen::<S>(indices, chosen, &mut out[first..]);
            }
        }
    }

    #[inline(always)]
    fn radiance_over_delta<'l, N: Single>(
        &self,
        cluster: &ReceiverCluster<F>,
        light: &LitFrom<N, impl Fn(usize) -> Option<&'l L>>,
    ) -> Majorant<N>
    where
        L: 'l,
    {
        cluster.radiance_over_delta(light, &self.roulette, self.least_distance_squared)
    }
}
