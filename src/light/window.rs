use crate::base::{Error, number_in};
use crate::num::{round_up, sqrt};

/// Pays for the rounding of r/√peak: a root and a quotient.
const LIMIT_ROUNDINGS: u16 = 2;

/// The window by which engines let a light end at a distance: the factor (1 − (l/r)⁴)² of its radiance, zero from
/// the radius r on [Karis 2013].
///
/// Bevy and Filament have this factor, and call r the range or the falloff of a light. The glTF extension
/// KHR_lights_punctual recommends its root.
///
/// # What a window throws away
///
/// Engines need an end to cull by, and the window darkens what is lit from afar. Of the light that a lamp at
/// height h sheds on a floor without end, the share (32/21)h/r is lost for r ≫ h: 15 % if the radius is ten
/// times the height, and 5 % for thirty times. In a scene of many lamps the far light of all of them is lost, the
/// same at every point, which is why rooms look too dark between lamps.
///
/// Roulette needs no window: its range √(I/(δξ)) ends where few points are still to be lit, and what those
/// beyond do not receive, those within do. The mean over frames is I/l² at any distance. So leave the window
/// out, unless lights are to end there, since the artist wants it so.
///
/// # Lights that keep their window
///
/// Take the estimate of the light without window, and multiply by [`factor`](Self::factor). The mean is then
/// that of the windowed light. No point beyond r counts, so the bound may end there: scale it by at most
/// [`limit`](Self::limit).
///
/// ```
/// use stochastic_light_culling::{ConstantLobe, DistanceWindow, Bounded, Roulette, Shape, SpotLobe, Vpl, Xi, glam::Vec3};
///
/// let (lamp, window) = (Vpl::point(Vec3::ZERO, 500.0)?, DistanceWindow::new(20.0)?); // 500 cd, 20 m
/// let (roulette, xi) = (Roulette::new(0.1)?, Xi::new(0.25)?); // δ = 0.1 lx
///
/// // In this frame the lamp would reach 141 m. Its bound ends at 20.
/// let scale = window.limit(ConstantLobe::PEAK, roulette.scale(lamp.flux(), xi));
/// let bound = lamp.lobe().unit_bound().placed(lamp.position(), scale);
/// assert!(bound.radius() >= 20.0 && bound.radius() < 20.001);
///
/// // At 10 m the estimate is the engine's own light, since this lamp is near enough to be certain.
/// let (direction, squared) = lamp.direction_to(Vec3::new(0.0, 0.0, 10.0));
/// let intensity = lamp.radiant_intensity(direction);
/// let estimate = roulette.estimate(intensity, squared, xi) * window.factor(squared);
/// assert_eq!(estimate, intensity / squared * window.factor(squared));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
///
/// A spot light's bound follows the falloff within its cones, so it cannot be scaled down to end at r.
/// [`SpotLobe::unit_bound_cut_at`](crate::SpotLobe::unit_bound_cut_at) makes one that does, as tight as that of the
/// whole lobe:
///
/// ```
/// # use stochastic_light_culling::{Bounded, Direction, DistanceWindow, Roulette, Shape, SpotLobe, Vpl, Xi, glam::Vec3};
/// # let (roulette, xi, window) = (Roulette::new(0.1)?, Xi::new(0.25)?, DistanceWindow::new(20.0)?);
/// let lamp = Vpl::spot(Vec3::ZERO, 500.0, SpotLobe::new(0.2, 0.6, Direction::Z)?)?;
/// let scale = roulette.scale(lamp.flux(), xi);
/// let limit = window.limit(SpotLobe::PEAK, scale);
/// let bound = lamp.lobe().unit_bound_cut_at(limit / scale).placed(lamp.position(), limit);
///
/// let sector = lamp.lobe().hard_edged().unit_bound().placed(lamp.position(), limit);
/// assert!(bound.semi_axes().element_product() < 0.99 * sector.semi_axes().element_product());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
///
/// Unit bounds that are kept instead are the lobe's own, and that of
/// [`SpotLobe::hard_edged`](crate::SpotLobe::hard_edged), which holds the lobe up to any distance. Where the limit
/// is less than the scale, place the smaller of the two. Its volume is 1.2 times the smallest on average, and 2.2
/// times at worst; that of the cut bound is at most 1.08 times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceWindow {
    radius: f32,
}

impl DistanceWindow {
    /// Creates the window that ends at `radius` = r, in the unit of length.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `radius` is not positive, not a normal number, or NaN.
    pub fn new(radius: f32) -> Result<Self, Error> {
        let valid = f32::MIN_POSITIVE..=f32::MAX;
        number_in("window radius", radius, "positive and finite", valid)
            .map(|radius| Self { radius })
    }

    /// The radius r.
    #[must_use]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The factor (1 − (l/r)⁴)² at `distance_squared` = l² ≥ 0.
    ///
    /// In \[0, 1\]: 1 at l = 0; 0 from l = r on, for infinity, and for NaN.
    #[inline]
    #[must_use]
    pub fn factor(&self, distance_squared: f32) -> f32 {
        // Two quotients, since r² can overflow.
        let share = distance_squared / self.radius / self.radius;
        let rest = (1.0 - share * share).max(0.0);
        // NaN is not less than 1.
        if share < 1.0 { rest * rest } else { 0.0 }
    }

    /// The lesser of `scale` and the scale at which the bound of a light ends at r, rounded up. `peak` is the
    /// largest value of the light's lobe: [`ConstantLobe::PEAK`](crate::ConstantLobe::PEAK) or
    /// [`SpotLobe::PEAK`](crate::SpotLobe::PEAK).
    ///
    /// `scale` is that of [`Roulette::scale`](crate::Roulette::scale). Zero stays zero.
    #[inline]
    #[must_use]
    pub fn limit(&self, peak: f32, scale: f32) -> f32 {
        let limit = round_up(self.radius / sqrt(peak), LIMIT_ROUNDINGS);
        scale.min(limit)
    }
}
