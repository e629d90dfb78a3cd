//! How the errors of neighbours go together, and what shows at the borders of tiles.

use common::frame::Frame;
use stochastic_light_culling::glam::Vec3;

use super::TILE;

/// The greatest distance of pixels whose errors are compared.
pub const DISTANCES: usize = 32;

/// How errors of pixels go together.
#[derive(Clone, Default)]
pub struct Errors {
    /// Of squared errors over the squared mean, a sum for each picture.
    relative_squares: Vec<f64>,
    /// For each distance: products of errors of two pixels in a row, and the mean of their squares.
    products: [[f64; 2]; DISTANCES],
    /// Squared steps of the error between neighbours of a subregion across a border, and within tiles.
    steps: [[f64; 2]; 2],
}

impl Errors {
    /// Adds a picture, made with a grid that is moved by `offset`. Errors are relative to the light that there is,
    /// and to its mean, so that neither bright nor dark pixels decide alone.
    pub fn add(&mut self, frame: &Frame, image: &[Vec3], truth: &[Vec3], offset: [u32; 2]) {
        let interleave = &frame.interleave;
        let [width, height] = frame.surfaces.image_size.map(|n| n as usize);
        let seen = |i: usize| !frame.surfaces.surfaces[i].is_sky();
        let brightness = |light: Vec3| f64::from(light.element_sum()) / 3.0;
        let pixels: Vec<usize> = (0..image.len()).filter(|i| seen(*i)).collect();
        let count = pixels.len().max(1) as f64;
        let mean = pixels.iter().map(|i| brightness(truth[*i])).sum::<f64>() / count;
        let error = |i: usize| brightness(image[i]) - brightness(truth[i]);
        let squares = pixels.iter().map(|i| error(*i).powi(2)).sum::<f64>() / count;
        self.relative_squares.push(squares / (mean * mean));

        let relative = |i: usize| error(i) / (brightness(truth[i]) + mean);
        let errors: Vec<Option<f64>> = (0..image.len())
            .map(|i| seen(i).then(|| relative(i)))
            .collect();
        let step = interleave.width() as usize;
        for (i, one) in errors.iter().enumerate() {
            let (Some(one), [x, y]) = (one, [i % width, i / width]) else {
                continue;
            };
            for distance in 1..=DISTANCES.min(width - 1 - x) {
                if let Some(other) = errors[i + distance] {
                    let [product, square] = &mut self.products[distance - 1];
                    *product += one * other;
                    *square += 0.5 * (one * one + other * other);
                }
            }
            let local = interleave.split_pixel([x as u32, y as u32]).1;
            let neighbours = [(x + step < width, step), (y + step < height, step * width)];
            for (axis, (has_one, away)) in neighbours.into_iter().enumerate() {
                if let (true, Some(other)) = (has_one, errors.get(i + away).copied().flatten()) {
                    let is_last = (local[axis] + offset[axis]) % TILE == TILE - 1;
                    let [square, pairs] = &mut self.steps[usize::from(!is_last)];
                    *square += (one - other).powi(2);
                    *pairs += 1.0;
                }
            }
        }
    }

    pub fn relative_rmse(&self) -> f64 {
        let count = self.relative_squares.len().max(1) as f64;
        (self.relative_squares.iter().sum::<f64>() / count).sqrt()
    }

    /// The squared step across a border over that within tiles: 1 where no border shows.
    pub fn border_contrast(&self) -> f64 {
        let [across, within] = self.steps.map(|[square, pairs]| square / pairs.max(1.0));
        across / within
    }

    pub fn correlation(&self, distance: usize) -> f64 {
        let [product, square] = self.products[distance - 1];
        product / square
    }
}
