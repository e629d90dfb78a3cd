//! Lights against the receivers of a tile: whether any of them may be lit, and how brightly.
//!
//! # The bound
//!
//! A light of flux Φ and lobe v_L at q reaches the eye by way of a receiver at x as the radiance
//! c = Φ v_L(ω) v_R(−ω)/l², with l = ‖x − q‖ and ω from q to x. The receivers of a cluster lie in a ball. So all −ω
//! lie in the cap of the directions from the ball's centre to the light, whose chord is that of the ball as the light
//! sees it, and all ω in the opposite cap. With both majorants and the least distance to the ball,
//! c ≤ Φ v̂_L v̂_R/l_min².
//!
//! # No light is lost
//!
//! Each factor is at least what the receiver computes, and the products are formed in the same order. Rounding is
//! monotone. What remains are distance and quotient, which [`RADIANCE_ROUNDINGS`] pays for.
//!
//! # Blocks
//!
//! The cluster of a block must not reject what a tile of it keeps. In exact arithmetic it does not, since balls, caps
//! and families nest, and since bounds of lobes that are sharper but do not nest serve clusters of receivers alone, not
//! those that were merged. For rounding, each step of merging widens the cap by [`MERGE_CHORD_ROUNDINGS`] and raises the
//! bound by [`MERGE_ROUNDINGS`].

use crate::light::{Roulette, Vpl};
use crate::lobe::{Caps, Lobe, LobeFamily, LobeNumbers, Majorant};
use crate::num::{Real, Single, UNIT_ROUNDOFF, Vector3};
use crate::view::ReceiverCluster;

/// Budget for c/δ, beside those of the two majorants.
const RADIANCE_ROUNDINGS: u16 = 32;
/// What each merge adds to the chord of a cap, in units of u.
const MERGE_CHORD_ROUNDINGS: f32 = 160.0;
/// What each merge adds to the bound.
const MERGE_ROUNDINGS: u16 = 512;

/// A light in each lane, as the bound reads it.
pub(crate) struct LitFrom<'a, N, O> {
    pub position: Vector3<N>,
    pub flux: N,
    pub numbers: &'a LobeNumbers<N>,
    /// The lobe of a lane.
    pub lobe_of: O,
}

impl<F: LobeFamily> ReceiverCluster<F> {
    /// An upper bound of c/δ: of the radiance that any receiver of the cluster reflects to the eye of `light`, in
    /// units of its δ. `least_distance_squared` is that of the estimator.
    ///
    /// Zero if no receiver is lit. Infinite if the light is among the receivers.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Blind, ConstantLobe, ReceiverCluster, Roulette, Vpl, glam::Vec3,
    /// };
    ///
    /// let light = Vpl::new(Vec3::ZERO, 1.0, ConstantLobe)?;
    /// let receivers = [3.0, 5.0].map(|x| (Vec3::new(x, 0.0, 0.0), Blind));
    /// let cluster = ReceiverCluster::of(receivers.into_iter()).expect("there are two");
    /// let bound = cluster.greatest_radiance(&light, &Roulette::new(0.01)?, 0.0);
    /// let at_three = ConstantLobe::PEAK / (0.01 * 9.0);
    /// assert!((1.0..1.0001).contains(&(bound / at_three)));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[must_use]
    pub fn greatest_radiance<L: Lobe>(
        &self,
        light: &Vpl<L>,
        roulette: &Roulette,
        least_distance_squared: f32,
    ) -> f32 {
        self.of_light(light, roulette, least_distance_squared)
            .greatest
    }

    /// An estimate of c/δ: of the radiance that a receiver of the cluster reflects to the eye of `light`, in units of
    /// its δ. At most [`greatest_radiance`](Self::greatest_radiance), and positive where that is, but where it
    /// underflows.
    ///
    /// The sum over all lights, times δ, is about the radiance of a receiver. It depends on no ξ, so a δ may follow
    /// from it: see [`EvenNoise`](crate::EvenNoise).
    #[must_use]
    pub fn typical_radiance<L: Lobe>(
        &self,
        light: &Vpl<L>,
        roulette: &Roulette,
        least_distance_squared: f32,
    ) -> f32 {
        self.of_light(light, roulette, least_distance_squared)
            .typical
    }

    fn of_light<L: Lobe>(
        &self,
        light: &Vpl<L>,
        roulette: &Roulette,
        least_distance_squared: f32,
    ) -> Majorant<f32> {
        let light = LitFrom {
            position: light.position().into(),
            flux: light.flux(),
            numbers: &light.lobe().numbers(),
            lobe_of: |_| Some(light.lobe()),
        };
        self.radiance_over_delta(&light, roulette, least_distance_squared)
    }

    /// The bound of c/δ, and an estimate of it, for the light in each lane.
    #[inline(always)]
    pub(crate) fn radiance_over_delta<'a, N: Single, L: Lobe + 'a>(
        &self,
        light: &LitFrom<N, impl Fn(usize) -> Option<&'a L>>,
        roulette: &Roulette,
        least_distance_squared: f32,
    ) -> Majorant<N> {
        let flux = light.flux;
        let way = light.position - Vector3::splat(flux, self.center().into());
        let margin = f32::from(self.merges()) * (MERGE_CHORD_ROUNDINGS * UNIT_ROUNDOFF);
        let (toward, distance) = Caps::of_balls(way, flux.splat(self.radius()), margin);
        let of_light = L::majorant_in_lanes(
            light.numbers,
            #[inline(always)]
            |lane| (light.lobe_of)(lane),
            &toward.opposite(),
        );
        let of_receivers = self.family().majorant_in_lanes(&toward);
        let delta = roulette.delta() * self.delta_scale();
        // NaN if the squared length is.
        let least = flux.splat(least_distance_squared);
        let roundings = RADIANCE_ROUNDINGS + MERGE_ROUNDINGS * self.merges();
        let sent = flux * of_light.greatest * of_receivers.greatest;
        let greatest = (sent / over_delta(distance * distance, least, delta)).round_up(roundings);
        let typical = flux * of_light.typical * of_receivers.typical
            / over_delta(way.length_squared(), least, delta);
        // Not NaN where the distance is zero, too.
        let zero = flux.zero();
        let [greatest, typical] = N::select_all(sent.is_positive(), [greatest, typical], [zero; 2]);
        Majorant {
            greatest,
            typical: typical.min(greatest),
        }
    }
}

/// δl² for l² of at least `least`. Finite, so that an infinite bound stays infinite.
#[inline(always)]
fn over_delta<N: Single>(squared: N, least: N, delta: f32) -> N {
    (Real::max(squared, least) * delta).min(squared.splat(f32::MAX))
}
