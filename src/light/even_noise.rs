use crate::base::{Error, number_in};
use crate::num::Real;

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
    /// Scales are in \[1/64, 64\], unless [another range](Self::with_range) is set.
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
