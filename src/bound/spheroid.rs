use glam::{Mat3, Vec3};

use super::{Bound, Ellipsoid, Sphere, rounding_of_sum, scaled};
use crate::{Direction, math};

/// The paper's bounding spheroid, held by its focus, which is the light
/// [Tokuyoshi & Harada 2017, Eqs. 12–15].
///
/// In the direction at angle θ to its axis ω_u it reaches s(θ) = rα/(1 − k cos²(θ/2)), k = 1 − α²,
/// from the light at q. With cos²(θ/2) = (1 + cosθ)/2 this is the polar equation of a conic,
///
/// s(θ) = P/(1 − e cosθ), P = 2αr/(1 + α²), e = k/(1 + α²),
///
/// with one focus at q. It reaches s(0) = r/α ahead of the light and s(π) = rα behind it: the
/// centre q + (k/2α) r ω_u and the semi-axis r_u = (1 + α²)/(2α) r are half the difference and half
/// the sum of these, and r_v = r_w = r is their geometric mean. To add the centre's large offset
/// and subtract it again would lose the near end; so the focus is what is stored.
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, Ggx, GgxLobe, NoFresnel, glam::Vec3};
///
/// let lobe = GgxLobe::new(Ggx::new(0.1)?, NoFresnel, Direction::Z, Direction::Z);
/// let spheroid = lobe.unit_bound();
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
    /// The spheroid with a focus at the origin and the given r and α, enlarged to hold as well
    /// those whose axis is tilted by up to `tilt_radians`.
    ///
    /// The greatest slope of ln s(θ) is e/√(1−e²) = k/(2α), so a tilt by φ is paid for by a factor
    /// exp(φk/(2α)), which 1 + x + x² exceeds for x ≤ 1.
    pub(super) fn around_tilted_axis(
        axis: Direction,
        radius: f32,
        roughness: f32,
        tilt_radians: f32,
    ) -> Self {
        let x = tilt_radians * (1.0 - roughness) * (1.0 + roughness) / (2.0 * roughness);
        Self {
            focus: Vec3::ZERO,
            axis,
            radius: math::round_up(radius * (1.0 + x * (1.0 + x)), 16),
            roughness,
        }
    }

    /// The light's position q, a focus of the spheroid.
    pub fn focus(&self) -> Vec3 {
        self.focus
    }

    /// The long axis ω_u, the direction of mirror reflection.
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// r, the two short semi-axes; infinite for a light too bright for its range to be an `f32`.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// α, which gives the shape: how far the spheroid reaches behind the focus over r, and r over
    /// how far it reaches ahead.
    pub fn roughness(&self) -> f32 {
        self.roughness
    }

    /// r_u = (1 + α²)/(2α) r, the long semi-axis.
    pub fn long_semi_axis(&self) -> f32 {
        let alpha = self.roughness;
        self.radius * ((1.0 + alpha * alpha) / (2.0 * alpha))
    }

    /// (k/2α) r, the distance from the focus to the centre.
    fn center_distance(&self) -> f32 {
        let alpha = self.roughness;
        self.radius * ((1.0 - alpha) * (1.0 + alpha) / (2.0 * alpha))
    }

    /// The sphere around the light of radius r/α, the bound of the 2016 method (Fig. 9a).
    pub fn sphere_at_focus(&self) -> Sphere {
        Sphere::from_parts(self.focus, math::round_up(self.radius / self.roughness, 1))
    }

    /// The smallest sphere around the spheroid (Fig. 9b).
    pub fn enclosing_sphere(&self) -> Sphere {
        if self.is_empty() || self.long_semi_axis().is_infinite() {
            return Sphere::from_parts(self.focus, self.radius / self.roughness);
        }
        let offset = *self.axis * self.center_distance();
        let center = self.focus + offset;
        // The distance itself is off by four roundings of at most r_u.
        let radius = math::round_up(self.long_semi_axis(), 8);
        let rounding = rounding_of_sum(offset) + rounding_of_sum(center);
        Sphere::from_parts(center, math::round_up(radius + rounding, 2))
    }
}

impl Bound for Spheroid {
    fn placed(self, position: Vec3, scale: f32) -> Self {
        let radius = scaled(self.radius, scale);
        if self.focus == Vec3::ZERO || radius == 0.0 {
            return Self {
                focus: position,
                radius,
                ..self
            };
        }
        // Its nearest point is αr from the focus, which may be off by the rounding of these two.
        let offset = self.focus * scale;
        let focus = position + offset;
        let rounding = rounding_of_sum(offset) + rounding_of_sum(focus);
        Self {
            focus,
            radius: math::round_up(radius + rounding / self.roughness, 4),
            ..self
        }
    }

    fn is_empty(&self) -> bool {
        self.radius == 0.0
    }
}

impl From<Spheroid> for Ellipsoid {
    /// The ellipsoid with the centre and semi-axes (r_u, r, r), enlarged to pay for their rounding.
    fn from(spheroid: Spheroid) -> Self {
        let u = *spheroid.axis;
        let long = spheroid.long_semi_axis();
        if spheroid.is_empty() || long.is_infinite() {
            return Ellipsoid::from_parts(
                spheroid.focus,
                Vec3::ZERO,
                Mat3::IDENTITY,
                Vec3::splat(long),
            );
        }
        let (v, w) = u.any_orthonormal_pair();
        let offset = u * spheroid.center_distance();
        // In units of the unit sphere: the offset's rounding over the shortest semi-axis, and the tilt
        // of the axes over the ratio of longest to shortest.
        let tilt = 8.0 * math::UNIT_ROUNDOFF * long;
        let growth = 1.0 + (rounding_of_sum(offset) + tilt) / spheroid.radius;
        Ellipsoid::from_parts(
            spheroid.focus,
            offset,
            Mat3::from_cols(u, v, w),
            Vec3::new(long, spheroid.radius, spheroid.radius)
                .map(|semi_axis| math::round_up(semi_axis * growth, 8)),
        )
    }
}
