use glam::Vec3;

use super::shape::{Quads, Shape, ShapeLanes, padded, rounding_of_sum, scaled};
use crate::base::{Error, finite, number_in};
use crate::num::{Real, Single, Vector3};

/// Pays for the sum of the radius and the rounding of the centre.
const PLACED_RADIUS_ROUNDINGS: u16 = 2;

/// A closed ball, or the empty set if its radius is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: Vec3,
    radius: f32,
}

impl Sphere {
    /// Creates the ball of `radius` around `center`. A radius of zero is the empty set.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `center` is not finite, [`Error::Number`] if `radius` is negative,
    /// infinite or NaN.
    pub fn new(center: Vec3, radius: f32) -> Result<Self, Error> {
        Ok(Self {
            center: finite("sphere centre", center)?,
            radius: number_in("sphere radius", radius, "in [0, ∞)", 0.0..=f32::MAX)?,
        })
    }

    pub(super) fn from_parts(center: Vec3, radius: f32) -> Self {
        Self { center, radius }
    }

    /// The sphere as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> Spheres<f32> {
        Spheres {
            center: Some(self.center.into()),
            radius: self.radius,
        }
    }

    /// The centre.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The radius. Zero if the sphere is empty, infinite if the range of the light overflows.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }
}

/// A [`Sphere`] in each lane.
#[derive(Clone, Copy)]
pub struct Spheres<N> {
    /// `None` for the origin of all lanes, the light: sums with it take no time.
    pub center: Option<Vector3<N>>,
    pub radius: N,
}

impl<N: Single> ShapeLanes<N> for Spheres<N> {
    #[inline(always)]
    fn placed(self, position: Vector3<N>, scale: N) -> Self {
        let radius = scaled(self.radius, scale);
        let (center, rounding) = match self.center {
            Some(center) => {
                let offset = center * scale;
                let center = position + offset;
                (center, rounding_of_sum(offset) + rounding_of_sum(center))
            }
            None => (position, rounding_of_sum(position)),
        };
        Self {
            center: Some(center),
            radius: (radius + rounding).round_up(PLACED_RADIUS_ROUNDINGS),
        }
    }

    #[inline(always)]
    fn is_empty(&self) -> N::Mask {
        !self.radius.is_positive()
    }
}

impl Sphere {
    /// Scales the shape by `scale` ≥ 0 about the origin, then moves it by `position`, rounded outward.
    ///
    /// Scaled by zero it is [empty](Self::is_empty). A radius that overflows is infinite.
    #[inline]
    #[must_use]
    pub fn placed(self, position: Vec3, scale: f32) -> Self {
        if self.is_empty() || !scale.is_positive() {
            return Self::from_parts(position, 0.0);
        }
        Self::from_lanes(self.lanes().placed(position.into(), scale))
    }

    /// Whether the shape is empty: the light reaches nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.radius == 0.0
    }
}

impl Shape for Sphere {
    fn placed(self, position: Vec3, scale: f32) -> Self {
        self.placed(position, scale)
    }

    fn is_empty(&self) -> bool {
        self.is_empty()
    }

    const EMPTY: Self = Self {
        center: Vec3::ZERO,
        radius: 0.0,
    };

    type Lanes<N: Single> = Spheres<N>;

    const QUADS: usize = 1;

    #[inline(always)]
    fn to_quads(&self) -> Quads<f32> {
        padded([[self.center.x, self.center.y, self.center.z, self.radius]])
    }

    #[inline(always)]
    fn from_quads<N: Single>(quads: &Quads<N>) -> Spheres<N> {
        let [x, y, z, radius] = quads[0];
        Spheres {
            center: Some(Vector3::new(x, y, z)),
            radius,
        }
    }

    #[inline(always)]
    fn from_lanes(Spheres { center, radius }: Spheres<f32>) -> Self {
        Self::from_parts(center.map_or(Vec3::ZERO, Into::into), radius)
    }
}
