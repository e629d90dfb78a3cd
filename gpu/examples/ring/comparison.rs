//! How far a picture is from that of the CPU.

use common::frame::Shaded;
use stochastic_light_culling::glam::Vec3;

/// For each pixel the irradiance, and the number of lights that it accepts.
pub type Picture = Vec<(Vec3, u32)>;

pub struct Comparison {
    /// The root of the mean squared error over the mean.
    pub relative_error: f64,
    /// At how many pixels more or fewer lights are accepted.
    pub unlike: usize,
    /// How many pairs of a light and a pixel the CPU accepts.
    #[allow(dead_code, reason = "for the tests")]
    pub accepted: u64,
}

impl Comparison {
    pub fn new(picture: &Picture, reference: &Shaded) -> Self {
        let (mut squared, mut sum, mut unlike, mut accepted) = (0.0, 0.0, 0, 0);
        let known = reference.irradiance.iter().zip(&reference.contributing);
        for ((irradiance, count), (known, known_count)) in picture.iter().zip(known) {
            squared += f64::from((irradiance - known).length_squared()) / 3.0;
            sum += f64::from(known.element_sum()) / 3.0;
            unlike += usize::from(count != known_count);
            accepted += u64::from(*known_count);
        }
        let pixels = picture.len() as f64;
        Self {
            relative_error: (squared / pixels).sqrt() / (sum / pixels),
            unlike,
            accepted,
        }
    }
}
