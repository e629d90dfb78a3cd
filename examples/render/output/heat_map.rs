//! How many lights each pixel evaluates, as a colour.

use image::{Rgb, RgbImage};

/// The brightest colour, as in the paper's Figs. 9 and 10.
const MOST_LIGHTS: u32 = 256;

/// The map of `counts`, row by row, with the scale from 0 to 256 and more at its right edge.
pub fn heat_map([width, height]: [u32; 2], counts: &[u32]) -> RgbImage {
    let bar = (width / 40).max(4);
    let gap = bar / 2;
    let color = |count: f64| {
        let share = (count / f64::from(MOST_LIGHTS)).min(1.0);
        let color = colorous::INFERNO.eval_continuous(share);
        Rgb([color.r, color.g, color.b])
    };
    let mut picture = RgbImage::from_pixel(width + gap + bar, height, Rgb([255; 3]));
    for (pixel, count) in counts.iter().enumerate() {
        let pixel = pixel as u32;
        picture.put_pixel(pixel % width, pixel / width, color(f64::from(*count)));
    }
    for y in 0..height {
        let share = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
        for x in 0..bar {
            picture.put_pixel(width + gap + x, y, color(share * f64::from(MOST_LIGHTS)));
        }
    }
    picture
}
