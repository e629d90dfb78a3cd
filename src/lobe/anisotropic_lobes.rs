//! The formulas of [`AnisotropicGgxLobe`](super::AnisotropicGgxLobe), for one lobe in each lane.

use super::facets::Facets;
use super::fresnel_of_one::FresnelOfOne;
use super::ggx::masking_root;
use super::ggx_majorant::GgxMembers;
use super::half_vectors::HalfVectors;
use super::{Caps, GgxLobes, Majorant, MaskingShadowing};
use crate::num::{Real, Single, Vector3};

/// f·max(μ_o, 0) towards `outgoing`, for the parts of a lobe. `reflectance` is F as a function of cosθ_h.
#[inline(always)]
pub(super) fn anisotropic_value<N: Single, G: MaskingShadowing>(
    at_any_azimuth: &GgxLobes<N>,
    facets: &Facets<N>,
    reflectance: impl FnOnce(N) -> N,
    outgoing: Vector3<N>,
) -> N {
    at_any_azimuth.value_with::<G>(
        reflectance,
        outgoing,
        #[inline(always)]
        |half_vector| facets.ndf(half_vector),
        #[inline(always)]
        |_| facets.masking_root(outgoing),
    )
}

/// The majorant of [`anisotropic_value`] within a cap.
///
/// The root √(α_x²x² + α_y²y² + z²) is that of an isotropic surface whose roughness is between α_x and α_y. Its square is
/// the lesser one, and of the difference the share of the rougher axis in x² + y².
#[inline(always)]
pub(super) fn anisotropic_majorant<N: Single, G: MaskingShadowing>(
    at_any_azimuth: &GgxLobes<N>,
    facets: &Facets<N>,
    fresnel: &FresnelOfOne<N, impl Fn(N) -> N>,
    cap: &Caps<N>,
) -> Majorant<N> {
    let members = GgxMembers::one(at_any_azimuth);
    members.majorant_of_one::<G>(
        fresnel,
        #[inline(always)]
        || *facets,
        #[inline(always)]
        |half_vectors| {
            let sine = least_scaled_sine(half_vectors, facets, cap.must_nest);
            let filtered = Facets {
                roughness: facets.roughness.map(
                    #[inline(always)]
                    |alpha| members.filtered(alpha * alpha, half_vectors).sqrt(),
                ),
                ..*facets
            };
            Majorant {
                greatest: facets.ndf_of_scaled_sine(sine),
                typical: filtered.ndf(half_vectors.middle),
            }
        },
        #[inline(always)]
        |outgoing_cosine| masking_root(least_roughness(facets, cap), outgoing_cosine),
        cap,
    )
}

/// A lower bound of √(x²(1/α_x² − 1) + y²(1/α_y² − 1)) for the unit vectors (x, y, z) along the half vectors: sharp unless it
/// must nest.
#[inline(always)]
fn least_scaled_sine<N: Single>(
    half_vectors: &HalfVectors<N>,
    facets: &Facets<N>,
    must_nest: bool,
) -> N {
    let ([along, across], rests) = (facets.roughness, facets.rests());
    let factors = [rests[0].sqrt() / along, rests[1].sqrt() / across];
    let sine = half_vectors.least_scaled_sine(&facets.to_surface_frame, factors);
    if must_nest {
        return sine;
    }
    let squares = facets.inverse_squared_scales();
    let sharp = half_vectors.sharp_scaled_sine(&facets.to_surface_frame, squares);
    Real::max(sharp, sine)
}

/// A lower bound of √(α_x²x² + α_y²y²)/√(x² + y²) for the directions (x, y, z) of a cap. It nests, since |x| − c and
/// √(x² + y²) + c do.
#[inline(always)]
fn least_roughness<N: Single>(facets: &Facets<N>, cap: &Caps<N>) -> N {
    let [along, across] = facets.roughness;
    let Vector3 { x, y, .. } = facets.to_surface_frame * cap.axis;
    let zero = x.zero();
    let rougher = N::select(along.gt(across), x, y);
    let length = (x * x + y * y).sqrt();
    let least = (rougher.abs() - cap.chord).max(zero) / (length + cap.chord);
    let (less, more) = (along.min(across), along.max(across));
    (less * less + (more - less) * (more + less) * (least * least)).sqrt()
}
