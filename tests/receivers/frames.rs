//! Many frames of a scene, and the error of their mean.

use fastrand::Rng;
use stochastic_light_culling::{
    Decision, FrameSeed, GgxLobe, LightLists, Lobe, LobeFamily, RadianceEstimator, Receiver,
    ReceiverBlock, ReceiverCluster, ReceiverCuller, ReceiverLobe, Roulette, Schlick, Seed,
    ShadingBatch, TileProbability, TileReceivers, Vpl, WeightedList, WeightedLists, Xi,
};

use crate::lists::glossy_light;
use crate::scene::{Pixel, Surfaces, lights};

const SEEDS: u32 = 64;
const FRAMES: u32 = 16;
const TILE: u32 = 8;
pub const LIGHTS: u32 = 60;
/// Keeps a light that is close to a surface from being all there is.
pub const LEAST_DISTANCE_SQUARED: f32 = 0.3;

/// The receivers of a depth interval of a tile.
pub struct Tile<R> {
    pub place: ([u32; 2], u32),
    receivers: Vec<Receiver<R>>,
    /// δ over that of the frame.
    pub delta_scale: f32,
}

pub struct Scene<R> {
    surfaces: Surfaces,
    pub lights: Vec<Vpl<GgxLobe<Schlick>>>,
    batch: ShadingBatch<GgxLobe<Schlick>>,
    pub tiles: Vec<Tile<R>>,
    /// What all lights send to each tile.
    exact: Vec<f64>,
    delta: f32,
}

/// What a receiver reflects of a light.
fn light_at<R: Lobe>(light: &Vpl<GgxLobe<Schlick>>, receiver: &Receiver<R>) -> f64 {
    let (direction, squared) = light.direction_to(receiver.position);
    let intensity = f64::from(light.radiant_intensity(direction));
    let squared = f64::from(squared.max(LEAST_DISTANCE_SQUARED));
    intensity / squared * f64::from(receiver.lobe.value(-direction))
}

impl<R: ReceiverLobe + Copy> Scene<R> {
    pub fn new(lobe: impl Fn(&Pixel) -> R, delta: f32, scale: impl Fn(usize) -> f32) -> Self {
        let mut rng = Rng::with_seed(8);
        let surfaces = Surfaces::of_size(&mut rng, [32, 24], TILE);
        let (lights, _) = lights(&mut rng, LIGHTS as usize, glossy_light);
        let lights: Vec<_> = lights.into_iter().map(|(light, _)| light).collect();
        let width = surfaces.grid.image_size()[0];
        let places = surfaces
            .grid
            .tiles()
            .flat_map(|tile| [(tile, 0), (tile, 1)]);
        let tiles = places.enumerate().filter_map(|(i, place)| {
            let pixels = surfaces.grid.pixels(place.0).pixels();
            let pixels = pixels.filter_map(|[x, y]| surfaces.pixels[(y * width + x) as usize]);
            let receivers: Vec<_> = pixels
                .filter(|pixel| pixel.interval == place.1)
                .map(|pixel| Receiver {
                    position: pixel.position,
                    lobe: lobe(&pixel),
                })
                .collect();
            (!receivers.is_empty()).then(|| Tile {
                place,
                receivers,
                delta_scale: scale(i),
            })
        });
        let mut scene = Self {
            tiles: tiles.collect(),
            surfaces,
            lights,
            batch: ShadingBatch::new(),
            exact: Vec::new(),
            delta,
        };
        // The brightest first.
        let mut lights = std::mem::take(&mut scene.lights);
        lights.sort_by_cached_key(|light| {
            let receivers = scene.tiles.iter().flat_map(|tile| &tile.receivers);
            let reflected: f64 = receivers.map(|receiver| light_at(light, receiver)).sum();
            std::cmp::Reverse((reflected * 1e9) as u64)
        });
        let any = Xi::new(1.0).unwrap();
        scene.batch.extend(lights.iter().map(|light| (light, any)));
        scene.lights = lights;
        let exact = scene.tiles.iter().map(|tile| {
            let receivers = tile.receivers.iter();
            receivers.map(|receiver| scene.all_light_at(receiver)).sum()
        });
        scene.exact = exact.collect();
        assert!(scene.tiles.len() >= 8, "{} tiles", scene.tiles.len());
        scene
    }

    fn all_light_at(&self, receiver: &Receiver<R>) -> f64 {
        self.lights
            .iter()
            .map(|light| light_at(light, receiver))
            .sum()
    }

    pub fn clusters<F: LobeFamily>(&self, family: impl Fn(&R) -> F + Copy) -> TileReceivers<F> {
        let mut receivers = TileReceivers::new(&self.surfaces.grid, 1, 2).unwrap();
        receivers.fill(|tile, interval| {
            let is_it = |of: &&Tile<R>| of.place == (tile, interval);
            let tile = self.tiles.iter().find(is_it)?;
            let receivers = tile.receivers.iter();
            let cluster = ReceiverCluster::of(receivers.map(|of| (of.position, family(&of.lobe))));
            cluster.map(|cluster| cluster.with_delta_scale(tile.delta_scale).unwrap())
        });
        receivers
    }

    pub fn roulette(&self) -> Roulette {
        Roulette::new(self.delta).unwrap()
    }

    /// The errors of the means of many frames, each of which `estimate` makes of the lights with their ξ and the
    /// ξ of the frame: what each tile reflects.
    pub fn errors(&mut self, mut estimate: impl FnMut(&Self, FrameSeed) -> Vec<f64>) -> Errors {
        let mut seeds = Vec::new();
        for seed in 0..SEEDS {
            let mut sums = vec![0.0; self.tiles.len()];
            for frame in 0..FRAMES {
                let frame = Seed(seed).frame(frame);
                for light in 0..LIGHTS {
                    self.batch.set_xi(light, frame.hashed_xi(light));
                }
                for (sum, tile) in sums.iter_mut().zip(estimate(self, frame)) {
                    *sum += tile / f64::from(FRAMES);
                }
            }
            seeds.push(sums);
        }
        let standard_errors = |values: &mut dyn Iterator<Item = f64>, exact: f64| {
            let values: Vec<f64> = values.collect();
            let count = f64::from(SEEDS);
            let mean = values.iter().sum::<f64>() / count;
            let squares = values
                .iter()
                .map(|value| (value - mean).powi(2))
                .sum::<f64>();
            let standard_error = (squares / (count - 1.0) / count).sqrt();
            // Sums of f32 are off by their rounding.
            (mean - exact) / (standard_error + 1e-5 * exact)
        };
        let of_tile = |tile: usize| {
            standard_errors(&mut seeds.iter().map(|sums| sums[tile]), self.exact[tile])
        };
        let worst = (0..self.tiles.len()).map(|tile| of_tile(tile).abs());
        let whole = seeds.iter().map(|sums| sums.iter().sum());
        Errors {
            whole: standard_errors(&mut whole.into_iter(), self.exact.iter().sum()),
            worst_tile: worst.fold(0.0, f64::max),
        }
    }

    /// What each tile reflects, with an estimator of its own and its list.
    pub fn reflect<'l, D: Decision>(
        &self,
        estimator_of: impl Fn(&Roulette) -> RadianceEstimator<D>,
        list_of: impl Fn(usize, &Tile<R>) -> D::List<'l>,
    ) -> Vec<f64> {
        let reflected = self.tiles.iter().enumerate().map(|(i, tile)| {
            let delta = self.delta * tile.delta_scale;
            let estimator = estimator_of(&Roulette::new(delta).unwrap())
                .with_least_distance_squared(LEAST_DISTANCE_SQUARED)
                .unwrap();
            let (mut sums, list) = ([0.0; 16], list_of(i, tile));
            let mut receivers = tile.receivers.iter().copied();
            while let Some(block) = ReceiverBlock::take(&mut receivers) {
                estimator.reflected_at_block(&self.batch, list, &block, |_, reflected| {
                    for (sum, reflected) in sums.iter_mut().zip(reflected) {
                        *sum += f64::from(*reflected);
                    }
                });
            }
            sums.iter().sum()
        });
        reflected.collect()
    }

    /// By lists of what may be accepted, with another δ than that of the frame perhaps.
    pub fn culled<F: LobeFamily, D>(
        &mut self,
        family: impl Fn(&R) -> F + Copy,
        estimator_of: impl Fn(&Roulette) -> RadianceEstimator<D>,
        delta_of_lists: f32,
    ) -> Errors
    where
        D: for<'l> Decision<List<'l> = &'l [u32]>,
    {
        let (receivers, mut lists) = (self.clusters(family), LightLists::new());
        let mut culler = culler(&Roulette::new(delta_of_lists).unwrap());
        self.errors(|scene, _| {
            culler.cull(&scene.batch, &receivers, &mut lists).unwrap();
            scene.reflect(&estimator_of, |_, tile| {
                lists.of(tile.place.0, tile.place.1)
            })
        })
    }

    /// By lists that are drawn, of which `changed` makes what is evaluated.
    pub fn drawn<F: LobeFamily>(
        &mut self,
        family: impl Fn(&R) -> F + Copy,
        probability: TileProbability,
        changed: impl for<'l> Fn(WeightedList<'l>) -> WeightedList<'l>,
    ) -> Errors {
        let (receivers, mut lists) = (self.clusters(family), WeightedLists::new());
        let mut culler = culler(&self.roulette());
        self.errors(|scene, _| {
            culler
                .draw(probability, &scene.batch, &receivers, &mut lists)
                .unwrap();
            scene.reflect(
                |_| RadianceEstimator::listed(),
                |_, tile| changed(lists.of(tile.place.0, tile.place.1)),
            )
        })
    }
}

fn culler(roulette: &Roulette) -> ReceiverCuller {
    ReceiverCuller::new(roulette)
        .with_least_distance_squared(LEAST_DISTANCE_SQUARED)
        .unwrap()
}

#[derive(Debug)]
pub struct Errors {
    /// Of the sum over the image, in standard errors.
    whole: f64,
    /// Of the worst tile, in its own.
    worst_tile: f64,
}

impl Errors {
    pub fn assert_small(&self) {
        assert!(self.whole.abs() < 3.0 && self.worst_tile < 5.0, "{self:?}");
    }

    /// That of a mistake.
    pub fn assert_great(&self) {
        assert!(self.whole.abs() > 8.0, "{self:?}");
    }
}
