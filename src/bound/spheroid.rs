use glam::{Mat3, Vec3};

use super::ellipsoid::Ellipsoids;
use super::shape::{Quads, Shape, ShapeLanes, padded, rounding_of_sum, scaled};
use super::{Ellipsoid, Sphere};
use crate::base::Direction;
use crate::num::{Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3, round_up};

/// Pays for the rounding of r and of its factor for a tilted axis.
const RADIUS_ROUNDINGS: u16 = 16;
/// Pays for the quotient r/α.
const FOCUS_SPHERE_ROUNDINGS: u16 = 1;
/// Pays for the rounding of r_u, and for most of that of the distance from focus to centre.
const LONG_SEMI_AXIS_ROUNDINGS: u16 = 8;
/// Pays for the sum of the radius and the rounding of the centre, and for the rest of the distance's.
const ENCLOSING_SPHERE_ROUNDINGS: u16 = 2;
/// Pays for the rounding of the frame, in units of u times r_u/r.
const FRAME_TILT_ROUNDINGS: f32 = 8.0;
/// Pays for the rounding of the semi-axes of an ellipsoid.
const SEMI_AXIS_ROUNDINGS: u16 = 8;
/// Pays for the growth of the radius of a spheroid whose focus is rounded.
const MOVED_RADIUS_ROUNDINGS: u16 = 4;

/// The paper's bounding spheroid, stored by its focus, which is the light
/// [Tokuyoshi & Harada 2017, Eqs. 12–15].
///
/// In a direction at the angle θ to its axis ω_u, its surface is at the distance
/// s(θ) = rα/(1 − k cos²(θ/2)), k = 1 − α², from the light at q. With cos²(θ/2) = (1 + cosθ)/2 this is the
/// polar equation of a conic,
///
/// s(θ) = P/(1 − e cosθ), P = 2αr/(1 + α²), e = k/(1 + α²),
///
/// with one focus at q. It extends s(0) = r/α ahead of the light and s(π) = rα behind it. Half their
/// difference, (k/2α) r, is the distance from q to the centre; half their sum is the semi-axis
/// r_u = (1 + α²)/(2α) r; and their geometric mean is r_v = r_w = r. The focus is stored, and not the centre,
/// since adding the large offset of the centre and subtracting it again would lose the near end.
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, Ggx, GgxLobe, Incidence, NoFresnel, Paper, glam::Vec3};
///
/// let lobe = GgxLobe::new(Ggx::new(0.1)?, NoFresnel, Incidence::head_on(Direction::Z));
/// let spheroid = lobe.unit_bound_by(Paper);
/// assert_eq!((spheroid.focus(), spheroid.axis()), (Vec3::ZERO, lobe.mirror_direction()));
/// assert!((spheroid.long_semi_axis() / spheroid.radius() - 5.05).abs() < 1e-5);
/// assert!(spheroid.enclosing_sphere().radius() < spheroid.sphere_at_focus().radius());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spheroid {
    focus: Vec3,
    axis: Direction,
    radius: f32,
    roughness: f32,
}

impl Spheroid {
    /// The spheroid as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> Spheroids<f32> {
        Spheroids {
            focus: self.focus.into(),
            axis: self.axis.into(),
            radius: self.radius,
            roughness: self.roughness,
        }
    }

    /// The focus q, the position of the light.
    #[must_use]
    pub fn focus(&self) -> Vec3 {
        self.focus
    }

    /// The long axis ω_u, the mirror direction.
    #[must_use]
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// The length r of the two short semi-axes. Zero if the spheroid is empty, infinite if the range of the
    /// light overflows.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The roughness α, which determines the proportions: the spheroid extends rα behind the focus and r/α
    /// ahead.
    #[must_use]
    pub fn roughness(&self) -> f32 {
        self.roughness
    }

    /// The long semi-axis r_u = (1 + α²)/(2α) r.
    #[must_use]
    pub fn long_semi_axis(&self) -> f32 {
        self.lanes().long_semi_axis()
    }

    /// The sphere of radius r/α around the light, the bound of the 2016 method
    /// [Tokuyoshi & Harada 2017, Fig. 9a]. It contains the spheroid.
    #[must_use]
    pub fn sphere_at_focus(&self) -> Sphere {
        Sphere::from_parts(
            self.focus,
            round_up(self.radius / self.roughness, FOCUS_SPHERE_ROUNDINGS),
        )
    }

    /// The smallest sphere around the spheroid, rounded outward [Tokuyoshi & Harada 2017, Fig. 9b].
    #[must_use]
    pub fn enclosing_sphere(&self) -> Sphere {
        if self.is_empty() || self.long_semi_axis().is_infinite() {
            return Sphere::from_parts(self.focus, self.radius / self.roughness);
        }
        let offset = self.lanes().center_offset();
        let center = Vector3::from(self.focus) + offset;
        let radius = round_up(self.long_semi_axis(), LONG_SEMI_AXIS_ROUNDINGS);
        let rounding = rounding_of_sum(offset) + rounding_of_sum(center);
        let radius = round_up(radius + rounding, ENCLOSING_SPHERE_ROUNDINGS);
        Sphere::from_parts(center.into(), radius)
    }
}

/// A [`Spheroid`] in each lane.
#[derive(Clone, Copy)]
pub struct Spheroids<N> {
    pub focus: Vector3<N>,
    pub axis: Vector3<N>,
    pub radius: N,
    pub roughness: N,
}

impl<N: Single> Spheroids<N> {
    /// The spheroids with a focus at the origin and the given r and α, enlarged to contain those whose axis
    /// is tilted by up to `tilt_radians`.
    ///
    /// The largest slope of ln s(θ) is e/√(1−e²) = k/(2α). So the factor exp(x), x = φk/(2α), pays for a tilt
    /// by φ, and 1 + x + x² is larger for x ≤ 1.
    #[inline(always)]
    pub fn around_tilted_axis(
        axis: Vector3<N>,
        radius: N,
        roughness: N,
        tilt_radians: f32,
    ) -> Self {
        let x = roughness.one_minus() * tilt_radians * (roughness + 1.0) / (roughness * 2.0);
        Self {
            focus: Vector3::zero(radius),
            axis,
            radius: (radius * (x * (x + 1.0) + 1.0)).round_up(RADIUS_ROUNDINGS),
            roughness,
        }
    }

    #[inline(always)]
    fn long_semi_axis(&self) -> N {
        let alpha = self.roughness;
        self.radius * ((alpha * alpha + 1.0) / (alpha * 2.0))
    }

    /// The vector (k/2α) r ω_u from the focus to the centre.
    #[inline(always)]
    fn center_offset(&self) -> Vector3<N> {
        let alpha = self.roughness;
        self.axis * (self.radius * (alpha.one_minus() * (alpha + 1.0) / (alpha * 2.0)))
    }

    /// The ellipsoids with the same centre and the semi-axes (r_u, r, r), rounded outward. Not finite where a
    /// spheroid is not.
    #[inline(always)]
    pub fn ellipsoids(self) -> Ellipsoids<N> {
        let long = self.long_semi_axis();
        let (v, w) = self.axis.any_orthonormal_pair();
        let offset = self.center_offset();
        // Relative to the shortest semi-axis: the rounding of the offset, and the tilt of the long axis.
        let tilt = long * (FRAME_TILT_ROUNDINGS * UNIT_ROUNDOFF);
        let growth = (rounding_of_sum(offset) + tilt) / self.radius + 1.0;
        let short = (self.radius * growth).round_up(SEMI_AXIS_ROUNDINGS);
        let long = (long * growth).round_up(SEMI_AXIS_ROUNDINGS);
        Ellipsoids {
            light: Some(self.focus),
            offset,
            axes: Matrix3::new(self.axis, v, w),
            semi_axes: Vector3::new(long, short, short),
        }
    }
}

impl<N: Single> ShapeLanes<N> for Spheroids<N> {
    #[inline(always)]
    fn placed(self, position: Vector3<N>, scale: N) -> Self {
        let radius = scaled(self.radius, scale);
        let is_at_origin = self.focus.is_zero();
        if N::is_known_false(!is_at_origin) {
            return Self {
                focus: position,
                radius,
                ..self
            };
        }
        // The focus is off by the rounding of these two sums, and the nearest point is αr from it.
        let offset = self.focus * scale;
        let focus = position + offset;
        let rounding = rounding_of_sum(offset) + rounding_of_sum(focus);
        let grown = (radius + rounding / self.roughness).round_up(MOVED_RADIUS_ROUNDINGS);
        Self {
            focus: Vector3::select(is_at_origin, position, focus),
            radius: N::select(is_at_origin, radius, grown),
            ..self
        }
    }

    #[inline(always)]
    fn is_empty(&self) -> N::Mask {
        !self.radius.is_positive()
    }
}

impl Spheroid {
    /// Scales the shape by `scale` ≥ 0 about the origin, then moves it by `position`, rounded outward.
    ///
    /// Scaled by zero it is [empty](Self::is_empty).
    #[inline]
    #[must_use]
    pub fn placed(self, position: Vec3, scale: f32) -> Self {
        if self.is_empty() || !scale.is_positive() {
            return Self {
                focus: position,
                radius: 0.0,
                ..self
            };
        }
        let Spheroids { focus, radius, .. } = self.lanes().placed(position.into(), scale);
        Self {
            focus: focus.into(),
            radius,
            ..self
        }
    }

    /// Whether the shape is empty: the light reaches nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.radius == 0.0
    }
}

impl Shape for Spheroid {
    fn placed(self, position: Vec3, scale: f32) -> Self {
        self.placed(position, scale)
    }

    fn is_empty(&self) -> bool {
        self.is_empty()
    }

    const EMPTY: Self = Self {
        focus: Vec3::ZERO,
        axis: Direction::X,
        radius: 0.0,
        roughness: 1.0,
    };

    type Lanes<N: Single> = Spheroids<N>;

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self) -> Quads<f32> {
        let (f, u) = (self.focus, self.axis);
        padded([
            [f.x, f.y, f.z, self.radius],
            [u.x, u.y, u.z, self.roughness],
        ])
    }

    #[inline(always)]
    fn from_quads<N: Single>(quads: &Quads<N>) -> Spheroids<N> {
        let [[f_x, f_y, f_z, radius], [u_x, u_y, u_z, roughness], ..] = *quads;
        Spheroids {
            focus: Vector3::new(f_x, f_y, f_z),
            axis: Vector3::new(u_x, u_y, u_z),
            radius,
            roughness,
        }
    }

    #[inline(always)]
    fn from_lanes(lanes: Spheroids<f32>) -> Self {
        Self {
            focus: lanes.focus.into(),
            axis: Direction::from_unit(lanes.axis.into()),
            radius: lanes.radius,
            roughness: lanes.roughness,
        }
    }
}

impl From<Spheroid> for Ellipsoid {
    /// The ellipsoid with the same centre and the semi-axes (r_u, r, r), rounded outward.
    #[inline]
    fn from(spheroid: Spheroid) -> Self {
        let long = spheroid.long_semi_axis();
        if spheroid.is_empty() || long.is_infinite() {
            return Self::from_parts(
                spheroid.focus,
                Vec3::ZERO,
                Mat3::IDENTITY,
                Vec3::splat(long),
            );
        }
        Self::from_lanes(spheroid.lanes().ellipsoids())
    }
}
