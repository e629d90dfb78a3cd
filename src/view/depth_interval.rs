use crate::base::{Error, number_in};
use crate::num::power;

/// The depths from `near` to `far`, both included, that a tile's surfaces lie in.
///
/// Those made from a depth buffer leave out sky: depths that are NaN, infinite, zero or negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthInterval {
    near: f32,
    far: f32,
}

impl DepthInterval {
    /// The interval from `near` to `far`. Equal depths are one plane: a wall that faces the eye.
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

    /// The least depth.
    #[must_use]
    pub fn near(&self) -> f32 {
        self.near
    }

    /// The greatest depth.
    #[must_use]
    pub fn far(&self) -> f32 {
        self.far
    }

    /// The least interval that holds `depths`; `None` if all of them are sky.
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

    /// *`HalfZ`*: the interval around `depths`, cut in two at its middle [Stewart 2015].
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

    /// *Modified `HalfZ`*: the depths are parted at the middle of their interval, and each part
    /// has the least interval that holds it [Stewart 2015].
    ///
    /// The nearer part first. It holds the middle itself; the farther one is `None` where all depths
    /// are equal, and both are where all of them are sky.
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

    /// The interval cut into `count` slices, each as many times as deep at its end as at its beginning:
    /// what clustered shading divides the view into [Olsson et al. 2012]. Neighbours share their depth, and
    /// the first and the last one end where the interval does. None for no slices.
    ///
    /// Of an interval that begins nearer than 2⁻²⁰ of where it ends, the first slice takes in what is nearer
    /// than that.
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
        const NEAREST: f32 = 1.0 / 1_048_576.0;
        let Self { near, far } = *self;
        let first = near.max(NEAREST * far);
        let cut = move |slice: u32| match slice {
            0 => near,
            _ if slice == count => far,
            _ => {
                let share = slice as f32 / count as f32;
                // NaN, where all depths are zero, is neither the greater nor the lesser.
                (first * power(far / first, share)).max(near).min(far)
            }
        };
        (0..count).map(move |slice| Self {
            near: cut(slice),
            far: cut(slice + 1).max(cut(slice)),
        })
    }

    fn middle(&self) -> f32 {
        // Halved first: the sum of two large depths overflows. The halves of subnormal depths are rounded,
        // which can take their sum out of the interval.
        (0.5 * self.near + 0.5 * self.far)
            .max(self.near)
            .min(self.far)
    }
}

fn is_surface(depth: &f32) -> bool {
    depth.is_finite() && *depth > 0.0
}
