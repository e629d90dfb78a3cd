use core::f64::consts::FRAC_1_PI;

use glam::{Mat3, Vec3};

use super::ltc_lobes::LtcLobes;
use super::{Cap, Caps, Fresnel, Ggx, Incidence, Lobe, LobeNumbers, Majorant, ltc_table, padded};
use crate::base::{Direction, Error, number_in};
use crate::num::{Single, Vector3, exact_dot, sqrt_f64};

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
/// n_A for F = 1 and f_A for F = (1 − cosθ_h)⁵ [Xia et al. 2023, Eq. 4]. For [`Schlick`](crate::Schlick) this
/// is exact, and for [`NoFresnel`](crate::NoFresnel) it is n_A. A dielectric or a conductor is taken as
/// Schlick's factor with its reflectance at normal and at grazing incidence.
///
/// Part of a cosine lies below the horizon, where no surface reflects. H ≥ ½ is the share above, (1 + c)/2,
/// where c is the cosine of the angle between the third axis and Mᵀn. The source lets the rest go. The
/// division by H keeps the energy for F = 1 within 1 % of that of GGX.
///
/// # Error
///
/// One matrix and one factor ρ cannot follow a Fresnel factor over the lobe. The relative L2 error for F = 1
/// is below 6 % up to 45° and 10 % at 60°, and grows to a half at grazing incidence. For F0 = 0.04 it is up to
/// 18 % at 45° and 43 % at 60°. The bound follows the lobe, so roulette is unbiased for the picture that these
/// lobes make. That picture differs from GGX's, in linear values up to 1, by a root mean square of 0.005 at most
/// for a plane below one light (α = 0.3, seen from 45°), and by 0.005 to 0.015 where a metal lights metals, which
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
/// The value takes 0.6 of the time of a [`GgxLobe`](crate::GgxLobe)'s with Schlick's factor, and half of it in
/// lanes. Direction, roulette and sum are the same for both, so that a light of a list takes 0.75 to 0.8 of the
/// time (Zen 4, AVX-512). But the lobe takes five times as long to make, 0.1 µs. So it pays at lights that are
/// made once. At receivers, which are made anew in each frame, and whose lobe is evaluated for accepted lights
/// alone, it pays from about 150 lights in the list of a pixel on.
///
/// # Edges
///
/// The lobe is empty, that is, zero in every direction, if the light arrives from below the surface or at
/// grazing incidence, μ ≤ 0. For α → 0 it becomes as narrow as the GGX lobe does.
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
    /// The first and the third row of M⁻¹, in world space. The second is their cross product.
    rows: [Vec3; 2],
}

impl LtcLobe {
    /// Creates the lobe that resembles the GGX lobe of light that arrives with `incidence`, with
    /// height-correlated masking and shadowing.
    pub fn new<F: Fresnel>(ggx: Ggx, fresnel: F, incidence: Incidence) -> Self {
        let plane = Plane::of(incidence);
        let [mu, sine] = [plane.cosine, plane.sine];
        if mu <= 0.0 {
            return Self::empty(incidence.normal);
        }
        let alpha = f64::from(ggx.roughness());
        let root = sqrt_f64(alpha);
        let [a, b, d, e] = ltc_table::matrix(root, sine / sqrt_f64(1.0 + mu));
        // tan(θ/2) and tan(δ/2), tanδ = α tanθ.
        let slope = alpha * sine;
        let half_delta = slope / (mu + sqrt_f64(mu * mu + slope * slope));
        let half_incidence = sine / (1.0 + mu);
        let [n_a, f_a] = ltc_table::albedos(root, 0.5 * (half_incidence + half_delta));
        let [head_on, grazing] = [1.0, 0.0].map(|cosine| f64::from(fresnel.reflectance(cosine)));
        let reflected = head_on * n_a + (grazing - head_on) * f_a;
        // A caller's factor may be NaN.
        let reflected = if reflected > 0.0 {
            reflected.min(1.0)
        } else {
            0.0
        };
        let elements = [a, alpha * b, alpha * d, alpha * e];
        // Above ω_u in the plane of incidence n has these coordinates.
        let above = share_above(elements, [-sine, mu]);
        Self::of_plane(
            incidence.normal,
            [plane.mirror.cross(plane.across), plane.mirror],
            elements,
            [reflected, above],
        )
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
    /// lengths of both rows.
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
        let elements = inverse.map(f64::from);
        let [m11, m13, m31, m33] = elements;
        let determinant = m11 * m33 - m13 * m31;
        let lengths = sqrt_f64((m11 * m11 + m13 * m13) * (m31 * m31 + m33 * m33));
        let in_range = inverse.iter().all(|element| element.abs() <= 1e6);
        if !(in_range && determinant >= 1e-6 && determinant >= 1e-4 * lengths) {
            return Err(Error::Matrix {
                quantity: "M⁻¹",
                element: determinant as f32,
                valid: "it must be invertible, with elements up to 10⁶; determinant",
            });
        }
        let plane = Plane::of(incidence);
        if plane.cosine <= 0.0 {
            return Ok(Self::empty(incidence.normal));
        }
        let normal = plane.normal;
        let above = share_above(elements, [0.0, 1.0]);
        let reflected = f64::from(magnitude) * above;
        Ok(Self::of_plane(
            incidence.normal,
            [plane.across.cross(normal), normal],
            elements,
            [reflected, above],
        ))
    }

    fn empty(normal: Direction) -> Self {
        Self {
            normal,
            reflected: 0.0,
            amplitude: 0.0,
            rows: [Vec3::X, Vec3::Z],
        }
    }

    /// From the elements m₁₁, m₁₃, m₃₁ and m₃₃ of M⁻¹, whose middle element is 1, in the frame of two unit
    /// vectors in the plane of incidence.
    ///
    /// M⁻¹ is multiplied by a factor, which changes the lobe by its third power alone, so that the second row
    /// becomes the cross product of the others: 1/(m₁₁m₃₃ − m₁₃m₃₁).
    fn of_plane(
        normal: Direction,
        [x, z]: [Vector3<f64>; 2],
        [m11, m13, m31, m33]: [f64; 4],
        [reflected, above]: [f64; 2],
    ) -> Self {
        let factor = 1.0 / (m11 * m33 - m13 * m31);
        let row = |along: f64, up: f64| {
            let row = Vector3::combine([(factor * along, x), (factor * up, z)]);
            Vec3::from(Vector3::<f32>::narrow(row))
        };
        let amplitude = reflected / above * FRAC_1_PI * factor * factor;
        Self {
            normal,
            reflected: reflected as f32,
            amplitude: amplitude as f32,
            rows: [row(m11, m13), row(m31, m33)],
        }
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
        let lanes = self.lanes();
        let rows = [lanes.first, lanes.second(), lanes.third].map(Vec3::from);
        Mat3::from_cols(rows[0], rows[1], rows[2]).transpose()
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
            first: self.rows[0].into(),
            third: self.rows[1].into(),
        }
    }
}

/// The share of a transformed cosine above the horizon, for the elements of M⁻¹ and the coordinates of n.
///
/// M⁻¹ maps the upper hemisphere to {ω : (Mᵀn)·ω > 0}, and the cosine of a lune integrates to π(1 + c)/2,
/// where c is the third component of the unit vector along Mᵀn. Both components below are those of Mᵀn times
/// the determinant. They do not vanish together.
fn share_above([m11, m13, m31, m33]: [f64; 4], [x, z]: [f64; 2]) -> f64 {
    let (first, third) = (x * m33 - z * m31, z * m11 - x * m13);
    let length = sqrt_f64(first * first + third * third);
    // Caller's lobes may lie almost wholly below the horizon.
    (0.5 * (1.0 + third / length)).max(1e-6)
}

/// The plane of incidence in `f64`.
struct Plane {
    normal: Vector3<f64>,
    /// ω_u
    mirror: Vector3<f64>,
    /// ω_u × n, of unit length
    across: Vector3<f64>,
    /// μ
    cosine: f64,
    /// √(1 − μ²)
    sine: f64,
}

impl Plane {
    fn of(incidence: Incidence) -> Self {
        let [normal, incoming] = [incidence.normal, incidence.incoming].map(Vector3::<f32>::from);
        let over = [normal, incoming].map(|v| 1.0 / v.widen().length());
        let (n, w) = (normal.widen() * over[0], incoming.widen() * over[1]);
        let cross = n.cross(w);
        let sine = cross.length();
        let across = if sine > 0.0 {
            cross * (1.0 / sine)
        } else {
            // At normal incidence the plane is arbitrary.
            let (any, _) = normal.any_orthonormal_pair();
            let perpendicular = n.cross(any.widen());
            perpendicular * (1.0 / perpendicular.length())
        };
        Self {
            normal: n,
            mirror: Vector3::combine([(2.0 * n.dot(w), n), (-1.0, w)]),
            across,
            cosine: exact_dot(normal, incoming) * (over[0] * over[1]),
            sine,
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
        let (n, [x, z]) = (self.normal, self.rows);
        padded([n.x, n.y, n.z, self.amplitude, x.x, x.y, x.z, z.x, z.y, z.z])
    }

    fn numbers_in_use() -> usize {
        10
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
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        LtcLobes::from_numbers(numbers).majorant(cap)
    }
}
