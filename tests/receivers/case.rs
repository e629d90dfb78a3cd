//! A random scene, and what is compared of its lists.

use std::marker::PhantomData;

use fastrand::Rng;
use stochastic_light_culling::{
    Blind, LightLists, Lobe, LobeFamily, ReceiverCluster, ReceiverCuller, Roulette, ShadingBatch,
    TileGrid, TileProbability, TileReceivers, Vpl, WeightedLists, Xi, glam::Vec3,
};

use crate::scene::{Pixel, Surfaces, lights};

/// A kind of receivers: the family of a pixel, and its value towards a light.
pub struct Receivers<F, M, V> {
    pub family: M,
    pub value: fn(&V, Vec3) -> f32,
    pub kinds: PhantomData<F>,
}

/// The family of a pixel, and what its value is computed from.
pub trait Family<F, V>: Fn(&Pixel, &mut Rng) -> (F, V) {}

impl<F, V, M: Fn(&Pixel, &mut Rng) -> (F, V)> Family<F, V> for M {}

pub fn blind() -> Receivers<Blind, impl Family<Blind, ()>, ()> {
    Receivers {
        family: |_: &Pixel, _: &mut Rng| (Blind, ()),
        value: |(), _| 1.0,
        kinds: PhantomData,
    }
}

const LEAST_DISTANCE_SQUARED: f32 = 1e-3;

/// Surfaces with their lobes, lights, and tiles.
struct Case<L, F, V> {
    surfaces: Surfaces,
    /// Of the pixels that see something.
    lobes: Vec<Option<(F, V)>>,
    lights: Vec<(Vpl<L>, Xi)>,
    batch: ShadingBatch<L>,
    delta: f32,
    probability: TileProbability,
    parts: u32,
    tiles: TileReceivers<F>,
}

impl<L: Lobe + Clone + Sync, F: LobeFamily, V: Sync> Case<L, F, V> {
    fn new<M: Family<F, V>>(
        lobe: fn(&mut Rng) -> L,
        receivers: &Receivers<F, M, V>,
        rng: &mut Rng,
    ) -> Self {
        let tile_size = [1, 2, 4, 8, 16][rng.usize(..5)];
        let surfaces = Surfaces::new(rng, tile_size);
        let lobes = surfaces.pixels.iter();
        let lobes = lobes.map(|pixel| pixel.as_ref().map(|pixel| (receivers.family)(pixel, rng)));
        let lobes = lobes.collect();
        let (lights, batch) = lights(rng, 200, lobe);
        let parts = [1, tile_size.min(2), tile_size][rng.usize(..3)];
        let tiles = TileReceivers::new(&surfaces.grid, parts, 1 + rng.u32(..2));
        let mean_square = TileProbability::root_mean_square(8.0).expect("in range");
        let mut case = Self {
            surfaces,
            lobes,
            lights,
            batch,
            delta: 10_f32.powf(-4.0 * rng.f32() - 1.0),
            probability: [TileProbability::bound(), mean_square][rng.usize(..2)],
            parts,
            tiles: tiles.expect("few"),
        };
        let mut tiles = case.tiles.clone();
        tiles.fill(|part, interval| case.cluster(part, interval));
        case.tiles = tiles;
        case
    }

    fn roulette(&self) -> Roulette {
        Roulette::new(self.delta).expect("positive")
    }

    fn points(
        &self,
        grid: TileGrid,
        tile: [u32; 2],
        interval: u32,
    ) -> impl Iterator<Item = (&Pixel, &(F, V))> + Clone {
        let columns = grid.image_size()[0];
        let pixels = grid.pixels(tile).pixels();
        let pixels = pixels.map(move |[x, y]| (y * columns + x) as usize);
        let points = pixels
            .filter_map(|i| Some((self.surfaces.pixels[i].as_ref()?, self.lobes[i].as_ref()?)));
        let all = self.tiles.intervals() == 1;
        points.filter(move |(pixel, _)| all || pixel.interval == interval)
    }

    fn cluster(&self, part: [u32; 2], interval: u32) -> Option<ReceiverCluster<F>> {
        let points = self.points(self.tiles.parts_grid(), part, interval);
        let scale = 1.0 + (part[0] / self.parts % 3) as f32;
        ReceiverCluster::of(points.map(|(pixel, (family, _))| (pixel.position, *family)))
            .map(|cluster| cluster.with_delta_scale(scale).expect("in range"))
    }

    /// All tiles and intervals.
    fn slots(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let intervals = self.tiles.intervals();
        let tiles = self.surfaces.grid.tiles();
        tiles.flat_map(move |tile| (0..intervals).map(move |interval| (tile, interval)))
    }

    /// The lists, which are the same at every width and on many cores.
    fn lists(&self) -> (LightLists, WeightedLists) {
        let mut found: Option<(LightLists, WeightedLists)> = None;
        for lanes in [4, 8, 16] {
            let culler = ReceiverCuller::new(&self.roulette()).with_lanes(lanes);
            let culler = culler.with_least_distance_squared(LEAST_DISTANCE_SQUARED);
            let mut culler = culler.expect("positive");
            let (mut lists, mut drawn) = (LightLists::new(), WeightedLists::new());
            let (batch, tiles) = (&self.batch, &self.tiles);
            culler.cull(batch, tiles, &mut lists).expect("few");
            let result = culler.draw(self.probability, batch, tiles, &mut drawn);
            result.expect("few");
            #[cfg(feature = "rayon")]
            self.check_many(&mut culler, (&lists, &drawn));
            if let Some(before) = &found {
                assert!(before.0 == lists && before.1 == drawn);
            }
            found = Some((lists, drawn));
        }
        found.expect("at three widths")
    }

    #[cfg(feature = "rayon")]
    fn check_many(&self, culler: &mut ReceiverCuller, of_one: (&LightLists, &WeightedLists)) {
        let (mut lists, mut drawn) = (LightLists::new(), WeightedLists::new());
        let mut tiles = self.tiles.clone();
        tiles.fill(|_, _| None);
        tiles.fill_in_parallel(|part, interval| self.cluster(part, interval));
        let result = culler.cull_in_parallel(&self.batch, &tiles, &mut lists);
        result.expect("few");
        let result = culler.draw_in_parallel(self.probability, &self.batch, &tiles, &mut drawn);
        result.expect("few");
        for (tile, interval) in self.slots() {
            assert_eq!(lists.of(tile, interval), of_one.0.of(tile, interval));
            assert_eq!(drawn.of(tile, interval), of_one.1.of(tile, interval));
        }
    }

    fn bound(&self, tile: [u32; 2], interval: u32, light: &Vpl<L>) -> f32 {
        let (roulette, least) = (self.roulette(), LEAST_DISTANCE_SQUARED);
        (self.tiles).greatest_radiance(tile, interval, light, &roulette, least)
    }

    /// The list of a tile is that of the scalar test.
    fn check_list(&self, (tile, interval): ([u32; 2], u32), list: &[u32]) {
        let expected = (0..).zip(&self.lights).filter(|(_, (light, xi))| {
            let bound = self.bound(tile, interval, light);
            bound > 0.0 && xi.get() <= bound
        });
        let expected: Vec<u32> = expected.map(|(light, _)| light).collect();
        assert_eq!(list, expected, "tile {tile:?}");
    }

    /// Every light that a receiver accepts is in the list of its tile. Returns how many pairs of a receiver and a light
    /// there are, and how many are accepted.
    fn check_accepted(
        &self,
        (tile, interval): ([u32; 2], u32),
        value: fn(&V, Vec3) -> f32,
        list: &[u32],
    ) -> [u64; 2] {
        let scale = (self.tiles.of(tile, interval)).map_or(1.0, ReceiverCluster::delta_scale);
        let roulette = Roulette::new(self.delta * scale).expect("positive");
        let mut counts = [0; 2];
        for (pixel, (_, lobe)) in self.points(self.surfaces.grid, tile, interval) {
            counts[0] += self.lights.len() as u64;
            for (light, (vpl, xi)) in (0..).zip(&self.lights) {
                let (direction, squared) = vpl.direction_to(pixel.position);
                let reflected = vpl.radiant_intensity(direction) * value(lobe, -direction);
                if roulette.accepts(reflected, squared.max(LEAST_DISTANCE_SQUARED), *xi) {
                    counts[1] += 1;
                    assert!(list.contains(&light), "light {light}, tile {tile:?}");
                }
            }
        }
        counts
    }

    /// The weight of a light that is drawn is at least 1 and that of the bound, and at most 1/ξ.
    fn check_weights(&self, (tile, interval): ([u32; 2], u32), drawn: &WeightedLists) {
        let drawn = drawn.of(tile, interval);
        assert_eq!(drawn.lights.len(), drawn.weights.len());
        for (light, weight) in drawn.lights.iter().zip(drawn.weights) {
            let (light, xi) = &self.lights[*light as usize];
            let least = (1.0 / self.bound(tile, interval, light)).max(1.0);
            assert!(*weight >= least * 0.99999, "{weight} {least}");
            assert!(xi.get() <= 1.00001 / weight);
        }
    }
}

/// Checks the lists of random scenes. Returns how many pairs of a receiver and a light were accepted.
pub fn check<L: Lobe + Clone + Sync, F: LobeFamily, M: Family<F, V>, V: Sync>(
    lobe: fn(&mut Rng) -> L,
    receivers: &Receivers<F, M, V>,
    seed: u64,
    scenes: u32,
) -> u64 {
    let mut rng = Rng::with_seed(seed);
    let [mut pairs, mut accepted, mut listed] = [0; 3];
    for _ in 0..scenes {
        let case = Case::new(lobe, receivers, &mut rng);
        let (lists, drawn) = case.lists();
        for slot in case.slots() {
            let list = lists.of(slot.0, slot.1);
            case.check_list(slot, list);
            case.check_weights(slot, &drawn);
            let [of_slot, accepted_of_slot] = case.check_accepted(slot, receivers.value, list);
            pairs += of_slot;
            accepted += accepted_of_slot;
            listed += list.len() as u64;
        }
    }
    println!(
        "{pairs} pairs of a receiver and a light, {accepted} accepted, 0 lost; {listed} listed"
    );
    accepted
}
