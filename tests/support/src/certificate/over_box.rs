//! The isosurface over a box of parameters and half vectors.

use std::array::from_fn;

use super::NUMBERS;
use super::angles::{Angles, half};
use super::cell::{Box5, Cell};
use super::interval::Interval;
use super::lobe::{Lobe, Point, level};
use super::real::Real;
use super::taylor::{PerVariable, Taylor, VARIABLES};

/// What depends on the parameters alone.
pub struct Parameters {
    of: [Interval; 3],
    lobe: Lobe<Taylor>,
    /// 1 − α².
    flatness: Taylor,
    /// (1 − μ)⁵.
    fifth: Taylor,
    /// (1 − F0)/F(μ).
    steepness: Taylor,
    ellipsoid: [Taylor; NUMBERS],
}

/// What is known of a box.
pub enum Verdict {
    BelowHorizon,
    /// ‖y‖² is at most `most` at Sζ, with an S of no less than s, so that at sζ it is at most that or that of
    /// the light; and what `most` may be too high by is for each variable to blame.
    Level {
        most: f64,
        blame: PerVariable,
    },
}

impl Parameters {
    pub fn new(cell: &Cell, b: &Box5) -> Self {
        let one = Taylor::constant(1.0);
        let angles = Angles::new(b[0], b[1]);
        let alpha = Taylor::variable(b[0], 0).square();
        let (tau, sigma) = angles.taylor(b[0], b[1]);
        let ((c, s), (cd, sd)) = (half(tau), half(sigma));
        // c and αs are the shares cosδ and sinδ of √L.
        let rl = c * cd + alpha * s * sd;
        // In whichever form is none of 0/0.
        let aol = if angles.tau.low > 0.25 {
            sd / s
        } else {
            alpha / rl
        };
        let f0 = Taylor::variable(b[2], 2).square().square();
        let fifth = (one - c).fifth_power();
        let fresnel = f0 + (one - f0) * fifth;
        Self {
            of: [b[0], b[1], b[2]],
            lobe: Lobe {
                alpha,
                c,
                s,
                cd,
                sd,
                rl,
                aol,
            },
            flatness: one - alpha.square(),
            fifth,
            steepness: (one - f0) / fresnel,
            ellipsoid: cell.ellipsoids(b),
        }
    }

    pub fn are_of(&self, b: &Box5) -> bool {
        self.of == [b[0], b[1], b[2]]
    }

    /// ‖y‖² of the light, at most.
    pub fn level_of_light(&self) -> f64 {
        let zero = Taylor::constant(0.0);
        level(zero, [zero; 3], &self.ellipsoid).most()
    }

    /// The surface over a box with these parameters.
    pub fn verdict(&self, b: &Box5) -> Verdict {
        let (cos_phi, sin_phi) = half(Taylor::variable(b[3], 3));
        let (cos_psi, sin_psi) = half(Taylor::variable(b[4], 4));
        let m = [cos_psi * sin_phi, sin_psi, cos_psi * cos_phi];
        let n = self.lobe.alpha.square() + self.flatness * m[2].square();
        let point = self.lobe.point(n, m);
        // As m₃ ≥ 0, below the horizon too where `a` is.
        if point.a.range().high <= 0.0 || point.e.range().high <= 0.0 {
            return Verdict::BelowHorizon;
        }
        let (fresnel, replaced_fresnel) = self.fresnel(&point);
        let (masking, replaced_masking) = self.masking(&point);
        let squared = fresnel * masking;
        let (s, replaced_root) = root(&squared);
        let level = level(s, point.z, &self.ellipsoid);
        let most_squared = squared.range().high;
        let blame = from_fn(|i| {
            // That the squares are at most what they are at the corners.
            let bulge = (-level.quadratic[0][i]).max(0.0);
            let replaced = replaced_masking[i] + replaced_root[i];
            level.rest[i]
                + bulge
                + squared.rest[i] / most_squared
                + replaced_fresnel[i]
                // The bound is mostly reached somewhere in the box.
                + 0.05 * replaced
        });
        Verdict::Level {
            most: level.most(),
            blame,
        }
    }

    /// F/F(μ) = 1 + ((1 − t)⁵ − (1 − μ)⁵) (1 − F0)/F(μ), or its value at t = 0, and in which variables that
    /// replaces it.
    fn fresnel(&self, point: &Point<Taylor>) -> (Taylor, PerVariable) {
        let one = Taylor::constant(1.0);
        let at = |fifth: Taylor| one + (fifth - self.fifth) * self.steepness;
        let fifth = (one - point.t).fifth_power();
        if fifth.is_finite() {
            return (at(fifth), [0.0; VARIABLES]);
        }
        let most = at(one);
        let there = Taylor::constant(1.0 - point.t.constant.clamp(0.0, 1.0)).fifth_power();
        let excess = 1.0 - at(there).constant / most.constant;
        (most, replaced(&point.n).map(|x| excess * x))
    }

    /// No less than G2/G1 wherever it is above the horizon, and in which variables a constant replaces it.
    fn masking(&self, point: &Point<Taylor>) -> (Taylor, PerVariable) {
        let one = Taylor::constant(1.0);
        let Lobe { cd, aol, .. } = self.lobe;
        // G2/G1 = (1 + cosδ)/(1 + cosδ r) falls as r rises, r² = 1 − α² + (α/μ_o)² ≥ 1.
        let of = |r: Taylor| (one + cd) / (one + cd * r);
        let w = aol * point.n;
        let slope = w.range().low.max(0.0) / point.e.range().high;
        let squared = self.flatness.range().low + slope * slope;
        let least = squared.max(0.0).sqrt() * (1.0 - 1e-14);
        // Not so much that the rounding of cosδ counts, at the horizon of grazing light.
        let most = of(Taylor::constant(least.clamp(1.0, 1e4)));
        let smooth = if point.e.constant > 2.0 * w.constant {
            of((self.flatness + (w / point.e).square()).sqrt())
        } else {
            let root = (self.flatness * point.e.square() + w.square()).sqrt();
            (one + cd) * point.e / (point.e + cd * root)
        };
        // Barely finite it is worse than a constant.
        if smooth.is_finite() && smooth.range().high <= 1.1 * most.range().high {
            (smooth, [0.0; VARIABLES])
        } else {
            (most, replaced(&point.e))
        }
    }
}

/// No less than s wherever there is one, and in which variables a constant replaces it.
pub fn root(squared: &Taylor) -> (Taylor, PerVariable) {
    let Interval { low, high } = squared.range();
    if low < -0.25 * high {
        // Else what is below the horizon would be put behind the light, and outside.
        let most = Taylor::constant(high.sqrt() * (1.0 + 1e-14));
        (most, replaced(squared))
    } else {
        let root = squared.above_root(squared.constant.max(0.5 * high));
        (root, [0.0; VARIABLES])
    }
}

/// What `x` varies by with each variable, over the most that it is.
fn replaced(x: &Taylor) -> PerVariable {
    let most = x.range().high;
    from_fn(|i| (x.variation(i) / most).min(1.0))
}
