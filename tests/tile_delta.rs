//! A δ that follows the brightness of a tile: from where it may, and what that makes of the noise.
//!
//! A tile is a few lights of known radiance. Its δ in a frame follows from an estimate of its radiance. If that
//! depends on the ξ of the frame, the mean is wrong.

use stochastic_light_culling::{Error, EvenNoise, FrameSeed, Roulette, Seed, Xi};

/// Which ξ a light has.
type Draw = fn(FrameSeed, u32) -> Xi;

/// The last one alone is independent from frame to frame.
const WAYS: [Draw; 3] = [FrameSeed::xi, FrameSeed::xi_of_rank, FrameSeed::hashed_xi];

/// Where the radiance of a tile is taken from.
#[derive(Clone, Copy, Debug)]
enum Origin {
    /// Of all lights, without ξ.
    Known,
    OtherSeed,
    /// The mean of so many frames before.
    Before(usize),
}

/// The mean radiance of frames after the first, over that of all lights, and its standard error.
fn mean(radiances: &[f32], draw: Draw, origin: Origin, seeds: u32) -> [f64; 2] {
    let all: f32 = radiances.iter().sum();
    let even = EvenNoise::new(all)
        .unwrap()
        .with_range(1.0 / 16.0, 16.0)
        .unwrap();
    let delta = 1.0;
    let estimate = |frame: FrameSeed, scale: f32| -> f32 {
        let roulette = Roulette::new(delta * scale).unwrap();
        let lights = (0..).zip(radiances);
        lights
            .map(|(light, c)| roulette.estimate(*c, 1.0, draw(frame, light)))
            .sum()
    };
    let frames = match origin {
        Origin::Before(count) => 2 * count.max(4),
        _ => 8,
    };
    let (mut sum, mut squares) = (0.0, 0.0);
    for seed in 0..seeds {
        // As if it had been known long before.
        let (mut history, mut of_seed) = (Vec::new(), 0.0);
        for frame in 0..frames as u32 {
            let before = match origin {
                Origin::Known => all,
                Origin::OtherSeed => estimate(Seed(!seed).frame(frame), 1.0),
                Origin::Before(count) => {
                    let taken = history.len().min(count);
                    let last: f32 = history[history.len() - taken..].iter().sum();
                    if taken > 0 { last / taken as f32 } else { all }
                }
            };
            let found = estimate(Seed(seed).frame(frame), even.delta_scale(before));
            history.push(found);
            if frame as usize >= frames / 2 {
                of_seed += f64::from(found) / (frames - frames / 2) as f64;
            }
        }
        sum += of_seed;
        squares += of_seed * of_seed;
    }
    let (count, all) = (f64::from(seeds), f64::from(all));
    let (mean, square) = (sum / count, squares / count);
    [mean / all, ((square - mean * mean) / count).sqrt() / all]
}

/// Few lights and many, dim and bright beside δ.
const TILES: [&[f32]; 8] = [
    &[0.7],
    &[0.3],
    &[0.5, 0.4, 0.3, 0.2],
    &[0.3; 8],
    &[0.1; 16],
    &[0.05; 20],
    &[0.8, 0.05, 0.05, 0.05, 0.05],
    &[3.0, 0.3, 0.3],
];

#[test]
fn what_does_not_depend_on_the_xi_of_the_frame_is_exact() {
    let is_exact = |tile, draw, origin| {
        let [mean, standard_error] = mean(tile, draw, origin, 20_000);
        // 64 comparisons; the last is the rounding of a sum.
        let most = 4.0 * standard_error + 1e-6;
        assert!((mean - 1.0).abs() < most, "{tile:?} {origin:?}: {mean}");
    };
    for tile in TILES {
        for draw in WAYS {
            is_exact(tile, draw, Origin::Known);
            is_exact(tile, draw, Origin::OtherSeed);
        }
        // Independent from frame to frame.
        is_exact(tile, FrameSeed::hashed_xi, Origin::Before(1));
        is_exact(tile, FrameSeed::hashed_xi, Origin::Before(4));
    }
}

#[test]
fn the_frame_before_is_not_if_xi_step() {
    let bias = |tile, draw, origin| mean(tile, draw, origin, 5_000)[0] - 1.0;
    let before = Origin::Before(1);
    // One light that decides alone: by as much as a quarter, darker or brighter.
    assert!(bias(TILES[0], FrameSeed::xi, before) < -0.25);
    assert!(bias(TILES[1], FrameSeed::xi, before) > 0.14);
    assert!(bias(TILES[0], FrameSeed::xi_of_rank, before) < -0.11);
    // Even among many: with ranks the ξ of all lights follow from one offset.
    assert!(bias(TILES[4], FrameSeed::xi_of_rank, before) < -0.05);
}

#[test]
fn a_long_mean_is_nearly_exact() {
    for draw in &WAYS[..2] {
        let worst = |frames: usize| {
            let origin = Origin::Before(frames);
            let bias = TILES.map(|tile| (mean(tile, *draw, origin, 1_000)[0] - 1.0).abs());
            bias.into_iter().fold(0.0, f64::max)
        };
        let [one, many] = [1, 64].map(worst);
        assert!(many < 0.025 && one > 5.0 * many, "{one} {many}");
    }
}

/// Relative deviation and work are those of a tile of typical radiance, or less, however bright a tile is.
#[test]
fn noise_is_even() {
    let (delta, typical) = (0.01, 0.7);
    let even = EvenNoise::new(typical).unwrap();
    let bound = f64::from(delta / typical).sqrt();
    let mut rng = fastrand::Rng::with_seed(3);
    let (mut greatest, mut uneven) = (0.0, [f64::INFINITY, 0.0]);
    for _ in 0..500 {
        let brightness = typical * 50_f32.powf(2.0 * rng.f32() - 1.0);
        let lights: Vec<f64> = (0..rng.u32(1..4000)).map(|_| rng.f64().powi(3)).collect();
        let all: f64 = lights.iter().sum();
        let lights = lights.iter().map(|c| c * f64::from(brightness) / all);
        let deviation = |delta: f32| {
            let variance = |c: f64| (c * (f64::from(delta) - c)).max(0.0);
            lights.clone().map(variance).sum::<f64>().sqrt() / f64::from(brightness)
        };
        let own = delta * even.delta_scale(brightness);
        let found = deviation(own);
        assert!(found <= bound * (1.0 + 1e-6), "{found} {bound}");
        greatest = f64::max(greatest, found);
        let one = deviation(delta);
        uneven = [uneven[0].min(one), uneven[1].max(one)];
        let dim = lights.filter(|c| *c < f64::from(own));
        let left_to_chance: f64 = dim.map(|c| c / f64::from(own)).sum();
        assert!(left_to_chance <= f64::from(typical / delta) * (1.0 + 1e-6));
    }
    assert!(greatest > 0.9 * bound, "{greatest} {bound}");
    // With one δ tiles differ more.
    assert!(uneven[1] > 4.0 * bound, "{uneven:?} {bound}");
}

#[test]
fn scales_are_in_their_range() {
    let even = EvenNoise::new(2.0).unwrap();
    let scales = [
        (2.0, 1.0),
        (1.0, 0.5),
        (0.0, 1.0 / 64.0),
        (-0.0, 1.0 / 64.0),
        (-3.0, 1.0 / 64.0),
        (f32::NEG_INFINITY, 1.0 / 64.0),
        (f32::from_bits(1), 1.0 / 64.0),
        (f32::MAX, 64.0),
        (f32::INFINITY, 64.0),
        (f32::NAN, 1.0),
    ];
    for (radiance, scale) in scales {
        assert_eq!(even.delta_scale(radiance), scale, "{radiance}");
    }
    let wide = even.with_range(1e-18, 1e18).unwrap();
    assert_eq!(wide.delta_scale(0.0), 1e-18);
    assert_eq!(
        EvenNoise::new(f32::MIN_POSITIVE).unwrap().delta_scale(1.0),
        64.0
    );
    for typical in [0.0, -1.0, 1e-40, f32::INFINITY, f32::NAN] {
        assert!(EvenNoise::new(typical).is_err(), "{typical}");
    }
    for [least, most] in [
        [0.0, 1.0],
        [2.0, 3.0],
        [1.0, 0.5],
        [0.5, f32::INFINITY],
        [f32::NAN, 1.0],
    ] {
        let error = even.with_range(least, most).unwrap_err();
        assert!(matches!(error, Error::Number { .. }), "{least} {most}");
    }
}

#[test]
fn a_tile_in_the_middle_has_the_least_scale() {
    let mut rng = fastrand::Rng::with_seed(5);
    for _ in 0..2_000 {
        // Brightnesses of pictures, from all alike to those of mirrors, and tiles that show nothing among them.
        let contrast = 1.0 + 6.0 * rng.f32();
        let shown: Vec<f32> = (0..rng.usize(1..200))
            .map(|_| 3.0 * (-contrast * rng.f32()).exp())
            .collect();
        let dark = [0.0, -0.0, -2.0, f32::NEG_INFINITY, f32::NAN, -f32::NAN];
        let mut tiles = shown.clone();
        tiles.extend((0..rng.usize(0..300)).map(|_| dark[rng.usize(0..dark.len())]));
        rng.shuffle(&mut tiles);
        let even = EvenNoise::of_tiles(&mut tiles).unwrap();

        let mut sorted = shown.clone();
        sorted.sort_by(f32::total_cmp);
        let mean = shown.iter().map(|l| f64::from(*l)).sum::<f64>() / shown.len() as f64;
        let near = |a: f32, b: f64| (f64::from(a) / b - 1.0).abs() < 1e-6;
        assert!(near(even.typical(), mean));
        let median = f64::from(sorted[sorted.len() / 2]);
        let [least, most] = even.range();
        assert!(near(least, (median / mean).min(1.0)) && most == 64.0);
        // Darker ones have the same, and brighter ones are in proportion.
        let scales: Vec<f32> = sorted.iter().map(|l| even.delta_scale(*l)).collect();
        assert!(scales.is_sorted());
        for (radiance, scale) in sorted.iter().zip(&scales) {
            let own = (f64::from(*radiance) / mean).min(64.0);
            assert!(near(*scale, own.max(f64::from(least))), "{radiance}");
        }
        // In whichever order.
        tiles.reverse();
        assert_eq!(EvenNoise::of_tiles(&mut tiles), Ok(even));
    }
}

#[test]
fn tiles_of_any_radiance_give_a_scale_or_an_error() {
    let of_tiles = |radiances: &[f32]| {
        let even = EvenNoise::of_tiles(&mut radiances.to_vec())?;
        Ok::<_, Error>((even.typical(), even.range()[0]))
    };
    let (nan, tiny) = (f32::NAN, f32::MIN_POSITIVE);
    // One tile, and of two the brighter one.
    assert_eq!(of_tiles(&[0.3]), Ok((0.3, 1.0)));
    assert_eq!(of_tiles(&[nan, 0.3, 0.0]), Ok((0.3, 1.0)));
    assert_eq!(of_tiles(&[1.0, 3.0]), Ok((2.0, 1.0)));
    assert_eq!(of_tiles(&[1.0, 7.0, 1.0]), Ok((3.0, 1.0 / 3.0)));
    // A sum that single precision cannot hold, and a median that is nothing beside it.
    assert_eq!(of_tiles(&[f32::MAX; 4]), Ok((f32::MAX, 1.0)));
    let black = 1.0 / 4096.0;
    assert_eq!(of_tiles(&[tiny, 3.0, tiny]), Ok((1.0, black)));
    assert_eq!(of_tiles(&[f32::from_bits(1), 3.0, tiny]), Ok((1.0, black)));
    for nothing in [
        &[] as &[f32],
        &[nan],
        &[0.0, -0.0, -1.0, nan],
        &[f32::NEG_INFINITY],
        &[f32::INFINITY, 1.0],
        &[tiny, f32::from_bits(1)],
    ] {
        let error = of_tiles(nothing).unwrap_err();
        assert!(matches!(error, Error::Number { .. }), "{nothing:?}");
    }
}
