//! A cap around others, in two passes over them: the mean of their axes, and how far they reach from it.
//!
//! Both passes run for each pixel of a frame. So three components are one vector, and of caps that hold their axes
//! alone the greatest squared distance is kept, whose root is taken once.

use glam::Vec3A;

use super::Cap;
use crate::base::Direction;
use crate::num::{Real, UNIT_ROUNDOFF, sqrt};

/// Budget for the distance of two axes, in units of u.
const UNION_ROUNDINGS: f32 = 20.0;
/// How far a mean is from equal axes at most, beside the rounding of their sum, in units of u.
const MEAN_ROUNDINGS: f32 = 4.0;
/// Squared length of a sum that is taken to be nothing but rounding.
const LEAST_SQUARED_SUM: f32 = 1e-12;

/// The sum of the axes of caps.
#[derive(Clone, Copy, Debug)]
pub struct CapSum {
    sum: Vec3A,
    /// The axis of the last one.
    last: Vec3A,
}

impl Default for CapSum {
    /// That of no caps, whose mean is any axis.
    fn default() -> Self {
        Self {
            sum: Vec3A::ZERO,
            last: Vec3A::Z,
        }
    }
}

impl CapSum {
    #[inline(always)]
    pub fn add(&mut self, cap: &Cap) {
        self.last = Vec3A::from(*cap.axis);
        self.sum += self.last;
    }

    /// The mean axis. The last one takes its place where rounding of the sum may be all that is between them, so that
    /// a cap around equal axes has no chord; and where there is no mean, since any axis will do.
    #[inline]
    pub fn mean(&self) -> CapMean {
        let squared = self.sum.length_squared();
        if squared < LEAST_SQUARED_SUM {
            return CapMean(self.last);
        }
        // About the number of axes, if all are the same.
        let length = sqrt(squared);
        let mean = self.sum / length;
        let rounding = (length + MEAN_ROUNDINGS) * UNIT_ROUNDOFF;
        if mean.distance_squared(self.last) <= rounding * rounding {
            CapMean(self.last)
        } else {
            CapMean(mean)
        }
    }
}

/// The mean axis of caps, a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct CapMean(Vec3A);

/// How far caps reach from a mean axis.
#[derive(Clone, Copy, Debug, Default)]
pub struct CapReach {
    /// The greatest squared distance of those that hold their axis alone.
    squared: f32,
    /// The chord that all others need.
    chord: f32,
}

impl CapMean {
    /// Extends `reach` until it holds `cap`.
    #[inline(always)]
    pub fn widen(&self, cap: &Cap, reach: &mut CapReach) {
        let squared = (Vec3A::from(*cap.axis) - self.0).length_squared();
        if cap.chord > 0.0 {
            reach.chord = Real::max(union_chord(squared, cap.chord), reach.chord);
        } else {
            reach.squared = Real::max(squared, reach.squared);
        }
    }

    /// The cap that reaches so far.
    #[inline]
    pub fn cap(&self, reach: &CapReach) -> Cap {
        Cap {
            axis: Direction::from_unit(self.0.into()),
            chord: Real::max(union_chord(reach.squared, 0.0), reach.chord),
        }
    }
}

/// The chord of a cap that holds one of this `chord` whose axis is so far away.
#[inline]
fn union_chord(squared_distance: f32, chord: f32) -> f32 {
    let apart = sqrt(squared_distance);
    let rounding = if apart > 0.0 {
        UNION_ROUNDINGS * UNIT_ROUNDOFF
    } else {
        0.0
    };
    Real::min(apart + chord + rounding, 2.0)
}
