use glam::{Mat3, Vec3};

use super::{Bound, rounding_of_sum, scaled};
use crate::{Error, error, math};

/// An ellipsoid, its surface included: {c + R diag(semi-axes) y : ‖y‖ ≤ 1}.
///
/// The one shape that all bounds which are not spheres become before they meet a view. It is empty
/// if its semi-axes are zero.
///
/// Its centre is held in two parts, the light and the way from there, since of their sum little is left
/// for a light with a tiny range far from the world's origin.
///
/// ```
/// use stochastic_light_culling::{Bound, Ellipsoid, glam::{Mat3, Vec3}};
///
/// let around = Vec3::new(0.0, 1.0, 0.0);
/// let unit = Ellipsoid::new(around, Mat3::IDENTITY, Vec3::new(1.0, 2.0, 3.0))?;
/// let far = Vec3::new(1e9, 0.0, 0.0);
/// // A metre above the light, which the sum of both numbers cannot say.
/// assert_eq!(unit.placed(far, 1.0).center_parts(), [far, around]);
/// assert!(unit.placed(far, 0.0).is_empty());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    light: Vec3,
    offset: Vec3,
    rotation: Mat3,
    semi_axes: Vec3,
}

impl Ellipsoid {
    pub(super) const EMPTY: Self = Self {
        light: Vec3::ZERO,
        offset: Vec3::ZERO,
        rotation: Mat3::IDENTITY,
        semi_axes: Vec3::ZERO,
    };

    /// The ellipsoid around `center` whose axes are the columns of `rotation`.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `center` is not finite or `semi_axes` are not finite, positive and
    /// within a ratio of 2³⁰ of each other; [`Error::Matrix`] if the columns of `rotation` are not
    /// orthonormal to 10⁻⁶.
    pub fn new(center: Vec3, rotation: Mat3, semi_axes: Vec3) -> Result<Self, Error> {
        let center = error::finite("ellipsoid centre", center)?;
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        if !(semi_axes.is_finite() && shortest > 0.0 && longest / shortest <= 1_073_741_824.0) {
            return Err(Error::Vector {
                quantity: "semi-axes",
                value: semi_axes,
                valid: "finite, positive and within a ratio of 2³⁰ of each other",
            });
        }
        error::orthonormal("ellipsoid rotation", rotation, 1e-6)?;
        Ok(Self::from_parts(center, Vec3::ZERO, rotation, semi_axes))
    }

    pub(super) fn from_parts(light: Vec3, offset: Vec3, rotation: Mat3, semi_axes: Vec3) -> Self {
        Self {
            light,
            offset,
            rotation,
            semi_axes,
        }
    }

    /// The centre c, rounded.
    pub fn center(&self) -> Vec3 {
        self.light + self.offset
    }

    /// Two vectors whose exact sum is the centre c: the light's position, and the way from there; or c
    /// and zero, of an ellipsoid that is [made](Self::new) of its centre.
    pub fn center_parts(&self) -> [Vec3; 2] {
        [self.light, self.offset]
    }

    /// R, whose columns are the directions of the axes.
    pub fn rotation(&self) -> Mat3 {
        self.rotation
    }

    /// The semi-axes, in the order of the columns of [`rotation`](Self::rotation).
    pub fn semi_axes(&self) -> Vec3 {
        self.semi_axes
    }
}

impl Bound for Ellipsoid {
    fn placed(self, position: Vec3, scale: f32) -> Self {
        let semi_axes = self.semi_axes.map(|semi_axis| scaled(semi_axis, scale));
        let shortest = semi_axes.min_element();
        if shortest == 0.0 || semi_axes.max_element().is_infinite() {
            let semi_axes = Vec3::splat(if shortest == 0.0 { 0.0 } else { f32::INFINITY });
            return Self::from_parts(position, Vec3::ZERO, self.rotation, semi_axes);
        }
        let [light, offset] = self.center_parts().map(|part| part * scale);
        let sum = light + offset;
        let rounding = rounding_of_sum(light) + rounding_of_sum(offset) + rounding_of_sum(sum);
        let growth = math::round_up(1.0 + rounding / shortest, 4);
        Self::from_parts(position, sum, self.rotation, semi_axes * growth)
    }

    fn is_empty(&self) -> bool {
        self.semi_axes == Vec3::ZERO
    }
}
