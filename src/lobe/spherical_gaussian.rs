use core::f64::consts::TAU;

use glam::Vec3;

use super::{Cap, Caps, Lobe, LobeNumbers, Majorant, padded, unit};
use crate::base::{Direction, Error, number_in};
use crate::num::{Real, Single, Vector3, exponential, one_minus_exponential};

/// Budget for the value of a maximum within a cap.
const MAXIMUM_ROUNDINGS: u16 = 8;

/// A spherical Gaussian (SG): the lobe v(ω) = c exp(λ(ω·ξ − 1)) about the axis ξ
/// [Tokuyoshi 2016, Sec. 2].
///
/// The sharpness λ says how narrow the lobe is, the amplitude c in sr⁻¹ is its largest value. For λ = 0 it has
/// the value c in every direction, and no surface cuts it: it has no horizon. Products of two SGs are SGs. An
/// SG of unit integral is the von Mises–Fisher distribution, from which [`sample`](Self::sample) draws.
///
/// SGs approximate what a surface reflects ([`diffuse`](Self::diffuse), [`specular`](Self::specular)), and
/// the light of a cluster of lights ([`Vsgl`](crate::Vsgl)).
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, Lobe, SphericalGaussian, glam::Vec3};
///
/// let lobe = SphericalGaussian::with_integral(Direction::Z, 50.0, 1.0)?;
/// assert!((lobe.integral() - 1.0).abs() < 1e-6);
/// assert_eq!(lobe.value(Vec3::Z), lobe.amplitude());
/// let aside = lobe.value(Vec3::new(0.6, 0.0, 0.8)) / lobe.amplitude();
/// assert!((aside / (50.0_f32 * (0.8 - 1.0)).exp() - 1.0).abs() < 1e-5);
///
/// // The product of two is one again.
/// let other = SphericalGaussian::new(Direction::X, 2.0, 0.5)?;
/// let product = lobe.product(&other);
/// let direction = Vec3::new(0.28, 0.0, 0.96);
/// let values = lobe.value(direction) * other.value(direction);
/// assert!((product.value(direction) / values - 1.0).abs() < 1e-5);
///
/// // It is bounded, placed and culled as any other lobe.
/// assert!(lobe.unit_bound().semi_axes().x > 2.0 * lobe.unit_bound().semi_axes().y);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalGaussian {
    axis: Direction,
    sharpness: f32,
    amplitude: f32,
}

/// 2π(1 − e^{−2λ})/λ, the integral A(λ) of an SG of unit amplitude, in sr, to 10⁻¹¹ of itself for every λ ≥ 0.
/// It is 4π for λ = 0.
#[inline(always)]
pub(crate) fn solid_angle<D: Real<Element = f64>>(sharpness: D) -> D {
    // Far below 10⁻¹¹, where A is 4π but for rounding.
    let sharpness = sharpness.max(sharpness.splat(1e-30));
    one_minus_exponential(sharpness * 2.0) * TAU / sharpness
}

impl SphericalGaussian {
    /// The largest sharpness, 2²². Its lobe is a fortieth of a degree wide, which `f32` directions still
    /// resolve.
    pub const MAX_SHARPNESS: f32 = 4_194_304.0;

    /// Creates the SG about `axis` = ξ with `sharpness` = λ and `amplitude` = c in sr⁻¹. It is zero
    /// everywhere for c = 0.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `sharpness` is outside \[0, [`MAX_SHARPNESS`](Self::MAX_SHARPNESS)\], `amplitude`
    /// is negative or infinite, or either is NaN.
    pub fn new(axis: Direction, sharpness: f32, amplitude: f32) -> Result<Self, Error> {
        Ok(Self {
            axis,
            sharpness: valid_sharpness(sharpness)?,
            amplitude: number_in("SG amplitude", amplitude, "in [0, ∞)", 0.0..=f32::MAX)?,
        })
    }

    /// Creates the SG about `axis` whose integral over all directions is `integral`. For 1 it is the von
    /// Mises–Fisher distribution.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`Error::Number`] too if `integral` is negative, NaN, or so large that the
    /// amplitude is infinite.
    pub fn with_integral(axis: Direction, sharpness: f32, integral: f32) -> Result<Self, Error> {
        let sharpness = valid_sharpness(sharpness)?;
        let amplitude = f64::from(integral) / solid_angle(f64::from(sharpness));
        if !(integral >= 0.0 && amplitude <= f64::from(f32::MAX)) {
            return Err(Error::Number {
                quantity: "SG integral",
                value: integral,
                valid: "in [0, ∞), with a finite amplitude",
            });
        }
        Ok(Self {
            axis,
            sharpness,
            amplitude: amplitude as f32,
        })
    }

    /// The SG of numbers that are known to be valid.
    #[inline]
    pub(crate) fn of_parts(axis: Direction, sharpness: f32, amplitude: f32) -> Self {
        Self {
            axis,
            sharpness,
            amplitude,
        }
    }

    /// The light that arrives from `axis` with the integral `irradiance`, which is not NaN. An amplitude above the
    /// largest `f32` is that.
    #[inline]
    pub(crate) fn arriving(axis: Direction, sharpness: f32, irradiance: f32) -> Self {
        let amplitude = f64::from(irradiance) / solid_angle(f64::from(sharpness));
        Self::of_parts(axis, sharpness, amplitude.min(f32::MAX.into()) as f32)
    }

    /// The axis ξ.
    #[must_use]
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// The sharpness λ in \[0, [`MAX_SHARPNESS`](Self::MAX_SHARPNESS)\].
    #[must_use]
    pub fn sharpness(&self) -> f32 {
        self.sharpness
    }

    /// The amplitude c in sr⁻¹, the value towards the axis.
    #[must_use]
    pub fn amplitude(&self) -> f32 {
        self.amplitude
    }

    /// The integral c A(λ) over all directions, A(λ) = 2π(1 − e^{−2λ})/λ
    /// [Tokuyoshi 2016, Sec. 2].
    ///
    /// A falls from 4π at λ = 0. An integral above the largest `f32` is that.
    #[must_use]
    pub fn integral(&self) -> f32 {
        let integral = f64::from(self.amplitude) * solid_angle(f64::from(self.sharpness));
        integral.min(f32::MAX.into()) as f32
    }

    /// The product with `other`, which is an SG too, in the form that does not cancel
    /// [Tokuyoshi et al. 2024].
    ///
    /// With s = λ₁ξ₁ + λ₂ξ₂ its sharpness is λ = ‖s‖, its axis is along s, and its amplitude is
    /// c₁c₂ exp(−λ₁λ₂‖ξ₁ − ξ₂‖²/(λ + λ₁ + λ₂)). For s = 0 the axis is arbitrary. A λ above
    /// [`MAX_SHARPNESS`](Self::MAX_SHARPNESS) is lowered to that, with the integral unchanged. An amplitude
    /// above the largest `f32` is that.
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        let [a, b] = [self, other].map(|sg| f64::from(sg.sharpness));
        let axes = [self, other].map(|sg| unit(Vector3::from(sg.axis)));
        let (sum, power) = product_of(axes, [a, b]);
        let sharpness = sum.length();
        let amplitude = f64::from(self.amplitude) * f64::from(other.amplitude) * power;
        let most = f64::from(Self::MAX_SHARPNESS);
        let (clamped, share) = if sharpness > most {
            (most, solid_angle(sharpness) / solid_angle(most))
        } else {
            (sharpness, 1.0)
        };
        Self {
            axis: direction_along(sum, sharpness).unwrap_or(self.axis),
            sharpness: clamped as f32,
            amplitude: (amplitude * share).min(f32::MAX.into()) as f32,
        }
    }

    /// ∫ v₁v₂ dω of this SG and `other`, the integral of their [`product`](Self::product).
    #[must_use]
    pub fn product_integral(&self, other: &Self) -> f32 {
        self.product(other).integral()
    }

    /// The SG as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> SphericalGaussians<f32> {
        SphericalGaussians {
            axis: self.axis.into(),
            sharpness: self.sharpness,
            amplitude: self.amplitude,
        }
    }
}

fn valid_sharpness(sharpness: f32) -> Result<f32, Error> {
    number_in(
        "SG sharpness λ",
        sharpness,
        "in [0, 2²²]",
        0.0..=SphericalGaussian::MAX_SHARPNESS,
    )
}

/// The direction along `vector`, which is `length` long. `None` if that is zero, infinite or NaN.
pub(crate) fn direction_along(vector: Vector3<f64>, length: f64) -> Option<Direction> {
    // A square below the normal range would lose the direction.
    (1e-150..=f64::MAX)
        .contains(&length)
        .then(|| Direction::from_unit(Vector3::narrow(vector / length).into()))
}

/// s = λ₁ξ₁ + λ₂ξ₂ and exp(−λ₁λ₂‖ξ₁ − ξ₂‖²/(‖s‖ + λ₁ + λ₂)), for the product of two SGs of unit amplitude.
#[inline(always)]
fn product_of<D: Real<Element = f64>>([u, v]: [Vector3<D>; 2], [a, b]: [D; 2]) -> (Vector3<D>, D) {
    let sum = u * a + v * b;
    let apart = (u - v).length_squared();
    // Positive where λ₁ and λ₂ are zero too.
    let sum_of_three = (sum.length() + a + b).max(a.splat(f64::MIN_POSITIVE));
    (sum, exponential(-(a * b * apart / sum_of_three)))
}

impl Lobe for SphericalGaussian {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        self.lanes().value(outgoing.into())
    }

    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        let axes = Caps::around(self.axis.into());
        self.lanes().majorant(&axes, &cap.lanes()).greatest
    }

    fn is_empty(&self) -> bool {
        self.amplitude <= 0.0
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        let axis = self.axis;
        padded([axis.x, axis.y, axis.z, self.sharpness, self.amplitude])
    }

    fn numbers_in_use() -> usize {
        5
    }

    fn has_more_than_numbers() -> bool {
        false
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        SphericalGaussians::from_numbers(numbers).value(outgoing)
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let lobes = SphericalGaussians::from_numbers(numbers);
        lobes.majorant(&Caps::around(lobes.axis), cap)
    }

    /// ∫ v g dω over the integral of g: of the product's integral, that of g is divided out.
    #[inline(always)]
    fn mean_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        axis: Vector3<N>,
        sharpness: N,
    ) -> N {
        let [x, y, z, own, amplitude, ..] = *numbers;
        let axes = [Vector3::new(x, y, z), axis].map(unit);
        let other = sharpness.widen();
        let (sum, power) = product_of(axes, [own.widen(), other]);
        let share = solid_angle(sum.length()) / solid_angle(other);
        N::narrow(amplitude.widen() * power * share)
    }
}

/// A [`SphericalGaussian`] in each lane.
#[derive(Clone, Copy)]
pub(crate) struct SphericalGaussians<N> {
    /// ξ
    pub axis: Vector3<N>,
    /// λ
    pub sharpness: N,
    /// c
    pub amplitude: N,
}

impl<N: Single> SphericalGaussians<N> {
    #[inline(always)]
    fn from_numbers(numbers: &LobeNumbers<N>) -> Self {
        let [x, y, z, sharpness, amplitude, ..] = *numbers;
        Self {
            axis: Vector3::new(x, y, z),
            sharpness,
            amplitude,
        }
    }

    /// The majorant within a cap, of SGs about `axes`.
    ///
    /// The typical value is that between the axes, of the SG that is wider by the spread of the directions: 1/λ is the
    /// variance for each of two axes, and that of a disc of the radius c is c²/4.
    #[inline(always)]
    pub(super) fn majorant(&self, axes: &Caps<N>, cap: &Caps<N>) -> Majorant<N> {
        let [least, middle] = cap.distances(axes).map(
            #[inline(always)]
            |distance| distance.widen() * distance.widen(),
        );
        let spread = cap.spread(axes);
        let wider = self.sharpness * spread * spread * 0.25 + 1.0;
        let filtered = Self {
            axis: self.axis,
            sharpness: self.sharpness / wider,
            amplitude: self.amplitude / wider,
        };
        // Both may underflow.
        let smallest = wider.splat(f32::MIN_POSITIVE);
        let greatest = self.value_at(least).round_up(MAXIMUM_ROUNDINGS);
        let greatest = Real::max(greatest, smallest).min(self.amplitude);
        let typical = Real::max(filtered.value_at(middle), smallest);
        Majorant {
            greatest,
            typical: typical.min(greatest),
        }
    }

    /// c exp(−½λ‖ω − ξ‖²), which is never above c, and zero for NaN.
    ///
    /// The exponent is computed in double precision, from the difference of the vectors, since λ multiplies
    /// the rounding of their dot product.
    #[inline(always)]
    pub fn value(&self, outgoing: Vector3<N>) -> N {
        let apart = outgoing.widen() - self.axis.widen();
        self.value_at(apart.length_squared())
    }

    /// c exp(−½λd²) for `distance_squared` = d² from the axis.
    #[inline(always)]
    fn value_at(&self, distance_squared: N::Double) -> N {
        let half = self.sharpness.widen() * 0.5;
        let power = exponential(-(half * distance_squared));
        N::narrow(self.amplitude.widen() * power)
    }
}
