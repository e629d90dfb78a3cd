use alloc::vec::Vec;

use fearless_simd::{Level, dispatch};

use super::bins::{Bins, Blocks};
use super::block::{BLOCK, By, Numbers, Output, Scene, Scratch};
use super::lists::Window;
use super::{LightBatch, LightLists, TileDepths};
use crate::base::Error;
use crate::touch::BoxTest;

/// Finds the lights that may touch each tile of a grid.
///
/// Takes a [`LightBatch`], which a [`BatchBuilder`](crate::BatchBuilder) makes from the lights of a frame,
/// and [`TileDepths`]; fills [`LightLists`]. Uses the widest vectors of the processor. The lists do not
/// depend on the width.
///
/// Keeps its memory, with half as much to spare. So frames after the first allocate only if one needs more
/// than that.
///
/// ```
/// use stochastic_light_culling::{
///     Camera, Culler, DepthInterval, LightBatch, LightLists, Sphere, TileDepths,
///     TileGrid, glam::Vec3,
/// };
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let grid = TileGrid::new([128, 128], 16)?;
/// let mut tiles = TileDepths::new(&grid, &camera, 1)?;
/// for tile in grid.tiles() {
///     tiles.set(tile, [DepthInterval::new(5.0, 20.0)?]);
/// }
///
/// let mut batch = LightBatch::new();
/// let sphere = Sphere::new(Vec3::new(0.0, 0.0, -10.0), 1.0)?;
/// batch.extend(sphere.project(&camera).map(|shape| (7, shape)));
///
/// let mut lists = LightLists::new();
/// Culler::new().cull(&batch, &tiles, &mut lists)?;
/// assert_eq!(lists.of([4, 4], 0), [7]);
/// assert!(lists.of([0, 0], 0).is_empty());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Culler<P: BoxTest> {
    pub(super) level: Level,
    pub(super) use_blocks: bool,
    /// 0, 1, 2 and so on: the places of all lights.
    places: Vec<u32>,
    pub(super) blocks: Blocks,
    bins: Bins,
    pub(super) scratch: Scratch<P>,
    #[cfg(feature = "rayon")]
    pub(super) bins_of_threads: Vec<Bins>,
    #[cfg(feature = "rayon")]
    pub(super) workers: Vec<super::parallel::Worker<P>>,
}

/// Counts of the work of one call of [`Culler::cull`].
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CullCounters {
    /// Comparisons of the bounds of a light with those of a part of a block of tiles.
    pub block_tests: u64,
    /// Comparisons of the bounds of a light with those of a tile. Those of a chunk count for all its sixteen lanes.
    pub tile_tests: u64,
    /// Box tests of a light against a depth interval of a tile. Those of a vector count for all its lanes, so the
    /// number depends on the processor.
    pub box_tests: u64,
    /// Depth intervals and whole blocks of tiles that have no surfaces and were skipped.
    pub empty: u64,
    /// Pairs of a light and a depth interval for which `touches` is true and the exact test fails. Zero without
    /// the exact test.
    pub rejected_exactly: u64,
    /// Pairs of a light and a depth interval in the lists: [`LightLists::len`].
    pub pairs: u64,
}

impl<P: BoxTest> Culler<P> {
    /// Creates a culler with the widest vectors of this processor. Without the feature `std` the processor
    /// cannot be queried, and the vectors are those of the compilation target.
    #[must_use]
    pub fn new() -> Self {
        Self::with_level(widest())
    }

    /// Creates a culler with vectors of at most `lanes` lanes, for measurements. The lists are the same.
    ///
    /// On x86, 16 lanes are AVX-512, 8 are AVX2 and 4 are SSE; fewer than 4 count as 4. On other processors
    /// there is only one width.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     BatchBuilder, Camera, Culler, DepthInterval, Direction, Ggx, GgxLobe, Incidence, LightBatch,
    ///     LightLists, NoFresnel, Roulette, TileDepths, TileGrid, Vpl, Xi, glam::Vec3,
    /// };
    ///
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
    /// let grid = TileGrid::new([128, 128], 16)?;
    /// let mut tiles = TileDepths::new(&grid, &camera, 1)?;
    /// for tile in grid.tiles() {
    ///     tiles.set(tile, [DepthInterval::new(5.0, 20.0)?]);
    /// }
    /// let lobe = GgxLobe::new(Ggx::new(0.2)?, NoFresnel, Incidence::head_on(Direction::Y));
    /// let light = Vpl::new(Vec3::new(0.0, -1.0, -9.0), 1.0, lobe)?;
    ///
    /// let builder = BatchBuilder::new(&Roulette::new(0.01)?, &camera);
    /// let mut lists = [4, 8, 16].map(|_| LightLists::new());
    /// for (lists, lanes) in lists.iter_mut().zip([4, 8, 16]) {
    ///     let mut batch = LightBatch::new();
    ///     builder.with_lanes(lanes).add([(3, &light, Xi::new(0.5)?)], &mut batch);
    ///     Culler::with_lanes(lanes).cull(&batch, &tiles, lists)?;
    /// }
    /// assert!(!lists[0].is_empty() && lists[0] == lists[1] && lists[1] == lists[2]);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[must_use]
    pub fn with_lanes(lanes: usize) -> Self {
        Self::with_level(at_most(lanes))
    }

    fn with_level(level: Level) -> Self {
        Self {
            level,
            use_blocks: true,
            places: Vec::new(),
            blocks: Blocks::default(),
            bins: Bins::default(),
            scratch: Scratch::new(),
            #[cfg(feature = "rayon")]
            bins_of_threads: Vec::new(),
            #[cfg(feature = "rayon")]
            workers: Vec::new(),
        }
    }

    /// Returns this culler without blocks: each tile is tested against all lights. The lists are the same.
    /// Faster for a few dozen lights.
    #[must_use]
    pub fn without_blocks(self) -> Self {
        Self {
            use_blocks: false,
            ..self
        }
    }

    /// Returns this culler with the exact test after the test by bounds and box: lists hold the lights for which
    /// [`touches_exactly`](crate::TileTest::touches_exactly) is true.
    ///
    /// The lists are shorter by a few per cent, and culling takes two to four times as long. Rarely worth it:
    /// only if the work for each light of a list takes a hundred times as long as an exact test, which is ten to
    /// twenty nanoseconds.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Camera, Culler, DepthInterval, Ellipsoid, LightBatch, LightLists, TileDepths,
    ///     TileRectangle, glam::{Mat3, Vec2, Vec3},
    /// };
    ///
    /// // Beside a deep tile, and turned so that its bounds and the tile's box meet.
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.5, 1.0, 0.1..100.0)?;
    /// let center = Vec3::new(4.5, 0.0, -11.0);
    /// let ellipsoid = Ellipsoid::new(center, Mat3::from_rotation_y(1.0), Vec3::new(2.0, 1.0, 1.0))?;
    /// let mut batch = LightBatch::new();
    /// batch.extend(ellipsoid.project(&camera).map(|stretch| (0, stretch)));
    /// let tile = TileRectangle::new(Vec2::new(0.5, 0.0), Vec2::new(0.6, 0.1))?;
    /// let mut tiles = TileDepths::from_rectangles([1, 1], 1, |_| tile)?;
    /// tiles.set([0, 0], [DepthInterval::new(5.0, 10.0)?]);
    ///
    /// let mut lists = LightLists::new();
    /// // One tile needs no blocks.
    /// let mut culler = Culler::new().without_blocks();
    /// assert_eq!(culler.cull(&batch, &tiles, &mut lists)?.pairs, 1);
    /// let counters = culler.with_exact_test().cull(&batch, &tiles, &mut lists)?;
    /// assert_eq!((counters.pairs, counters.rejected_exactly), (0, 1));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[must_use]
    pub fn with_exact_test(mut self) -> Self {
        self.scratch.test_exactly();
        self
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub(super) fn bytes(&self) -> usize {
        let bins = core::iter::once(&self.bins).chain(&self.bins_of_threads);
        let workers = self.workers.iter().map(super::parallel::Worker::bytes);
        bins.map(Bins::bytes).sum::<usize>() + self.scratch.bytes() + workers.sum::<usize>()
    }

    /// Fills `lists` with the lights of `batch` that may touch each depth interval of each tile: those for
    /// which [`touches`](crate::TileTest::touches) is true, or
    /// [`touches_exactly`](crate::TileTest::touches_exactly) for a culler
    /// [with the exact test](Self::with_exact_test).
    ///
    /// `batch` must be projected with the camera that `tiles` are of. Previous contents of `lists` are
    /// discarded.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if all lists together hold 2³² lights or more. The lists are then empty.
    pub fn cull(
        &mut self,
        batch: &LightBatch<P>,
        tiles: &TileDepths,
        lists: &mut LightLists,
    ) -> Result<CullCounters, Error> {
        let all = tiles.all();
        lists.reset(all.size(), tiles.intervals() as usize);
        self.scratch.counters = CullCounters::default();
        let scene = Scene { batch, tiles };
        let mut output = Output {
            lists,
            window: Window::all(all.size()[0]),
            numbers: Numbers::Lights,
        };
        let Self {
            places,
            blocks,
            bins,
            scratch,
            ..
        } = self;
        if self.use_blocks && all.exceeds(BLOCK) {
            blocks.set(tiles);
            dispatch!(self.level, simd => bins.fill(simd, batch, 0..batch.len(), blocks));
            for (block, area) in blocks.areas.iter().enumerate() {
                let places = bins.of(block);
                dispatch!(self.level, simd => scratch.cull(simd, &scene, places, *area, By::BoundsAndBoxes, &mut output));
            }
        } else {
            places.extend(places.len() as u32..batch.len() as u32);
            let places = &places[..batch.len()];
            let selects = self.use_blocks;
            dispatch!(self.level, simd => if selects {
                scratch.cull(simd, &scene, places, all, By::BoundsOfAll, &mut output);
            } else {
                scratch.cull_undivided(simd, &scene, places, all, &mut output);
            });
        }
        finish(self.scratch.counters, tiles, lists)
    }
}

/// Finishes `lists`, and completes `counters` with the number of pairs.
pub(super) fn finish(
    counters: CullCounters,
    tiles: &TileDepths,
    lists: &mut LightLists,
) -> Result<CullCounters, Error> {
    lists.finish();
    lists.check_size(tiles.size())?;
    Ok(CullCounters {
        pairs: lists.len() as u64,
        ..counters
    })
}

/// The widest vectors of the processor; without `std`, of the compilation target.
pub(super) fn widest() -> Level {
    Level::try_detect().unwrap_or(Level::baseline())
}

/// The widest vectors of at most `lanes` lanes, where there is a choice.
pub(super) fn at_most(lanes: usize) -> Level {
    let widest = widest();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let _ = lanes;
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let widest = match lanes {
        ..8 => widest.as_sse2().map_or(widest, Level::Sse2),
        8..16 => widest.as_avx2().map_or(widest, Level::Avx2),
        16.. => widest,
    };
    widest
}

impl<P: BoxTest> Default for Culler<P> {
    fn default() -> Self {
        Self::new()
    }
}
