//! A way to light receivers, from coarse to fine.

use super::score::Measures;
use super::way::{Setting, Way};

/// A way at one setting.
#[derive(Clone, Copy)]
pub struct Step {
    pub setting: Setting,
    pub ms: f64,
    pub measures: Measures,
}

/// The steps of a way, from the coarsest to the finest.
pub struct Curve {
    pub way: Way,
    pub steps: Vec<Step>,
}

/// What a way comes to in a given time.
#[derive(Clone, Copy)]
pub struct AtTime {
    /// The logarithm of the mean squared error over the squared mean radiance, and its standard error.
    pub log_mse: [f64; 2],
    pub sigma: f64,
    pub median: f64,
}

impl Curve {
    /// By interpolation of logarithms between the two settings that take less and more time. None if one of them is not
    /// there.
    pub fn at(&self, ms: f64) -> Option<AtTime> {
        let fast = self.steps.iter().rposition(|step| step.ms <= ms)?;
        let (fast, next) = (&self.steps[fast], self.steps.get(fast + 1));
        // The last setting is there for its own time.
        let slow = next.or((fast.ms >= ms).then_some(fast))?;
        let share = if slow.ms > fast.ms {
            (ms / fast.ms).ln() / (slow.ms / fast.ms).ln()
        } else {
            0.0
        };
        let between = |of: fn(&Measures) -> f64| {
            let [a, b] = [fast, slow].map(|step| of(&step.measures).max(f64::MIN_POSITIVE).ln());
            a + share * (b - a)
        };
        let error = |step: &Step| step.measures.mse.standard_error / step.measures.mse.mean;
        Some(AtTime {
            log_mse: [
                between(|measures| measures.mse.mean),
                error(fast).max(error(slow)),
            ],
            sigma: between(|measures| measures.sigma.mean).exp(),
            median: between(|measures| measures.median.mean).exp(),
        })
    }
}
