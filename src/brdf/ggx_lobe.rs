use core::marker::PhantomData;

use glam::{Mat3, Vec3};

use super::fresnel::LEAST_REFLECTED;
use super::{Fresnel, Ggx, HeightCorrelated, Lobe, MaskingShadowing, NoFresnel, Separable};
use crate::{Direction, math};

/// The GGX microfacet lobe for light from one direction [Tokuyoshi & Harada 2017, Eq. 6].
///
/// f·max(μ_o, 0) = F(ω_i·ω_h) G2(μ, μ_o) D(ω_h·n)/(4μ), with the [`Fresnel`] factor `F` and the
/// [`MaskingShadowing`] function `G`. Empty, zero in every direction, if the light arrives from
/// below the surface or along it.
///
/// ```
/// use stochastic_light_culling::{Direction, Ggx, GgxLobe, Lobe, Schlick, glam::Vec3};
///
/// let gold = GgxLobe::new(
///     Ggx::new(0.2)?,
///     Schlick::new(0.9)?,
///     Direction::Z,
///     Direction::new(Vec3::new(-1.0, 0.0, 1.0))?,
/// );
/// let mirror = Vec3::from(Direction::new(Vec3::new(1.0, 0.0, 1.0))?);
/// assert!(gold.value(mirror) > gold.value(Vec3::Z));
/// assert!(gold.separable().value(mirror) < gold.value(mirror));
///
/// assert_eq!(gold.ggx().roughness(), 0.2);
/// assert!((gold.incident_cosine() - 0.5_f32.sqrt()).abs() < 1e-6);
/// // F is 1 where the reflection grazes the surface, but there it is masked.
/// assert!(0.9 <= gold.max_reflected() && gold.max_reflected() < gold.max_fresnel());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        from = "crate::unchecked::GgxLobe<F>",
        bound(
            serialize = "F: serde::Serialize",
            deserialize = "F: Fresnel + serde::Deserialize<'de>"
        )
    )
)]
pub struct GgxLobe<F = NoFresnel, G = HeightCorrelated> {
    ggx: Ggx,
    fresnel: F,
    normal: Direction,
    incoming: Direction,
    /// μ; zero if the light arrives from below.
    #[cfg_attr(feature = "serde", serde(skip))]
    incident_cosine: f32,
    /// √(kμ² + α²)
    #[cfg_attr(feature = "serde", serde(skip))]
    incident_root: f32,
    #[cfg_attr(feature = "serde", serde(skip))]
    masking_shadowing: PhantomData<G>,
}

impl<F: Fresnel> GgxLobe<F> {
    /// The lobe, with height-correlated masking and shadowing, of a surface with unit `normal` = n
    /// for light from the unit direction `incoming` = ω_i. Both point away from the surface.
    pub fn new(ggx: Ggx, fresnel: F, normal: Direction, incoming: Direction) -> Self {
        let cosine = math::exact_dot(*normal, *incoming);
        // Above the surface by less than an f32 can say is still above it.
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
            incident_root: ggx.masking_root(incident_cosine),
            masking_shadowing: PhantomData,
        }
    }

    /// The same lobe with [`Separable`] masking and shadowing.
    pub fn separable(self) -> GgxLobe<F, Separable> {
        self.with_masking()
    }
}

impl<F: Fresnel, G> GgxLobe<F, G> {
    /// The same lobe with masking and shadowing of another form.
    pub(crate) fn with_masking<H>(self) -> GgxLobe<F, H> {
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

    /// The microsurface.
    pub fn ggx(&self) -> Ggx {
        self.ggx
    }

    /// n, the surface normal.
    pub fn normal(&self) -> Direction {
        self.normal
    }

    /// ω_i, the direction that light comes from.
    pub fn incoming(&self) -> Direction {
        self.incoming
    }

    /// μ = ω_i·n in \[0, 1\]; 0 means that the lobe is empty.
    pub fn incident_cosine(&self) -> f32 {
        self.incident_cosine
    }

    /// F_max, the largest Fresnel factor that any direction above the surface can have, rounded up.
    ///
    /// The half angle reaches ½ arccos μ + π/4, whose cosine is μ/√(2(1 + √(1−μ²))). The source's
    /// √((1 − √(1−μ²))/2) cancels at grazing incidence, and √(1−μ²) at normal incidence, where the sine
    /// of a cross product does not [Tokuyoshi & Harada 2017, supplemental, below Eq. 2].
    pub fn max_fresnel(&self) -> f32 {
        self.max_fresnel_at(self.incident_sine())
    }

    /// F_max, given √(1 − μ²).
    #[inline]
    pub(crate) fn max_fresnel_at(&self, incident_sine: f32) -> f32 {
        let smallest_cosine = self.incident_cosine / math::sqrt(2.0 * (1.0 + incident_sine));
        self.fresnel.maximum(smallest_cosine)
    }

    /// The lobe with `root` in the place of √(kμ² + α²) for ω_i, and none other.
    pub(super) fn with_incident_root(self, root: f32) -> Self {
        Self {
            incident_root: root,
            ..self
        }
    }

    /// F.
    pub(crate) fn fresnel(&self) -> &F {
        &self.fresnel
    }

    /// √(kμ² + α²), the root of G1(μ).
    pub(crate) fn incident_root(&self) -> f32 {
        self.incident_root
    }

    /// √(1 − μ²) ≥ 0.
    pub(crate) fn incident_sine(&self) -> f32 {
        math::length(math::cross(*self.normal, *self.incoming)) as f32
    }

    /// G1(μ)/(4μ) = 1/(2(μ + √(kμ² + α²))), which stays finite at grazing incidence.
    pub(crate) fn masking_over_four_cosines(&self) -> f32 {
        0.5 / (self.incident_cosine + self.incident_root)
    }

    /// ω_u = 2μn − ω_i, the direction of mirror reflection.
    ///
    /// Reckoned in `f64`, since at small α an angular error φ costs a bound the share φ/(2α).
    pub fn mirror_direction(&self) -> Direction {
        self.incoming.mirrored(self.normal)
    }

    /// The rotation \[ω_u, ω_v, ω_w\] from the lobe's own axes to world space: ω_w = unit(ω_u × n)
    /// is perpendicular to the plane of incidence, and ω_v = ω_w × ω_u
    /// [Tokuyoshi & Harada 2017, Eq. 14].
    ///
    /// At normal incidence, where any such frame will do, an arbitrary one.
    pub fn rotation(&self) -> Mat3 {
        let [u, w] = self.mirror_and_across().0;
        Mat3::from_cols(u, w.cross(u), w)
    }

    /// ω_u and ω_w, and √(1 − μ²).
    #[inline]
    pub(crate) fn mirror_and_across(&self) -> ([Vec3; 2], f32) {
        let u = *self.mirror_direction();
        // ω_u × n = n × ω_i, without the rounding of ω_u.
        let cross = math::cross(*self.normal, *self.incoming);
        let length = math::length(cross);
        let w = if length > 0.0 {
            // The reciprocal of the least length there is, 2⁻²⁹⁸, is finite.
            let over = 1.0 / length;
            Vec3::from_array(cross.map(|x| (x * over) as f32))
        } else {
            u.any_orthonormal_vector()
        };
        ([u, w], length as f32)
    }
}

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// An upper bound of F·G2/G1(μ) over all directions above the surface: as F_max is of F alone,
    /// and never above that.
    ///
    /// F is largest where ω_o grazes the surface, and there G2 vanishes. At an angle θ_o to the normal
    /// the half angle is at most ½(θ_i + θ_o), so F, being quasi-convex, is at most the larger of F(1)
    /// and F(cos ½(θ_i + θ_o)), which rises with θ_o; G2 falls with it. On a segment of θ_o the product
    /// is then at most that F at its end times that G2 at its start. For Schlick's factor with
    /// F0 ≥ 0.02 eight segments come within 10 % of the maximum on average, and 30 % at worst.
    pub fn max_reflected(&self) -> f32 {
        /// cosθ at the start, and cos ½θ and sin ½θ at the end: 0°, 40°, 55°, 65°, 72°, 78°, 83°, 87°, 90°.
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
        let most = self.max_fresnel();
        let head_on = self.fresnel.reflectance(1.0);
        if head_on >= most {
            return most;
        }
        let half_cosine = math::sqrt(0.5 * (1.0 + self.incident_cosine));
        let half_sine = 0.5 * self.incident_sine() / half_cosine;
        let unmasked = 1.0 / self.masking_over_four_cosines();
        // Without an early end, so that the segments can share vector registers.
        let products = SEGMENTS.map(|[start, end_half_cosine, end_half_sine]| {
            let cosine = half_cosine * end_half_cosine - half_sine * end_half_sine;
            let cosine = (cosine - 16.0 * math::UNIT_ROUNDOFF).max(0.0);
            let masking = G::over_four_incident_cosines(
                self.incident_cosine,
                self.incident_root,
                start,
                self.ggx.masking_root(start),
            );
            self.fresnel.reflectance(cosine).max(head_on) * (masking * unmasked)
        });
        let joint = products.into_iter().fold(0.0, f32::max);
        // Not `clamp`, which panics where a Fresnel factor of the caller's own makes `most` NaN.
        math::round_up(joint, 96)
            .max(LEAST_REFLECTED.min(most))
            .min(most)
    }
}

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// The lobe's value with another NDF, of the half vector, and another root, of μ_o.
    #[inline]
    pub(super) fn value_with(
        &self,
        outgoing: Vec3,
        ndf: impl FnOnce(Vec3) -> f32,
        masking_root: impl FnOnce(f32) -> f32,
    ) -> f32 {
        let outgoing_cosine = self.normal.dot(outgoing);
        if !(outgoing_cosine > 0.0 && self.incident_cosine > 0.0) {
            return 0.0;
        }
        let half_vector = *self.incoming + outgoing;
        // ω_i·ω_h is half the length of ω_i + ω_o.
        let half_angle_cosine = (0.5 * math::sqrt(half_vector.length_squared())).min(1.0);
        self.fresnel.reflectance(half_angle_cosine)
            * ndf(half_vector)
            * G::over_four_incident_cosines(
                self.incident_cosine,
                self.incident_root,
                outgoing_cosine,
                masking_root(outgoing_cosine),
            )
    }
}

impl<F: Fresnel, G: MaskingShadowing> Lobe for GgxLobe<F, G> {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        self.value_with(
            outgoing,
            |half_vector| self.ggx.ndf_at(half_vector, *self.normal),
            |outgoing_cosine| self.ggx.masking_root(outgoing_cosine),
        )
    }
}
