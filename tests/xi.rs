//! How the ξ of lights and frames go together: uniform each by itself, and spread or independent together.
//!
//! Fixed seeds; the limits of chi-squared are exceeded by chance once in 10⁴ comparisons or less.

use proptest::prelude::*;
use stochastic_light_culling::{Seed, Xi};

/// Whether the ξ of so many draws are uniform in (0, 1].
fn is_uniform(draw: impl Fn(u32) -> Xi) -> bool {
    const BINS: usize = 64;
    const DRAWS: u32 = 100_000;
    let mut bins = [0.0; BINS];
    for i in 0..DRAWS {
        let xi = draw(i).get();
        assert!(xi > 0.0 && xi <= 1.0);
        bins[((xi * BINS as f32) as usize).min(BINS - 1)] += 1.0;
    }
    // With 63 degrees of freedom.
    chi_squared(&bins, f64::from(DRAWS)) < 113.5
}

/// Whether pairs of numbers that are `lag` apart fill the unit square as independent numbers do.
fn pairs_fill_the_square(draw: &dyn Fn(u32) -> Xi, lag: u32) -> bool {
    const SIDE: usize = 64;
    const PAIRS: u32 = 1 << 16;
    let bin = |i: u32| ((draw(i).get() * SIDE as f32) as usize).min(SIDE - 1);
    let mut bins = vec![0.0; SIDE * SIDE];
    for i in 0..PAIRS {
        bins[bin(i) * SIDE + bin(i + lag)] += 1.0;
    }
    let freedom = (SIDE * SIDE - 1) as f64;
    // In standard deviations: a lattice leaves bins empty, or fills them too evenly.
    let deviation = (chi_squared(&bins, f64::from(PAIRS)) - freedom) / (2.0 * freedom).sqrt();
    deviation.abs() < 5.0
}

fn chi_squared(bins: &[f64], draws: f64) -> f64 {
    let expected = draws / bins.len() as f64;
    let terms = bins.iter().map(|n| (n - expected).powi(2) / expected);
    terms.sum()
}

/// Each light's ξ in each frame is uniform over seeds and over subregions, in whichever way it is drawn.
#[test]
fn numbers_are_uniform_over_seeds() {
    for light in [0, 1, 2, 3, 1000, 65_535, 1 << 31, u32::MAX] {
        for frame in [0, 1, 2, 63, 1 << 31, u32::MAX] {
            let draws: [&dyn Fn(u32) -> Xi; 5] = [
                &|seed| Seed(seed).frame(frame).hashed_xi(light),
                &|seed| Seed(seed).frame(frame).xi(light),
                &|seed| Seed(seed).frame(frame).xi_of_rank(light),
                &|seed| Seed(seed).subregion(3).frame(frame).xi_of_rank(light),
                &|subregion| Seed(7).subregion(subregion).frame(frame).xi_of_rank(light),
            ];
            for (way, draw) in draws.into_iter().enumerate() {
                assert!(is_uniform(draw), "way {way}, light {light}, frame {frame}");
            }
        }
    }
}

#[test]
fn numbers_are_uniform_over_lights_and_frames() {
    assert!(is_uniform(|light| Seed(0).frame(0).hashed_xi(light)));
    assert!(is_uniform(|frame| Seed(0).frame(frame).hashed_xi(0)));
    assert!(is_uniform(|i| Seed(5).frame(i / 317).hashed_xi(i % 317)));
    assert!(is_uniform(|light| Seed(0).frame(0).xi(light)));
    assert!(is_uniform(|light| Seed(3).frame(9).xi(light)));
}

/// Two lights of a seed are independent, over seeds: their ξ together fill the unit square. (Not so for lights
/// 2³¹ apart, whose indices differ in the bit that products spread least.)
#[test]
fn lights_are_independent() {
    const SIDE: usize = 64;
    const SEEDS: u32 = 1 << 17;
    let ways: [fn(u32, u32) -> Xi; 2] = [
        |seed, light| Seed(seed).frame(3).xi(light),
        |seed, light| Seed(seed).frame(3).hashed_xi(light),
    ];
    for draw in ways {
        for [first, second] in [
            [0, 1],
            [0, 2],
            [1, 2],
            [2, 3],
            [7, 8],
            [0, 64],
            [5, 1 << 20],
        ] {
            let bin = |xi: Xi| ((xi.get() * SIDE as f32) as usize).min(SIDE - 1);
            let mut bins = vec![0.0; SIDE * SIDE];
            for seed in 0..SEEDS {
                bins[bin(draw(seed, first)) * SIDE + bin(draw(seed, second))] += 1.0;
            }
            let freedom = (SIDE * SIDE - 1) as f64;
            let deviation =
                (chi_squared(&bins, f64::from(SEEDS)) - freedom) / (2.0 * freedom).sqrt();
            assert!(deviation.abs() < 5.0, "{first}, {second}: {deviation}");
        }
    }
}

/// No subregion of one seed is one of another seed.
#[test]
fn seeds_share_no_subregions() {
    let mut seen = std::collections::HashSet::new();
    for seed in 0..64 {
        for subregion in 0..64 {
            assert!(
                seen.insert(Seed(seed).subregion(subregion)),
                "{seed}, {subregion}"
            );
        }
    }
}

/// The offsets of seeds, and of the subregions of a seed, are independent.
#[test]
fn offsets_show_no_lattice() {
    for lag in [1, 2, 3, 4, 8, 16, 256] {
        let along_seeds = |seed| Seed(seed).frame(0).xi_of_rank(0);
        assert!(pairs_fill_the_square(&along_seeds, lag), "lag {lag}");
        for seed in [0, 1, 7, 2026, 634_785_765, 1 << 31, u32::MAX] {
            let along_lights = |light| Seed(seed).frame(0).xi(light);
            assert!(
                pairs_fill_the_square(&along_lights, lag),
                "seed {seed}, lag {lag}"
            );
            // One light in many seeds.
            let along_seeds = |i| Seed(i).frame(0).xi(seed);
            assert!(
                pairs_fill_the_square(&along_seeds, lag),
                "light {seed}, lag {lag}"
            );
            let along_subregions = |subregion| {
                let seed = Seed(seed).subregion(subregion);
                seed.frame(0).xi_of_rank(0)
            };
            assert!(
                pairs_fill_the_square(&along_subregions, lag),
                "seed {seed}, lag {lag}"
            );
        }
    }
}

/// Pairs of successive numbers fill the unit square evenly: along lights, along frames, and where frame and
/// seed are equal, for any seed; 634785765 is the one that the hash's generator takes to zero.
#[test]
fn hashed_numbers_show_no_lattice() {
    for seed in [
        0,
        1,
        7,
        2026,
        634_785_764,
        634_785_765,
        634_785_766,
        1 << 31,
        u32::MAX,
    ] {
        for lag in [1, 2, 3, 8] {
            for frame in [0, 1, 634_785_765, seed] {
                let along_lights = |light| Seed(seed).frame(frame).hashed_xi(light);
                assert!(
                    pairs_fill_the_square(&along_lights, lag),
                    "seed {seed}, frame {frame}, lag {lag}"
                );
            }
            for light in [0, 1, 1000] {
                let along_frames = |frame| Seed(seed).frame(frame).hashed_xi(light);
                assert!(
                    pairs_fill_the_square(&along_frames, lag),
                    "seed {seed}, light {light}, lag {lag}"
                );
            }
        }
    }
    for light in [0, 1, 1000] {
        let equal = |frame| Seed(frame).frame(frame).hashed_xi(light);
        assert!(pairs_fill_the_square(&equal, 1), "light {light}");
    }
}

/// The largest gap between numbers on a circle of this length.
fn largest_gap(mut numbers: Vec<f64>, length: f64) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let around = numbers[0] + length - numbers[numbers.len() - 1];
    let gaps = numbers.windows(2).map(|pair| pair[1] - pair[0]);
    gaps.fold(around, f64::max)
}

proptest! {
    /// 2ⁿ ranks from a multiple of 2ⁿ have one ξ in each cell of a grid of 2⁻ⁿ.
    #[test]
    fn neighbours_are_evenly_spaced(
        seed: u32, frame: u32, log_count in 0..10_u32, block: u32,
    ) {
        let count = 1 << log_count;
        let first = block >> log_count << log_count;
        let frame = Seed(seed).frame(frame);
        let mut xis: Vec<f32> = (0..count).map(|i| frame.xi_of_rank(first + i).get()).collect();
        xis.sort_by(f32::total_cmp);
        let step = (count as f32).recip();
        for (i, xi) in xis.iter().enumerate() {
            prop_assert!((xi - xis[0] - i as f32 * step).abs() < 1e-6);
        }
        prop_assert!(xis[0] <= step * (1.0 + 1e-6));
    }

    /// The ξ of a light over frames leave no gap much wider than those of evenly spaced numbers, and neither
    /// do those of neighbours together. (Steps by the golden ratio would leave up to 5.9
    /// times that for neighbours.)
    #[test]
    fn frames_are_spread(
        seed: u32, light: u32, first in 0..u32::MAX - 64, log_frames in 1..=6_u32, log_count in 0..=8_u32,
    ) {
        let frames = 1 << log_frames;
        let of_frames = |draw: &dyn Fn(u32) -> Xi| -> Vec<f64> {
            (0..frames).map(|i| f64::from(draw(first + i).get())).collect()
        };
        let alone = of_frames(&|frame| Seed(seed).frame(frame).xi(light));
        prop_assert!(largest_gap(alone, 1.0) <= 1.9 / f64::from(frames));

        // Neighbours repeat after this length.
        let length = f64::from(1 << log_count).recip();
        let together: Vec<f64> = of_frames(&|frame| Seed(seed).frame(frame).xi_of_rank(light));
        let together = together.into_iter().map(|xi| xi % length).collect();
        prop_assert!(largest_gap(together, length) <= 2.7 * length / f64::from(frames));
    }

    #[test]
    fn nothing_is_outside_its_range(seed: u32, frame: u32, light: u32, subregion: u32) {
        let frame = Seed(seed).subregion(subregion).frame(frame);
        for xi in [frame.xi(light), frame.xi_of_rank(light), frame.hashed_xi(light)] {
            prop_assert_eq!(Xi::new(xi.get()), Ok(xi));
        }
    }
}
