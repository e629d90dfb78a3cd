//! No light is lost: over the whole domain of the crate, a tile with a point in it that a light
//! reaches in exact arithmetic is touched, whichever bound the light is tested by, and by which test.
//!
//! `CASES=100000000 cargo test --test extremes -- --nocapture` is the long run.

use fastrand::Rng;
use rayon::prelude::*;
use stochastic_light_culling::{HalfSpace, Orthographic, Perspective};
use support::adversary::{Bound, ClusterLight, Drawn, Light, Tile};
use support::reference::Brdf;

/// Of each kind of projection.
const TILES_PER_LIGHT: usize = 8;
const BATCH: usize = 4096;

/// Runs `batch` on seeds until as many cases as are wanted are tested, or the share of them. It returns how many of its
/// cases are in perspective, and how many are orthographic.
fn search(share: u64, batch: impl Fn(&mut Rng, u64) -> [usize; 2] + Sync + Send) {
    let wanted = std::env::var("CASES").map_or(1_000_000, |cases| cases.parse().expect("a number"));
    let batches = wanted / share / BATCH as u64 + 1;
    let sum = |[a, b]: [usize; 2], [c, d]: [usize; 2]| [a + c, b + d];
    let whole_batch = |seed| {
        let (mut rng, mut tested) = (Rng::with_seed(seed), [0; 2]);
        while tested[0] + tested[1] < BATCH {
            tested = sum(tested, batch(&mut rng, seed));
        }
        tested
    };
    let tested = (0..batches).into_par_iter().map(whole_batch);
    let [perspective, orthographic] = tested.reduce(|| [0; 2], sum);
    println!("{perspective} cases in perspective, {orthographic} orthographic, 0 lost");
}

#[test]
fn no_cluster_is_lost() {
    search(5, |rng, seed| {
        let light = ClusterLight::draw(rng);
        [
            clusters_that_are_touched::<Perspective>(rng, seed, &light),
            clusters_that_are_touched::<Orthographic>(rng, seed, &light),
        ]
    });
}

fn clusters_that_are_touched<P: Drawn>(rng: &mut Rng, seed: u64, light: &ClusterLight) -> usize {
    let bound = light.bound();
    let tiles = (0..TILES_PER_LIGHT).filter_map(|_| Tile::<P>::draw(rng, light));
    let touched = tiles.map(|tile| {
        let found = bound.project(&tile.camera).is_some_and(|test| {
            test.touches(&tile.rectangle, &tile.depths)
                && test.touches_exactly(&tile.rectangle, &tile.depths)
        });
        assert!(found, "seed {seed}: {light:?} in {tile:?}");
    });
    touched.count()
}

#[test]
fn no_light_is_lost() {
    search(1, |rng, seed| {
        let light = Light::draw(rng);
        let bound = light.bound();
        [
            tiles_that_are_touched::<Perspective>(rng, seed, &light, &bound),
            tiles_that_are_touched::<Orthographic>(rng, seed, &light, &bound),
        ]
    });
}

/// Draws tiles with a point in them that the light reaches, and tests them all. Returns their number.
fn tiles_that_are_touched<P: Drawn>(
    rng: &mut Rng,
    seed: u64,
    light: &Light,
    bound: &Bound,
) -> usize {
    let tiles = (0..TILES_PER_LIGHT).filter_map(|_| Tile::<P>::draw(rng, light));
    let touched = tiles.map(|tile| {
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
    });
    touched.count()
}
