//! How far pictures of receivers are from what they estimate.

use stochastic_light_culling::glam::Vec3;

use crate::statistics::{Mean, median};

/// What some pixels show in the mean.
pub struct Expected {
    /// Places in the image.
    pub pixels: Vec<usize>,
    pub radiance: Vec<Vec3>,
}

impl Expected {
    /// The mean over pixels and channels.
    pub fn mean(&self) -> f64 {
        self.radiance.iter().map(brightness).sum::<f64>() / self.radiance.len().max(1) as f64
    }
}

/// The errors of pictures with different random numbers.
pub struct Errors<'a> {
    expected: &'a Expected,
    /// Of each picture and pixel, the mean over three channels.
    squares: Vec<Vec<f64>>,
    /// The mean of each picture over the expected one.
    means: Vec<f64>,
}

/// What is reported of them.
#[derive(Clone, Copy)]
pub struct Measures {
    /// The mean squared error over the squared mean radiance.
    pub mse: Mean,
    /// The sum of the standard deviations of pixels over the sum of what they show.
    pub sigma: Mean,
    /// The relative standard deviation of the pixel in the middle.
    pub median: Mean,
    /// By how many standard errors the pictures are too bright.
    pub bias: f64,
}

impl<'a> Errors<'a> {
    pub fn new(expected: &'a Expected) -> Self {
        Self {
            expected,
            squares: Vec::new(),
            means: Vec::new(),
        }
    }

    /// Takes in a picture, by the radiance of all its pixels.
    pub fn add(&mut self, radiance: &[Vec3]) {
        let Expected {
            pixels,
            radiance: expected,
        } = self.expected;
        let square = |(pixel, expected): (&usize, &Vec3)| {
            f64::from((radiance[*pixel] - *expected).length_squared()) / 3.0
        };
        self.squares
            .push(pixels.iter().zip(expected).map(square).collect());
        let sum: f64 = pixels
            .iter()
            .map(|pixel| brightness(&radiance[*pixel]))
            .sum();
        self.means
            .push(sum / (pixels.len() as f64 * self.expected.mean()));
    }

    pub fn measures(&self) -> Measures {
        let (mean, expected) = (self.expected.mean(), &self.expected.radiance);
        let of_picture = |squares: &Vec<f64>| squares.iter().sum::<f64>() / squares.len() as f64;
        let of_pictures: Vec<f64> = self.squares.iter().map(of_picture).collect();
        let sigma = |variances: &[f64]| {
            let sum: f64 = variances.iter().map(|variance| variance.sqrt()).sum();
            sum / (variances.len() as f64 * mean)
        };
        let middle = |variances: &[f64]| {
            let lit = variances
                .iter()
                .zip(expected)
                .filter(|(_, e)| brightness(e) > 0.0);
            let relative: Vec<f64> = lit.map(|(v, e)| v.sqrt() / brightness(e)).collect();
            median(&relative)
        };
        let one = Mean::of(&self.means);
        Measures {
            mse: Mean::of(&of_pictures).over(mean * mean),
            sigma: self.jackknife(sigma),
            median: self.jackknife(middle),
            bias: Mean {
                mean: one.mean - 1.0,
                ..one
            }
            .sigmas(),
        }
    }

    /// A `statistic` of the variances of pixels, and what it would vary by from one run to the next
    /// [Tukey 1958].
    fn jackknife(&self, statistic: impl Fn(&[f64]) -> f64) -> Mean {
        let count = self.squares.len() as f64;
        let pixels = self.expected.pixels.len();
        let mut sums = vec![0.0; pixels];
        for squares in &self.squares {
            for (sum, square) in sums.iter_mut().zip(squares) {
                *sum += square;
            }
        }
        let all: Vec<f64> = sums.iter().map(|sum| sum / count).collect();
        let without = |squares: &Vec<f64>| {
            let others = sums.iter().zip(squares);
            // Rounding may leave less than nothing.
            let variances: Vec<f64> = others
                .map(|(sum, square)| ((sum - square) / (count - 1.0).max(1.0)).max(0.0))
                .collect();
            statistic(&variances)
        };
        let leaving_one: Vec<f64> = self.squares.iter().map(without).collect();
        Mean {
            mean: statistic(&all),
            standard_error: Mean::of(&leaving_one).standard_error * (count - 1.0),
        }
    }
}

fn brightness(radiance: &Vec3) -> f64 {
    f64::from(radiance.element_sum()) / 3.0
}
