use glam::Vec3;

use crate::base::{Direction, Error, finite, number_in};
use crate::lobe::SphericalGaussian;
use crate::num::{Real, Single, Vector3, exponential, one_minus_exponential};

/// A virtual spherical Gaussian light (VSGL): a cluster of lights, with a spread and a smooth lobe
/// [Tokuyoshi 2015; Tokuyoshi 2016, Sec. 3].
///
/// Its radiant intensity is a [`SphericalGaussian`] c_v exp(λ_v(ω·ξ_v − 1)) in W/sr. Its position is spread
/// around μ as a Gaussian of the standard deviation σ. So it has no spike: near its centre the light that
/// arrives stays finite. Without spread, σ = 0, it is a point light.
///
/// [`ClusterSums`](crate::ClusterSums) make one of many lights.
///
/// ```
/// use stochastic_light_culling::{Direction, LambertLobe, SphericalGaussian, Vsgl, glam::Vec3};
///
/// let lobe = SphericalGaussian::with_integral(Direction::Z, 20.0, 5.0)?;
/// let light = Vsgl::new(Vec3::ZERO, 0.2, lobe)?;
/// // From afar it is a point light: E = I/l².
/// let point = Vec3::new(0.0, 0.0, 10.0);
/// let of_point_light = light.lobe().amplitude() / 100.0;
/// assert!((light.scalar_irradiance(point) / of_point_light - 1.0).abs() < 0.01);
/// // At its centre E = c(1 − e^{−2λ})/(λσ²) is finite, and nowhere larger.
/// assert!(light.scalar_irradiance(Vec3::ZERO) < 1.01 * light.lobe().amplitude() / (20.0 * 0.04));
/// // The light arrives from the centre, within an angle of about σ/l.
/// let arriving = light.incoming(point);
/// assert_eq!(*arriving.axis(), -Vec3::Z);
/// assert!((arriving.sharpness() / (100.0 / 0.04) - 1.0).abs() < 0.01);
/// // A surface reflects it.
/// let facing = LambertLobe::new(0.5, -Direction::Z)?;
/// assert!(facing.product_integral(&arriving) > 0.0);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vsgl {
    position: Vec3,
    spread: f32,
    lobe: SphericalGaussian,
}

impl Vsgl {
    /// Creates the light around `position` = μ with `spread` = σ ≥ 0, in the unit of length, and the radiant
    /// intensity `lobe` in W/sr, whose integral is the flux in W.
    ///
    /// A light whose lobe is zero everywhere reaches nothing.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `position` is not finite, [`Error::Number`] if `spread` is negative, above 10¹⁵, or
    /// NaN.
    pub fn new(position: Vec3, spread: f32, lobe: SphericalGaussian) -> Result<Self, Error> {
        Ok(Self {
            position: finite("light position", position)?,
            spread: number_in("spread σ", spread, "in [0, 10¹⁵]", 0.0..=Self::MAX_SPREAD)?,
            lobe,
        })
    }

    /// The largest spread.
    const MAX_SPREAD: f32 = 1e15;

    /// The light of a cluster, whose numbers are known to be valid but for the size of the spread.
    pub(super) fn of_cluster(position: Vec3, spread: f32, lobe: SphericalGaussian) -> Self {
        Self {
            position,
            spread: spread.min(Self::MAX_SPREAD),
            lobe,
        }
    }

    /// The mean position μ, in world space.
    #[must_use]
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// The spread σ, in the unit of length.
    #[must_use]
    pub fn spread(&self) -> f32 {
        self.spread
    }

    /// The radiant intensity as a function of the direction, in W/sr.
    #[must_use]
    pub fn lobe(&self) -> &SphericalGaussian {
        &self.lobe
    }

    /// The light that arrives at `point`, as a function of the direction that it comes from: the incoming
    /// radiance in W/(m²·sr), an SG [Tokuyoshi 2016, Eq. 7].
    ///
    /// With x = `point` − μ, l = ‖x‖ and A = λ_vσ² its axis is along −(lx + Aξ_v), its sharpness is the length
    /// of that over σ², and its integral is the [`scalar_irradiance`](Self::scalar_irradiance). A sharpness
    /// above [`SphericalGaussian::MAX_SHARPNESS`] is lowered to that with the integral unchanged, as for a
    /// light without spread. Where lx + Aξ_v = 0 the SG is constant.
    ///
    /// An amplitude above the largest `f32`, as at a light without spread, is that. If `point` is not finite
    /// the SG is zero everywhere.
    #[must_use]
    pub fn incoming(&self, point: Vec3) -> SphericalGaussian {
        let incoming = self.lanes().incoming(point.into());
        let axis = Direction::from_unit(incoming.axis.into());
        SphericalGaussian::arriving(axis, incoming.sharpness, incoming.scalar_irradiance)
    }

    /// The integral E = ∫L_in dω of the [`incoming`](Self::incoming) radiance over all directions, in W/m².
    ///
    /// From afar it is I/l², the radiance of a point light, and a [`Roulette`](crate::Roulette) takes it as the
    /// intensity of a light at unit distance; [`bound`](Self::bound) encloses where it accepts that. It never grows
    /// along a way out from the centre. At the centre it is c_v(1 − e^{−2λ})/(λσ²), and infinite for σ = 0. Zero if the lobe is
    /// zero, and at points that are not finite. It is computed in double precision, and rounded once.
    #[must_use]
    pub fn scalar_irradiance(&self, point: Vec3) -> f32 {
        self.lanes().incoming(point.into()).scalar_irradiance
    }

    /// The light as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> Vsgls<f32> {
        Vsgls {
            position: self.position.into(),
            spread: self.spread,
            axis: Vector3::from(self.lobe.axis()),
            sharpness: self.lobe.sharpness(),
            amplitude: self.lobe.amplitude(),
        }
    }
}

/// A [`Vsgl`] in each lane.
#[derive(Clone, Copy)]
pub(crate) struct Vsgls<N> {
    pub position: Vector3<N>,
    pub spread: N,
    pub axis: Vector3<N>,
    pub sharpness: N,
    pub amplitude: N,
}

/// The light that arrives at a point.
#[derive(Clone, Copy)]
pub(crate) struct Incoming<N> {
    /// E
    pub scalar_irradiance: N,
    /// The direction that it comes from.
    pub axis: Vector3<N>,
    pub sharpness: N,
}

impl<N: Single> Vsgls<N> {
    /// E = c exp(−2λq/(T + l² + A)) (1 − e^{−2T/σ²})/T with A = λσ² and T = ‖lx + Aξ‖. The light comes along
    /// −(lx + Aξ) with the sharpness T/σ².
    ///
    /// This is c/(2πσ²) times the integral of the product of the SGs about ξ and x, of the sharpness λ and
    /// l²/σ², in a form without differences: with c = cosθ, T² = (l² − A)² + 2Al²(1 + c), and
    /// T − l² − A = −2Aq/(T + l² + A), q = l²(1 − c). Of 1 ± c the one that would cancel is ρ²/(l² ∓ lz), where
    /// z = lc and ρ is the distance from the axis.
    #[inline(always)]
    pub fn incoming(&self, point: Vector3<N>) -> Incoming<N> {
        let axis = self.axis.widen();
        let axis = axis / axis.length();
        let x = point.widen() - self.position.widen();
        let (spread, lambda) = (self.spread.widen(), self.sharpness.widen());
        let spread_squared = spread * spread;
        let a = lambda * spread_squared;
        let squared = x.length_squared();
        let length = squared.sqrt();
        let height = x.dot(axis);
        let rim = x.cross(axis).length_squared();
        // l − |z| without cancellation; 0/0 at the centre.
        let least = squared.splat(f64::MIN_POSITIVE);
        // A square below the normal range would lose the direction.
        let least_length = squared.splat(1e-150);
        let sum = length + height.abs();
        let rest = rim / sum.max(least);
        let is_ahead = height.is_positive();
        let [minus, plus] = <N::Double as Real>::select_all(is_ahead, [rest, sum], [sum, rest]);
        let (q, p) = (length * minus, length * plus);
        let difference = squared - a;
        let t = (difference * difference + a * 2.0 * p).sqrt();
        // Above zero, where the quotient has its limit 2/σ² already.
        let t = t.max(spread_squared * 1e-20).max(least);
        let exponent = -(lambda * 2.0 * q / (t + squared + a));
        let y = t * 2.0 / spread_squared.max(least);
        let value = self.amplitude.widen() * exponential(exponent) * one_minus_exponential(y) / t;
        // Zero at points that are not finite.
        let value = <N::Double as Real>::select(squared.is_finite(), value, squared.zero());
        let way = -(x * length + axis * a);
        let way_length = way.length();
        let has_way = way_length.gt(least_length) & way_length.is_finite();
        let way = Vector3::select(has_way, way / way_length, axis);
        let most = squared.splat(SphericalGaussian::MAX_SHARPNESS.into());
        let is_less_sharp = (most * spread_squared).gt(t);
        let sharpness = <N::Double as Real>::select(is_less_sharp, t / spread_squared, most);
        Incoming {
            scalar_irradiance: N::narrow(value),
            axis: Vector3::narrow(way),
            sharpness: N::narrow(sharpness),
        }
    }
}
