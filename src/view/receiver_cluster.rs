use glam::{Vec3, Vec3A};

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
/// use stochastic_light_culling::{Blind, ReceiverCluster, glam::Vec3};
///
/// let positions = [Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0)];
/// let receivers = positions.iter().map(|position| (*position, Blind));
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

/// What a first pass over receivers or clusters finds.
#[derive(Clone, Copy)]
struct Sum<S> {
    /// The corners of their box.
    min: Vec3A,
    max: Vec3A,
    len: u32,
    families: S,
}

impl<S: Default> Default for Sum<S> {
    fn default() -> Self {
        Self {
            min: Vec3A::MAX,
            max: Vec3A::MIN,
            len: 0,
            families: S::default(),
        }
    }
}

impl<S> Sum<S> {
    /// Adds `len` receivers in the box with these corners.
    #[inline(always)]
    fn add<F: LobeFamily<Sum = S>>(&mut self, [min, max]: [Vec3A; 2], len: u32, family: &F) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
        self.len = self.len.saturating_add(len);
        family.add_to(&mut self.families);
    }

    /// The centre of the box.
    fn center(&self) -> Vec3A {
        self.min.midpoint(self.max)
    }
}

impl<F: LobeFamily> ReceiverCluster<F> {
    /// The cluster of receivers with these positions and lobes. `None` if there are none.
    ///
    /// Receivers with a NaN or infinite coordinate, which accept no light, are left out. The iterator is walked
    /// twice.
    #[must_use]
    pub fn of(receivers: impl Iterator<Item = (Vec3, F)> + Clone) -> Option<Self> {
        let receivers = receivers.map(
            #[inline(always)]
            |(position, family)| (Vec3A::from(position), family),
        );
        let receivers = receivers.filter(|(position, _)| position.is_finite());
        // The iterator runs its own loops, which is faster for rows of pixels. What they change is passed from one to
        // the next by value, so that it stays in registers.
        let sum = receivers.clone().fold(
            Sum::<F::Sum>::default(),
            #[inline(always)]
            |mut sum, (position, family)| {
                sum.add([position; 2], 1, &family);
                sum
            },
        );
        if sum.len == 0 {
            return None;
        }
        let (center, mean) = (sum.center(), F::mean(&sum.families));
        let (squared, reach) = receivers.fold(
            (0.0_f32, F::Reach::default()),
            #[inline(always)]
            |(squared, mut reach), (position, family)| {
                family.widen(&mean, &mut reach);
                let own = center.distance_squared(position);
                (Real::max(own, squared), reach)
            },
        );
        let center = center.into();
        Some(Self {
            center,
            // Infinite where a square overflows.
            radius: enlarged(sqrt(squared), center),
            family: F::around(&mean, &reach),
            delta_scale: 1.0,
            len: sum.len,
            merges: 0,
        })
    }

    /// The cluster that holds all of `clusters`. `None` if there are none.
    ///
    /// Whatever light one of them may be lit by, this one may be lit by.
    #[must_use]
    pub fn union(clusters: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        let mut sum = Sum::<F::Sum>::default();
        let (mut delta_scale, mut merges) = (f32::MAX, 0);
        clusters.clone().for_each(|cluster| {
            let center = Vec3A::from(cluster.center);
            let corners = [center - cluster.radius, center + cluster.radius];
            sum.add(corners, cluster.len, &cluster.family);
            delta_scale = Real::min(cluster.delta_scale, delta_scale);
            merges = merges.max(cluster.merges);
        });
        if sum.len == 0 {
            return None;
        }
        let center = sum.center();
        let center = if center.is_finite() {
            center
        } else {
            Vec3A::ZERO
        };
        let mean = F::mean(&sum.families);
        let (mut radius, mut reach) = (0.0, F::Reach::default());
        clusters.for_each(|cluster| {
            cluster.family.widen(&mean, &mut reach);
            let own = center.distance(cluster.center.into()) + cluster.radius;
            radius = Real::max(own, radius);
        });
        Some(Self {
            center: center.into(),
            radius: enlarged(radius, center.into()),
            family: F::around(&mean, &reach),
            delta_scale,
            len: sum.len,
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
