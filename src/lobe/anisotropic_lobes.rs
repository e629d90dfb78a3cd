//! The formulas of [`AnisotropicGgxLobe`](super::AnisotropicGgxLobe), for one lobe in each lane.

use super::anisotropic_ggx::{anisotropic_masking_root, anisotropic_ndf, ndf_of_scaled_sine};
use super::ggx::masking_root;
use super::ggx_majorant::GgxMembers;
use super::half_vectors::HalfVectors;
use super::{Caps, FIRST_NUMBERS, GgxLobes, LobeNumbers, Majorant, MaskingShadowing};
use crate::num::{Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3};

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
    is_gentle: bool,
    reflectance: impl Fn(N) -> N,
    cap: &Caps<N>,
) -> Majorant<N> {
    let members = GgxMembers::one(at_any_azimuth);
    members.majorant_of_one::<G>(
        is_gentle,
        reflectance,
        #[inline(always)]
        |half_vectors| {
            let sine = least_scaled_sine(half_vectors, &to_surface_frame, roughness, cap.must_nest);
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

/// A lower bound of √(x²(1/α_x² − 1) + y²(1/α_y² − 1)) for the unit vectors (x, y, z) along the half vectors: sharp unless it
/// must nest.
#[inline(always)]
fn least_scaled_sine<N: Single>(
    half_vectors: &HalfVectors<N>,
    to_surface_frame: &Matrix3<N>,
    roughness: [N; 2],
    must_nest: bool,
) -> N {
    let rests = roughness.map(
        #[inline(always)]
        |alpha| alpha.one_minus() * (alpha + 1.0),
    );
    let factors = [
        rests[0].sqrt() / roughness[0],
        rests[1].sqrt() / roughness[1],
    ];
    let sine = half_vectors.least_scaled_sine(to_surface_frame, factors);
    if must_nest {
        return sine;
    }
    // Where α is 1, u is as good as zero.
    let square = |alpha: N, rest: N| alpha * alpha / Real::max(rest, rest.splat(UNIT_ROUNDOFF));
    let squares = [
        square(roughness[0], rests[0]),
        square(roughness[1], rests[1]),
    ];
    let sharp = half_vectors.sharp_scaled_sine(to_surface_frame, squares);
    Real::max(sharp, sine)
}

/// A lower bound of √(α_x²x² + α_y²y²)/√(x² + y²) for the directions (x, y, z) of a cap. It nests, since |x| − c and
/// √(x² + y²) + c do.
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
