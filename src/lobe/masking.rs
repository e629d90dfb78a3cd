use super::Ggx;
use super::ggx::masking_root;
use crate::num::Single;

/// Smith's masking-shadowing function G2: the share of facets that are both lit and visible.
///
/// It is a type parameter of a lobe, so that lights are culled with the form that an engine shades with.
///
/// # What every form must satisfy
///
/// - G2 is at most G1(μ_i).
/// - G2/(4μ_i) grows with μ_o, for a fixed roughness, and falls with the root of ω_o, for a fixed μ_o.
/// - G2/(4μ_i) falls with μ_i and with the root of ω_i, each while the other is fixed.
///
/// "Grows" and "falls" include that it does not change. The bounds of a lobe rely on the first two, those of many
/// lobes at once ([`LobeFamily`](crate::LobeFamily)) on all. Let Λ_i and Λ_o be the roots. The two forms of this
/// crate divide 1 by 2(Λ_i + μ_i Λ_o/μ_o) and by (μ_i + Λ_i)(1 + Λ_o/μ_o): both sums grow with μ_i, Λ_i and Λ_o, and
/// Λ_o/μ_o = √(k + α²/μ_o²) falls with μ_o.
///
/// ```
/// use stochastic_light_culling::{Ggx, HeightCorrelated, MaskingShadowing, Separable};
///
/// let (rough, lit, seen) = (Ggx::new(0.8)?, 0.3, 0.2);
/// let together = HeightCorrelated::masking_shadowing(rough, lit, seen);
/// let independent = Separable::masking_shadowing(rough, lit, seen);
/// assert!(independent < together && together < rough.masking(lit));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
pub trait MaskingShadowing: Copy + 'static {
    /// Whether G2 is nowhere above the [height-correlated](HeightCorrelated) form. The table of the
    /// [tight bound](crate::Tight) is valid only for such forms. For others that strategy returns the
    /// [triaxial bound](crate::Triaxial).
    const IS_AT_MOST_HEIGHT_CORRELATED: bool = false;

    /// G2(μ_i, μ_o)/(4μ_i): the factor of a microfacet BRDF times μ_o besides F and D.
    ///
    /// The cosines are in (0, 1]; the result must be finite even close to grazing. The roots are √(kμ² + α²)
    /// of the two cosines, or √(α_x²x² + α_y²y² + z²) of a direction (x, y, z) on an anisotropic surface.
    ///
    /// ```
    /// use stochastic_light_culling::MaskingShadowing;
    ///
    /// /// No facet shadows another: G2 = G1(μ_i).
    /// #[derive(Clone, Copy)]
    /// struct MaskedAlone;
    ///
    /// impl MaskingShadowing for MaskedAlone {
    ///     fn over_four_incident_cosines(cosine: f32, root: f32, _: f32, _: f32) -> f32 {
    ///         0.5 / (cosine + root)
    ///     }
    /// }
    /// assert_eq!(MaskedAlone::over_four_incident_cosines(1.0, 1.0, 1.0, 1.0), 0.25);
    /// ```
    fn over_four_incident_cosines(
        incident_cosine: f32,
        incident_root: f32,
        outgoing_cosine: f32,
        outgoing_root: f32,
    ) -> f32;

    /// Computes [`over_four_incident_cosines`](Self::over_four_incident_cosines) in each lane.
    #[doc(hidden)]
    #[inline(always)]
    fn over_four_incident_cosines_in_lanes<N: Single>(
        incident_cosine: N,
        incident_root: N,
        outgoing_cosine: N,
        outgoing_root: N,
    ) -> N {
        N::per_lane(
            [
                incident_cosine,
                incident_root,
                outgoing_cosine,
                outgoing_root,
            ],
            #[inline(always)]
            |_,
             [
                incident_cosine,
                incident_root,
                outgoing_cosine,
                outgoing_root,
            ]| {
                Self::over_four_incident_cosines(
                    incident_cosine,
                    incident_root,
                    outgoing_cosine,
                    outgoing_root,
                )
            },
        )
    }

    /// G2 in \[0, 1\] for the cosines μ_i = ω_i·n and μ_o = ω_o·n. Zero if either is not positive, or NaN.
    #[must_use]
    fn masking_shadowing(ggx: Ggx, incident_cosine: f32, outgoing_cosine: f32) -> f32 {
        if !(incident_cosine > 0.0 && outgoing_cosine > 0.0) {
            return 0.0;
        }
        4.0 * incident_cosine
            * Self::over_four_incident_cosines(
                incident_cosine,
                masking_root(ggx.roughness(), incident_cosine),
                outgoing_cosine,
                masking_root(ggx.roughness(), outgoing_cosine),
            )
    }
}

/// Height-correlated masking and shadowing,
/// G2 = 2μ_iμ_o/(μ_o√(kμ_i²+α²) + μ_i√(kμ_o²+α²)) [Heitz 2014, Eq. 99].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HeightCorrelated;

impl MaskingShadowing for HeightCorrelated {
    const IS_AT_MOST_HEIGHT_CORRELATED: bool = true;

    #[inline]
    fn over_four_incident_cosines(
        incident_cosine: f32,
        incident_root: f32,
        outgoing_cosine: f32,
        outgoing_root: f32,
    ) -> f32 {
        Self::over_four_incident_cosines_in_lanes(
            incident_cosine,
            incident_root,
            outgoing_cosine,
            outgoing_root,
        )
    }

    #[inline(always)]
    fn over_four_incident_cosines_in_lanes<N: Single>(
        incident_cosine: N,
        incident_root: N,
        outgoing_cosine: N,
        outgoing_root: N,
    ) -> N {
        let sum = outgoing_cosine * incident_root + incident_cosine * outgoing_root;
        // Both terms can underflow at once, where the numerator does not.
        outgoing_cosine * 0.5 / sum.max(sum.splat(f32::MIN_POSITIVE))
    }
}

/// Independent masking and shadowing, G2 = G1(μ_i) G1(μ_o) [Walter et al. 2007, Eq. 23].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Separable;

impl MaskingShadowing for Separable {
    const IS_AT_MOST_HEIGHT_CORRELATED: bool = true;

    #[inline]
    fn over_four_incident_cosines(
        incident_cosine: f32,
        incident_root: f32,
        outgoing_cosine: f32,
        outgoing_root: f32,
    ) -> f32 {
        Self::over_four_incident_cosines_in_lanes(
            incident_cosine,
            incident_root,
            outgoing_cosine,
            outgoing_root,
        )
    }

    #[inline(always)]
    fn over_four_incident_cosines_in_lanes<N: Single>(
        incident_cosine: N,
        incident_root: N,
        outgoing_cosine: N,
        outgoing_root: N,
    ) -> N {
        outgoing_cosine / ((incident_cosine + incident_root) * (outgoing_cosine + outgoing_root))
    }
}
