//! The formulas of [`AnisotropicGgxLobe`](super::AnisotropicGgxLobe), for one lobe in each lane.

use super::anisotropic_ggx::{anisotropic_masking_root, anisotropic_ndf, ndf_of_scaled_sine};
use super::ggx_majorant::GgxMembers;
use super::{Caps, FIRST_NUMBERS, GgxLobes, LobeNumbers, Majorant, MaskingShadowing};
use crate::num::{Matrix3, Single, Vector3};

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
/// The root √(α_x²x² + α_y²y² + z²) is least where each coordinate is.
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
            let factors = roughness.map(
                #[inline(always)]
                |alpha| (alpha.one_minus() * (alpha + 1.0)).sqrt() / alpha,
            );
            let sine = half_vectors.least_scaled_sine(&to_surface_frame, factors);
            let greatest = ndf_of_scaled_sine(roughness, sine);
            let filtered = roughness.map(
                #[inline(always)]
                |alpha| members.filtered(alpha * alpha, half_vectors).sqrt(),
            );
            let typical = anisotropic_ndf(filtered, to_surface_frame * half_vectors.middle());
            Majorant { greatest, typical }
        },
        #[inline(always)]
        |_| {
            let along = |axis: Vector3<N>| cap.least_magnitude(axis);
            let [x, y] = [
                to_surface_frame.transpose().x,
                to_surface_frame.transpose().y,
            ]
            .map(along);
            let least = Vector3::new(x, y, cap.least_cosine(at_any_azimuth.normal));
            anisotropic_masking_root(roughness, least)
        },
        cap,
    )
}
