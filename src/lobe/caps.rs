//! Caps of directions in lanes: one for each light of a vector.
//!
//! # The cap of a ball
//!
//! The directions from a point to a ball at distance l, of radius ρ, are those within the angle γ of its centre,
//! sinγ = ρ/l. Their chord is 2 sin ½γ. The cap has the greater 2 tan ½γ = 2ρ/(l + √(l² − ρ²)), because it nests:
//! let the ball hold another, of angle γ′, and let θ be the angle between both centres. Then θ + γ′ ≤ γ, and since
//! tan is superadditive, 2 tan ½γ ≥ 2 tan ½θ + 2 tan ½γ′, which is at least the distance 2 sin ½θ of the axes and
//! the chord of the other together. With sines in place of tangents that is false.

use glam::Vec3;

use super::cap::CHORD_ROUNDINGS;
use super::half_vectors::HalfVectors;
use super::{Cap, Majorant};
use crate::base::Direction;
use crate::num::{Real, Single, UNIT_ROUNDOFF, Vector3, round_down};

/// Budget for the distance of a ball.
const DISTANCE_ROUNDINGS: u16 = 4;
/// Budget for the chord of a ball, beside that of its distance.
const BALL_ROUNDINGS: u16 = 6;
/// Budget for the chord of a difference of two angles, in units of u.
const DIFFERENCE_ROUNDINGS: f32 = 40.0;
/// √2, the distance of directions at a right angle: below, that of a difference of angles falls by at least 1/√2 of what
/// a chord grows by.
const STEEP_DISTANCE: f32 = core::f32::consts::SQRT_2;

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
    /// Whether bounds within these caps must be no greater than within caps that hold them. Some bounds are sharper
    /// without.
    pub(super) must_nest: bool,
}

impl<N: Single> Caps<N> {
    /// The directions along `way` to the points of balls of these radii, with a chord that is greater by `margin` than
    /// rounding asks for. Then a lower bound of the distance to a point of the ball. With a margin bounds must nest.
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
        let must_nest = margin > 0.0;
        let caps = Self {
            axis,
            chord,
            must_nest,
        };
        (caps, gap)
    }

    /// The caps that hold `axis` alone, a unit vector.
    #[inline(always)]
    pub fn around(axis: Vector3<N>) -> Self {
        let chord = axis.x.zero();
        Self {
            axis,
            chord,
            must_nest: true,
        }
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
            ..*self
        }
    }

    /// Applies `function` to the cap of each lane.
    #[inline(always)]
    pub(crate) fn per_lane(&self, mut function: impl FnMut(usize, &Caps<f32>) -> f32) -> N {
        let Vector3 { x, y, z } = self.axis;
        let must_nest = self.must_nest;
        N::per_lane(
            [x, y, z, self.chord],
            #[inline(always)]
            |i, [x, y, z, chord]| {
                let caps = Caps {
                    axis: Vector3::new(x, y, z),
                    chord,
                    must_nest,
                };
                function(i, &caps)
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

    /// The least distance ‖ω − u‖ for u in `axes`, and that of both axes.
    ///
    /// That of the difference of both angles, up to [`STEEP_DISTANCE`]. Beyond, where chords hardly matter to it, rounding
    /// could make it greater in a greater cap, and the triangle inequality is enough.
    #[inline(always)]
    pub fn distances(&self, axes: &Self) -> [N; 2] {
        let middle = (self.axis - axes.axis).length();
        let spread = self.spread(axes);
        let cosine = (self.axis + axes.axis).length() * 0.5;
        let of_spread = half_angle_cosine(spread);
        let of_difference = middle * of_spread - spread * cosine;
        let of_difference = of_difference - DIFFERENCE_ROUNDINGS * UNIT_ROUNDOFF;
        let least = Real::max(middle - spread, middle.zero());
        let least = of_difference.min(spread.splat(STEEP_DISTANCE)).max(least);
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
        HalfVectors::of(incoming, self)
    }
}

impl Caps<f32> {
    /// The cap of the only lane.
    pub fn cap(&self) -> Cap {
        let Vector3 { x, y, z } = self.axis;
        match Direction::new(Vec3::new(x, y, z)) {
            Ok(axis) => Cap {
                axis,
                chord: self.chord,
            },
            Err(_) => Cap::all(),
        }
    }
}

/// cos ½γ for the angle γ of a chord, or zero for chords above 2.
#[inline(always)]
pub(super) fn half_angle_cosine<N: Single>(chord: N) -> N {
    let sine = (chord * 0.5).min(chord.splat(1.0));
    (sine.one_minus() * (sine + 1.0)).sqrt()
}
