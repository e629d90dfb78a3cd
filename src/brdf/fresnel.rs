use crate::{Error, error, math};

/// What a maximum of F is at least said to be: less can have underflowed, and its products with other
/// terms would be subnormal.
pub(super) const LEAST_REFLECTED: f32 = 1e-30;

/// The share of light that a smooth interface reflects, F.
///
/// An implementation must be quasi-convex in the angle, that is, fall and then rise, or only one of
/// both: [`maximum`](Fresnel::maximum) rests on it.
pub trait Fresnel: Copy {
    /// F in \[0, 1\] for cosθ_h = ω_i·ω_h in \[0, 1\].
    fn reflectance(&self, half_angle_cosine: f32) -> f32;

    /// An upper bound, tight to rounding, of F over all half angles from zero to the one whose cosine
    /// is `smallest_cosine` in \[0, 1\].
    ///
    /// A quasi-convex F is largest at one of the two ends
    /// [Tokuyoshi & Harada 2017, supplemental Eq. 6]. Never below 10⁻³⁰.
    #[inline]
    fn maximum(&self, smallest_cosine: f32) -> f32 {
        // Of cosines nearer to zero than this, powers underflow.
        let smallest_cosine = if smallest_cosine < 1e-15 {
            0.0
        } else {
            math::round_down(smallest_cosine, 16)
        };
        let head_on = self.reflectance(1.0);
        let grazing = self.reflectance(smallest_cosine);
        math::round_up(head_on.max(grazing), 64).clamp(LEAST_REFLECTED, 1.0)
    }
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
    fn maximum(&self, _smallest_cosine: f32) -> f32 {
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

    /// F0, the reflectance at normal incidence.
    pub fn f0(&self) -> f32 {
        self.f0
    }
}

impl Fresnel for Schlick {
    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        self.f0 + (1.0 - self.f0) * math::fifth_power(1.0 - half_angle_cosine)
    }
}
