//! Light culling and shading in a frame loop, as an engine has them: lights that do not move, a camera that
//! does, and no allocation after the first frame.
//!
//! ```text
//! cargo run --release --example engine -- --help
//! ```

mod light_pass;
mod world;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use common::command::{self, say};
use stochastic_light_culling::{Camera, Error, Projection, glam::Mat4};

use light_pass::LightPass;
use world::{Handedness, World, lights};

const SIZE: [u32; 2] = [1280, 720];
const TILE_SIZE: u32 = 16;
/// On the wall, which the floor lights.
const WATCHED_PIXEL: [u32; 2] = [640, 270];

/// Culls thousands of glossy lights in each frame of a flight over a gold floor.
#[derive(Debug, Parser)]
#[command(name = "engine", version)]
struct Arguments {
    /// How many frames
    #[arg(long, default_value_t = 8, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    frames: u32,

    /// How many lights
    #[arg(long, default_value_t = 4096, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    lights: u32,

    /// The roughness α of the floor
    #[arg(long, default_value_t = 0.1)]
    alpha: f32,

    /// The variance parameter δ: less is less noise and more work
    #[arg(long, default_value_t = 0.01)]
    delta: f32,

    /// Have view space look along +z, as in Direct3D, in place of −z, as in Bevy and wgpu
    #[arg(long)]
    left_handed: bool,

    /// Look along parallel rays
    #[arg(long)]
    orthographic: bool,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| run(&arguments).map_err(|error| error.to_string()))
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    if arguments.orthographic {
        draw_frames(arguments, Camera::orthographic)
    } else {
        draw_frames(arguments, Camera::new)
    }
}

/// Each kind of projection is compiled by itself. `camera` makes one of the engine's two matrices.
fn draw_frames<P: Projection>(
    arguments: &Arguments,
    camera: impl Fn(Mat4, Mat4) -> Result<Camera<P>, Error>,
) -> Result<(), Error> {
    let handedness = if arguments.left_handed {
        Handedness::Left
    } else {
        Handedness::Right
    };
    // When a level is loaded, and when the window changes its size.
    let mut world = World::new(SIZE, handedness, arguments.orthographic);
    let lights = lights(arguments.lights, arguments.alpha)?;
    let camera_of = |world: &World, frame| {
        let (view, projection) = world.matrices(frame);
        camera(view, projection)
    };
    let camera = camera_of(&world, 0)?;
    let mut pass = LightPass::new(lights, arguments.delta, &camera, SIZE, TILE_SIZE)?;

    say(format_args!(
        "frame  in reach  lights/tile  most  tile tests  block tests  empty  radiance  cull ms  shade ms"
    ));
    for frame in 0..arguments.frames {
        let camera = camera_of(&world, frame)?;
        let depth_buffer = world.draw_depths(frame);
        let start = Instant::now();
        let counters = pass.cull(&camera, depth_buffer, frame)?;
        let cull_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        pass.shade(&camera, depth_buffer);
        let shade_ms = start.elapsed().as_secs_f64() * 1e3;
        let radiance = pass.radiance(&camera, depth_buffer, WATCHED_PIXEL);

        let lengths = pass.list_lengths();
        let (tiles, most) = (lengths.clone().count(), lengths.max().unwrap_or(0));
        let is_read = say(format_args!(
            "{frame:>5}  {:>8}  {:>11.1}  {most:>4}  {:>10}  {:>11}  {:>5}  {radiance:>8.4}  {cull_ms:>7.2}  {shade_ms:>8.2}",
            pass.lights_in_reach(),
            counters.pairs as f64 / tiles as f64,
            counters.tile_tests,
            counters.block_tests,
            counters.empty,
        ));
        if !is_read {
            break;
        }
    }
    Ok(())
}
