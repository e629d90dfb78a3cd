//! A block of tiles: lights are selected for parts of it, and those of each part are tested against its tiles.

use fearless_simd::Simd;

use super::exact::ExactLists;
use super::lanes::LANES;
use super::lists::Window;
use super::select::{MAX_SIDE, Parts, Ranges, Selection};
use super::tile_depths::{Area, Cut};
use super::tile_lists::TileLists;
use super::{CullCounters, LightBatch, LightLists, TileDepths};
use crate::touch::BoxTest;

/// The lights and the tiles of a frame.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a, P: BoxTest> {
    pub batch: &'a LightBatch<P>,
    pub tiles: &'a TileDepths,
}

/// The lists to write, and where they hold the tiles that are culled.
pub(super) struct Output<'a> {
    pub lists: &'a mut LightLists,
    pub window: Window,
    pub numbers: Numbers,
}

/// What lists hold for each light.
#[derive(Clone, Copy)]
pub(super) enum Numbers {
    /// Its index, for the caller.
    Lights,
    /// Its place, for the exact test.
    Places,
}

/// Upper limit of the tiles of a block, in each direction.
pub(super) const BLOCK: usize = MAX_SIDE * PARTS[0];
/// Upper limits of the tiles of the parts of a block, and of their parts, in each direction.
const PARTS: [usize; 2] = [5, 2];
/// So many lights are tested against all tiles of an area, each of which takes one vector or a few.
const FEW: usize = 2 * LANES;

/// How the lights of a part are selected.
#[derive(Clone, Copy)]
pub(super) enum By {
    /// By their bounds, from all lights of the batch, which are read in order.
    BoundsOfAll,
    /// By their bounds.
    Bounds,
    /// By their bounds, then by the box of the part. Pays for lights that are known to have bounds that touch the
    /// block, since those of its parts reject few of them.
    BoundsAndBoxes,
}

/// The memory for one block at a time.
#[derive(Clone, Debug)]
pub(super) struct Scratch<P: BoxTest> {
    /// The lights of each part of a block, and of each part of the current part.
    selections: [Selection; PARTS.len()],
    tile_lists: TileLists<P>,
    /// What the exact test needs, if it follows the box test.
    exact: Option<ExactLists>,
    pub counters: CullCounters,
}

impl<P: BoxTest> Scratch<P> {
    pub fn new() -> Self {
        Self {
            selections: [const { Selection::new() }; PARTS.len()],
            tile_lists: TileLists::new(),
            exact: None,
            counters: CullCounters::default(),
        }
    }

    /// Has the exact test follow the box test.
    pub fn test_exactly(&mut self) {
        self.exact = Some(ExactLists::default());
    }

    /// Memory for the same tests, without any contents.
    #[cfg(feature = "rayon")]
    pub fn with_same_tests(&self) -> Self {
        let mut scratch = Self::new();
        if self.exact.is_some() {
            scratch.test_exactly();
        }
        scratch
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub fn bytes(&self) -> usize {
        let selections = self.selections.iter().map(Selection::bytes);
        selections.sum::<usize>() + self.tile_lists.bytes()
    }

    /// Writes the lists of the tiles of `area`, which is at most a block: those of the lights at `places` that
    /// touch each.
    #[inline(always)]
    pub fn cull<S: Simd>(
        &mut self,
        simd: S,
        scene: &Scene<P>,
        places: &[u32],
        area: Area,
        by: By,
        output: &mut Output,
    ) {
        self.cull_parts(simd, scene, places, area, (&PARTS, by), output);
    }

    /// Writes the lists of the tiles of any `area`, without a selection of lights for parts of it.
    #[inline(always)]
    pub fn cull_undivided<S: Simd>(
        &mut self,
        simd: S,
        scene: &Scene<P>,
        places: &[u32],
        area: Area,
        output: &mut Output,
    ) {
        self.cull_parts(simd, scene, places, area, (&[], By::Bounds), output);
    }

    /// Writes the lists of the tiles of `area`, divided into parts of these sizes.
    #[inline(always)]
    fn cull_parts<S: Simd>(
        &mut self,
        simd: S,
        scene: &Scene<P>,
        places: &[u32],
        area: Area,
        (sizes, by): (&[usize], By),
        output: &mut Output,
    ) {
        let (tile_lists, counters) = (&mut self.tile_lists, &mut self.counters);
        let mut divide = |output: &mut Output| {
            let mut walk = Walk {
                scene,
                tile_lists: &mut *tile_lists,
                output,
                counters: &mut *counters,
            };
            walk.divide(simd, places, area, &mut self.selections, sizes, by);
        };
        let Some(exact) = &mut self.exact else {
            return divide(output);
        };
        divide(&mut exact.begin(area, scene.tiles));
        let rejected = simd.vectorize(
            #[inline(always)]
            || exact.write(simd, scene, area, output),
        );
        self.counters.rejected_exactly += rejected;
    }
}

/// The state of the walk over a block.
struct Walk<'a, 'b, P: BoxTest> {
    scene: &'a Scene<'a, P>,
    tile_lists: &'a mut TileLists<P>,
    output: &'a mut Output<'b>,
    counters: &'a mut CullCounters,
}

impl<P: BoxTest> Walk<'_, '_, P> {
    /// Writes the lists of `area`: selects the lights of parts of it, whose greatest sizes are `sizes`, until there
    /// are few lights or few tiles.
    fn divide<S: Simd>(
        &mut self,
        simd: S,
        places: &[u32],
        area: Area,
        selections: &mut [Selection],
        sizes: &[usize],
        by: By,
    ) {
        let ([selection, selections @ ..], [size, sizes @ ..]) = (selections, sizes) else {
            return self.write(simd, places, area);
        };
        if places.len() <= FEW {
            return self.write(simd, places, area);
        }
        if !area.exceeds(*size) {
            return self.divide(simd, places, area, selections, sizes, by);
        }
        let cut = area.cut(*size);
        let parts = parts_of(cut, self.scene.tiles);
        simd.vectorize(
            #[inline(always)]
            || {
                let batch = self.scene.batch;
                match by {
                    By::BoundsOfAll => selection.select_of_all(simd, batch, &parts),
                    By::Bounds => selection.select(simd, batch, places, &parts),
                    By::BoundsAndBoxes => selection.select_by_boxes(simd, batch, places, &parts),
                }
            },
        );
        self.counters.block_tests += (places.len() * parts.size[0] * parts.size[1]) as u64;
        let [columns, rows] = parts.size;
        for row in 0..rows {
            for column in 0..columns {
                let places = selection.of(row * columns + column);
                let part = cut.part(column, row);
                self.divide(simd, places, part, selections, sizes, By::Bounds);
            }
        }
    }

    /// Writes the lists of `area`.
    fn write<S: Simd>(&mut self, simd: S, places: &[u32], area: Area) {
        let Self {
            scene,
            tile_lists,
            output,
            counters,
        } = self;
        tile_lists.write(simd, scene, places, area, output, counters);
    }
}

/// What the selection of lights needs to know of the parts of an area.
fn parts_of(cut: Cut, tiles: &TileDepths) -> Parts {
    let size @ [columns, rows] = cut.size();
    let mut parts = Parts {
        size,
        across: Ranges::NONE,
        down: Ranges::NONE,
        depths: Ranges::NONE,
    };
    for row in 0..rows {
        for column in 0..columns {
            let part = cut.part(column, row);
            let [across, down] = [0, 1].map(|i| part.min[i]..part.max[i]);
            parts.across.set(column, tiles.columns_of(across));
            parts.down.set(row, tiles.rows_of(down));
            let depths = tiles.depths_of_area(part);
            parts.depths.set(row * columns + column, depths);
        }
    }
    parts
}
