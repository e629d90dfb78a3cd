use alloc::vec::Vec;

use fearless_simd::{Level, dispatch};

use super::lists::WeightedLists;
use super::tiles::TileReceivers;
use super::walk::{Block, MayBeAccepted, Output, PieceLists, Rule, Scene};
use crate::base::{Error, number_in};
use crate::cull::culler::{at_most, widest};
use crate::cull::{LightLists, ShadingBatch};
use crate::light::{Roulette, TileProbability};
use crate::lobe::{Lobe, LobeFamily};

/// Finds the lights that the receivers of each tile reflect to the eye.
///
/// Where a [`Culler`](crate::Culler) knows of a tile only where it is, this one knows what its surfaces reflect. It
/// needs no bounds of lights: it reads the lights of a [`ShadingBatch`] with their ξ, and [`TileReceivers`]. Two ways
/// to choose:
///
/// - [`cull`](Self::cull) lists every light that a receiver of the tile may accept. Each receiver then decides by
///   its own radiance.
/// - [`draw`](Self::draw) decides for a tile as a whole, with the probability p_T that [`TileProbability`] gives.
///   Every light in the list counts, with the weight 1/p_T.
///
/// Keeps its memory. So frames after the first seldom allocate.
///
/// ```
/// use stochastic_light_culling::{
///     Blind, ConstantLobe, ReceiverCluster, ReceiverCuller, Roulette, Seed, ShadingBatch, TileGrid,
///     TileProbability, TileReceivers, Vpl, WeightedLists, glam::Vec3,
/// };
///
/// // A floor of 64×64 positions, and a hundred lamps above it.
/// let grid = TileGrid::new([64, 64], 16)?;
/// let mut tiles = TileReceivers::new(&grid, 1, 1)?;
/// tiles.fill(|tile, _| {
///     let pixels = grid.pixels(tile).pixels();
///     ReceiverCluster::of(pixels.map(|[x, y]| (Vec3::new(x as f32, y as f32, 0.0), Blind)))
/// });
/// let mut lights = ShadingBatch::new();
/// for light in 0..100 {
///     let position = Vec3::new((light % 10) as f32 * 6.0, (light / 10) as f32 * 6.0, 2.0);
///     lights.push(&Vpl::new(position, 1.0, ConstantLobe)?, Seed(0).frame(0).xi(light));
/// }
///
/// let mut lists = WeightedLists::new();
/// let mut culler = ReceiverCuller::new(&Roulette::new(0.005)?);
/// culler.draw(TileProbability::default(), &lights, &tiles, &mut lists)?;
/// let list = lists.of([1, 2], 0);
/// assert!(!list.lights.is_empty() && list.lights.len() < 50);
/// assert!(list.weights.iter().all(|weight| *weight >= 1.0));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ReceiverCuller {
    roulette: Roulette,
    least_distance_squared: f32,
    pub(super) level: Level,
    /// 0, 1, 2 and so on.
    pub(super) lights: Vec<u32>,
    /// One for the parts of a tile, and one for each level of blocks.
    scratch: Vec<PieceLists>,
    #[cfg(feature = "rayon")]
    pub(super) workers: Vec<super::parallel::Worker>,
    pub(super) pair_tests: u64,
}

impl ReceiverCuller {
    /// Creates a culler with the widest vectors of this processor. δ of `roulette` is in the unit of the radiance that
    /// reaches the eye.
    #[must_use]
    pub fn new(roulette: &Roulette) -> Self {
        Self {
            roulette: *roulette,
            least_distance_squared: 0.0,
            level: widest(),
            lights: Vec::new(),
            scratch: Vec::new(),
            #[cfg(feature = "rayon")]
            workers: Vec::new(),
            pair_tests: 0,
        }
    }

    /// Returns this culler with squared distances taken to be at least `least`, as
    /// [those of the estimator](crate::RadianceEstimator::with_least_distance_squared).
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `least` is negative, infinite or NaN.
    pub fn with_least_distance_squared(self, least: f32) -> Result<Self, Error> {
        let least = number_in("least squared distance", least, "in [0, ∞)", 0.0..=f32::MAX)?;
        Ok(Self {
            least_distance_squared: least,
            ..self
        })
    }

    /// Returns this culler with vectors of at most `lanes` lanes, as
    /// [`Culler::with_lanes`](crate::Culler::with_lanes) does. The lists are the same.
    #[must_use]
    pub fn with_lanes(self, lanes: usize) -> Self {
        Self {
            level: at_most(lanes),
            ..self
        }
    }

    /// How many pairs of a light and a tile, or a block of tiles, the last call tested.
    #[must_use]
    pub fn pair_tests(&self) -> u64 {
        self.pair_tests
    }

    /// Fills `lists` with the lights that a receiver of each tile may accept: those for which
    /// [`greatest_radiance`](TileReceivers::greatest_radiance) is positive and at least ξ.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if all lists together hold 2³² lights or more. The lists are then empty.
    pub fn cull<L: Lobe, F: LobeFamily>(
        &mut self,
        lights: &ShadingBatch<L>,
        tiles: &TileReceivers<F>,
        lists: &mut LightLists,
    ) -> Result<(), Error> {
        WeightedLists::without_weights(lists, |lists| {
            self.write(MayBeAccepted, lights, tiles, lists)
        })
    }

    /// Fills `lists` with the lights that are drawn for all receivers of a tile, and their weights 1/p_T: those for
    /// which the probability p_T is positive and at least ξ.
    ///
    /// # Errors
    ///
    /// As [`cull`](Self::cull).
    pub fn draw<L: Lobe, F: LobeFamily>(
        &mut self,
        probability: TileProbability,
        lights: &ShadingBatch<L>,
        tiles: &TileReceivers<F>,
        lists: &mut WeightedLists,
    ) -> Result<(), Error> {
        self.write(probability, lights, tiles, lists)
    }

    fn write<L: Lobe, F: LobeFamily, R: Rule>(
        &mut self,
        rule: R,
        lights: &ShadingBatch<L>,
        tiles: &TileReceivers<F>,
        lists: &mut WeightedLists,
    ) -> Result<(), Error> {
        lists.reset(tiles);
        self.number(lights.len());
        let scene = self.scene(rule, lights, tiles);
        let all = &self.lights[..lights.len()];
        let steps = tiles.levels_of_blocks() + 1;
        self.scratch
            .resize_with(steps.max(self.scratch.len()), PieceLists::default);
        let mut output = Output {
            lists,
            tiles: None,
            pair_tests: 0,
        };
        dispatch!(self.level, simd => {
            let block = Block {
                node: tiles.root(),
                lights: all,
                scratch: &mut self.scratch[..steps],
            };
            scene.walk(simd, block, &mut output);
        });
        self.pair_tests = output.pair_tests;
        lists.finish(tiles)
    }

    /// Makes sure that there are numbers for so many lights.
    pub(super) fn number(&mut self, lights: usize) {
        self.lights.extend(self.lights.len() as u32..lights as u32);
    }

    pub(super) fn scene<'a, L: Lobe, F: LobeFamily, R: Rule>(
        &self,
        rule: R,
        lights: &'a ShadingBatch<L>,
        tiles: &'a TileReceivers<F>,
    ) -> Scene<'a, L, F, R> {
        Scene {
            lights,
            tiles,
            roulette: self.roulette,
            least_distance_squared: self.least_distance_squared,
            rule,
        }
    }
}
