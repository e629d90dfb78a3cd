use core::marker::PhantomData;

use glam::{Mat3, Vec3};

use super::fresnel_of_one::{fresnel_in_lanes, fresnel_of_one, reflectance};
use super::ggx::masking_root;
use super::ggx_lobes::GgxLobes;
use super::{
    Cap, Caps, Fresnel, Ggx, HeightCorrelated, Incidence, Lobe, LobeNumbers, Majorant,
    MaskingShadowing, NoFresnel, Separable, padded,
};
use crate::base::Direction;
use crate::num::{Quad, Single, Vector3, exact_dot};

/// The GGX microfacet lobe for light from one direction [Tokuyoshi & Harada 2017, Eq. 6].
///
/// Its value is f·max(μ_o, 0) = F(ω_i·ω_h) G2(μ, μ_o) D(ω_h·n)/(4μ), with the [`Fresnel`] factor `F` and the
/// [`MaskingShadowing`] function `G`. It is empty, that is, zero in every direction, if the light arrives
/// from below the surface or at grazing incidence, μ ≤ 0.
///
/// ```
/// use stochastic_light_culling::{Direction, Ggx, GgxLobe, Incidence, Lobe, Schlick, glam::Vec3};
///
/// let incidence = Incidence {
///     normal: Direction::Z,
///     incoming: Direction::new(Vec3::new(-1.0, 0.0, 1.0))?,
/// };
/// let gold = GgxLobe::new(Ggx::new(0.2)?, Schlick::new(0.9)?, incidence);
/// let mirror = Vec3::from(Direction::new(Vec3::new(1.0, 0.0, 1.0))?);
/// assert!(gold.value(mirror) > gold.value(Vec3::Z));
/// assert!(gold.separable().value(mirror) < gold.value(mirror));
///
/// assert_eq!(gold.ggx().roughness(), 0.2);
/// assert!((gold.incident_cosine() - 0.5_f32.sqrt()).abs() < 1e-6);
/// // F is 1 at grazing incidence, where it is masked.
/// assert!(0.9 <= gold.max_reflected() && gold.max_reflected() < gold.max_fresnel());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GgxLobe<F = NoFresnel, G = HeightCorrelated> {
    ggx: Ggx,
    fresnel: F,
    normal: Direction,
    incoming: Direction,
    /// μ, or zero if the light arrives from below.
    incident_cosine: f32,
    /// √(kμ² + α²)
    pub(super) incident_root: f32,
    masking_shadowing: PhantomData<G>,
}

impl<F: Fresnel> GgxLobe<F> {
    /// Creates the lobe of light that arrives with `incidence`, with height-correlated masking and shadowing.
    pub fn new(ggx: Ggx, fresnel: F, incidence: Incidence) -> Self {
        let Incidence { normal, incoming } = incidence;
        let cosine = exact_dot(Vector3::from(normal), incoming.into());
        // A positive cosine stays positive where it underflows.
        let incident_cosine = if cosine > 0.0 {
            (cosine as f32).clamp(f32::MIN_POSITIVE, 1.0)
        } else {
            0.0
        };
        Self {
            ggx,
            fresnel,
            normal,
            incoming,
            incident_cosine,
            incident_root: masking_root(ggx.roughness(), incident_cosine),
            masking_shadowing: PhantomData,
        }
    }

    /// The same lobe with [`Separable`] masking and shadowing.
    pub fn separable(self) -> GgxLobe<F, Separable> {
        self.with_masking()
    }
}

impl<F: Fresnel, G> GgxLobe<F, G> {
    /// The same lobe with masking and shadowing of the form `H`.
    pub fn with_masking<H>(self) -> GgxLobe<F, H> {
        let Self {
            ggx,
            fresnel,
            normal,
            incoming,
            incident_cosine,
            incident_root,
            ..
        } = self;
        GgxLobe {
            ggx,
            fresnel,
            normal,
            incoming,
            incident_cosine,
            incident_root,
            masking_shadowing: PhantomData,
        }
    }

    /// The GGX microsurface.
    pub fn ggx(&self) -> Ggx {
        self.ggx
    }

    /// The surface normal, and the direction that light comes from.
    pub fn incidence(&self) -> Incidence {
        Incidence {
            normal: self.normal,
            incoming: self.incoming,
        }
    }

    /// The surface normal n.
    pub fn normal(&self) -> Direction {
        self.normal
    }

    /// The direction ω_i that light comes from.
    pub fn incoming(&self) -> Direction {
        self.incoming
    }

    /// The cosine μ = ω_i·n in \[0, 1\] of the angle of incidence. Zero if the lobe is empty.
    pub fn incident_cosine(&self) -> f32 {
        self.incident_cosine
    }

    /// The Fresnel factor F.
    pub fn fresnel(&self) -> &F {
        &self.fresnel
    }

    /// The largest Fresnel factor F_max of any direction above the surface, rounded up, in \[10⁻³⁰, 1\].
    ///
    /// The half angle is at most ½ arccos μ + π/4 [Tokuyoshi & Harada 2017, supplemental, below Eq. 2]. Its
    /// cosine is computed as μ/√(2(1 + √(1−μ²))), since the source's √((1 − √(1−μ²))/2) cancels at grazing
    /// incidence. √(1−μ²), which cancels at normal incidence, is the length of a cross product.
    pub fn max_fresnel(&self) -> f32 {
        self.lanes().max_fresnel(&[self.fresnel])
    }

    /// The mirror direction ω_u = 2μn − ω_i.
    ///
    /// It is computed in `f64`, since for an angular error φ a bound must grow by the share φ/(2α).
    pub fn mirror_direction(&self) -> Direction {
        self.incoming.mirrored(self.normal)
    }

    /// The rotation \[ω_u, ω_v, ω_w\] from the axes of the lobe to world space
    /// [Tokuyoshi & Harada 2017, Eq. 14].
    ///
    /// ω_w is the unit vector along ω_u × n, perpendicular to the plane of incidence, and ω_v = ω_w × ω_u. At
    /// normal incidence ω_w is an arbitrary perpendicular.
    pub fn rotation(&self) -> Mat3 {
        let plane = self.lanes().plane_of_incidence();
        let [u, w] = [plane.mirror, plane.across].map(Vec3::from);
        Mat3::from_cols(u, w.cross(u), w)
    }

    /// Replaces the root √(kμ² + α²) of ω_i by `root`.
    pub(super) fn with_incident_root(self, root: f32) -> Self {
        Self {
            incident_root: root,
            ..self
        }
    }

    /// The numbers that [`GgxLobes::from_quads`] takes.
    #[inline]
    pub(crate) fn quads(&self) -> [Quad<f32>; 3] {
        let (n, w) = (self.normal, self.incoming);
        [
            [n.x, n.y, n.z, self.incident_cosine],
            [w.x, w.y, w.z, self.incident_root],
            [self.ggx.roughness(), 0.0, 0.0, 0.0],
        ]
    }

    /// The numbers that [`GgxLobes::from_numbers`] takes, with this roughness.
    #[inline]
    pub(super) fn numbers_with_roughness(&self, roughness: f32) -> [f32; 11] {
        let (n, w) = (self.normal, self.incoming);
        let (cosine, root) = (self.incident_cosine, self.incident_root);
        let [first, second] = self.fresnel.parameters();
        [
            n.x, n.y, n.z, cosine, w.x, w.y, w.z, root, roughness, first, second,
        ]
    }

    /// The lobe as a single lane.
    #[inline(always)]
    pub(crate) fn lanes(&self) -> GgxLobes<f32> {
        GgxLobes::from_quads(self.quads())
    }
}

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// An upper bound of F·G2/G1(μ) over all directions above the surface. It is never above F_max, the bound
    /// of F alone.
    ///
    /// F is largest where ω_o is at grazing, but there G2 vanishes. At an angle θ_o to the normal the half
    /// angle is at most ½(θ_i + θ_o). So F, which is quasi-convex, is at most the larger of F(1) and F(cos
    /// ½(θ_i + θ_o)). This larger one does not fall with θ_o, and G2 does not rise. So on a segment of θ_o
    /// the product is at most the former at its end times the latter at its start. With eight segments the
    /// bound is within 10 % of the maximum on average, and within 30 % at worst, for Schlick's factor with
    /// F0 ≥ 0.02.
    pub fn max_reflected(&self) -> f32 {
        self.lanes().max_reflected::<F, G>(&[self.fresnel])
    }
}

impl<F: Fresnel, G: MaskingShadowing> Lobe for GgxLobe<F, G> {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        self.lanes().value::<G>(
            #[inline(always)]
            |cosine| self.fresnel.reflectance(cosine),
            outgoing.into(),
        )
    }

    /// Needs of F that it is quasi-convex, and of G2 what [`MaskingShadowing`] says.
    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        let fresnel = fresnel_of_one(&self.fresnel);
        let majorant = self.lanes().majorant::<G>(&fresnel, &cap.lanes());
        majorant.greatest
    }

    fn horizon_normal(&self) -> Option<Direction> {
        Some(self.normal)
    }

    #[inline]
    fn is_empty(&self) -> bool {
        self.incident_cosine <= 0.0
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        padded(self.numbers_with_roughness(self.ggx.roughness()))
    }

    fn numbers_in_use() -> usize {
        11
    }

    fn has_more_than_numbers() -> bool {
        F::reflectance_of_parameters([0.0; 2], 1.0).is_none()
    }

    #[inline(always)]
    fn horizon_in_lanes<N: Single>(numbers: &LobeNumbers<N>) -> Option<Vector3<N>> {
        let [x, y, z, ..] = *numbers;
        Some(Vector3::new(x, y, z))
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        let (lobes, parameters) = GgxLobes::from_numbers(numbers);
        lobes.value::<G>(
            #[inline(always)]
            |cosine| {
                let fresnel_of = |i| lobe_of(i).map(|lobe| lobe.fresnel);
                reflectance(parameters, fresnel_of, cosine)
            },
            outgoing,
        )
    }

    #[inline(always)]
    fn is_fainter_in_lanes<N: Single>(
        numbers: &LobeNumbers<N>,
        flux: N,
        way: Vector3<N>,
        length_squared: N,
        least: N,
    ) -> Option<N::Mask> {
        let (lobes, _) = GgxLobes::from_numbers(numbers);
        Some(lobes.is_fainter(flux, way, length_squared, least))
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
            |i| lobe_of(i).map(|lobe| lobe.fresnel),
        );
        lobes.majorant::<G>(&fresnel, cap)
    }

    #[inline(always)]
    fn mean_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        axis: Vector3<N>,
        sharpness: N,
    ) -> N {
        let (lobes, parameters) = GgxLobes::from_numbers(numbers);
        lobes.mean_over_gaussians(
            #[inline(always)]
            |cosine| {
                let fresnel_of = |i| lobe_of(i).map(|lobe| lobe.fresnel);
                reflectance(parameters, fresnel_of, cosine)
            },
            axis,
            sharpness,
        )
    }
}
