//! The ring of the example `render` by the GPU, compared with the picture of the CPU.
//!
//! ```text
//! cargo run --release --manifest-path gpu/Cargo.toml --example ring -- --help
//! ```
//!
//! Glossy and diffuse lights are bounded, culled and shaded, once in one pass for each tile and once by lists in memory.
//! Prints the milliseconds of each pass, where the adapter has timestamps. Those of a software driver say nothing of a GPU.

mod comparison;
mod shading;
mod stage;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use common::command::{self, say};
use common::folder::make_folder;
use common::picture::{Exposure, tone_mapped, write_png};
use gpu::{Compiled, Error, Gpu, Method};
use stochastic_light_culling::glam::Vec3;

use comparison::{Comparison, Picture};
use shading::Lighting;
use stage::{Request, Stage};

/// Renders the ring by the GPU, and compares it with the picture of the CPU.
#[derive(Debug, Parser)]
#[command(name = "ring")]
struct Arguments {
    /// Roughness α of the gold, in (0, 1]
    #[arg(long, default_value_t = 0.1)]
    alpha: f32,

    /// Its reflectance F0 at normal incidence, in [0, 1]
    #[arg(long, default_value_t = 0.9)]
    f0: f32,

    /// Rays from the light; each hit makes a virtual point light
    #[arg(long, default_value_t = 16384, value_parser = clap::value_parser!(u32).range(1..=1 << 22))]
    vpls: u32,

    /// Variance parameter δ: less is less noise and more work
    #[arg(long, default_value_t = 0.001)]
    delta: f32,

    /// Width and height of the picture
    #[arg(long, num_args = 2, default_values_t = [640, 360], value_names = ["WIDTH", "HEIGHT"])]
    size: Vec<u32>,

    /// Which random numbers to use
    #[arg(long, default_value_t = 1)]
    seed: u32,

    /// Width w of interleaved sampling: each pixel is lit by 1/w² of the lights
    #[arg(long, default_value_t = 4, value_name = "W")]
    interleave: u32,

    /// How often each pass is timed; the least time counts
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeat: u32,

    /// The folder that the pictures go to
    #[arg(long, default_value = "target/ring", value_name = "DIR")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| render(&arguments))
}

fn render(arguments: &Arguments) -> Result<(), String> {
    let said = |error: stochastic_light_culling::Error| error.to_string();
    let stage = Stage::new(Request {
        alpha: arguments.alpha,
        f0: arguments.f0,
        vpls: arguments.vpls,
        delta: arguments.delta,
        size: [arguments.size[0], arguments.size[1]],
        seed: arguments.seed,
        interleave: arguments.interleave,
    });
    let stage = stage.map_err(said)?;
    let gpu = Gpu::new().map_err(|error| error.to_string())?;
    make_folder(&arguments.out)?;
    let (by_cpu, cpu_ms) = stage.by_cpu().map_err(said)?;
    say(format_args!(
        "{}; by the CPU {cpu_ms:.1} ms for all",
        gpu.name()
    ));
    let lightings = [
        ("glossy", Lighting::glossy(&gpu, &stage)),
        ("diffuse", Lighting::diffuse(&gpu, &stage)),
    ];
    let mut sum = vec![Vec3::ZERO; stage.surfaces.surfaces.len()];
    for ((kind, lighting), reference) in lightings.into_iter().zip(&by_cpu) {
        let lighting = lighting.map_err(|error| error.to_string())?;
        for method in [Method::Tiles, Method::Lists] {
            let by_gpu = lighting.compiled(method, |compiled| {
                timed(&lighting, compiled, arguments.repeat)
            });
            let (picture, times) = by_gpu.map_err(|error| error.to_string())?;
            say(format_args!(
                "\n{} {kind} lights, {}",
                lighting.record.lights,
                named(method)
            ));
            for (pass, milliseconds) in times {
                let time = milliseconds.map_or("no timestamps".into(), |ms| format!("{ms:9.3} ms"));
                say(format_args!("  {pass:20} {time}"));
            }
            let Comparison {
                relative_error,
                unlike,
                ..
            } = Comparison::new(&picture, reference);
            say(format_args!(
                "  RMSE {relative_error:.1e} of the mean of the CPU's; {unlike} pixels accept more or fewer lights"
            ));
            if method == Method::Tiles {
                for (sum, (irradiance, _)) in sum.iter_mut().zip(&picture) {
                    *sum += irradiance;
                }
            }
        }
    }
    let reflected = |irradiance: &[Vec3]| -> Vec<Vec3> {
        let seen = stage.surfaces.surfaces.iter().zip(irradiance);
        seen.map(|(surface, irradiance)| surface.reflected(*irradiance))
            .collect()
    };
    let [glossy, diffuse] = by_cpu.each_ref().map(|shaded| &shaded.irradiance);
    let of_cpu: Vec<Vec3> = glossy.iter().zip(diffuse).map(|(a, b)| a + b).collect();
    let [by_gpu, by_cpu] = [reflected(&sum), reflected(&of_cpu)];
    let exposure = Exposure::of(&by_cpu);
    for (name, picture) in [("gpu.png", by_gpu), ("cpu.png", by_cpu)] {
        let picture = tone_mapped(stage.request.size, &picture, exposure);
        write_png(&arguments.out, name, &picture)?;
    }
    say(format_args!("\npictures: {}", arguments.out.display()));
    Ok(())
}

fn named(method: Method) -> &'static str {
    match method {
        Method::Tiles => "culled and shaded tile by tile",
        _ => "shaded by lists in memory",
    }
}

type Timed = (Picture, Vec<(&'static str, Option<f64>)>);

/// The picture, and the least milliseconds of each pass.
fn timed(lighting: &Lighting, compiled: &Compiled, repeat: u32) -> Result<Timed, Error> {
    let (mut picture, times) = lighting.picture(compiled)?;
    let ms = |time: Option<std::time::Duration>| time.map(|time| 1e3 * time.as_secs_f64());
    let mut least: Vec<_> = times
        .into_iter()
        .map(|(pass, time)| (pass, ms(time)))
        .collect();
    for _ in 1..repeat {
        let (again, times) = lighting.picture(compiled)?;
        picture = again;
        for ((_, least), (_, time)) in least.iter_mut().zip(times) {
            *least = least.zip(ms(time)).map(|(a, b)| a.min(b));
        }
    }
    Ok((picture, least))
}
