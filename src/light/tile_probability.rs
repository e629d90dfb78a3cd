use crate::base::{Error, number_in};
use crate::num::{Real, Single};

/// The probability p_T with which a light is drawn for all receivers of a tile at once.
///
/// A light that is drawn counts c/p_T at each of them, where c is the radiance that reaches the eye. The mean is c for
/// any p_T that is positive where c is. So what is chosen here changes the noise, and how many lights are drawn.
///
/// ```
/// use stochastic_light_culling::TileProbability;
///
/// let most = TileProbability::root_mean_square(6.0)?;
/// assert!(TileProbability::root_mean_square(0.5).is_err());
/// assert_eq!(TileProbability::default(), TileProbability::root_mean_square(8.0)?);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileProbability {
    /// κ, at least 1. For 1 the probability is that of the bound.
    most: f32,
}

impl TileProbability {
    /// p_T = min(1, ĉ/δ) for the upper bound ĉ of c over the tile: no estimate exceeds max(c, δ).
    #[must_use]
    pub const fn bound() -> Self {
        Self { most: 1.0 }
    }

    /// p_T = min(1, max(c_rms, ĉ/κ)/δ) for the upper bound ĉ of c, an estimate c_rms of its root mean square over the
    /// tile, and `most` = κ: no estimate exceeds max(c, κδ). Fewer lights are drawn than by the bound.
    ///
    /// At receivers of radiance c the variance is the mean of c²(1/p_T − 1). For a given number of lights it is least
    /// where p_T is in proportion to the root of the mean of c².
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `most` is outside \[1, 10⁶\] or NaN.
    pub fn root_mean_square(most: f32) -> Result<Self, Error> {
        let most = number_in("greatest estimate κ", most, "in [1, 10⁶]", 1.0..=1e6)?;
        Ok(Self { most })
    }

    /// p_T for the upper bound `greatest` = ĉ/δ and the mean square `mean_square` = c_rms²/δ² ≤ ĉ²/δ².
    ///
    /// Zero if ĉ is zero or NaN, else positive. 1 for infinite ĉ.
    ///
    /// ```
    /// use stochastic_light_culling::TileProbability;
    ///
    /// assert_eq!(TileProbability::bound().probability(0.5, 0.01), 0.5);
    /// assert_eq!(TileProbability::default().probability(0.5, 0.0625), 0.25);
    /// assert_eq!(TileProbability::default().probability(0.5, 0.0), 0.0625);
    /// ```
    #[must_use]
    pub fn probability(self, greatest: f32, mean_square: f32) -> f32 {
        self.in_lanes(greatest, mean_square)
    }

    /// p_T in each lane.
    #[inline(always)]
    pub(crate) fn in_lanes<N: Single>(self, greatest: N, mean_square: N) -> N {
        // The first is NaN where an infinite bound meets a mean of zero.
        let probability = Real::max(mean_square.sqrt(), greatest * (1.0 / self.most));
        // The weight of a lesser one would be infinite.
        let least = greatest.splat(f32::MIN_POSITIVE);
        let probability = Real::max(probability, least).min(greatest.splat(1.0));
        N::select(greatest.is_positive(), probability, greatest.zero())
    }
}

/// The root mean square with κ = 8.
impl Default for TileProbability {
    fn default() -> Self {
        Self { most: 8.0 }
    }
}
