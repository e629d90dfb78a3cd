//! How far frames are from the truth.

use common::frame::rmse;
use stochastic_light_culling::glam::Vec3;

use crate::statistics::Mean;
use crate::subject::{Subject, Truth};

/// The errors of frames with different random numbers.
pub struct Score<'a> {
    subject: &'a Subject<'a>,
    truth: &'a Truth,
    squared: Vec<f64>,
    brightness: Vec<f64>,
}

impl<'a> Score<'a> {
    pub fn new(subject: &'a Subject<'a>, truth: &'a Truth) -> Self {
        Self {
            subject,
            truth,
            squared: Vec::new(),
            brightness: Vec::new(),
        }
    }

    /// Takes in a frame, by the irradiance of all its pixels.
    pub fn add(&mut self, irradiance: &[Vec3]) {
        let Truth {
            pixels,
            irradiance: truth,
            ..
        } = self.truth;
        let error = rmse(&self.subject.surfaces, irradiance, pixels, truth);
        self.squared.push(error * error);
        let shown: Vec<Vec3> = pixels.iter().map(|pixel| irradiance[*pixel]).collect();
        self.brightness
            .push(self.subject.brightness(pixels, &shown));
    }

    /// The root of the mean squared error, over the mean brightness.
    pub fn relative_rmse(&self) -> Mean {
        self.relative_mse().sqrt()
    }

    /// The mean squared error, over the squared mean brightness.
    pub fn relative_mse(&self) -> Mean {
        let brightness = self.truth.brightness.mean;
        Mean::of(&self.squared).over(brightness * brightness)
    }

    /// By how much frames are too bright in the mean, over the brightness; that the truth is known to a
    /// finite accuracy counts.
    pub fn relative_bias(&self) -> Mean {
        let frames = Mean::of(&self.brightness);
        let truth = self.truth.brightness;
        let offset = Mean {
            mean: frames.mean - truth.mean,
            standard_error: frames.standard_error.hypot(truth.standard_error),
        };
        offset.over(truth.mean)
    }
}
