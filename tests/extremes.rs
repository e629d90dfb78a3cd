//! No light is lost: over the whole domain of the crate, a tile with a point in it that a light
//! reaches in exact arithmetic is touched, whichever bound the light is tested by, and by which test.
//!
//! `CASES=100000000 cargo test --test extremes -- --nocapture` is the long run.

use fastrand::Rng;
use rayon::prelude::*;
use stochastic_light_culling::HalfSpace;
use support::adversary::{ClusterLight, Light, Tile};
use support::reference::Brdf;

const TILES_PER_LIGHT: usize = 16;
const BATCH: usize = 4096;

/// Runs `batch` on seeds until as many cases as are wanted are tested, or the share of them.
fn search(share: u64, batch: impl Fn(u64) -> usize + Sync + Send) {
    let wanted = std::env::var("CASES").map_or(1_000_000, |cases| cases.parse().expect("a number"));
    let batches = wanted / share / BATCH as u64 + 1;
    let tested: usize = (0..batches).into_par_iter().map(batch).sum();
    println!("{tested} cases, 0 lost");
}

#[test]
fn no_cluster_is_lost() {
    search(5, |seed| {
        let mut rng = Rng::with_seed(seed);
        let mut tested = 0;
        while tested < BATCH {
            let light = ClusterLight::draw(&mut rng);
            let bound = light.bound();
            for _ in 0..TILES_PER_LIGHT {
                let Some(tile) = Tile::draw(&mut rng, &light) else {
                    continue;
                };
                let found = bound.project(&tile.camera).is_some_and(|test| {
                    test.touches(&tile.rectangle, &tile.depths)
                        && test.touches_exactly(&tile.rectangle, &tile.depths)
                });
                assert!(found, "seed {seed}: {light:?} in {tile:?}");
                tested += 1;
            }
        }
        tested
    });
}

#[test]
fn no_light_is_lost() {
    search(1, |seed| {
        let mut rng = Rng::with_seed(seed);
        let mut tested = 0;
        while tested < BATCH {
            let light = Light::draw(&mut rng);
            let bound = light.bound();
            for _ in 0..TILES_PER_LIGHT {
                let Some(tile) = Tile::draw(&mut rng, &light) else {
                    continue;
                };
                let mut lost = bound.that_lose(&tile);
                if lost.is_empty() {
                    lost = bound.that_lose_exactly(&tile);
                }
                let lit_side = HalfSpace::new(light.position, light.normal)
                    .unwrap()
                    .project(&tile.camera);
                let is_lit = lit_side.touches(&tile.rectangle, &tile.depths);
                // Neither a lamp nor an SG has a surface.
                let has_surface = !matches!(
                    light.brdf,
                    Brdf::Constant | Brdf::Spot { .. } | Brdf::SphericalGaussian { .. }
                );
                if !is_lit && has_surface {
                    lost.push("half-space");
                }
                assert!(
                    lost.is_empty(),
                    "seed {seed}: {lost:?} of {light:?} in {tile:?}"
                );
                tested += 1;
            }
        }
        tested
    });
}
