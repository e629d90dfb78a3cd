use glam::Vec3;

use super::anisotropic_ggx::anisotropic_masking_root;
use super::anisotropic_lobes::{anisotropic_majorant, anisotropic_value};
use super::facets::Facets;
use super::fresnel_of_one::{fresnel_in_lanes, fresnel_of_one, reflectance};
use super::ggx_lobes::GgxLobes;
use super::{
    AnisotropicGgx, Cap, Caps, FIRST_NUMBERS, Fresnel, GgxLobe, HeightCorrelated, Incidence, Lobe,
    LobeNumbers, Majorant, MaskingShadowing, NoFresnel, Separable,
};
use crate::base::{Direction, Error};
use crate::num::{Matrix3, Real, Single, Vector3};

/// The lobe of an [`AnisotropicGgx`] microsurface for light from one direction [Heitz 2014].
///
/// Its value is f·max(μ_o, 0) = F(ω_i·ω_h) G2(ω_i, ω_o) D(ω_h)/(4μ), with the [`Fresnel`] factor `F` and the
/// [`MaskingShadowing`] function `G`. It is empty, that is, zero in every direction, if the light arrives
/// from below the surface or at grazing incidence, μ ≤ 0.
///
/// ```
/// use stochastic_light_culling::{
///     AnisotropicGgx, AnisotropicGgxLobe, Bounded, Direction, Incidence, Lobe, Schlick, glam::Vec3,
/// };
///
/// let incoming = Direction::new(Vec3::new(-1.0, 0.0, 1.0))?;
/// let incidence = Incidence { normal: Direction::Z, incoming };
/// let (brushed, tangent) = (AnisotropicGgx::new(0.05, 0.3)?, Direction::X);
/// let lobe = AnisotropicGgxLobe::new(brushed, Schlick::new(0.9)?, incidence, tangent)?;
///
/// // The surface is smooth along the tangent, so the highlight is wider across it.
/// let towards = |x, y| Direction::new(Vec3::new(x, y, 1.0)).map(Vec3::from);
/// assert!(lobe.value(towards(1.0, 0.3)?) > lobe.value(towards(1.3, 0.0)?));
///
/// assert_eq!((lobe.ggx(), lobe.tangent()), (brushed, tangent));
/// assert!(lobe.max_reflected() <= 1.0 && lobe.incident_cosine() > 0.7);
/// assert!(lobe.separable().value(towards(1.0, 0.3)?) <= lobe.value(towards(1.0, 0.3)?));
///
/// let semi_axes = lobe.unit_bound().semi_axes();
/// assert!(semi_axes.max_element() > 3.0 * semi_axes.min_element());
/// // A tangent parallel to the normal gives no frame.
/// assert!(AnisotropicGgxLobe::new(brushed, Schlick::new(0.9)?, incidence, Direction::Z).is_err());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnisotropicGgxLobe<F = NoFresnel, G = HeightCorrelated> {
    ggx: AnisotropicGgx,
    /// Unchanged, as the caller passed it.
    tangent: Direction,
    /// The tangent's part perpendicular to n, normalised, and the bitangent.
    tangent_axes: [Vec3; 2],
    /// What does not depend on the azimuth of ω_o: an isotropic lobe with the root of this lobe for ω_i. It
    /// has the smaller roughness, whose G2 is at least that of any azimuth.
    at_any_azimuth: GgxLobe<F, G>,
}

impl<F: Fresnel> AnisotropicGgxLobe<F> {
    /// Creates the lobe of light that arrives with `incidence`, with height-correlated masking and shadowing.
    ///
    /// The surface has the roughness α_x along the part of `tangent` that is perpendicular to n. The sign of
    /// `tangent` does not matter.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `tangent` is parallel to the normal to within 10⁻⁶ radians, where its
    /// perpendicular part is mostly rounding.
    pub fn new(
        ggx: AnisotropicGgx,
        fresnel: F,
        incidence: Incidence,
        tangent: Direction,
    ) -> Result<Self, Error> {
        let Incidence { normal, incoming } = incidence;
        let SurfaceAxes { axes, sine } = SurfaceAxes::new(normal.into(), tangent.into());
        if sine < 1e-6 {
            return Err(Error::Vector {
                quantity: "tangent",
                value: *tangent,
                valid: "not parallel to the normal",
            });
        }
        let isotropic = GgxLobe::new(ggx.smoother(), fresnel, incidence);
        let at_any_azimuth = if ggx.is_isotropic() {
            isotropic
        } else {
            let [x, y, z] = axes.map(|axis| axis.dot(unit(incoming.into())));
            let roughness = ggx.roughness().map(f64::from);
            let root = anisotropic_masking_root(roughness, Vector3::new(x, y, z));
            isotropic.with_incident_root(root as f32)
        };
        let [along, across, _] = axes.map(|axis| Vec3::from(Vector3::narrow(axis)));
        Ok(Self {
            ggx,
            tangent,
            tangent_axes: [along, across],
            at_any_azimuth,
        })
    }

    /// The same lobe with [`Separable`] masking and shadowing.
    pub fn separable(self) -> AnisotropicGgxLobe<F, Separable> {
        self.with_masking()
    }
}

impl<F: Fresnel, G> AnisotropicGgxLobe<F, G> {
    /// The same lobe with masking and shadowing of the form `H`.
    pub fn with_masking<H>(self) -> AnisotropicGgxLobe<F, H> {
        let Self {
            ggx,
            tangent,
            tangent_axes,
            at_any_azimuth,
        } = self;
        AnisotropicGgxLobe {
            ggx,
            tangent,
            tangent_axes,
            at_any_azimuth: at_any_azimuth.with_masking(),
        }
    }

    /// The GGX microsurface.
    pub fn ggx(&self) -> AnisotropicGgx {
        self.ggx
    }

    /// The surface normal, and the direction that light comes from.
    pub fn incidence(&self) -> Incidence {
        Incidence {
            normal: self.normal(),
            incoming: self.incoming(),
        }
    }

    /// The surface normal n.
    pub fn normal(&self) -> Direction {
        self.at_any_azimuth.normal()
    }

    /// The tangent that was passed to [`new`](AnisotropicGgxLobe::new); not necessarily perpendicular to n.
    pub fn tangent(&self) -> Direction {
        self.tangent
    }

    /// The direction ω_i that light comes from.
    pub fn incoming(&self) -> Direction {
        self.at_any_azimuth.incoming()
    }

    /// The cosine μ = ω_i·n in \[0, 1\] of the angle of incidence. Zero if the lobe is empty.
    pub fn incident_cosine(&self) -> f32 {
        self.at_any_azimuth.incident_cosine()
    }

    /// The mirror direction ω_u = 2μn − ω_i.
    pub fn mirror_direction(&self) -> Direction {
        self.at_any_azimuth.mirror_direction()
    }

    /// The Fresnel factor F.
    pub fn fresnel(&self) -> &F {
        self.at_any_azimuth.fresnel()
    }

    /// An isotropic lobe with the same normal, ω_i, F and G1(ω_i), whose G2 is nowhere below that of this
    /// lobe. For α_x = α_y it is the same lobe.
    pub(crate) fn at_any_azimuth(&self) -> &GgxLobe<F, G> {
        &self.at_any_azimuth
    }
}

impl<F: Fresnel, G> AnisotropicGgxLobe<F, G> {
    /// Its microsurface.
    #[inline(always)]
    pub(super) fn facets(&self) -> Facets<f32> {
        let [along, across] = self.tangent_axes;
        let world = Matrix3::new(along.into(), across.into(), self.normal().into());
        Facets {
            roughness: self.ggx.roughness(),
            to_surface_frame: world.transpose(),
        }
    }
}

/// The tangent frame of an anisotropic surface.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceAxes<D> {
    /// The unit vectors along the tangent's part perpendicular to n, the bitangent n × tangent, and n.
    pub axes: [Vector3<D>; 3],
    /// The sine of the angle between the tangent and n. Where it is nearly zero the frame is meaningless.
    pub sine: D,
}

impl<D: Real<Element = f64>> SurfaceAxes<D> {
    #[inline(always)]
    pub fn new<N: Single<Double = D>>(normal: Vector3<N>, tangent: Vector3<N>) -> Self {
        let across = normal.widen().cross(tangent.widen());
        let sine = across.length();
        let across = across / sine;
        let normal = unit(normal);
        Self {
            axes: [across.cross(normal), across, normal],
            sine,
        }
    }
}

/// The vector of unit length along `direction`, in double precision.
#[inline(always)]
pub(crate) fn unit<N: Single>(direction: Vector3<N>) -> Vector3<N::Double> {
    let direction = direction.widen();
    direction / direction.length()
}

impl<F: Fresnel, G: MaskingShadowing> AnisotropicGgxLobe<F, G> {
    /// An upper bound of F·G2/G1(ω_i) over all directions above the surface; see
    /// [`GgxLobe::max_reflected`].
    pub fn max_reflected(&self) -> f32 {
        self.at_any_azimuth.max_reflected()
    }
}

impl<F: Fresnel, G: MaskingShadowing> Lobe for AnisotropicGgxLobe<F, G> {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        anisotropic_value::<f32, G>(
            &self.at_any_azimuth.lanes(),
            &self.facets(),
            #[inline(always)]
            |cosine| self.fresnel().reflectance(cosine),
            outgoing.into(),
        )
    }

    /// Needs of F that it is quasi-convex, and of G2 what [`MaskingShadowing`] says.
    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        let majorant = anisotropic_majorant::<f32, G>(
            &self.at_any_azimuth.lanes(),
            &self.facets(),
            &fresnel_of_one(self.fresnel()),
            &cap.lanes(),
        );
        majorant.greatest
    }

    fn horizon_normal(&self) -> Option<Direction> {
        Some(self.normal())
    }

    #[inline]
    fn is_empty(&self) -> bool {
        self.at_any_azimuth.is_empty()
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        let [along, across] = self.ggx.roughness();
        let [t, b] = self.tangent_axes;
        let mut numbers = [0.0; FIRST_NUMBERS + 16];
        let (first, rest) = numbers.split_at_mut(FIRST_NUMBERS);
        first.copy_from_slice(&self.at_any_azimuth.numbers_with_roughness(along));
        rest[..7].copy_from_slice(&[across, t.x, t.y, t.z, b.x, b.y, b.z]);
        numbers
    }

    fn numbers_in_use() -> usize {
        FIRST_NUMBERS + 7
    }

    fn has_more_than_numbers() -> bool {
        GgxLobe::<F, G>::has_more_than_numbers()
    }

    #[inline(always)]
    fn horizon_in_lanes<N: Single>(numbers: &LobeNumbers<N>) -> Option<Vector3<N>> {
        GgxLobe::<F, G>::horizon_in_lanes(numbers)
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        let (lobes, parameters) = GgxLobes::from_numbers(numbers);
        anisotropic_value::<N, G>(
            &lobes,
            &Facets::from_numbers(numbers),
            #[inline(always)]
            |cosine| {
                let fresnel_of = |i| lobe_of(i).map(|lobe| *lobe.fresnel());
                reflectance(parameters, fresnel_of, cosine)
            },
            outgoing,
        )
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let (lobes, parameters) = GgxLobes::from_numbers(numbers);
        let fresnel = fresnel_in_lanes(
            parameters,
            #[inline(always)]
            |i| lobe_of(i).map(|lobe| *lobe.fresnel()),
        );
        anisotropic_majorant::<N, G>(&lobes, &Facets::from_numbers(numbers), &fresnel, cap)
    }
}
