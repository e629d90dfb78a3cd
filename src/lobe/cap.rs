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
//! - ‖ω − u‖ ≥ ‖w − u‖ − c for any u;
//! - the half vector ω_i + ω lies within c of h. So ‖h‖ − c ≤ ‖ω_i + ω‖ ≤ min(‖h‖ + c, 2), and the sine of
//!   its angle to n is ‖(ω_i + ω) × n‖/‖ω_i + ω‖ ≥ (‖h × n‖ − c)/min(‖h‖ + c, 2).
//!
//! Each is an equality for c = 0, so a bound that is made of them becomes the function itself as the cap closes.
//!
//! Where n and ω_i are not fixed, but lie in caps of their own around mean directions, the chords add: ω·n is at
//! most that of the axes and both chords, the half vectors lie within the sum of the chords of ω_i and ω, and a sine
//! is less than that to the mean normal by no more than the chord of the normals.
//!
//! # The cap of a ball
//!
//! The directions from a point to a ball at distance l, of radius ρ, are those within the angle γ of its centre,
//! sinγ = ρ/l. Their chord is 2 sin ½γ. The cap has the greater 2 tan ½γ = 2ρ/(l + √(l² − ρ²)), because it nests:
//! let the ball hold another, of angle γ′, and let θ be the angle between both centres. Then θ + γ′ ≤ γ, and since
//! tan is superadditive, 2 tan ½γ ≥ 2 tan ½θ + 2 tan ½γ′, which is at least the distance 2 sin ½θ of the axes and
//! the chord of the other together. With sines in place of tangents that is false.
//!
//! # Rounding
//!
//! All of these quantities are computed with an absolute error of a few u. So the chord is enlarged by
//! [`CHORD_ROUNDINGS`] u, and the quotient of the sine is rounded down.

use glam::Vec3;

use super::Majorant;
use super::half_vectors::HalfVectors;
use crate::base::{Direction, Error, number_in};
use crate::num::{Real, Single, UNIT_ROUNDOFF, Vector3, round_down};

/// Budget for dot products, cross products and differences of directions, in units of u.
const CHORD_ROUNDINGS: f32 = 80.0;
/// Budget for the distance of a ball.
const DISTANCE_ROUNDINGS: u16 = 4;
/// Budget for the chord of a ball, beside that of its distance.
const BALL_ROUNDINGS: u16 = 6;
/// Budget for the distance of two axes, in units of u.
const UNION_ROUNDINGS: f32 = 20.0;

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
    axis: Direction,
    chord: f32,
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
        let mut sum = CapSum::of(&caps.clone().next()?);
        for cap in caps.clone().skip(1) {
            sum.add(&cap);
        }
        let mut union = sum.mean();
        for cap in caps {
            union.widen(&cap);
        }
        Some(union)
    }

    /// Widens the cap until it holds `other`.
    #[inline(always)]
    pub(super) fn widen(&mut self, other: &Self) {
        let apart = Vector3::from(*other.axis - *self.axis).length();
        let rounding = if apart > 0.0 {
            UNION_ROUNDINGS * UNIT_ROUNDOFF
        } else {
            0.0
        };
        let chord = Real::min(apart + other.chord + rounding, 2.0);
        self.chord = Real::max(chord, self.chord);
    }

    /// The cap in as many lanes as `like` has, not enlarged.
    #[inline(always)]
    pub(super) fn splat<N: Single>(&self, like: N) -> Caps<N> {
        Caps {
            axis: Vector3::splat(like, self.axis.into()),
            chord: like.splat(self.chord),
        }
    }

    /// The cap as a single lane, enlarged for rounding.
    pub(super) fn lanes(&self) -> Caps<f32> {
        Caps {
            axis: self.axis.into(),
            chord: self.chord + CHORD_ROUNDINGS * UNIT_ROUNDOFF,
        }
    }
}

/// The sum of the axes of caps, around which their union is.
#[derive(Clone, Copy, Debug)]
pub struct CapSum {
    first: Direction,
    sum: Vec3,
    is_one_axis: bool,
}

impl CapSum {
    /// That of one cap.
    #[inline(always)]
    pub fn of(cap: &Cap) -> Self {
        Self {
            first: cap.axis,
            sum: *cap.axis,
            is_one_axis: true,
        }
    }

    #[inline(always)]
    pub fn add(&mut self, cap: &Cap) {
        self.sum += *cap.axis;
        self.is_one_axis &= cap.axis == self.first;
    }

    /// The mean axis alone, before the cap is [widened](Cap::widen).
    pub fn mean(&self) -> Cap {
        let axis = if self.is_one_axis {
            self.first
        } else {
            // Any axis holds all of them.
            Direction::new(self.sum).unwrap_or(self.first)
        };
        Cap { axis, chord: 0.0 }
    }
}

/// A [`Cap`] in each lane.
///
/// Bounds take the directions towards which they hold in a cap that is [enlarged](Cap::lanes) for rounding. Caps of
/// normals and of incoming directions are not.
#[derive(Clone, Copy, Debug)]
pub struct Caps<N> {
    /// A unit vector, or zero for all directions.
    pub(super) axis: Vector3<N>,
    /// At most 2, but for rounding.
    pub(super) chord: N,
}

impl<N: Single> Caps<N> {
    /// The directions along `way` to the points of balls of these radii, with a chord that is greater by `margin` than
    /// rounding asks for. Then a lower bound of the distance to a point of the ball.
    ///
    /// All directions, and zero, if `way` ends in the ball, and if its square is outside the range of `f32`.
    #[inline(always)]
    pub(crate) fn of_balls(way: Vector3<N>, radius: N, margin: f32) -> (Self, N) {
        let squared = way.length_squared();
        let zero = squared.zero();
        let length = squared.sqrt();
        let distance = length * round_down(1.0, DISTANCE_ROUNDINGS);
        let radius = radius.round_up(DISTANCE_ROUNDINGS);
        let gap = distance - radius;
        // False for NaN. The square neither overflows nor loses digits.
        let is_outside = gap.is_positive()
            & zero.splat(f32::MIN_POSITIVE).le(squared)
            & squared.le(zero.splat(f32::MAX));
        // 2 tan ½γ
        let tangent = (gap * (distance + radius)).sqrt();
        let chord = (radius * 2.0 / (distance + tangent)).round_up(BALL_ROUNDINGS);
        let chord = (chord + CHORD_ROUNDINGS * UNIT_ROUNDOFF + margin).min(zero.splat(2.0));
        let inverse = zero.splat(1.0) / length;
        let axis = way * inverse;
        let [x, y, z, chord, gap] = N::select_all(
            is_outside,
            [axis.x, axis.y, axis.z, chord, gap],
            [zero, zero, zero, zero.splat(2.0), zero],
        );
        let axis = Vector3::new(x, y, z);
        (Self { axis, chord }, gap)
    }

    /// The caps that hold `axis` alone, a unit vector.
    #[inline(always)]
    pub fn around(axis: Vector3<N>) -> Self {
        let chord = axis.x.zero();
        Self { axis, chord }
    }

    /// `value` in each lane.
    #[inline(always)]
    pub(crate) fn splat(&self, value: f32) -> N {
        self.chord.splat(value)
    }

    /// The opposite directions.
    #[inline(always)]
    pub(crate) fn opposite(&self) -> Self {
        Self {
            axis: -self.axis,
            chord: self.chord,
        }
    }

    /// Applies `function` to the cap of each lane.
    #[inline(always)]
    pub(crate) fn per_lane(&self, mut function: impl FnMut(usize, &Cap) -> f32) -> N {
        let Vector3 { x, y, z } = self.axis;
        N::per_lane(
            [x, y, z, self.chord],
            #[inline(always)]
            |i, [x, y, z, chord]| {
                let cap = match Direction::new(Vec3::new(x, y, z)) {
                    Ok(axis) => Cap { axis, chord },
                    Err(_) => Cap::all(),
                };
                function(i, &cap)
            },
        )
    }

    /// The greatest ω·n for n in `normals`, at most 1. Not positive if all of the cap is below every horizon.
    #[inline(always)]
    pub fn greatest_cosine(&self, normals: &Self) -> N {
        self.cosine(normals).greatest
    }

    /// The greatest ω·n for n in `normals`, and a typical max(ω·n, 0): ½(x + √(x² + c²)) for the cosine x of the
    /// axes and the sum c of the chords.
    #[inline(always)]
    pub fn cosine(&self, normals: &Self) -> Majorant<N> {
        let cosine = normals.axis.dot(self.axis);
        let spread = self.spread(normals);
        let greatest = (cosine + spread).min(spread.splat(1.0));
        let both = (cosine * cosine + spread * spread).sqrt();
        Majorant {
            greatest,
            typical: ((cosine + both) * 0.5).min(greatest),
        }
    }

    /// The least ω·n, not negative: zero if some of the cap is below the horizon.
    #[inline(always)]
    pub fn least_cosine(&self, normal: Vector3<N>) -> N {
        (normal.dot(self.axis) - self.chord).max(self.chord.zero())
    }

    /// The least |ω·a| for a unit vector `axis` = a.
    #[inline(always)]
    pub fn least_magnitude(&self, axis: Vector3<N>) -> N {
        (axis.dot(self.axis).abs() - self.chord).max(self.chord.zero())
    }

    /// The least distance ‖ω − u‖ for u in `axes`, and that of both axes.
    #[inline(always)]
    pub fn distances(&self, axes: &Self) -> [N; 2] {
        let middle = (self.axis - axes.axis).length();
        let least = Real::max(middle - self.spread(axes), middle.zero());
        [least, middle]
    }

    /// The sum of both chords.
    #[inline(always)]
    pub fn spread(&self, other: &Self) -> N {
        self.chord + other.chord
    }

    /// The half vectors ω_i + ω for ω_i in `incoming`.
    #[inline(always)]
    pub fn half_vectors(&self, incoming: &Self) -> HalfVectors<N> {
        HalfVectors::within(incoming.axis + self.axis, self.chord + incoming.chord)
    }
}
