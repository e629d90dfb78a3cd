use glam::{Mat3, Vec3};

use super::shape::{Quads, Shape, ShapeLanes, rounding_of_sum, scaled};
use crate::base::{Error, finite, orthonormal};
use crate::num::{Matrix3, Real, Single, Vector3};

/// Pays for the rounding of the semi-axes' growth and of their product with it.
const GROWTH_ROUNDINGS: u16 = 4;

/// A closed ellipsoid {c + R diag(semi-axes) y : ‖y‖ ≤ 1}. It is empty if its semi-axes are zero.
///
/// All bounds but spheres are projected as ellipsoids.
///
/// The centre is stored in two parts, the position of the light and the offset from there. Their sum would be
/// inaccurate for a light with a small range far from the origin of the world.
///
/// ```
/// use stochastic_light_culling::{Ellipsoid, Shape, glam::{Mat3, Vec3}};
///
/// let around = Vec3::new(0.0, 1.0, 0.0);
/// let unit = Ellipsoid::new(around, Mat3::IDENTITY, Vec3::new(1.0, 2.0, 3.0))?;
/// let far = Vec3::new(1e9, 0.0, 0.0);
/// // The offset of a metre would be lost in the sum.
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
    /// Creates the ellipsoid around `center` with `semi_axes` along the columns of `rotation`.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `center` is not finite or `semi_axes` are not finite, positive and
    /// within a ratio of 2³⁰ of each other; [`Error::Matrix`] if the columns of `rotation` are not
    /// orthonormal to 10⁻⁶.
    pub fn new(center: Vec3, rotation: Mat3, semi_axes: Vec3) -> Result<Self, Error> {
        let center = finite("ellipsoid centre", center)?;
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        if !(semi_axes.is_finite() && shortest > 0.0 && longest / shortest <= 1_073_741_824.0) {
            return Err(Error::Vector {
                quantity: "semi-axes",
                value: semi_axes,
                valid: "finite, positive and within a ratio of 2³⁰ of each other",
            });
        }
        orthonormal("ellipsoid rotation", rotation, 1e-6)?;
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

    /// The ellipsoid as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> Ellipsoids<f32> {
        Ellipsoids {
            light: Some(self.light.into()),
            offset: self.offset.into(),
            axes: self.rotation.into(),
            semi_axes: self.semi_axes.into(),
        }
    }

    /// The centre c, rounded to `f32`.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.light + self.offset
    }

    /// Two vectors whose exact sum is the centre c: the position of the light and the offset from there. For
    /// an ellipsoid made by [`new`](Self::new) they are c and zero.
    #[must_use]
    pub fn center_parts(&self) -> [Vec3; 2] {
        [self.light, self.offset]
    }

    /// The rotation R, whose columns are the directions of the axes.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        self.rotation
    }

    /// The semi-axes, in the order of the columns of [`rotation`](Self::rotation). Zero if the ellipsoid is
    /// empty, infinite if the range of the light overflows.
    #[must_use]
    pub fn semi_axes(&self) -> Vec3 {
        self.semi_axes
    }
}

/// An [`Ellipsoid`] in each lane.
#[derive(Clone, Copy)]
pub struct Ellipsoids<N> {
    /// The position of the light. `None` for the origin in all lanes: sums with it take no time.
    pub light: Option<Vector3<N>>,
    /// The way from there to the centre, which is the exact sum of both.
    pub offset: Vector3<N>,
    /// R, whose columns are the directions of the axes.
    pub axes: Matrix3<N>,
    pub semi_axes: Vector3<N>,
}

impl<N: Single> Ellipsoids<N> {
    #[inline(always)]
    pub fn select(mask: N::Mask, yes: Self, no: Self) -> Self {
        Self {
            light: match (yes.light, no.light) {
                (None, None) => None,
                _ => Some(Vector3::select(
                    mask,
                    yes.light_or_origin(),
                    no.light_or_origin(),
                )),
            },
            offset: Vector3::select(mask, yes.offset, no.offset),
            axes: Matrix3::select(mask, yes.axes, no.axes),
            semi_axes: Vector3::select(mask, yes.semi_axes, no.semi_axes),
        }
    }

    #[inline(always)]
    pub fn light_or_origin(&self) -> Vector3<N> {
        self.light.unwrap_or(Vector3::zero(self.offset.x))
    }

    #[inline(always)]
    fn scaled_semi_axes(&self, scale: N) -> Vector3<N> {
        let Vector3 { x, y, z } = self.semi_axes;
        Vector3::new(scaled(x, scale), scaled(y, scale), scaled(z, scale))
    }
}

impl<N: Single> ShapeLanes<N> for Ellipsoids<N> {
    #[inline(always)]
    fn placed(self, position: Vector3<N>, scale: N) -> Self {
        let semi_axes = self.scaled_semi_axes(scale);
        let offset = self.offset * scale;
        let of_offset = rounding_of_sum(offset);
        let (sum, rounding) = match self.light {
            Some(light) => {
                let light = light * scale;
                let sum = light + offset;
                (
                    sum,
                    rounding_of_sum(light) + of_offset + rounding_of_sum(sum),
                )
            }
            None => (offset, of_offset + of_offset),
        };
        let growth = (rounding / semi_axes.min_element() + 1.0).round_up(GROWTH_ROUNDINGS);
        Self {
            light: Some(position),
            offset: sum,
            axes: self.axes,
            semi_axes: semi_axes * growth,
        }
    }

    #[inline(always)]
    fn is_empty(&self) -> N::Mask {
        !self.semi_axes.min_element().is_positive()
    }
}

impl Ellipsoid {
    /// Scales the shape by `scale` ≥ 0 about the origin, then moves it by `position`, rounded outward.
    ///
    /// Scaled by zero it is [empty](Self::is_empty).
    #[inline]
    #[must_use]
    pub fn placed(self, position: Vec3, scale: f32) -> Self {
        let all = |semi_axis: f32| {
            let semi_axes = Vec3::splat(semi_axis);
            Self::from_parts(position, Vec3::ZERO, self.rotation, semi_axes)
        };
        if self.is_empty() || !scale.is_positive() {
            return all(0.0);
        }
        let lanes = self.lanes();
        if lanes.scaled_semi_axes(scale).max_element().is_infinite() {
            return all(f32::INFINITY);
        }
        Self::from_lanes(lanes.placed(position.into(), scale))
    }

    /// Whether the shape is empty: the light reaches nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.semi_axes == Vec3::ZERO
    }
}

impl Shape for Ellipsoid {
    fn placed(self, position: Vec3, scale: f32) -> Self {
        self.placed(position, scale)
    }

    fn is_empty(&self) -> bool {
        self.is_empty()
    }

    const EMPTY: Self = Self {
        light: Vec3::ZERO,
        offset: Vec3::ZERO,
        rotation: Mat3::IDENTITY,
        semi_axes: Vec3::ZERO,
    };

    type Lanes<N: Single> = Ellipsoids<N>;

    const QUADS: usize = 5;

    // In the order of the fields, in which the numbers are copied fastest.
    #[inline(always)]
    fn to_quads(&self) -> Quads<f32> {
        let ([q, o], r, s) = (self.center_parts(), self.rotation, self.semi_axes);
        let [u, v, w] = [r.x_axis, r.y_axis, r.z_axis];
        [
            [q.x, q.y, q.z, o.x],
            [o.y, o.z, u.x, u.y],
            [u.z, v.x, v.y, v.z],
            [w.x, w.y, w.z, s.x],
            [s.y, s.z, 0.0, 0.0],
        ]
    }

    #[inline(always)]
    fn from_quads<N: Single>(quads: &Quads<N>) -> Ellipsoids<N> {
        let [[q_x, q_y, q_z, o_x], [o_y, o_z, u_x, u_y], quads @ ..] = *quads;
        let [[u_z, v_x, v_y, v_z], [w_x, w_y, w_z, s_x], [s_y, s_z, ..]] = quads;
        Ellipsoids {
            light: Some(Vector3::new(q_x, q_y, q_z)),
            offset: Vector3::new(o_x, o_y, o_z),
            axes: Matrix3::new(
                Vector3::new(u_x, u_y, u_z),
                Vector3::new(v_x, v_y, v_z),
                Vector3::new(w_x, w_y, w_z),
            ),
            semi_axes: Vector3::new(s_x, s_y, s_z),
        }
    }

    #[inline(always)]
    fn from_lanes(lanes: Ellipsoids<f32>) -> Self {
        Self::from_parts(
            lanes.light_or_origin().into(),
            lanes.offset.into(),
            lanes.axes.into(),
            lanes.semi_axes.into(),
        )
    }
}
