//! The formulas of [`AnisotropicGgxLobe`](super::AnisotropicGgxLobe), for one lobe in each lane.

use super::anisotropic_ggx::{anisotropic_masking_root, anisotropic_ndf, ndf_of_scaled_sine};
use super::ggx::masking_root;
use super::ggx_majorant::GgxMembers;
use super::{Caps, FIRST_NUMBERS, GgxLobes, LobeNumbers, Majorant, MaskingShadowing};
use crate::num::{Matrix3, Single, UNIT_ROUNDOFF, Vector3};

/// α_x and α_y, and the rotation from world space to the frame of the surface.
#[inline(always)]
pub(super) fn surface_from_numbers<N: Single>(numbers: &LobeNumbers<N>) -> ([N; 2], Matrix3<N>) {
    let (first, rest) = numbers.split_at(FIRST_NUMBERS);
    let world = Matrix3::new(
        Vector3::new(rest[1], rest[2], rest[3]),
        Vector3::new(rest[4], rest[5], rest[6]),
        Vector3::new(first[0], first[1], first[2]),
    );
    ([first[8], rest[0]], world.transpose())
}

/// f·max(μ_o, 0) towards `outgoing`, for the parts of a lobe. `to_surface_frame` is the rotation from world
/// space to (tangent, bitangent, n), and `reflectance` is F as a function of cosθ_h.
#[inline(always)]
pub(super) fn anisotropic_value<N: Single, G: MaskingShadowing>(
    at_any_azimuth: &GgxLobes<N>,
    roughness: [N; 2],
    to_surface_frame: Matrix3<N>,
    reflectance: impl FnOnce(N) -> N,
    outgoing: Vector3<N>,
) -> N {
    at_any_azimuth.value_with::<G>(
        reflectance,
        outgoing,
        #[inline(always)]
        |half_vector| anisotropic_ndf(roughness, to_surface_frame * half_vector),
        #[inline(always)]
        |_| anisotropic_masking_root(roughness, to_surface_frame * outgoing),
    )
}

/// The majorant of [`anisotropic_value`] within a cap.
///
/// The root √(α_x²x² + α_y²y² + z²) is that of an isotropic surface whose roughness is between α_x and α_y. Its square is
/// the lesser one, and of the difference the share of the rougher axis in x² + y².
#[inline(always)]
pub(super) fn anisotropic_majorant<N: Single, G: MaskingShadowing>(
    at_any_azimuth: &GgxLobes<N>,
    roughness: [N; 2],
    to_surface_frame: Matrix3<N>,
    reflectance: impl Fn(N) -> N,
    cap: &Caps<N>,
) -> Majorant<N> {
    let members = GgxMembers::one(at_any_azimuth);
    members.majorant_of_one::<G>(
        reflectance,
        #[inline(always)]
        |half_vectors| {
            // Where α is 1, u is as good as zero.
            let squares = roughness.map(
                #[inline(always)]
                |alpha| {
                    let rest = alpha.one_minus() * (alpha + 1.0);
                    alpha * alpha / rest.max(rest.splat(UNIT_ROUNDOFF))
                },
            );
            let sine = half_vectors.least_scaled_sine(&to_surface_frame, squares);
            let greatest = ndf_of_scaled_sine(roughness, sine);
            let filtered = roughness.map(
                #[inline(always)]
                |alpha| members.filtered(alpha * alpha, half_vectors).sqrt(),
            );
            let typical = anisotropic_ndf(filtered, to_surface_frame * half_vectors.middle());
            Majorant { greatest, typical }
        },
        #[inline(always)]
        |outgoing_cosine| {
            masking_root(
                least_roughness(roughness, &to_surface_frame, cap),
                outgoing_cosine,
            )
        },
        cap,
    )
}

/// A lower bound of √(α_x²x² + α_y²y²)/√(x² + y²) for the directions (x, y, z) of a cap.
#[inline(always)]
fn least_roughness<N: Single>(
    [along, across]: [N; 2],
    to_surface_frame: &Matrix3<N>,
    cap: &Caps<N>,
) -> N {
    let Vector3 { x, y, .. } = *to_surface_frame * cap.axis;
    let zero = x.zero();
    let rougher = N::select(along.gt(across), x, y);
    let length = (x * x + y * y).sqrt();
    let least = (rougher.abs() - cap.chord).max(zero) / (length + cap.chord);
    let (less, more) = (along.min(across), along.max(across));
    (less * less + (more - less) * (more + less) * (least * least)).sqrt()
}
