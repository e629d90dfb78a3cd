use crate::{Error, error, math};

/// The share of light that a smooth interface reflects, F.
///
/// An implementation must be quasi-convex in the angle, that is, fall and then rise, or only one of
/// both: [`maximum`](Fresnel::maximum) rests on it.
pub trait Fresnel: Copy {
    /// F in \[0, 1\] for cosθ_h = ω_i·ω_h in \[0, 1\].
    fn reflectance(&self, half_angle_cosine: f32) -> f32;

    /// An upper bound, tight to rounding, of F over all outgoing directions above the surface, for
    /// light that arrives at `incidence_cosine` = μ = ω_i·n in (0, 1].
    ///
    /// The half angle θ_h runs from 0 to ½ arccos μ + π/4, and a quasi-convex F is largest at one
    /// of the two ends [Tokuyoshi & Harada 2017, supplemental Eq. 6].
    fn maximum(&self, incidence_cosine: f32) -> f32 {
        let head_on = self.reflectance(1.0);
        let grazing = self.reflectance(smallest_half_angle_cosine(incidence_cosine));
        math::round_up(head_on.max(grazing), 32).min(1.0)
    }
}

/// cosθ_h^max = cos(½ arccos μ + π/4), rounded down.
///
/// Written as μ/√(2(1 + √(1−μ²))): the source's √((1 − √(1−μ²))/2) cancels at grazing incidence
/// [Tokuyoshi & Harada 2017, supplemental, below Eq. 2].
fn smallest_half_angle_cosine(incidence_cosine: f32) -> f32 {
    let mu = incidence_cosine;
    let sine = math::sqrt((1.0 - mu) * (1.0 + mu));
    math::round_down(mu / math::sqrt(2.0 * (1.0 + sine)), 8)
}

/// No Fresnel factor, F = 1: all light is reflected. Costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoFresnel;

impl Fresnel for NoFresnel {
    #[inline]
    fn reflectance(&self, _half_angle_cosine: f32) -> f32 {
        1.0
    }

    #[inline]
    fn maximum(&self, _incidence_cosine: f32) -> f32 {
        1.0
    }
}

/// Schlick's approximation F = F0 + (1 − F0)(1 − cosθ_h)⁵ [Schlick 1994, Eq. 15].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlick {
    f0: f32,
}

impl Schlick {
    /// The approximation with reflectance `f0` at normal incidence: about 0.04 for plastic and
    /// glass, 0.5 to 0.98 for metals.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `f0` is outside \[0, 1\] or NaN.
    pub fn new(f0: f32) -> Result<Self, Error> {
        error::number_in("reflectance F0", f0, "in [0, 1]", 0.0..=1.0).map(|f0| Self { f0 })
    }
}

impl Fresnel for Schlick {
    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        self.f0 + (1.0 - self.f0) * math::fifth_power(1.0 - half_angle_cosine)
    }
}
