use crate::base::{Error, number_in};
use crate::num::power;

/// An interval of depths that holds the surfaces in a tile. Both ends are included.
///
/// Depths are those of [`Camera::depth`](crate::Camera::depth), in the unit of the scene: distances along the
/// viewing direction for a perspective. The functions that take
/// depths of a depth buffer ignore sky, which is a depth that is NaN, infinite, zero or negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthInterval {
    near: f32,
    far: f32,
}

impl DepthInterval {
    /// Creates the interval from `near` to `far`. Equal ends are valid: a wall that faces the camera.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `near` is negative, infinite or NaN, or `far` is less than `near`,
    /// infinite or NaN.
    pub fn new(near: f32, far: f32) -> Result<Self, Error> {
        let near = number_in("near depth", near, "in [0, ∞)", 0.0..=f32::MAX)?;
        let valid = "finite and not less than the near depth";
        let far = number_in("far depth", far, valid, near..=f32::MAX)?;
        Ok(Self { near, far })
    }

    /// The near end.
    #[must_use]
    pub fn near(&self) -> f32 {
        self.near
    }

    /// The far end.
    #[must_use]
    pub fn far(&self) -> f32 {
        self.far
    }

    /// The smallest interval that holds `depths`. `None` if all of them are sky.
    pub fn around(depths: impl IntoIterator<Item = f32>) -> Option<Self> {
        depths
            .into_iter()
            .filter(is_surface)
            .fold(None, |interval, depth| {
                Some(interval.map_or(
                    Self {
                        near: depth,
                        far: depth,
                    },
                    |Self { near, far }| Self {
                        near: near.min(depth),
                        far: far.max(depth),
                    },
                ))
            })
    }

    /// *`HalfZ`*: the smallest interval that holds `depths`, split at its middle [Stewart 2015].
    ///
    /// The nearer half comes first. `None` if all depths are sky.
    ///
    /// ```
    /// use stochastic_light_culling::DepthInterval;
    ///
    /// let halves = DepthInterval::half_z([2.0, 9.0, 8.0]);
    /// assert_eq!(halves, Some([DepthInterval::new(2.0, 5.5)?, DepthInterval::new(5.5, 9.0)?]));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn half_z(depths: impl IntoIterator<Item = f32>) -> Option<[Self; 2]> {
        let whole = Self::around(depths)?;
        let middle = whole.middle();
        Some([
            Self {
                far: middle,
                ..whole
            },
            Self {
                near: middle,
                ..whole
            },
        ])
    }

    /// *Modified `HalfZ`*: the depths are split at the middle of their interval, and each part has the
    /// smallest interval that holds it [Stewart 2015].
    ///
    /// The nearer part comes first and includes the middle. The farther part is `None` if all depths are
    /// equal. Both are `None` if all depths are sky.
    ///
    /// ```
    /// use stochastic_light_culling::DepthInterval;
    ///
    /// let [near, far] = DepthInterval::modified_half_z([2.0, 9.0, 2.5, f32::INFINITY, 8.0]);
    /// assert_eq!(near, Some(DepthInterval::new(2.0, 2.5)?));
    /// assert_eq!(far, Some(DepthInterval::new(8.0, 9.0)?));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn modified_half_z(
        depths: impl IntoIterator<Item = f32, IntoIter: Clone>,
    ) -> [Option<Self>; 2] {
        let depths = depths.into_iter();
        let Some(whole) = Self::around(depths.clone()) else {
            return [None; 2];
        };
        let middle = whole.middle();
        [
            Self::around(depths.clone().filter(|depth| *depth <= middle)),
            Self::around(depths.filter(|depth| *depth > middle)),
        ]
    }

    /// Splits the interval into `count` slices with equal ratios of far to near, as clustered shading does
    /// [Olsson et al. 2012].
    ///
    /// Neighbouring slices share an end, and all slices together are the interval. A `count` of zero gives no
    /// slices. If `near` is less than 2⁻²⁰ of `far`, which includes zero, the ratios begin at 2⁻²⁰ of `far`,
    /// and the first slice also holds all that is nearer.
    ///
    /// ```
    /// use stochastic_light_culling::DepthInterval;
    ///
    /// let view = DepthInterval::new(0.5, 8.0)?;
    /// let ends = view.exponential_slices(4).map(|slice| slice.far());
    /// assert!(ends.eq([1.0, 2.0, 4.0, 8.0]));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn exponential_slices(&self, count: u32) -> impl Iterator<Item = Self> + Clone + use<> {
        const MIN_NEAR_SHARE: f32 = 1.0 / 1_048_576.0;
        let Self { near, far } = *self;
        let first = near.max(MIN_NEAR_SHARE * far);
        let cut = move |slice: u32| match slice {
            0 => near,
            _ if slice == count => far,
            _ => {
                let share = slice as f32 / count as f32;
                // 0/0 if both ends are zero; `max` and `min` ignore NaN.
                (first * power(far / first, share)).max(near).min(far)
            }
        };
        (0..count).map(move |slice| Self {
            near: cut(slice),
            far: cut(slice + 1).max(cut(slice)),
        })
    }

    /// Splits the interval into `count` slices of equal length, as suits an orthographic view.
    ///
    /// Neighbouring slices share an end, and all slices together are the interval. A `count` of zero gives no
    /// slices.
    ///
    /// ```
    /// use stochastic_light_culling::DepthInterval;
    ///
    /// let view = DepthInterval::new(20.0, 30.0)?;
    /// let ends = view.uniform_slices(4).map(|slice| slice.far());
    /// assert!(ends.eq([22.5, 25.0, 27.5, 30.0]));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn uniform_slices(&self, count: u32) -> impl Iterator<Item = Self> + Clone + use<> {
        let Self { near, far } = *self;
        let cut = move |slice: u32| {
            let share = slice as f32 / count as f32;
            // Neither end is missed by rounding, and none of the products overflows.
            (near * (1.0 - share) + far * share).max(near).min(far)
        };
        (0..count).map(move |slice| Self {
            near: cut(slice),
            far: cut(slice + 1).max(cut(slice)),
        })
    }

    fn middle(&self) -> f32 {
        // Halved first, since the sum of two large depths overflows. Clamped, since the halves of subnormal
        // depths round.
        (0.5 * self.near + 0.5 * self.far)
            .max(self.near)
            .min(self.far)
    }
}

fn is_surface(depth: &f32) -> bool {
    depth.is_finite() && *depth > 0.0
}
