//! The command line.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use common::frame::{BoundKind, Clustering};
use common::scene::Gloss;
use stochastic_light_culling::{Error, Ggx, Roulette, Schlick};

use crate::look::Look;

/// Renders a glossy caustic by stochastic light culling, and measures what each bound costs.
#[derive(Debug, Parser)]
#[command(name = "render", version)]
pub struct Arguments {
    /// What to render: ring, cornell, or a file (.obj, .glb, .gltf)
    #[arg(long, default_value = "ring")]
    pub scene: String,

    #[command(flatten)]
    pub look: Look,

    /// A material of the file that reflects as GGX; can be given more than once [default: what the file
    /// says: those with a specular colour, or all of glTF; of a file without materials, everything]
    #[arg(long, value_name = "NAME")]
    pub glossy: Vec<String>,

    /// Roughness α of glossy surfaces, in (0, 1] [default: what the file says, else 0.1]
    #[arg(long, value_parser = ggx)]
    pub alpha: Option<Ggx>,

    /// Their reflectance F0 at normal incidence, in [0, 1] [default: what the file says, else 0.9]
    #[arg(long, value_parser = schlick)]
    pub f0: Option<Schlick>,

    /// Roughness α in (0, 1] of a coat over all that is seen, as a receiver [default: what the file says; of scenes without
    /// a gloss of their own, none, unless there is --receiver-f0]
    #[arg(long, value_parser = ggx, value_name = "ALPHA")]
    pub receiver_alpha: Option<Ggx>,

    /// Its reflectance F0 at normal incidence, in [0, 1] [default: 0.04]
    #[arg(long, value_parser = schlick, value_name = "F0")]
    pub receiver_f0: Option<Schlick>,

    /// Rays from the light; each hit makes a virtual point light
    #[arg(long, default_value_t = 16384, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    pub vpls: u32,

    /// What lights the scene: every point, or smooth lights that each stand for a cluster of points
    #[arg(long, default_value = "vpl")]
    pub lights: LightKind,

    /// How many smooth lights stand for the glossy points, and how many for the diffuse ones [default: 1024]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pub clusters: Option<u32>,

    /// What points go to a cluster [default: fis]
    #[arg(long)]
    pub clustering: Option<Clustering>,

    /// Variance parameter δ: less is less noise and more work
    #[arg(long, default_value = "0.001", value_parser = roulette)]
    pub delta: Roulette,

    /// What encloses a light's range; can be given more than once [default: all, one after another]
    #[arg(long)]
    pub bound: Vec<BoundKind>,

    /// Width and height of the picture
    #[arg(long, default_value = "640x360", value_name = "WxH", value_parser = size)]
    pub size: [u32; 2],

    /// Which random numbers to use
    #[arg(long, default_value_t = 1)]
    pub seed: u32,

    /// The folder that the pictures go to
    #[arg(long, default_value = "target/render", value_name = "DIR")]
    pub out: PathBuf,

    /// Print one JSON object to standard output, and the table to standard error
    #[arg(long)]
    pub json: bool,

    /// Width w of interleaved sampling: each pixel is lit by 1/w² of the lights
    #[arg(long, default_value_t = 4, value_name = "W")]
    pub interleave: u32,

    /// Width of a tile in pixels
    #[arg(long, default_value_t = 16, value_name = "N")]
    pub tile: u32,

    /// Leave the noise in
    #[arg(long)]
    pub no_denoise: bool,

    /// The picture of all lights, to measure the error by [default: full if that is quick, else
    /// sampled]
    #[arg(long)]
    pub reference: Option<ReferenceKind>,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum LightKind {
    /// Virtual point lights
    Vpl,
    /// Virtual spherical Gaussian lights
    Vsgl,
}

/// How to make smooth lights.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Clusters {
    pub count: u32,
    pub clustering: Clustering,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum ReferenceKind {
    /// At every pixel
    Full,
    /// At pixels on a coarse grid
    Sampled,
    /// Not at all
    Off,
}

impl Arguments {
    /// How glossy surfaces reflect that have no gloss of their own.
    pub fn gloss(&self) -> Result<Gloss, Error> {
        let ggx = self.alpha.map_or_else(|| Ggx::new(0.1), Ok)?;
        let fresnel = self.f0.map_or_else(|| Schlick::new(0.9), Ok)?;
        Ok(Gloss::new(ggx, fresnel))
    }

    /// The coat of all receivers; none if they are what the scene says.
    ///
    /// # Errors
    ///
    /// A number that is not in range, which no default is.
    pub fn coat(&self) -> Result<Option<Gloss>, Error> {
        if self.receiver_alpha.is_none() && self.receiver_f0.is_none() {
            return Ok(None);
        }
        let ggx = self.receiver_alpha.map_or_else(|| Ggx::new(0.1), Ok)?;
        let fresnel = self.receiver_f0.map_or_else(|| Schlick::new(0.04), Ok)?;
        Ok(Some(Gloss::new(ggx, fresnel)))
    }

    /// How to make smooth lights; none for points.
    ///
    /// # Errors
    ///
    /// An option that means nothing beside the others.
    pub fn smooth(&self) -> Result<Option<Clusters>, String> {
        match self.lights {
            LightKind::Vpl if self.clusters.is_some() => {
                Err("--clusters is for --lights vsgl".into())
            }
            LightKind::Vpl if self.clustering.is_some() => {
                Err("--clustering is for --lights vsgl".into())
            }
            LightKind::Vpl => Ok(None),
            LightKind::Vsgl if self.receiver_alpha.is_some() => {
                Err("--receiver-alpha is for --lights vpl".into())
            }
            LightKind::Vsgl if self.receiver_f0.is_some() => {
                Err("--receiver-f0 is for --lights vpl".into())
            }
            LightKind::Vsgl if self.bound.iter().any(|bound| *bound != BoundKind::Tight) => {
                Err("--lights vsgl has one bound, tight".into())
            }
            LightKind::Vsgl => Ok(Some(Clusters {
                count: self.clusters.unwrap_or(1024),
                clustering: self.clustering.unwrap_or(Clustering::Fis),
            })),
        }
    }

    /// The bounds to measure, each once, from the loosest to the tightest.
    pub fn bounds(&self) -> Vec<BoundKind> {
        let mut bounds = if self.bound.is_empty() {
            BoundKind::ALL.to_vec()
        } else {
            self.bound.clone()
        };
        bounds.sort_unstable();
        bounds.dedup();
        bounds
    }
}

type Refusal = Box<dyn std::error::Error + Send + Sync>;

fn ggx(text: &str) -> Result<Ggx, Refusal> {
    Ok(Ggx::new(text.parse()?)?)
}

fn schlick(text: &str) -> Result<Schlick, Refusal> {
    Ok(Schlick::new(text.parse()?)?)
}

fn roulette(text: &str) -> Result<Roulette, Refusal> {
    Ok(Roulette::new(text.parse()?)?)
}

fn size(text: &str) -> Result<[u32; 2], Refusal> {
    const LARGEST: u32 = 16384;
    let valid = "must be width x height, such as 640x360, each from 1 to 16384";
    let (width, height) = text.split_once('x').ok_or(valid)?;
    let size = [
        width.parse().map_err(|_| valid)?,
        height.parse().map_err(|_| valid)?,
    ];
    if size.iter().all(|side| (1..=LARGEST).contains(side)) {
        Ok(size)
    } else {
        Err(valid.into())
    }
}
