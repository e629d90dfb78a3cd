//! Caps of directions, and what bounds a function of a direction within one.
//!
//! # Distances in place of angles
//!
//! A cap holds the unit vectors whose distance from its axis is at most its *chord*. Distances need no
//! trigonometry, and they add: by the triangle inequality, a linear function of a direction changes within a
//! cap by no more than its norm times the chord.
//!
//! So within a cap of axis w and chord c, for fixed unit vectors n and ω_i and h = ω_i + w,
//!
//! - ω·n ≤ w·n + c;
//! - ‖ω − u‖ ≥ ‖w − u‖ − c for any unit vector u, and at least ‖w − u‖√(1 − ¼c²) − ½c‖w + u‖, the chord of the
//!   difference of both angles;
//! - the half vector ω_i + ω lies within c of h. So ‖h‖ − c ≤ ‖ω_i + ω‖ ≤ min(‖h‖ + c, 2). All of them fill an
//!   elliptic cone, whose least angle to n is in closed form (`half_vectors`).
//!
//! Each is an equality for c = 0, so a bound that is made of them becomes the function itself as the cap closes.
//!
//! Where n and ω_i are not fixed, but lie in caps of their own around mean directions, the chords add: ω·n is at
//! most that of the axes and both chords, the half vectors lie within the sum of the chords of ω_i and ω, and a sine
//! is less than that to the mean normal by no more than the chord of the normals.
//!
//! # Rounding
//!
//! All of these quantities are computed with an absolute error of a few u. So the chord is enlarged by
//! [`CHORD_ROUNDINGS`] u, and the sine is rounded down.

use glam::Vec3;

use super::Caps;
use super::cap_union::{CapReach, CapSum};
use crate::base::{Direction, Error, number_in};
use crate::num::{Single, UNIT_ROUNDOFF, Vector3};

/// Budget for dot products, cross products and differences of directions, in units of u.
pub(super) const CHORD_ROUNDINGS: f32 = 80.0;

/// A cap of directions: the unit vectors whose distance from an axis is at most a chord.
///
/// The chord of an angle γ between axis and edge is 2 sin ½γ: nearly γ for narrow caps, √2 for a hemisphere and
/// 2 for all directions.
///
/// ```
/// use stochastic_light_culling::{Cap, Direction, Ggx, GgxLobe, Incidence, Lobe, NoFresnel, glam::Vec3};
///
/// // The directions from a light to a ball of radius 1, ten units away.
/// let cap = Cap::of_sphere(Vec3::ZERO, Vec3::new(0.0, 6.0, 8.0), 1.0);
/// assert!((cap.chord() - 0.1).abs() < 1e-3);
///
/// // The lobe is nowhere greater than this in the cap.
/// let lobe = GgxLobe::new(Ggx::new(0.3)?, NoFresnel, Incidence::head_on(Direction::Z));
/// let most = lobe.maximum_within(&cap);
/// let upward = Vec3::new(0.0, 5.5, 8.4).normalize();
/// assert!(lobe.value(*cap.axis()) < lobe.value(upward) && lobe.value(upward) < most);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    pub(super) axis: Direction,
    pub(super) chord: f32,
}

impl Cap {
    /// Creates the cap around `axis` up to the distance `chord` from it. Zero holds the axis alone.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `chord` is outside \[0, 2\] or NaN.
    pub fn new(axis: Direction, chord: f32) -> Result<Self, Error> {
        let chord = number_in("chord", chord, "in [0, 2]", 0.0..=2.0)?;
        Ok(Self { axis, chord })
    }

    /// The cap that holds `axis` alone.
    pub(super) const fn of_axis(axis: Direction) -> Self {
        Self { axis, chord: 0.0 }
    }

    /// All directions.
    #[must_use]
    pub const fn all() -> Self {
        Self {
            axis: Direction::Z,
            chord: 2.0,
        }
    }

    /// The directions from `apex` to the points of the ball of this `center` and `radius`, rounded outward.
    ///
    /// The chord is 2 tan ½γ, somewhat more than that of the ball's angle γ; see [nesting](#nesting).
    ///
    /// All directions if the ball holds the apex, if a number is NaN, and if the square of the distance is outside
    /// the range of `f32`.
    ///
    /// # Nesting
    ///
    /// If a ball holds another, its chord is at least that of the other and the distance of the two axes together,
    /// but for rounding.
    #[must_use]
    pub fn of_sphere(apex: Vec3, center: Vec3, radius: f32) -> Self {
        let way = center - apex;
        let (cap, _) = Caps::of_balls(way.into(), radius.abs(), 0.0);
        match Direction::new(way) {
            Ok(axis) if cap.chord < 2.0 => Self {
                axis,
                chord: cap.chord,
            },
            _ => Self::all(),
        }
    }

    /// The axis.
    #[must_use]
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// The greatest distance of a direction of the cap from the axis, in \[0, 2\].
    #[must_use]
    pub fn chord(&self) -> f32 {
        self.chord
    }

    /// A cap that holds all of `caps`, around the mean of their axes. `None` if there are none.
    ///
    /// Its chord is the greatest sum of the distance of an axis from the mean, and the chord there. It is rounded up,
    /// unless all axes are the same.
    #[must_use]
    pub fn union(caps: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        caps.clone().next()?;
        let mut sum = CapSum::default();
        for cap in caps.clone() {
            sum.add(&cap);
        }
        let (mean, mut reach) = (sum.mean(), CapReach::default());
        for cap in caps {
            mean.widen(&cap, &mut reach);
        }
        Some(mean.cap(&reach))
    }

    /// The cap in as many lanes as `like` has, not enlarged.
    #[inline(always)]
    pub(super) fn splat<N: Single>(&self, like: N) -> Caps<N> {
        Caps {
            axis: Vector3::splat(like, self.axis.into()),
            chord: like.splat(self.chord),
            must_nest: true,
        }
    }

    /// The cap as a single lane, enlarged for rounding, for bounds that need not nest.
    pub(super) fn lanes(&self) -> Caps<f32> {
        Caps {
            axis: self.axis.into(),
            chord: self.chord + CHORD_ROUNDINGS * UNIT_ROUNDOFF,
            must_nest: false,
        }
    }
}
