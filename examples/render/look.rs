//! Where to look from, and where to light from.

use clap::Args;
use common::scene::Wanted;
use stochastic_light_culling::glam::Vec3;

#[derive(Debug, Args)]
pub struct Look {
    /// Where the eye is [default: what the scene says, else a place that sees what is lit]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub eye: Option<Vec3>,

    /// What it looks at
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub target: Option<Vec3>,

    /// The field of view across the shorter side of the picture, in degrees
    #[arg(long, value_name = "DEGREES", value_parser = fov)]
    pub fov: Option<f32>,

    /// A light in the place of the scene's own, as bright as those; can be given more than once. In a room it shines
    /// in all directions, in the open at what is glossy
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub light: Vec<Vec3>,
}

impl Look {
    /// What this asks for of a scene, whose materials of the names in `glossy` are glossy.
    pub fn wanted<'a>(&'a self, glossy: &'a [String]) -> Wanted<'a> {
        Wanted {
            glossy,
            eye: self.eye,
            target: self.target,
            fov_radians: self.fov.map(f32::to_radians),
            lights: &self.light,
        }
    }
}

fn point(text: &str) -> Result<Vec3, &'static str> {
    const VALID: &str = "must be X,Y,Z, such as 1.5,0,-2, each finite and within 10⁹";
    let numbers: Result<Vec<f32>, _> = text
        .split(',')
        .map(|number| number.trim().parse())
        .collect();
    let numbers: [f32; 3] = numbers.ok().and_then(|n| n.try_into().ok()).ok_or(VALID)?;
    // False for NaN.
    let is_valid = numbers.iter().all(|x| x.abs() <= 1e9);
    is_valid.then(|| numbers.into()).ok_or(VALID)
}

fn fov(text: &str) -> Result<f32, &'static str> {
    const VALID: &str = "must be from 0.1 to 160 degrees";
    let degrees: f32 = text.parse().map_err(|_| VALID)?;
    let is_valid = (0.1..=160.0).contains(&degrees);
    is_valid.then_some(degrees).ok_or(VALID)
}
