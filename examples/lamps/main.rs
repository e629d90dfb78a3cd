//! Thousands of ordinary lamps: as an engine ends them, and by roulette, side by side.
//!
//! ```text
//! cargo run --release --example lamps -- --help
//! ```
//!
//! Writes `lamps.png`: at the top the lamps with windows, and all light of all lamps; below one frame by
//! roulette, and the mean of many.

mod passes;
mod street;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use common::command::{self, say};
use common::folder::make_folder;
use common::picture::{Exposure, tone_mapped, write_png};
use stochastic_light_culling::{Bounded, ConstantLobe, Error, Roulette, SpotLobe, glam::Vec3};

use passes::{Picture, View, by_roulette, by_windows, of_all};
use street::{camera, lamps, luminance, seen};

/// Lights a street with thousands of spot and point lights, clamped and unbiased.
#[derive(Debug, Parser)]
#[command(name = "lamps", version)]
struct Arguments {
    /// How many lamps; they emit the same in all
    #[arg(long, default_value_t = 4000, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=100_000))]
    lamps: u32,

    /// The exposure value at ISO 100: how bright white is
    #[arg(long, default_value_t = 3.5)]
    ev100: f32,

    /// δ as a share of the illuminance at which white paper is white
    #[arg(long, default_value_t = 0.01)]
    delta: f32,

    /// The share of that illuminance at which an engine ends a lamp
    #[arg(long, default_value_t = 0.003)]
    cut: f32,

    /// How many frames the last picture is the mean of
    #[arg(long, default_value_t = 64, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    frames: u32,

    /// The width of each of the four pictures, in pixels; the height is 9/16 of that
    #[arg(long, default_value_t = 640, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=4096))]
    width: u32,

    /// Another seed gives other lamps and another noise
    #[arg(long, default_value_t = 1)]
    seed: u32,

    /// Where the picture goes
    #[arg(long, default_value = "target/lamps", value_name = "DIR")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        make_folder(&arguments.out)?;
        let size = [arguments.width, arguments.width * 9 / 16];
        let rows = run(&arguments, size).map_err(|error| error.to_string())?;
        let white = 1.2 * arguments.ev100.exp2();
        let [width, height] = size;
        let mut sheet = Vec::new();
        for [left, right] in rows {
            for y in 0..height as usize {
                for picture in [&left, &right] {
                    sheet.extend_from_slice(&picture[y * width as usize..][..width as usize]);
                }
            }
        }
        let exposure = Exposure::with_white(white);
        let picture = tone_mapped([2 * width, 2 * height], &sheet, exposure);
        write_png(&arguments.out, "lamps.png", &picture)
    })
}

type Rows = [[Vec<Vec3>; 2]; 2];

fn run(arguments: &Arguments, size: [u32; 2]) -> Result<Rows, Error> {
    let camera = camera(size)?;
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    let surfaces = pixels.map(|pixel| seen(&camera, size, pixel)).collect();
    let view = View::new(camera, size, surfaces)?;
    let (spots, bulbs) = lamps(arguments.lamps, arguments.seed)?;

    // White paper of illuminance E has the luminance E/π, which is the most that the exposure shows.
    let white = std::f32::consts::PI * 1.2 * arguments.ev100.exp2();
    let (delta, cut) = (arguments.delta * white, arguments.cut * white);
    let roulette = Roulette::new(delta)?;
    say(format_args!(
        "{} lamps, {}×{}, EV100 {}: white at {white:.1} lx, δ = {delta:.3} lx, windows end at {cut:.3} lx\n\n{:<22}{:>13}{:>14}{:>12}{:>9}",
        arguments.lamps,
        size[0],
        size[1],
        arguments.ev100,
        "",
        "lights/pixel",
        "mean of all",
        "RMSE/white",
        "ms",
    ));

    let start = Instant::now();
    let mut all = of_all(&view, &spots)?;
    all.add(&of_all(&view, &bulbs)?);
    let report = |name: &str, picture: &Picture, frames: u32, ms: f64| {
        let mean = |radiance: &[Vec3]| {
            radiance
                .iter()
                .map(|rgb| f64::from(luminance(*rgb)))
                .sum::<f64>()
        };
        let squares = picture.radiance.iter().zip(&all.radiance);
        let squares = squares.map(|(a, b)| f64::from(luminance(*a - *b)).powi(2));
        let rmse = (squares.sum::<f64>() / all.radiance.len() as f64).sqrt();
        let lit = view.surfaces.iter().flatten().count() as f64 * f64::from(frames);
        say(format_args!(
            "{name:<22}{:>13.1}{:>13.1}%{:>12.4}{ms:>9.1}",
            picture.evaluated as f64 / lit,
            100.0 * mean(&picture.radiance) / mean(&all.radiance),
            rmse / f64::from(white / std::f32::consts::PI),
        ));
    };
    let counted = Picture {
        radiance: all.radiance.clone(),
        evaluated: u64::from(arguments.lamps) * view.surfaces.iter().flatten().count() as u64,
    };
    report("all lamps", &counted, 1, elapsed(start));

    let start = Instant::now();
    let mut clamped = by_windows(&view, &spots, cut, SpotLobe::PEAK, |lobe| {
        lobe.hard_edged().unit_bound()
    })?;
    clamped.add(&by_windows(
        &view,
        &bulbs,
        cut,
        ConstantLobe::PEAK,
        Bounded::unit_bound,
    )?);
    report("windows", &clamped, 1, elapsed(start));

    let mut first = None;
    let mut mean = Picture {
        radiance: vec![Vec3::ZERO; view.surfaces.len()],
        evaluated: 0,
    };
    let start = Instant::now();
    for frame in 0..arguments.frames {
        let mut picture = by_roulette(&view, &spots, &roulette, arguments.seed, frame)?;
        picture.add(&by_roulette(
            &view,
            &bulbs,
            &roulette,
            !arguments.seed,
            frame,
        )?);
        mean.add(&picture);
        if frame == 0 {
            report("roulette, one frame", &picture, 1, elapsed(start));
            first = Some(picture);
        }
    }
    let count = arguments.frames;
    for radiance in &mut mean.radiance {
        *radiance /= count as f32;
    }
    report(
        &format!("roulette, {count} frames"),
        &mean,
        count,
        elapsed(start),
    );
    let first = first.map_or_else(Vec::new, |picture| picture.radiance);
    Ok([[clamped.radiance, all.radiance], [first, mean.radiance]])
}

fn elapsed(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
