//! The inequality behind the bound of a transformed cosine, and the least q for which it holds.

use std::f64::consts::FRAC_PI_2;

/// Pays for the rounding of sines, cosines and roots.
const GROWTH: f64 = 1.0 + 1e-12;

/// (√P − α₁P − α₂g)² ≤ q(‖ω‖² − ‖û‖²g² + ν‖û‖²g²) wherever the left root is positive, P = r₃·ω ≥ 0 and g = û·ω
/// for all unit vectors ω; r₃ = (0, 0, 1) and û = (`sine`, 0, `cosine`), which has about unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LtcInequality {
    pub alpha_1: f64,
    pub alpha_2: f64,
    pub sine: f64,
    pub cosine: f64,
    pub nu: f64,
}

impl LtcInequality {
    /// The inequality of these numbers, as a table stores them: α₁, α₂, the sine and the cosine of û, and ν.
    pub fn from_numbers(numbers: [f32; 5]) -> Self {
        let [alpha_1, alpha_2, sine, cosine, nu] = numbers.map(f64::from);
        Self {
            alpha_1,
            alpha_2,
            sine,
            cosine,
            nu,
        }
    }

    /// A q for which it holds, proved in intervals of the angle δ between û and ω, so many of them. More
    /// intervals give a smaller one. α₁ must be positive, α₂ not negative, and ν in (0, 1].
    ///
    /// For fixed δ the angle between r₃ and ω goes from |φ − δ| to φ + δ, and √P − α₁P has one maximum, at
    /// P = 1/(4α₁²). g falls with δ. So each factor is bounded by its value at an end of the interval.
    pub fn proved_q(&self, intervals: u32) -> f64 {
        let Self {
            alpha_1,
            alpha_2,
            sine,
            cosine,
            nu,
        } = *self;
        let (angle, length) = (sine.atan2(cosine), sine.hypot(cosine));
        let peak = 1.0 / (4.0 * alpha_1 * alpha_1);
        let at = |i: u32| {
            let share = f64::from(i) / f64::from(intervals);
            (FRAC_PI_2 + angle) * share * share
        };
        let spread = |delta: f64| delta.sin().powi(2) + nu * delta.cos().powi(2);
        let mut q = 0.0_f64;
        for i in 0..intervals {
            let [near, far] = [at(i), at(i + 1)];
            let least = (angle + far).min(FRAC_PI_2).cos();
            let most = (angle - far).max(near - angle).clamp(0.0, FRAC_PI_2).cos();
            let p = peak.clamp(least.max(0.0), most.max(least).max(0.0));
            let root = p.sqrt() - alpha_1 * p - alpha_2 * length * far.cos() + 1e-14;
            if root > 0.0 {
                // sin² grows up to 90°, and falls beyond.
                let over = spread(near).min(spread(far)) * length.min(1.0).powi(2);
                q = q.max(root * root / over);
            }
        }
        q * GROWTH
    }
}
