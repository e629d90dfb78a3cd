//! Whichever way it is decided which lights count, the mean is what all lights send.
//!
//! 64 seeds with 16 frames each, whose ξ are independent. The sum over the image is held to three standard errors of
//! the seeds, and each tile, of which there are many, to five.

use fastrand::Rng;
use stochastic_light_culling::{
    AtPoint, AtReceiver, Blind, Decision, EvenNoise, FrameSeed, Ggx, GgxLobe, InList, LambertLobe,
    LightLists, Lobe, LobeFamily, RadianceEstimator, Receiver, ReceiverBlock, ReceiverCluster,
    ReceiverCuller, ReceiverLobe, Roulette, Schlick, Seed, ShadingBatch, TileProbability,
    TileReceivers, Vpl, WeightedList, WeightedLists, Xi,
};

use crate::lists::glossy_light;
use crate::scene::{Pixel, Surfaces, lights};

const SEEDS: u32 = 64;
const FRAMES: u32 = 16;
const TILE: u32 = 8;
const LIGHTS: u32 = 60;
/// Keeps a light that is close to a surface from being all there is.
const LEAST_DISTANCE_SQUARED: f32 = 0.3;

/// The receivers of a depth interval of a tile.
struct Tile<R> {
    place: ([u32; 2], u32),
    receivers: Vec<Receiver<R>>,
    /// δ over that of the frame.
    delta_scale: f32,
}

struct Scene<R> {
    surfaces: Surfaces,
    lights: Vec<Vpl<GgxLobe<Schlick>>>,
    batch: ShadingBatch<GgxLobe<Schlick>>,
    tiles: Vec<Tile<R>>,
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
    fn new(lobe: impl Fn(&Pixel) -> R, delta: f32, scale: impl Fn(usize) -> f32) -> Self {
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

    fn clusters<F: LobeFamily>(&self, family: impl Fn(&R) -> F + Copy) -> TileReceivers<F> {
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

    fn roulette(&self) -> Roulette {
        Roulette::new(self.delta).unwrap()
    }

    /// The errors of the means of many frames, each of which `estimate` makes of the lights with their ξ and the
    /// ξ of the frame: what each tile reflects.
    fn errors(&mut self, mut estimate: impl FnMut(&Self, FrameSeed) -> Vec<f64>) -> Errors {
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
    fn reflect<'l, D: Decision>(
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
    fn culled<F: LobeFamily, D>(
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
    fn drawn<F: LobeFamily>(
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
struct Errors {
    /// Of the sum over the image, in standard errors.
    whole: f64,
    /// Of the worst tile, in its own.
    worst_tile: f64,
}

impl Errors {
    fn assert_small(&self) {
        assert!(self.whole.abs() < 3.0 && self.worst_tile < 5.0, "{self:?}");
    }

    /// That of a mistake.
    fn assert_great(&self) {
        assert!(self.whole.abs() > 8.0, "{self:?}");
    }
}

fn metal(pixel: &Pixel) -> GgxLobe<Schlick> {
    let (ggx, schlick) = (Ggx::new(0.2).unwrap(), Schlick::new(0.9).unwrap());
    GgxLobe::new(ggx, schlick, pixel.incidence)
}

fn paper(pixel: &Pixel) -> LambertLobe {
    LambertLobe::new(0.8, pixel.incidence.normal).unwrap()
}

/// δ of tiles side by side that differs by up to 64 times.
fn uneven(tile: usize) -> f32 {
    [1.0, 8.0, 0.125, 2.0, 0.5][tile % 5]
}

const DELTA: f32 = 0.002;

#[test]
fn decided_by_what_arrives() {
    for scale in [|_| 1.0, uneven] {
        let mut scene = Scene::new(metal, DELTA, scale);
        scene
            .culled::<_, AtPoint>(|_| Blind, RadianceEstimator::new, DELTA)
            .assert_small();
    }
}

#[test]
fn decided_by_what_is_reflected() {
    for scale in [|_| 1.0, uneven] {
        let mut scene = Scene::new(metal, DELTA, scale);
        let family = GgxLobe::family;
        scene
            .culled::<_, AtReceiver>(family, RadianceEstimator::aware, DELTA)
            .assert_small();
        // With lists that lack lights it shows.
        let delta = 1000.0 * DELTA;
        let lacking = scene.culled::<_, AtReceiver>(family, RadianceEstimator::aware, delta);
        lacking.assert_great();
    }
    let mut scene = Scene::new(paper, DELTA, uneven);
    scene
        .culled::<_, AtReceiver>(LambertLobe::family, RadianceEstimator::aware, DELTA)
        .assert_small();
}

#[test]
fn drawn_by_the_tile() {
    let ways = [
        TileProbability::bound(),
        TileProbability::default(),
        TileProbability::root_mean_square(100.0).unwrap(),
    ];
    for probability in ways {
        for scale in [|_| 1.0, uneven] {
            let mut scene = Scene::new(metal, DELTA, scale);
            scene
                .drawn(GgxLobe::family, probability, |list| list)
                .assert_small();
            let mut scene = Scene::new(paper, DELTA, scale);
            scene
                .drawn(LambertLobe::family, probability, |list| list)
                .assert_small();
        }
    }
}

#[test]
fn drawn_by_the_tile_without_knowing_receivers() {
    let mut scene = Scene::new(metal, DELTA, uneven);
    scene
        .drawn(|_| Blind, TileProbability::bound(), |list| list)
        .assert_small();
}

/// A δ that follows the brightness of tiles, as every fourth light shows it without ξ.
#[test]
fn drawn_with_even_noise() {
    let mut scene = Scene::new(metal, DELTA, |_| 1.0);
    let (clusters, roulette) = (scene.clusters(GgxLobe::family), scene.roulette());
    let brightness = |tile: &Tile<_>| {
        let cluster = clusters.of(tile.place.0, tile.place.1).unwrap();
        let some = scene.lights.iter().step_by(4);
        let radiance = some.map(|light| {
            let least = LEAST_DISTANCE_SQUARED;
            let typical = cluster.typical_radiance(light, &roulette, least);
            assert!(typical <= cluster.greatest_radiance(light, &roulette, least));
            typical
        });
        4.0 * roulette.delta() * radiance.sum::<f32>()
    };
    let brightnesses: Vec<f32> = scene.tiles.iter().map(brightness).collect();
    let mean = brightnesses.iter().sum::<f32>() / brightnesses.len() as f32;
    let even = EvenNoise::new(mean).unwrap();
    for (tile, brightness) in scene.tiles.iter_mut().zip(brightnesses) {
        tile.delta_scale = even.delta_scale(brightness);
    }
    let scales = scene.tiles.iter().map(|tile| tile.delta_scale);
    let [least, most] = [f32::min, f32::max].map(|f| scales.clone().reduce(f).unwrap());
    assert!(most > 10.0 * least, "{least} {most}");
    scene
        .drawn(GgxLobe::family, TileProbability::default(), |list| list)
        .assert_small();
    scene
        .culled::<_, AtReceiver>(GgxLobe::family, RadianceEstimator::aware, DELTA)
        .assert_small();
}

#[test]
fn mistakes_show() {
    let mut scene = Scene::new(metal, DELTA, |_| 1.0);
    let (family, probability) = (GgxLobe::family, TileProbability::default());
    scene
        .drawn(family, probability, |list| WeightedList {
            weights: &[1.0; LIGHTS as usize][..list.lights.len()],
            ..list
        })
        .assert_great();
    // The brightest light alone.
    scene
        .drawn(family, probability, |list| match list.lights {
            [0, lights @ ..] => WeightedList {
                lights,
                weights: &list.weights[1..],
            },
            _ => list,
        })
        .assert_great();
}

/// p_T may be any number that does not depend on the light's own ξ, and ξ may be that of a tile and a light.
#[test]
fn drawn_by_any_positive_probability() {
    let mut scene = Scene::new(metal, DELTA, |_| 1.0);
    let probability = |tile: usize, light: u32| {
        Seed(tile as u32)
            .frame(5)
            .hashed_xi(light)
            .get()
            .powi(2)
            .max(0.02)
    };
    let by_tile = |frame: FrameSeed, tile: usize, light: u32| -> Xi {
        frame.hashed_xi(light ^ (tile as u32 + 1) << 16)
    };
    let by_light = |frame: FrameSeed, _: usize, light: u32| frame.hashed_xi(light);
    let ways: [&dyn Fn(FrameSeed, usize, u32) -> Xi; 2] = [&by_tile, &by_light];
    for xi in ways {
        let errors = scene.errors(|scene, frame| {
            let drawn: Vec<(Vec<u32>, Vec<f32>)> = (0..scene.tiles.len())
                .map(|tile| {
                    let is_drawn =
                        |light: &u32| xi(frame, tile, *light).get() <= probability(tile, *light);
                    let lights: Vec<u32> = (0..LIGHTS).filter(is_drawn).collect();
                    let weight = |light: &u32| 1.0 / probability(tile, *light);
                    let weights = lights.iter().map(weight).collect();
                    (lights, weights)
                })
                .collect();
            scene.reflect::<InList>(
                |_| RadianceEstimator::listed(),
                |tile, _| {
                    let (lights, weights) = &drawn[tile];
                    WeightedList { lights, weights }
                },
            )
        });
        errors.assert_small();
    }
}
