//! Writes a small glTF file to try `render` on: a room with two lamps, a varnished floor and a ball like a mirror.
//!
//! ```text
//! cargo run --release --example room
//! cargo run --release --example render -- --scene target/room/room.glb
//! ```

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use common::command::{self, say};
use common::folder::make_folder;
use common::room::Room;

/// Writes room.glb, a scene for the example `render`.
#[derive(Debug, Parser)]
#[command(name = "room", version)]
struct Arguments {
    /// Leave out the camera
    #[arg(long)]
    no_camera: bool,

    /// Leave out the lights; the lamps still shine by themselves
    #[arg(long)]
    no_lights: bool,

    /// The folder that the file goes to
    #[arg(long, default_value = "target/room", value_name = "DIR")]
    out: PathBuf,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        make_folder(&arguments.out)?;
        let room = Room {
            has_camera: !arguments.no_camera,
            has_lights: !arguments.no_lights,
        };
        let path = arguments.out.join("room.glb");
        let written = std::fs::write(&path, room.glb()?);
        written.map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        say(format_args!("{}", path.display()));
        Ok(())
    })
}
