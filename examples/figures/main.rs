//! The pictures of the documentation, each made by a command:
//!
//! ```text
//! cargo run --release --example figures -- culling lobe tiles frames --out docs
//! ```
#![expect(
    clippy::cast_possible_wrap,
    reason = "pictures are a few thousand pixels wide"
)]

mod culling;
mod frames;
mod lobe;
mod section;
mod sheet;
mod stage;
mod tiles;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, ValueEnum};
use common::command::{self, say};
use common::folder::make_folder;

/// Draws the pictures of the documentation, as SVG.
#[derive(Debug, Parser)]
#[command(name = "figures", version)]
struct Arguments {
    /// Which to draw [default: all]
    which: Vec<Picture>,

    /// The folder that the pictures go to
    #[arg(long, default_value = "target/figures", value_name = "DIR")]
    out: PathBuf,

    /// How many times as coarse as in the documentation, for a quick look
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8))]
    coarse: u32,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
enum Picture {
    /// Lights per pixel by sphere, spheroid and tight ellipsoid
    Culling,
    /// A lobe's isosurface and what encloses it
    Lobe,
    /// Tiles over a frame, and lights' ellipsoids
    Tiles,
    /// One frame, many, and clamped ranges
    Frames,
}

impl Picture {
    const ALL: [Self; 4] = [Self::Culling, Self::Lobe, Self::Tiles, Self::Frames];

    fn name(self) -> &'static str {
        match self {
            Self::Culling => "culling",
            Self::Lobe => "lobe",
            Self::Tiles => "tiles",
            Self::Frames => "frames",
        }
    }

    fn svg(self, coarse: u32) -> Result<String, String> {
        match self {
            Self::Culling => culling::svg(coarse),
            Self::Lobe => lobe::svg(),
            Self::Tiles => tiles::svg(coarse),
            Self::Frames => frames::svg(coarse),
        }
    }
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        make_folder(&arguments.out)?;
        let which = if arguments.which.is_empty() {
            &Picture::ALL
        } else {
            &*arguments.which
        };
        for picture in which {
            let path = arguments.out.join(format!("{}.svg", picture.name()));
            let svg = picture.svg(arguments.coarse)?;
            let unfinished = path.with_extension("svg.part");
            std::fs::write(&unfinished, svg)
                .and_then(|()| std::fs::rename(&unfinished, &path))
                .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
            say(format_args!("{}", path.display()));
        }
        Ok(())
    })
}
