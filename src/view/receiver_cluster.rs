use glam::Vec3;

use crate::base::{Error, number_in};
use crate::lobe::LobeFamily;
use crate::num::{Real, UNIT_ROUNDOFF, round_up, sqrt};

/// Budget for the radius of a ball, beside that of its centre.
const RADIUS_ROUNDINGS: u16 = 8;
/// Budget for the centre of a ball, in units of u times the greatest coordinate.
const CENTER_ROUNDINGS: f32 = 4.0;

/// What is known of the receivers of a tile, or of a block of tiles: a ball that holds their positions, and the
/// [family](LobeFamily) of their lobes.
///
/// ```
/// use stochastic_light_culling::{ConstantLobe, ReceiverCluster, ReceiverLobe, glam::Vec3};
///
/// let positions = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0)];
/// let receivers = positions.iter().map(|position| (*position, ConstantLobe.family()));
/// let cluster = ReceiverCluster::of(receivers).expect("there are two");
/// assert_eq!(cluster.center(), Vec3::X);
/// assert!((1.0..1.00001).contains(&cluster.radius()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverCluster<F> {
    center: Vec3,
    radius: f32,
    family: F,
    /// δ of these receivers over that of the frame.
    delta_scale: f32,
    len: u32,
    /// How often clusters have been merged to this one.
    merges: u16,
}

impl<F: LobeFamily> ReceiverCluster<F> {
    /// The cluster of receivers with these positions and lobes. `None` if there are none.
    ///
    /// Receivers with a NaN or infinite coordinate, which accept no light, are left out. The iterator is walked
    /// twice.
    #[must_use]
    pub fn of(receivers: impl Iterator<Item = (Vec3, F)> + Clone) -> Option<Self> {
        let receivers = receivers.filter(|(position, _)| position.is_finite());
        let (first, family) = receivers.clone().next()?;
        let (mut min, mut max, mut len) = (first, first, 1_u32);
        let mut sum = family.to_sum();
        // The iterator runs its own loops, which is faster for rows of pixels.
        receivers.clone().skip(1).for_each(
            #[inline(always)]
            |(position, family)| {
                (min, max) = (min.min(position), max.max(position));
                family.add_to(&mut sum);
                len = len.saturating_add(1);
            },
        );
        let center = min.midpoint(max);
        let mut family = F::mean(&sum);
        let mut squared = 0.0_f32;
        receivers.for_each(
            #[inline(always)]
            |(position, member)| {
                squared = Real::max(center.distance_squared(position), squared);
                family.widen(&member);
            },
        );
        Some(Self {
            center,
            // Infinite where a square overflows.
            radius: enlarged(sqrt(squared), center),
            family,
            delta_scale: 1.0,
            len,
            merges: 0,
        })
    }

    /// The cluster that holds all of `clusters`. `None` if there are none.
    ///
    /// Whatever light one of them may be lit by, this one may be lit by.
    #[must_use]
    pub fn union(clusters: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        let family = F::union(clusters.clone().map(|cluster| cluster.family))?;
        let (mut min, mut max) = (Vec3::MAX, Vec3::MIN);
        let (mut delta_scale, mut len, mut merges) = (f32::MAX, 0_u32, 0);
        for cluster in clusters.clone() {
            min = min.min(cluster.center - cluster.radius);
            max = max.max(cluster.center + cluster.radius);
            delta_scale = delta_scale.min(cluster.delta_scale);
            len = len.saturating_add(cluster.len);
            merges = merges.max(cluster.merges);
        }
        let center = min.midpoint(max);
        let center = if center.is_finite() {
            center
        } else {
            Vec3::ZERO
        };
        let radii = clusters.map(|cluster| center.distance(cluster.center) + cluster.radius);
        let radius = radii.fold(0.0, f32::max);
        Some(Self {
            center,
            radius: enlarged(radius, center),
            family,
            delta_scale,
            len,
            merges: merges + 1,
        })
    }

    /// Returns this cluster with a δ of its own, that of the frame times `scale`.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `scale` is outside \[10⁻¹⁸, 10¹⁸\] or NaN.
    pub fn with_delta_scale(self, scale: f32) -> Result<Self, Error> {
        let valid = 1e-18..=1e18;
        let delta_scale = number_in("scale of δ", scale, "in [10⁻¹⁸, 10¹⁸]", valid)?;
        Ok(Self {
            delta_scale,
            ..self
        })
    }

    /// The centre of the ball of positions, in world space.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The radius of the ball, rounded up. Infinite if the ball is too large for a square in `f32`.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The family of the lobes.
    #[must_use]
    pub fn family(&self) -> &F {
        &self.family
    }

    /// δ of these receivers over that of the frame: 1 unless [set](Self::with_delta_scale), and the least of all
    /// clusters that were merged.
    #[must_use]
    pub fn delta_scale(&self) -> f32 {
        self.delta_scale
    }

    /// The number of receivers, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "it is never empty")]
    #[must_use]
    pub fn len(&self) -> u32 {
        self.len
    }

    /// How often clusters have been merged to this one: the number of steps in the longest chain.
    pub(crate) fn merges(&self) -> u16 {
        self.merges
    }
}

/// Pays for the rounding of a radius, and of positions that it was measured from.
fn enlarged(radius: f32, center: Vec3) -> f32 {
    let of_center = center.abs().max_element() * (CENTER_ROUNDINGS * UNIT_ROUNDOFF);
    round_up(radius + of_center, RADIUS_ROUNDINGS)
}
