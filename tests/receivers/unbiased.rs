//! Whichever way it is decided which lights count, the mean is what all lights send.
//!
//! 64 seeds with 16 frames each, whose ξ are independent. The sum over the image is held to three standard errors of
//! the seeds, and each tile, of which there are many, to five.

use stochastic_light_culling::{
    AtPoint, AtReceiver, Blind, EvenNoise, FrameSeed, Ggx, GgxLobe, InList, LambertLobe,
    RadianceEstimator, ReceiverLobe, Schlick, Seed, TileProbability, WeightedList, Xi,
};

use crate::frames::{LEAST_DISTANCE_SQUARED, LIGHTS, Scene, Tile};
use crate::scene::Pixel;

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
