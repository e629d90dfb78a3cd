use glam::{Mat3, Vec3};

use super::ltc_from_ggx::{GgxSurfaces, IncidencePlane, Matrix};
use super::ltc_lobes::{LTC_NUMBERS, LtcLobes};
use super::{Cap, Caps, Fresnel, Ggx, Incidence, Lobe, LobeNumbers, Majorant, padded};
use crate::base::{Direction, Error, number_in};
use crate::num::{Single, Vector3};

/// A linearly transformed cosine: a cheap lobe that resembles a [`GgxLobe`](crate::GgxLobe)
/// [Heitz et al. 2016; Xia et al. 2023].
///
/// Its value is
///
/// v(ω_o) = (ρ/H) max(z, 0)/π · |M⁻¹|/‖M⁻¹ω_o‖⁴ above the surface and zero below it, z = (M⁻¹ω_o)₃
///
/// [Xia et al. 2023, Eqs. 9 and 14]. The power is 4 and not the 3 of the Jacobian, since z has yet to be
/// divided by the length too. M⁻¹ comes from a table over α and the angle of incidence.
///
/// # Energy
///
/// ρ is the share of the light that is reflected: ρ = F(1) n_A + (F(0) − F(1)) f_A with the table's albedos
/// n_A for F = 1 and f_A for F = (1 − cosθ_h)⁵ [Xia et al. 2023, Eq. 4], which for [`Schlick`](crate::Schlick)
/// is the whole Fresnel factor. For [`NoFresnel`](crate::NoFresnel) it is n_A. A dielectric or a conductor is taken
/// as Schlick's factor with its reflectance at normal and at grazing incidence.
///
/// Part of a cosine lies below the horizon, where no surface reflects. H ≥ ½ is the share above, (1 + c)/2,
/// where c is the cosine of the angle between the third axis and Mᵀn. The source lets the rest go. The
/// division by H keeps the energy for F = 1 within 1 % of that of GGX. Where less than GGX's is nearer to it, the
/// albedos are up to ¼ % lower: at normal incidence and α = 0.1 the relative L2 error is then 0.0033 and not 0.0047.
///
/// # Error
///
/// One matrix and one factor ρ cannot follow a Fresnel factor over the lobe. The relative L2 error for F = 1
/// is below 6 % up to 45° and 10 % at 60°, and grows to a half at grazing incidence. For F0 = 0.04 it is up to
/// 18 % at 45° and 43 % at 60°. The bound follows the lobe, so roulette is unbiased for the picture that these
/// lobes make. That picture differs from GGX's, in linear values up to 1, by a root mean square of 0.005 at most
/// for a plane below one light (α = 0.3, seen from 45°), and by 0.005 to 0.016 where a metal lights metals, which
/// is more than the 0.002 to 0.006 of the source. `cargo run --release --example report -- --study ltsd` makes
/// the map, and compares pictures and times.
///
/// # Which direction is fixed
///
/// The table is looked up by the direction ω_i of the light. [Xia et al. 2023, Eq. 13] states that looking it
/// up by ω_o gives the same value, as a reciprocal BRDF would. But the fit is not reciprocal. Exchanging the
/// directions changes the BRDF by as much as the fit errs: at α = 0.2 by 1 % between 20° and 40°, and by 26 %
/// between 30° and 80°. At a receiver the fixed direction is that to the eye.
///
/// # When it pays
///
/// The value takes 0.6 of the time of a [`GgxLobe`](crate::GgxLobe)'s with Schlick's factor, and on Zen 4 half of it in
/// lanes. Direction, roulette, sum, and a test of lights that are too faint are the same for both. But the lobe takes
/// longer to make: 20 ns, sixteen at a time, as `LtcLobe::many` makes them with the feature `cull`, and 35 ns one by
/// one. So it pays at lights that are made once. At receivers, which are made anew in each frame, and whose lobe is
/// evaluated for accepted lights alone, it pays from about 300 lights in the list of a pixel on.
///
/// # Edges
///
/// The lobe is empty, that is, zero in every direction, if the light arrives from below the surface or at
/// grazing incidence, μ ≤ 0. Across the plane of incidence a GGX lobe is about 2αμ wide. Where αμ is below 2.4·10⁻⁵,
/// which single precision cannot follow, the lobe is as wide as with that.
///
/// A saved scene keeps the GGX material and makes the lobe anew.
///
/// ```
/// use stochastic_light_culling::{
///     Direction, Ggx, GgxLobe, Incidence, Lobe, LtcLobe, Schlick, glam::Vec3,
/// };
///
/// let incidence = Incidence {
///     normal: Direction::Z,
///     incoming: Direction::new(Vec3::new(-1.0, 0.0, 2.0))?,
/// };
/// let (ggx, gold) = (Ggx::new(0.2)?, Schlick::new(0.9)?);
/// let exact = GgxLobe::new(ggx, gold, incidence);
/// let cheap = LtcLobe::new(ggx, gold, incidence);
/// let mirror = Vec3::from(exact.mirror_direction());
/// assert!((cheap.value(mirror) / exact.value(mirror) - 1.0).abs() < 0.02);
/// assert_eq!(cheap.value(-Vec3::Z), 0.0);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LtcLobe {
    normal: Direction,
    /// ρ
    reflected: f32,
    /// The factor of z/‖M⁻¹ω‖⁴.
    amplitude: f32,
    /// What of the first row of M⁻¹ is across the third, and the third, in world space.
    rows: [Vec3; 2],
    /// The factor of the third row in the first.
    shear: f32,
}

/// The most by which rounding may move the image of a direction under a caller's matrix, as a share of its length.
const MOST_ROUNDING: f64 = 1.0 / 16.0;

impl LtcLobe {
    /// Creates the lobe that resembles the GGX lobe of light that arrives with `incidence`, with
    /// height-correlated masking and shadowing.
    pub fn new<F: Fresnel>(ggx: Ggx, fresnel: F, incidence: Incidence) -> Self {
        let (lobe, reflected) = GgxSurfaces::new(ggx, fresnel, incidence).lobes();
        Self::from_lanes(incidence.normal, &lobe, reflected)
    }

    /// The lobe of a single lane, with this normal and ρ = `reflected`.
    #[inline(always)]
    pub(crate) fn from_lanes(normal: Direction, lane: &LtcLobes<f32>, reflected: f32) -> Self {
        Self {
            normal,
            reflected,
            amplitude: lane.amplitude,
            rows: [lane.across.into(), lane.third.into()],
            shear: lane.shear,
        }
    }

    /// Creates a lobe from a caller's own table, for light that arrives with `incidence`. The directions of
    /// its matrix are the tangent towards ω_i, the bitangent and the normal, as with [Heitz et al. 2016].
    ///
    /// `inverse` holds the elements m₁₁, m₁₃, m₃₁ and m₃₃ of M⁻¹, whose middle element is 1 and whose others
    /// are zero. `magnitude` is the integral of the lobe over the whole sphere, in \[0, 1\], before it is
    /// clipped at the horizon.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `magnitude` is outside \[0, 1\] or NaN. [`Error::Matrix`] if an element is above
    /// 10⁶ or NaN, or if the determinant m₁₁m₃₃ − m₁₃m₃₁ is not at least 10⁻⁶ and 10⁻⁴ of the product of the
    /// lengths of both rows. Also if rounding to single precision may move M⁻¹ω by more than 1/16 of its length, as it
    /// may if the greatest singular value is 10⁵ times the least: values near the peak would be wrong by more than 30 %.
    ///
    /// ```
    /// use stochastic_light_culling::{Direction, Incidence, Lobe, LtcLobe, glam::Vec3};
    ///
    /// // The identity is Lambert's lobe.
    /// let incidence = Incidence::head_on(Direction::Z);
    /// let chalk = LtcLobe::with_matrix([1.0, 0.0, 0.0, 1.0], 0.9, incidence)?;
    /// assert!((chalk.value(Vec3::Z) - 0.9 / std::f32::consts::PI).abs() < 1e-6);
    /// assert!(LtcLobe::with_matrix([1.0, 1.0, 1.0, 1.0], 0.9, incidence).is_err());
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn with_matrix(
        inverse: [f32; 4],
        magnitude: f32,
        incidence: Incidence,
    ) -> Result<Self, Error> {
        let magnitude = number_in("magnitude", magnitude, "in [0, 1]", 0.0..=1.0)?;
        let matrix = Matrix::of(inverse);
        let determinant = matrix.determinant;
        let in_range = inverse.iter().all(|element| element.abs() <= 1e6);
        if !(in_range && determinant >= 1e-6 && determinant >= 1e-4 * matrix.lengths()) {
            return Err(Error::Matrix {
                quantity: "M⁻¹",
                element: determinant as f32,
                valid: "it must be invertible, with elements up to 10⁶; determinant",
            });
        }
        let rounding = matrix.rounding();
        if rounding > MOST_ROUNDING {
            return Err(Error::Matrix {
                quantity: "M⁻¹",
                element: rounding as f32,
                valid: "in single precision it must move no image of a direction by more than 1/16 of its length",
            });
        }
        let normal = incidence.normal.into();
        let plane = IncidencePlane::of(normal, incidence.incoming.into());
        if plane.cosine <= 0.0 {
            let lobe = LtcLobes::empty(normal);
            return Ok(Self::from_lanes(incidence.normal, &lobe, 0.0));
        }
        let magnitude = f64::from(magnitude);
        let reflected = 0.5 * magnitude * matrix.twice_share_above([0.0, 1.0]);
        let frame = [plane.across.cross(plane.normal), plane.normal];
        let lobe = matrix.lobes(normal, frame, magnitude);
        Ok(Self::from_lanes(incidence.normal, &lobe, reflected as f32))
    }

    /// The surface normal n.
    #[must_use]
    pub fn normal(&self) -> Direction {
        self.normal
    }

    /// The share ρ in \[0, 1\] of the light that is reflected, but for the error of the table: the integral
    /// of the value over the hemisphere. Zero if the lobe is empty.
    #[must_use]
    pub fn reflected(&self) -> f32 {
        self.reflected
    }

    /// The matrix M⁻¹ from world space to the space of the cosine, such that the value above the surface is
    /// [`amplitude`](Self::amplitude)·max(z, 0)/‖M⁻¹ω‖⁴ with z = (M⁻¹ω)₃.
    ///
    /// Its second row is the cross product of the third and the first.
    #[must_use]
    pub fn inverse_matrix(&self) -> Mat3 {
        let [first, second, third] = self.lanes().rows();
        let [x, y, z] = [first, second, third].map(|row| Vec3::from(Vector3::<f32>::narrow(row)));
        Mat3::from_cols(x, y, z).transpose()
    }

    /// The factor of z/‖M⁻¹ω‖⁴ in the value, in sr⁻¹. Zero if the lobe is empty.
    #[must_use]
    pub fn amplitude(&self) -> f32 {
        self.amplitude
    }

    /// The lobe as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> LtcLobes<f32> {
        LtcLobes {
            normal: self.normal.into(),
            amplitude: self.amplitude,
            across: self.rows[0].into(),
            third: self.rows[1].into(),
            shear: self.shear,
        }
    }
}

impl Lobe for LtcLobe {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        self.lanes().value(outgoing.into())
    }

    fn maximum_within(&self, cap: &Cap) -> f32 {
        self.lanes().majorant(&cap.lanes()).greatest
    }

    fn horizon_normal(&self) -> Option<Direction> {
        Some(self.normal)
    }

    #[inline]
    fn is_empty(&self) -> bool {
        self.amplitude <= 0.0
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        padded(self.lanes().numbers())
    }

    fn numbers_in_use() -> usize {
        LTC_NUMBERS
    }

    fn has_more_than_numbers() -> bool {
        false
    }

    #[inline(always)]
    fn horizon_in_lanes<N: Single>(numbers: &LobeNumbers<N>) -> Option<Vector3<N>> {
        let [x, y, z, ..] = *numbers;
        Some(Vector3::new(x, y, z))
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        LtcLobes::from_numbers(numbers).value(outgoing)
    }

    #[inline(always)]
    fn is_fainter_in_lanes<N: Single>(
        numbers: &LobeNumbers<N>,
        flux: N,
        way: Vector3<N>,
        length_squared: N,
        least: N,
    ) -> Option<N::Mask> {
        let lobes = LtcLobes::from_numbers(numbers);
        Some(lobes.is_fainter(flux, way, length_squared, least))
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        LtcLobes::from_numbers(numbers).majorant(cap)
    }
}
