//! From radiance to a PNG.

use std::fs;
use std::path::Path;

use image::{ImageFormat, Rgb, RgbImage};
use stochastic_light_culling::glam::Vec3;

/// What radiance is multiplied by before it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Exposure(f32);

impl Exposure {
    /// The exposure that shows all but the brightest 2 % of `radiance` short of white.
    pub fn of(radiance: &[Vec3]) -> Self {
        let mut brightest: Vec<f32> = radiance.iter().map(|rgb| rgb.max_element()).collect();
        brightest.retain(|value| *value > 0.0);
        brightest.sort_by(f32::total_cmp);
        let white = brightest.get(brightest.len() * 98 / 100).unwrap_or(&1.0);
        Self(2.0 / white)
    }

    /// The exposure at which a radiance of `white` is nearly white.
    pub fn with_white(white: f32) -> Self {
        Self(2.0 / white)
    }
}

/// The sRGB picture of `radiance`, row by row.
pub fn tone_mapped([width, height]: [u32; 2], radiance: &[Vec3], exposure: Exposure) -> RgbImage {
    let mut picture = RgbImage::new(width, height);
    for (pixel, radiance) in picture.pixels_mut().zip(radiance) {
        let exposed = (*radiance * exposure.0).to_array();
        *pixel = Rgb(exposed.map(|x| (255.0 * srgb(1.0 - (-x).exp()) + 0.5) as u8));
    }
    picture
}

/// The value that is stored for a linear one in \[0, 1\] [IEC 61966-2-1].
fn srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// Writes `name` in `folder`, all of it or nothing.
pub fn write_png(folder: &Path, name: &str, picture: &RgbImage) -> Result<(), String> {
    let unfinished = folder.join(format!(".{name}.{}.part", std::process::id()));
    let written = picture
        .save_with_format(&unfinished, ImageFormat::Png)
        .map_err(|error| error.to_string())
        .and_then(|()| {
            fs::rename(&unfinished, folder.join(name)).map_err(|error| error.to_string())
        });
    written.map_err(|reason| {
        // Nothing can be done about one that cannot be removed either.
        let _ = fs::remove_file(&unfinished);
        format!("cannot write {}: {reason}", folder.join(name).display())
    })
}
