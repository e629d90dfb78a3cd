//! Means of samples, and how sure they are.

/// A mean, and the standard deviation of that mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mean {
    pub mean: f64,
    /// Zero for a single sample.
    pub standard_error: f64,
}

impl Mean {
    pub fn of(samples: &[f64]) -> Self {
        let count = samples.len().max(1) as f64;
        let mean = samples.iter().sum::<f64>() / count;
        let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
        let variance = squares / (count - 1.0).max(1.0);
        Self {
            mean,
            standard_error: (variance / count).sqrt(),
        }
    }

    /// The mean of independent means.
    pub fn of_means(means: &[Self]) -> Self {
        let count = means.len().max(1) as f64;
        let variance: f64 = means.iter().map(|mean| mean.standard_error.powi(2)).sum();
        Self {
            mean: means.iter().map(|mean| mean.mean).sum::<f64>() / count,
            standard_error: variance.sqrt() / count,
        }
    }

    /// Where the expectation lies in 95 cases of a hundred.
    pub fn interval(self) -> [f64; 2] {
        [-1.96, 1.96].map(|sigmas| self.mean + sigmas * self.standard_error)
    }

    /// The root of a mean of squares: by its derivative, half the relative error.
    pub fn sqrt(self) -> Self {
        let root = self.mean.max(0.0).sqrt();
        let standard_error = if root > 0.0 {
            0.5 * self.standard_error / root
        } else {
            0.0
        };
        Self {
            mean: root,
            standard_error,
        }
    }

    pub fn over(self, divisor: f64) -> Self {
        Self {
            mean: self.mean / divisor,
            standard_error: self.standard_error / divisor,
        }
    }

    /// How many standard errors it is from zero; NaN if nothing is left to chance.
    pub fn sigmas(self) -> f64 {
        // Samples that are all the same differ by rounding at most.
        if self.standard_error > 1e-12 * self.mean.abs() {
            self.mean / self.standard_error
        } else {
            f64::NAN
        }
    }
}

/// The middle of `samples`; NaN if there are none.
pub fn median(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    match count {
        0 => f64::NAN,
        _ => 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]),
    }
}
