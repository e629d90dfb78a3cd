use crate::base::{Error, number_in};
use crate::num::{Real, Single, round_down, round_up};

/// Lower clamp for Fresnel maxima; keeps products out of the subnormal range.
pub(super) const LEAST_REFLECTED: f32 = 1e-30;

/// Pays for the rounding of the cosine of the largest half angle.
const SMALLEST_COSINE_ROUNDINGS: u16 = 16;
/// Pays for the rounding of a value of F.
const REFLECTANCE_ROUNDINGS: u16 = 64;
/// Pays for the rounding of F/(1 + rise (1 − cosθ_h)⁵).
const MAJORANT_BASE_ROUNDINGS: u16 = 8;
/// Pays for the product of base and rise.
const MAJORANT_RISE_ROUNDINGS: u16 = 2;
/// Pays for the difference 1 − F0.
const SCHLICK_RISE_ROUNDINGS: u16 = 1;

/// The Fresnel factor F: the share of light that a smooth interface reflects.
///
/// An implementation must be quasi-convex in the angle: F falls, then rises, or does only one of both.
/// [`maximum`](Fresnel::maximum) relies on it.
///
/// ```
/// use stochastic_light_culling::{Direction, Fresnel, FresnelMajorant, Ggx, GgxLobe, Incidence};
///
/// /// A coat with F0 = 0.04 over a base with constant reflectance.
/// #[derive(Clone, Copy)]
/// struct Coat(f32);
///
/// impl Fresnel for Coat {
///     fn reflectance(&self, half_angle_cosine: f32) -> f32 {
///         self.0.max(0.04 + 0.96 * (1.0 - half_angle_cosine).powi(5))
///     }
///
///     // The default is the largest F, which is 1 here, and gives a larger tight bound.
///     fn majorant(&self) -> FresnelMajorant {
///         FresnelMajorant { base: self.0.max(0.04), rise: 0.96 }
///     }
/// }
///
/// let lobe = GgxLobe::new(Ggx::new(0.3)?, Coat(0.2), Incidence::head_on(Direction::Z));
/// assert!(lobe.max_fresnel() < 0.21);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
pub trait Fresnel: Copy + 'static {
    /// F in \[0, 1\] for `half_angle_cosine` = cosθ_h = ω_i·ω_h in \[0, 1\]: 1 at normal incidence, 0 at
    /// grazing.
    fn reflectance(&self, half_angle_cosine: f32) -> f32;

    /// An upper bound of F over all half angles from zero to the one whose cosine is `smallest_cosine` in
    /// \[0, 1\]. It is tight but for rounding.
    ///
    /// A quasi-convex F is largest at one of the two ends [Tokuyoshi & Harada 2017, supplemental Eq. 6]. The
    /// bound is clamped to \[10⁻³⁰, 1\].
    #[inline]
    fn maximum(&self, smallest_cosine: f32) -> f32 {
        quasi_convex_maximum(|cosine| self.reflectance(cosine), [smallest_cosine, 1.0])
    }

    /// An upper bound of F in Schlick's form, for the [tight bound](crate::Tight). The closer it is to F, the
    /// smaller that bound. It may exceed 1.
    ///
    /// By default it is the largest F of all angles.
    fn majorant(&self) -> FresnelMajorant {
        FresnelMajorant {
            base: self.maximum(0.0),
            rise: 0.0,
        }
    }

    /// The cosine in \[0, 1\] of the half angle from which on all light is reflected, or next to which F is steep for
    /// another reason. Zero, the default, if there is none.
    ///
    /// Any value is safe. [`Lobe::maximum_within`](crate::Lobe::maximum_within) is sharper for the right one, within narrow
    /// caps of directions.
    fn critical_cosine(&self) -> f32 {
        0.0
    }

    /// Whether `majorant` is known to be one, whatever the numbers of this factor.
    #[doc(hidden)]
    const HAS_VALID_MAJORANT: bool = false;

    /// Whether F falls with cosθ_h and is steep nowhere: a bound then needs it once, at an angle that need not be exact.
    #[doc(hidden)]
    const IS_GENTLE: bool = false;

    /// Whether `reflectance_in_lanes` is implemented, and `maximum` is not.
    #[doc(hidden)]
    const IS_IN_LANES: bool = false;

    /// Computes the [`reflectance`](Self::reflectance) of one factor in each lane.
    #[doc(hidden)]
    #[inline(always)]
    fn reflectance_in_lanes<N: Single>(fresnels: &[Self], half_angle_cosine: N) -> N {
        N::per_lane(
            [half_angle_cosine],
            #[inline(always)]
            |i, [cosine]| fresnels[i].reflectance(cosine),
        )
    }

    /// The numbers that [`reflectance_of_parameters`](Self::reflectance_of_parameters) takes.
    #[doc(hidden)]
    fn parameters(&self) -> [f32; 2] {
        [0.0; 2]
    }

    /// Computes the [`reflectance`](Self::reflectance) of one factor in each lane from its
    /// [`parameters`](Self::parameters). `None` if it cannot be computed in lanes.
    #[doc(hidden)]
    #[inline(always)]
    fn reflectance_of_parameters<N: Single>(_: [N; 2], _half_angle_cosine: N) -> Option<N> {
        None
    }

    /// Computes the [`critical_cosine`](Self::critical_cosine) of one factor in each lane from its
    /// [`parameters`](Self::parameters). `None` if it cannot be computed in lanes. A gentle factor needs none.
    #[doc(hidden)]
    #[inline(always)]
    fn critical_cosine_of_parameters<N: Single>([any, _]: [N; 2]) -> Option<N> {
        Self::IS_GENTLE.then(|| any.zero())
    }

    /// Computes the [`maximum`](Self::maximum) of one factor in each lane.
    #[doc(hidden)]
    #[inline(always)]
    fn maximum_in_lanes<N: Single>(fresnels: &[Self], smallest_cosine: N) -> N {
        if Self::IS_IN_LANES {
            return quasi_convex_maximum(
                #[inline(always)]
                |cosine| Self::reflectance_in_lanes(fresnels, cosine),
                [smallest_cosine, smallest_cosine.splat(1.0)],
            );
        }
        N::per_lane(
            [smallest_cosine],
            #[inline(always)]
            |i, [cosine]| fresnels[i].maximum(cosine),
        )
    }
}

/// An upper bound of a quasi-convex F between two cosines; see [`Fresnel::maximum`].
#[inline(always)]
pub(super) fn quasi_convex_maximum<N: Single>(
    reflectance: impl Fn(N) -> N,
    [smallest_cosine, largest_cosine]: [N; 2],
) -> N {
    let steepest = reflectance(largest_cosine);
    let grazing = reflectance(rounded_cosine(smallest_cosine));
    rounded_reflectance(grazing.max(steepest))
}

/// An upper bound of an F that falls with the cosine, from this one on.
#[inline(always)]
pub(super) fn falling_maximum<N: Single>(
    reflectance: impl FnOnce(N) -> N,
    smallest_cosine: N,
) -> N {
    rounded_reflectance(reflectance(rounded_cosine(smallest_cosine)))
}

/// The smallest cosine, rounded down.
#[inline(always)]
fn rounded_cosine<N: Single>(cosine: N) -> N {
    // Powers of smaller cosines would underflow.
    let is_tiny = cosine.splat(1e-15).gt(cosine);
    let rounded = cosine * round_down(1.0, SMALLEST_COSINE_ROUNDINGS);
    N::select(is_tiny, cosine.zero(), rounded)
}

/// The greatest F, rounded up.
#[inline(always)]
fn rounded_reflectance<N: Single>(most: N) -> N {
    let most = most.round_up(REFLECTANCE_ROUNDINGS);
    most.max(most.splat(LEAST_REFLECTED)).min(most.splat(1.0))
}

/// An upper bound of F in Schlick's form: base + rise (1 − cosθ_h)⁵, for every cosθ_h in \[0, 1\]. See
/// [`Fresnel::majorant`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FresnelMajorant {
    /// Its value at normal incidence, at least 10⁻³⁰.
    pub base: f32,
    /// Its increase from normal to grazing incidence, not negative.
    pub rise: f32,
}

impl FresnelMajorant {
    /// The majorant of `fresnel`, or 1 where a caller's numbers are none.
    #[inline(always)]
    pub(super) fn of_any<F: Fresnel>(fresnel: &F) -> Self {
        let majorant = fresnel.majorant();
        let Self { base, rise } = majorant;
        let is_valid =
            F::HAS_VALID_MAJORANT || base >= LEAST_REFLECTED && (0.0..=f32::MAX).contains(&rise);
        if is_valid {
            majorant
        } else {
            Self {
                base: 1.0,
                rise: 0.0,
            }
        }
    }

    /// Its value, at most 1.
    #[inline(always)]
    pub(super) fn value<N: Single>(self, half_angle_cosine: N) -> N {
        let rise = half_angle_cosine.one_minus().fifth_power() * self.rise;
        (rise + self.base).min(rise.splat(1.0))
    }

    /// Searches a close majorant of `reflectance`, which must be quasi-convex: of several candidates the one
    /// with the smallest mean quotient of majorant and F.
    ///
    /// Between two cosines F is at most the larger of its two values there, and the majorant is at least its
    /// value at the larger cosine.
    pub(super) fn of(reflectance: impl Fn(f32) -> f32) -> Self {
        const STEPS: usize = 64;
        let cosine = |i: usize| i as f32 / STEPS as f32;
        let rises: [f32; STEPS + 1] = core::array::from_fn(|i| (1.0 - cosine(i)).fifth_power());
        let values: [f32; STEPS + 1] =
            core::array::from_fn(|i| round_up(reflectance(cosine(i)), REFLECTANCE_ROUNDINGS));
        let most = values.into_iter().fold(LEAST_REFLECTED, f32::max).min(1.0);
        let mut best = (
            f32::INFINITY,
            Self {
                base: most,
                rise: 0.0,
            },
        );
        // Candidates are multiples of 1 + rise (1 − c)⁵, from steep to flat.
        let mut rise = 256.0;
        while rise > 0.01 {
            let shape = |i: usize| 1.0 + rise * rises[i];
            let base = (0..STEPS)
                .map(|i| values[i].max(values[i + 1]).min(1.0) / shape(i + 1))
                .fold(LEAST_REFLECTED, f32::max);
            let base = round_up(base, MAJORANT_BASE_ROUNDINGS);
            let excess: f32 = (0..=STEPS)
                .map(|i| base * shape(i) / values[i].max(1e-3))
                .sum();
            if excess < best.0 {
                best = (
                    excess,
                    Self {
                        base,
                        rise: round_up(base * rise, MAJORANT_RISE_ROUNDINGS),
                    },
                );
            }
            rise *= 0.7;
        }
        best.1
    }
}

/// No Fresnel factor: F = 1, all light is reflected, at no cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NoFresnel;

impl Fresnel for NoFresnel {
    const HAS_VALID_MAJORANT: bool = true;
    const IS_GENTLE: bool = true;

    #[inline]
    fn reflectance(&self, _half_angle_cosine: f32) -> f32 {
        1.0
    }

    #[inline]
    fn maximum(&self, _smallest_cosine: f32) -> f32 {
        1.0
    }

    #[inline(always)]
    fn reflectance_in_lanes<N: Single>(_: &[Self], half_angle_cosine: N) -> N {
        half_angle_cosine.splat(1.0)
    }

    #[inline(always)]
    fn reflectance_of_parameters<N: Single>(_: [N; 2], half_angle_cosine: N) -> Option<N> {
        Some(half_angle_cosine.splat(1.0))
    }

    #[inline(always)]
    fn maximum_in_lanes<N: Single>(_: &[Self], smallest_cosine: N) -> N {
        smallest_cosine.splat(1.0)
    }

    #[inline]
    fn majorant(&self) -> FresnelMajorant {
        FresnelMajorant {
            base: 1.0,
            rise: 0.0,
        }
    }
}

/// Schlick's approximation F = F0 + (1 − F0)(1 − cosθ_h)⁵ [Schlick 1994, Eq. 15].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schlick {
    f0: f32,
}

impl Schlick {
    /// Creates the approximation with the reflectance `f0` = F0 at normal incidence: about 0.04 for plastic
    /// and glass, 0.5 to 0.98 for metals.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `f0` is outside \[0, 1\] or NaN.
    pub fn new(f0: f32) -> Result<Self, Error> {
        number_in("reflectance F0", f0, "in [0, 1]", 0.0..=1.0).map(|f0| Self { f0 })
    }

    /// The reflectance F0 at normal incidence.
    #[must_use]
    pub fn f0(&self) -> f32 {
        self.f0
    }
}

impl Fresnel for Schlick {
    const HAS_VALID_MAJORANT: bool = true;
    const IS_GENTLE: bool = true;
    const IS_IN_LANES: bool = true;

    #[inline]
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        Self::reflectance_in_lanes(&[*self], half_angle_cosine)
    }

    #[inline(always)]
    fn reflectance_in_lanes<N: Single>(fresnels: &[Self], half_angle_cosine: N) -> N {
        let f0 = half_angle_cosine.gather(
            #[inline(always)]
            |i| fresnels[i].f0,
        );
        schlick(f0, half_angle_cosine)
    }

    #[inline]
    fn parameters(&self) -> [f32; 2] {
        [self.f0, 0.0]
    }

    #[inline(always)]
    fn reflectance_of_parameters<N: Single>([f0, _]: [N; 2], cosine: N) -> Option<N> {
        Some(schlick(f0, cosine))
    }

    #[inline]
    fn majorant(&self) -> FresnelMajorant {
        FresnelMajorant {
            base: self.f0.max(LEAST_REFLECTED),
            rise: round_up(1.0 - self.f0, SCHLICK_RISE_ROUNDINGS),
        }
    }
}

/// F0 + (1 − F0)(1 − cosθ_h)⁵
#[inline(always)]
fn schlick<N: Single>(f0: N, half_angle_cosine: N) -> N {
    f0 + f0.one_minus() * half_angle_cosine.one_minus().fifth_power()
}
