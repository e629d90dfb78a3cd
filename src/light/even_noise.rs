use core::cmp::Ordering;

use crate::base::{Error, number_in};
use crate::num::Real;

/// The least scale that [`EvenNoise::of_tiles`] gives: twelve stops below the mean, which is black beside it.
const LEAST_OF_TILES: f32 = 1.0 / 4096.0;

/// The scale of δ of a tile that makes noise even to the eye: δ in proportion to the brightness of the tile.
///
/// A light of radiance c that is accepted with the probability min(c/δ, 1) has the variance c(δ − c), or none if it
/// is brighter than δ. So the variance of a pixel of radiance L is at most δL, and its *relative* deviation at most
/// √(δ/L), while it accepts at most L/δ lights that are left to chance. With one δ for all, dark tiles are noisy and
/// bright ones take most of the work. With δ·L/L₀, where L₀ is a typical radiance, both are what they would be at L₀,
/// everywhere.
///
/// The scale is for [`ReceiverCluster::with_delta_scale`](crate::ReceiverCluster::with_delta_scale). Where p is that of
/// [`Blind`](crate::Blind), L is still what receivers reflect: measured, that is no worse than what arrives.
///
/// # Unbiased or not
///
/// The mean is exact for any δ of a tile that does not depend on the frame's own ξ. So the radiance that is given
/// here may be of any quality, but not of any origin:
///
/// | a tile's radiance from | |
/// |---|---|
/// | positions, fluxes and lobes alone: [`typical_radiance`](crate::ReceiverCluster::typical_radiance) of some lights, chosen without the frame's ξ | exact |
/// | roulette with another [`Seed`](crate::Seed), in this frame or in any | exact |
/// | the frame before, with [`hashed_xi`](crate::FrameSeed::hashed_xi), which is independent from frame to frame | exact |
/// | the frame before, with [`xi`](crate::FrameSeed::xi) or [`xi_of_rank`](crate::FrameSeed::xi_of_rank), which step from frame to frame | biased |
/// | the mean of many frames with such ξ | biased the less the more frames there are |
///
/// ```
/// use stochastic_light_culling::EvenNoise;
///
/// // In a picture of typically 0.2 W/(m²·sr).
/// let even = EvenNoise::new(0.2)?;
/// assert_eq!(even.delta_scale(0.2), 1.0);
/// assert_eq!(even.delta_scale(0.4), 2.0);
/// // However dark, and if nothing is known.
/// assert_eq!(even.delta_scale(0.0), 1.0 / 64.0);
/// assert_eq!(even.delta_scale(f32::NAN), 1.0);
///
/// // By the tiles of a frame before, one of which has shown nothing.
/// let shown = [0.02, 3.9, 0.04, 0.03, f32::NAN, 0.01];
/// let even = EvenNoise::of_tiles(&mut shown.clone())?;
/// // Their mean is 0.8, and half of them show 0.03 or less.
/// assert!((even.delta_scale(0.04) - 0.05).abs() < 1e-6);
/// assert_eq!(even.delta_scale(0.01), even.delta_scale(0.03));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenNoise {
    typical: f32,
    least: f32,
    most: f32,
}

impl EvenNoise {
    /// Scales δ by the radiance of a tile over `typical` = L₀, the radiance at which δ is that of the frame. The mean
    /// of a picture does, if it is one of frames long ago, or of another seed; where most of it is dark, the radiance of
    /// its median tile.
    ///
    /// Scales are in \[1/64, 64\], unless [another range](Self::with_range) is set. [`of_tiles`](Self::of_tiles) finds L₀
    /// and the least scale.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `typical` is zero, negative, infinite or NaN.
    pub fn new(typical: f32) -> Result<Self, Error> {
        let valid = f32::MIN_POSITIVE..=f32::MAX;
        Ok(Self {
            typical: number_in("typical radiance", typical, "in (0, ∞), and normal", valid)?,
            least: 1.0 / 64.0,
            most: 64.0,
        })
    }

    /// Scales δ by the radiance of a tile over the mean of these `radiances`, one of each tile, down to the scale of the
    /// median tile: all that are darker have that one, too.
    ///
    /// δ in proportion to L gives a dark tile as many lights as a bright one, or far more, where little of what arrives
    /// is reflected to the eye. So there has to be a least scale. By that of the median tile, noise is even in the brighter
    /// half of the picture, and in the other half the relative deviation grows as 1/√L. No fixed one fits all materials:
    /// the median of diffuse surfaces may be a thirtieth of the mean, and that of mirrors a thousandth.
    ///
    /// Tiles of no radiance, or less, or NaN have shown nothing, and are left out. Of an even number the median is the
    /// brighter one in the middle. Tiles count alike: give those of about as many pixels, or some of them as often as they
    /// have these. The least scale is in \[1/4096, 1\], and the greatest is 64. The slice is left in another order.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if the mean is infinite or subnormal, or if no tile has shown anything.
    pub fn of_tiles(radiances: &mut [f32]) -> Result<Self, Error> {
        let (mut sum, mut count) = (0.0_f64, 0_usize);
        for radiance in radiances.iter().filter(|radiance| **radiance > 0.0) {
            sum += f64::from(*radiance);
            count += 1;
        }
        let even = Self::new((sum / count.max(1) as f64) as f32)?;
        // There is one, or the mean would be zero.
        let (_, median, _) = radiances.select_nth_unstable_by(count / 2, dark_first);
        let least = Real::max(*median / even.typical, LEAST_OF_TILES);
        even.with_range(Real::min(least, 1.0), even.most)
    }

    /// Returns this with scales of at least `least` and at most `most`. The least one limits the work in the dark: a
    /// tile of radiance L accepts up to L/δ lights that are left to chance.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `least` is outside \[10⁻¹⁸, 1\], `most` outside \[1, 10¹⁸\], or one is NaN.
    pub fn with_range(self, least: f32, most: f32) -> Result<Self, Error> {
        Ok(Self {
            least: number_in("least scale of δ", least, "in [10⁻¹⁸, 1]", 1e-18..=1.0)?,
            most: number_in("greatest scale of δ", most, "in [1, 10¹⁸]", 1.0..=1e18)?,
            ..self
        })
    }

    /// The radiance L₀ at which the scale is 1.
    #[must_use]
    pub fn typical(&self) -> f32 {
        self.typical
    }

    /// The least and the greatest scale.
    #[must_use]
    pub fn range(&self) -> [f32; 2] {
        [self.least, self.most]
    }

    /// The scale of δ for a tile of this `radiance`, in the range.
    ///
    /// The least one for zero and for negative numbers, the greatest for infinity, and 1 for NaN.
    ///
    /// Of a tile that has shown nothing in many frames, as one that faces away from the lights, give NaN: with the least
    /// scale it would have the longest lists of all, for nothing.
    #[must_use]
    pub fn delta_scale(&self, radiance: f32) -> f32 {
        if radiance.is_nan() {
            return 1.0;
        }
        let scale = radiance / self.typical;
        Real::min(Real::max(scale, self.least), self.most)
    }
}

/// The order by radiance, with tiles that have shown nothing last.
fn dark_first(a: &f32, b: &f32) -> Ordering {
    let place = |radiance: f32| {
        if radiance > 0.0 { radiance } else { f32::NAN }
    };
    place(*a).total_cmp(&place(*b))
}
