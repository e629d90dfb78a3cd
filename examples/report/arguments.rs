//! The command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};

/// Measures error against run time for every choice that the crate offers, as tables, CSV and SVG.
#[derive(Debug, Parser)]
#[command(name = "report", version)]
pub struct Arguments {
    /// What to light: ring, cornell, or a file (.obj, .glb, .gltf); can be given more than once
    /// [default: ring and cornell]
    #[arg(long)]
    pub scene: Vec<String>,

    /// What to measure; can be given more than once [default: everything]
    #[arg(long)]
    pub study: Vec<StudyKind>,

    /// Small pictures and few repetitions, in under a minute: to see that all works
    #[arg(long)]
    pub quick: bool,

    /// Which random numbers to use
    #[arg(long, default_value_t = 1)]
    pub seed: u32,

    /// The folder that everything goes to
    #[arg(long, default_value = "target/report", value_name = "DIR")]
    pub out: PathBuf,
}

#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd, ValueEnum)]
pub enum StudyKind {
    /// Error against milliseconds as δ goes from coarse to fine, for each method
    DeltaSweep,
    /// The error of each method in the time of the paper's
    EqualTime,
    /// Error and nanoseconds of each function
    Functions,
    /// Volumes of the bounds over that of the smallest ellipsoid, and nanoseconds
    Tightness,
    /// Lights that a list holds and no pixel accepts, and nanoseconds, for each test, tile size and slicing
    Tests,
    /// Error and milliseconds against the number of lights
    VplCount,
    /// Error and milliseconds against the width of interleaving, with and without denoising
    Interleaving,
    /// What it costs to leave the receiver's BRDF out of the probability, and error against time with it
    Receivers,
    /// Error of the mean of 1 to 64 frames, by how the ξ of lights and frames go together
    Spread,
    /// One decision for all pixels of a tile: what is seen of the tiles' borders
    TileBorders,
    /// Transformed cosines in the place of GGX: error of the lobes and of pictures, and milliseconds
    Ltsd,
    /// Smooth lights in the place of points: error against time, and change under a moving light
    Vsgl,
}

impl Arguments {
    pub fn scenes(&self) -> Vec<String> {
        if self.scene.is_empty() {
            return ["ring", "cornell"].map(str::to_owned).to_vec();
        }
        let mut scenes = Vec::new();
        for scene in &self.scene {
            if !scenes.contains(scene) {
                scenes.push(scene.clone());
            }
        }
        scenes
    }

    /// The studies to make, each once, in their order.
    pub fn studies(&self) -> Vec<StudyKind> {
        let mut studies = self.study.clone();
        if studies.is_empty() {
            studies = StudyKind::value_variants().to_vec();
        }
        studies.sort_unstable();
        studies.dedup();
        studies
    }
}
