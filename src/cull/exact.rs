//! The exact test of all pairs of a light and a depth interval that pass the box test in an area.
//!
//! The pairs of many tiles are tested side by side, since a list of one tile seldom fills a vector.

use alloc::vec::Vec;
use core::ops::Range;

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::grow;
use super::block::{Numbers, Output, Scene};
use super::lanes::{LANES, mask_of_first, numbers_from, write_chosen};
use super::lists::Window;
use super::records::{Line, load_lines, load_records};
use super::tile_depths::Area;
use super::{LightLists, TileDepths};
use crate::num::{F32Lanes, Single};
use crate::touch::{BoxTest, Frustum};
use crate::view::ViewBounds;

/// The memory of the exact test of an area.
#[derive(Clone, Debug, Default)]
pub(super) struct ExactLists {
    /// For each depth interval, the places of the lights that pass the box test.
    pairs: LightLists,
    /// The bounds of each depth interval whose list is not empty.
    intervals: Vec<Line>,
    /// For each pair, the index of its interval in `intervals`.
    owners: Vec<u32>,
    /// For each pair, whether the light touches the interval.
    touches: Vec<bool>,
    /// For each pair, how many pairs before it touch.
    kept_before: Vec<u32>,
    /// The pairs that the first step of the test leaves undecided.
    undecided: Vec<u32>,
}

impl ExactLists {
    /// Clears the pairs, to be written for the tiles of `area`.
    pub fn begin(&mut self, area: Area, tiles: &TileDepths) -> Output<'_> {
        self.pairs.reset(area.size(), tiles.intervals() as usize);
        Output {
            lists: &mut self.pairs,
            window: Window::of(area, 0),
            numbers: Numbers::Places,
        }
    }

    /// Writes the lists of the pairs that pass the exact test. Returns the number of the others.
    #[inline(always)]
    pub fn write<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        scene: &Scene<P>,
        area: Area,
        output: &mut Output,
    ) -> u64 {
        self.find_owners(scene.tiles, area);
        self.test(simd, scene);
        let (places, lights) = (self.pairs.lights(), scene.batch.lights());
        let room = output.lists.room_for(places.len() + 1);
        grow(&mut self.kept_before, places.len() + 1, 0);
        let mut kept = 0;
        for (pair, place) in places.iter().enumerate() {
            self.kept_before[pair] = kept as u32;
            // Overwritten by the next light unless it touches the interval.
            room[kept] = lights[*place as usize];
            kept += usize::from(self.touches[pair]);
        }
        self.kept_before[places.len()] = kept as u32;
        let (from, intervals) = (Window::of(area, 0), scene.tiles.intervals() as usize);
        for y in area.min[1]..area.max[1] {
            for x in area.min[0]..area.max[0] {
                let from = from.slot([x, y], intervals);
                let to = output.window.slot([x, y], intervals);
                for interval in 0..intervals {
                    let Range { start, end } = self.pairs.range(from + interval);
                    let [start, end] = [start, end].map(|pair| self.kept_before[pair] as usize);
                    output.lists.set_range(to + interval, start..end);
                }
            }
        }
        let rejected = places.len() - kept;
        output.lists.advance(kept);
        rejected as u64
    }

    /// Finds the interval of each pair, and the bounds of that.
    #[inline(always)]
    fn find_owners(&mut self, tiles: &TileDepths, area: Area) {
        let window = Window::of(area, 0);
        let intervals = tiles.intervals() as usize;
        self.intervals.clear();
        grow(&mut self.owners, self.pairs.len(), 0);
        for y in area.min[1]..area.max[1] {
            for x in area.min[0]..area.max[0] {
                let first = window.slot([x, y], intervals);
                for (interval, [near, far]) in tiles.depths_of(x, y).iter().enumerate() {
                    let range = self.pairs.range(first + interval);
                    if !range.is_empty() {
                        self.owners[range].fill(self.intervals.len() as u32);
                        let mut bounds = [0.0; LANES];
                        let ([left, right], [bottom, top]) = (tiles.across(x), tiles.down(y));
                        bounds[..6].copy_from_slice(&[left, right, bottom, top, *near, *far]);
                        self.intervals.push(Line(bounds));
                    }
                }
            }
        }
    }

    /// Finds out which pairs touch.
    #[inline(always)]
    fn test<S: Simd, P: BoxTest>(&mut self, simd: S, scene: &Scene<P>) {
        let places = self.pairs.lights();
        grow(&mut self.touches, places.len(), false);
        grow(&mut self.undecided, places.len() + LANES, 0);
        let mut undecided = 0;
        for first in (0..places.len()).step_by(S::f32s::LEN) {
            let count = S::f32s::LEN.min(places.len() - first);
            let frustum = self.frustum(simd, scene, |lane| first + lane.min(count - 1));
            let verdict = frustum.first_verdict();
            let wanted = mask_of_first(simd, count);
            let meets_or_open = wanted & !(verdict.is_separated | frustum.is_out_of_reach());
            let touching = meets_or_open & !verdict.is_undecided;
            let touching = touching.to_bitmask();
            for (lane, touches) in self.touches[first..][..count].iter_mut().enumerate() {
                *touches = touching >> lane & 1 != 0;
            }
            let numbers = numbers_from(simd, first);
            let out = &mut self.undecided[undecided..];
            undecided += write_chosen::<S>(numbers, meets_or_open & verdict.is_undecided, out);
        }
        for pairs in self.undecided[..undecided].chunks(S::f32s::LEN) {
            let pair = |lane: usize| pairs[lane.min(pairs.len() - 1)] as usize;
            let touching = self.frustum(simd, scene, pair).meets_ball();
            let touching = touching.to_bitmask();
            for (lane, pair) in pairs.iter().enumerate() {
                self.touches[*pair as usize] = touching >> lane & 1 != 0;
            }
        }
    }

    /// The image of the interval of the pair that `pair` gives for each lane, and the ball of its light.
    #[inline(always)]
    fn frustum<S: Simd, P: BoxTest>(
        &self,
        simd: S,
        scene: &Scene<P>,
        pair: impl Fn(usize) -> usize,
    ) -> Frustum<<F32Lanes<S> as Single>::Double, P::Projection> {
        let (places, batch) = (self.pairs.lights(), scene.batch);
        let shapes = load_records::<S, P>(
            simd,
            #[inline(always)]
            |lane| (batch.record(places[pair(lane)] as usize)).expect("a light of the batch"),
        );
        let bounds = load_lines(
            simd,
            #[inline(always)]
            |lane| &self.intervals[self.owners[pair(lane)] as usize],
        );
        let mut fields = P::fields_of(F32Lanes::new(simd, 0.0).widen());
        for (field, vector) in fields.as_mut().iter_mut().zip(shapes.as_ref()) {
            *field = vector.widen();
        }
        let [left, right, bottom, top, near, far, ..] = bounds;
        let tile = ViewBounds {
            across: [left, right],
            down: [bottom, top],
            depths: [near, far],
        };
        Frustum::new(P::image(&fields), P::clipped(&shapes, &tile).widen())
    }
}
