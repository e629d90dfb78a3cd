//! The lists of tiles with one depth interval, with a tile in each lane.
//!
//! Where few lights touch a tile, a vector of lights has idle lanes at each tile. Neighbours share most of their lights:
//! of a vector of tiles, a light that touches one touches most.

use alloc::vec::Vec;

use fearless_simd::{Simd, SimdBase, SimdMask};

use super::batch::grow;
use super::block::Output;
use super::lanes::{LANES, Lanes, load, numbers_from, parts, write_chosen};
use super::tile_depths::{Area, NONE, is_none};
use super::tile_lists::Chunk;
use super::{CullCounters, TileDepths};
use crate::num::{F32Lanes, Real};
use crate::touch::BoxTest;
use crate::view::ViewBounds;

/// Up to as many tiles as a vector has lanes.
struct TilesInLanes {
    /// The least and the greatest slopes across and down, and depths. Of lanes past the last tile, anything.
    ends: [[Lanes; 2]; 3],
    /// What holds all tiles.
    hull: [[f32; 2]; 3],
    slots: Lanes<usize>,
    len: usize,
}

impl TilesInLanes {
    const EMPTY: Self = Self {
        ends: [[[NONE[0]; LANES], [NONE[1]; LANES]]; 3],
        hull: [NONE; 3],
        slots: [0; LANES],
        len: 0,
    };

    #[inline(always)]
    fn push(&mut self, tile: [[f32; 2]; 3], slot: usize) {
        let lane = self.len % LANES;
        for ([least, greatest], range) in self.ends.iter_mut().zip(tile) {
            [least[lane], greatest[lane]] = range;
        }
        for (hull, [least, greatest]) in self.hull.iter_mut().zip(tile) {
            *hull = [Real::min(hull[0], least), Real::max(hull[1], greatest)];
        }
        self.slots[lane] = slot;
        self.len += 1;
    }

    /// Forgets all tiles.
    #[inline(always)]
    fn clear(&mut self) {
        (self.hull, self.len) = ([NONE; 3], 0);
    }

    /// What holds all tiles, in each lane.
    #[inline(always)]
    fn hull<S: Simd>(&self, simd: S) -> ViewBounds<F32Lanes<S>> {
        let range = |[least, greatest]: [f32; 2]| {
            [F32Lanes::new(simd, least), F32Lanes::new(simd, greatest)]
        };
        let [across, down, depths] = self.hull;
        ViewBounds {
            across: range(across),
            down: range(down),
            depths: range(depths),
        }
    }

    /// What each tile spans. Nothing past the last one.
    #[inline(always)]
    fn load<S: Simd>(&mut self, simd: S) -> ViewBounds<F32Lanes<S>> {
        for [least, greatest] in &mut self.ends {
            for lane in self.len..S::f32s::LEN {
                [least[lane % LANES], greatest[lane % LANES]] = NONE;
            }
        }
        let range =
            |[least, greatest]: &[Lanes; 2]| [load(simd, least, 0), load(simd, greatest, 0)];
        let [across, down, depths] = &self.ends;
        ViewBounds {
            across: range(across),
            down: range(down),
            depths: range(depths),
        }
    }
}

/// Makes the lists of as many tiles at a time as there are lanes.
#[derive(Clone, Debug)]
pub(super) struct LaneWriter {
    /// The lights whose bounds touch what holds the tiles: their places in the chunks, then their numbers.
    lights: Vec<u32>,
    /// The bits of the lanes whose tiles each of them touches.
    touched: Vec<u32>,
}

impl LaneWriter {
    pub const fn new() -> Self {
        Self {
            lights: Vec::new(),
            touched: Vec::new(),
        }
    }

    /// The memory in use, with what is to spare.
    #[cfg(all(test, feature = "rayon"))]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.lights[..]) + size_of_val(&self.touched[..])
    }

    /// Writes the lists of the tiles of `area`, which have one depth interval, for the lights of `chunks`.
    #[inline(always)]
    pub fn write<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        chunks: &[Chunk<P>],
        tiles: &TileDepths,
        area: Area,
        output: &mut Output,
        counters: &mut CullCounters,
    ) {
        let tests = (chunks.len() * LANES) as u64;
        let mut lanes = TilesInLanes::EMPTY;
        let last = area.max.map(|end| end - 1);
        for y in area.min[1]..area.max[1] {
            for x in area.min[0]..area.max[0] {
                let depths = tiles.hull(x, y);
                if is_none(depths) {
                    counters.empty += 1;
                } else {
                    counters.tile_tests += tests;
                    counters.box_tests += tests;
                    let slot = output.window.slot([x, y], 1);
                    lanes.push([tiles.across(x), tiles.down(y), depths], slot);
                }
                if lanes.len == S::f32s::LEN || ([x, y] == last && lanes.len > 0) {
                    self.write_lanes(simd, chunks, &mut lanes, output);
                    lanes.clear();
                }
            }
        }
    }

    #[inline(always)]
    fn write_lanes<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        chunks: &[Chunk<P>],
        lanes: &mut TilesInLanes,
        output: &mut Output,
    ) {
        let tiles = lanes.load(simd);
        let count = self.find_lights(simd, chunks, &lanes.hull(simd));
        if count == 0 {
            return;
        }
        // Bits of the tiles that each light touches. Whole vectors are read.
        let room = count + S::u32s::LEN;
        grow(&mut self.touched, room, 0);
        let (lights, touched) = (&mut self.lights[..room], &mut self.touched[..room]);
        for (light, touched) in lights[..count].iter_mut().zip(touched.iter_mut()) {
            let place = *light as usize;
            let (fields, number) = chunks[place / LANES].splat(simd, place % LANES);
            let outline = P::outline(&fields, tiles.across, tiles.down);
            let meet = P::bounds_of(&fields).meet(&tiles);
            let touching = meet & !P::misses(&fields, &outline, tiles.depths);
            (*light, *touched) = (number, touching.to_bitmask() as u32);
        }
        touched[count..].fill(0);
        for (lane, slot) in lanes.slots[..lanes.len.min(LANES)].iter().enumerate() {
            let (list, mut len) = (output.lists.room_for(room), 0);
            for first in (0..count).step_by(S::u32s::LEN) {
                let load =
                    |lanes: &[u32]| S::u32s::from_slice(simd, &lanes[first..][..S::u32s::LEN]);
                let bit = S::u32s::splat(simd, 1 << lane);
                let touches = (load(touched) & bit).simd_eq(bit);
                len += write_chosen::<S>(load(lights), touches, &mut list[len..]);
            }
            output.lists.set_range(*slot, 0..len);
            output.lists.advance(len);
        }
    }

    /// Writes the places in `chunks` of the lights whose bounds meet `hull` to the front of `lights`. Returns their number.
    #[inline(always)]
    fn find_lights<S: Simd, P: BoxTest>(
        &mut self,
        simd: S,
        chunks: &[Chunk<P>],
        hull: &ViewBounds<F32Lanes<S>>,
    ) -> usize {
        grow(&mut self.lights, (chunks.len() + 1) * LANES, 0);
        let mut count = 0;
        for (index, chunk) in chunks.iter().enumerate() {
            for part in 0..parts::<S>() {
                let places = numbers_from(simd, index * LANES + part * S::u32s::LEN);
                let meet = P::bounds_of(&chunk.load(simd, part)).meet(hull);
                count += write_chosen::<S>(places, meet, &mut self.lights[count..]);
            }
        }
        count
    }
}
