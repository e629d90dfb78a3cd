use core::marker::PhantomData;

use glam::{Mat3, Vec3};

use super::fresnel::LEAST_REFLECTED;
use super::ggx::{masking_root, ndf_at};
use super::{
    Fresnel, Ggx, HeightCorrelated, Incidence, Lobe, LobeNumbers, MaskingShadowing, NoFresnel,
    Separable, padded,
};
use crate::base::{Direction, mirrored};
use crate::num::{Quad, Real, Single, UNIT_ROUNDOFF, Vector3, exact_dot};

/// Pays for the rounding of the half angle's cosine at the end of a segment, in units of u.
const END_COSINE_ROUNDINGS: f32 = 16.0;
/// Pays for the rounding of F·G2/G1(μ).
const MAX_REFLECTED_ROUNDINGS: u16 = 96;

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
    incident_root: f32,
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
}

/// The reflectance of the Fresnel factor in each lane: computed in lanes if that is possible, and else by the
/// factor that `fresnel_of` gives for a lane.
#[inline(always)]
pub(super) fn reflectance<N: Single, F: Fresnel>(
    parameters: [N; 2],
    fresnel_of: impl Fn(usize) -> Option<F>,
    cosine: N,
) -> N {
    F::reflectance_of_parameters(parameters, cosine).unwrap_or_else(
        #[inline(always)]
        || {
            N::per_lane(
                [cosine],
                #[inline(always)]
                |i, [cosine]| fresnel_of(i).map_or(0.0, |fresnel| fresnel.reflectance(cosine)),
            )
        },
    )
}

/// A [`GgxLobe`] in each lane, without its Fresnel factor and its masking function.
#[derive(Clone, Copy)]
pub(crate) struct GgxLobes<N> {
    pub normal: Vector3<N>,
    pub incoming: Vector3<N>,
    /// μ
    pub incident_cosine: N,
    /// The root √(kμ² + α²) of G1(μ)
    pub incident_root: N,
    /// α
    pub roughness: N,
}

/// The plane of incidence.
#[derive(Clone, Copy)]
pub(crate) struct PlaneOfIncidence<N> {
    /// ω_u
    pub mirror: Vector3<N>,
    /// ω_w, perpendicular to the plane
    pub across: Vector3<N>,
    /// √(1 − μ²)
    pub sine: N,
}

impl<N: Single> GgxLobes<N> {
    #[inline(always)]
    pub fn from_quads(quads: [Quad<N>; 3]) -> Self {
        let [
            [n_x, n_y, n_z, cosine],
            [w_x, w_y, w_z, root],
            [roughness, ..],
        ] = quads;
        Self {
            normal: Vector3::new(n_x, n_y, n_z),
            incoming: Vector3::new(w_x, w_y, w_z),
            incident_cosine: cosine,
            incident_root: root,
            roughness,
        }
    }

    /// The lobes, and the parameters of their Fresnel factors.
    #[inline(always)]
    pub fn from_numbers(numbers: &LobeNumbers<N>) -> (Self, [N; 2]) {
        let [
            n_x,
            n_y,
            n_z,
            cosine,
            w_x,
            w_y,
            w_z,
            root,
            roughness,
            first,
            second,
            ..,
        ] = *numbers;
        let lobes = Self {
            normal: Vector3::new(n_x, n_y, n_z),
            incoming: Vector3::new(w_x, w_y, w_z),
            incident_cosine: cosine,
            incident_root: root,
            roughness,
        };
        (lobes, [first, second])
    }

    /// ω_u
    #[inline(always)]
    pub fn mirror_direction(&self) -> Vector3<N> {
        mirrored(self.incoming, self.normal)
    }

    /// √(1 − μ²) ≥ 0
    #[inline(always)]
    pub fn incident_sine(&self) -> N {
        let cross = self.normal.widen().cross(self.incoming.widen());
        N::narrow(cross.length())
    }

    #[inline(always)]
    pub fn plane_of_incidence(&self) -> PlaneOfIncidence<N> {
        let mirror = self.mirror_direction();
        // Equals ω_u × n, without the rounding of ω_u.
        let cross = self.normal.widen().cross(self.incoming.widen());
        let length = cross.length();
        let is_oblique = length.is_positive();
        // Finite, since the smallest positive length is 2⁻²⁹⁸.
        let across = Vector3::narrow(cross * (length.splat(1.0) / length));
        let across = if N::is_known_false(!is_oblique) {
            across
        } else {
            Vector3::select(is_oblique, across, mirror.any_orthonormal_pair().1)
        };
        PlaneOfIncidence {
            mirror,
            across,
            sine: N::narrow(length),
        }
    }

    /// G1(μ)/(4μ) = 1/(2(μ + √(kμ² + α²))), which stays finite at grazing incidence.
    #[inline(always)]
    pub fn masking_over_four_cosines(&self) -> N {
        self.incident_cosine.splat(0.5) / (self.incident_cosine + self.incident_root)
    }

    /// F_max; see [`GgxLobe::max_fresnel`].
    #[inline(always)]
    pub fn max_fresnel<F: Fresnel>(&self, fresnels: &[F]) -> N {
        self.max_fresnel_at(self.incident_sine(), fresnels)
    }

    /// F_max for √(1 − μ²) = `incident_sine`.
    #[inline(always)]
    pub fn max_fresnel_at<F: Fresnel>(&self, incident_sine: N, fresnels: &[F]) -> N {
        let smallest_cosine = self.incident_cosine / ((incident_sine + 1.0) * 2.0).sqrt();
        F::maximum_in_lanes(fresnels, smallest_cosine)
    }

    /// An upper bound of F·G2/G1(μ); see [`GgxLobe::max_reflected`].
    #[inline(always)]
    pub fn max_reflected<F: Fresnel, G: MaskingShadowing>(&self, fresnels: &[F]) -> N {
        /// cosθ_o at the start of a segment, and cos ½θ_o and sin ½θ_o at its end. The ends are 0°, 40°, 55°,
        /// 65°, 72°, 78°, 83°, 87° and 90°.
        const SEGMENTS: [[f32; 3]; 8] = [
            [1.0, 0.939_692_6, 0.342_020_15],
            [0.766_044_5, 0.887_010_8, 0.461_748_63],
            [0.573_576_4, 0.843_391_4, 0.537_299_6],
            [0.422_618_27, 0.809_017, 0.587_785_24],
            [0.309_017, 0.777_146, 0.629_320_4],
            [0.207_911_7, 0.748_955_7, 0.662_620_07],
            [0.121_869_34, 0.725_374_4, 0.688_354_6],
            [0.052_335_96, 0.707_106_77, 0.707_106_77],
        ];
        let sine = self.incident_sine();
        let most = self.max_fresnel_at(sine, fresnels);
        let (zero, one) = (most.zero(), most.splat(1.0));
        let head_on = F::reflectance_in_lanes(fresnels, one);
        let rises = !most.le(head_on);
        if N::is_known_false(rises) {
            return most;
        }
        let half_cosine = ((self.incident_cosine + 1.0) * 0.5).sqrt();
        let half_sine = sine * 0.5 / half_cosine;
        let unmasked = one / self.masking_over_four_cosines();
        let mut joint = zero;
        for [start, end_half_cosine, end_half_sine] in SEGMENTS {
            let cosine = half_cosine * end_half_cosine - half_sine * end_half_sine;
            let cosine = (cosine - END_COSINE_ROUNDINGS * UNIT_ROUNDOFF).max(zero);
            let start = most.splat(start);
            let masking = G::over_four_incident_cosines_in_lanes(
                self.incident_cosine,
                self.incident_root,
                start,
                masking_root(self.roughness, start),
            );
            let reflected = F::reflectance_in_lanes(fresnels, cosine).max(head_on);
            joint = (reflected * (masking * unmasked)).max(joint);
        }
        // The second operand is taken where a caller's Fresnel factor makes `most` NaN.
        let least = most.min(most.splat(LEAST_REFLECTED));
        let joint = most.min(joint.round_up(MAX_REFLECTED_ROUNDINGS).max(least));
        N::select(rises, joint, most)
    }

    /// f·max(μ_o, 0) towards `outgoing`, where `reflectance` is F as a function of cosθ_h.
    #[inline(always)]
    pub fn value<G: MaskingShadowing>(
        &self,
        reflectance: impl FnOnce(N) -> N,
        outgoing: Vector3<N>,
    ) -> N {
        self.value_with::<G>(
            reflectance,
            outgoing,
            #[inline(always)]
            |half_vector| ndf_at(self.roughness, half_vector, self.normal),
            #[inline(always)]
            |outgoing_cosine| masking_root(self.roughness, outgoing_cosine),
        )
    }

    /// The value with another NDF, a function of the half vector, and another root, a function of μ_o.
    #[inline(always)]
    pub(super) fn value_with<G: MaskingShadowing>(
        &self,
        reflectance: impl FnOnce(N) -> N,
        outgoing: Vector3<N>,
        ndf: impl FnOnce(Vector3<N>) -> N,
        masking_root: impl FnOnce(N) -> N,
    ) -> N {
        let outgoing_cosine = self.normal.dot(outgoing);
        let zero = outgoing_cosine.zero();
        let is_lit = outgoing_cosine.is_positive() & self.incident_cosine.is_positive();
        if N::is_known_false(is_lit) {
            return zero;
        }
        let half_vector = self.incoming + outgoing;
        // ω_i·ω_h = ½‖ω_i + ω_o‖.
        let half_angle_cosine = (half_vector.length() * 0.5).min(zero.splat(1.0));
        let value = reflectance(half_angle_cosine)
            * ndf(half_vector)
            * G::over_four_incident_cosines_in_lanes(
                self.incident_cosine,
                self.incident_root,
                outgoing_cosine,
                masking_root(outgoing_cosine),
            );
        N::select(is_lit, value, zero)
    }
}
