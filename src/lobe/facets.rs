//! An anisotropic microsurface in each lane.

use super::anisotropic_ggx::{anisotropic_masking_root, anisotropic_ndf, ndf_of_scaled_sine};
use super::{FIRST_NUMBERS, LobeNumbers};
use crate::num::{Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3};

/// Facets that are turned by two roughnesses.
#[derive(Clone, Copy)]
pub(super) struct Facets<N> {
    /// α_x and α_y
    pub roughness: [N; 2],
    /// The rotation from world space to (tangent, bitangent, n).
    pub to_surface_frame: Matrix3<N>,
}

impl<N: Single> Facets<N> {
    /// Those of lobes by their numbers.
    #[inline(always)]
    pub fn from_numbers(numbers: &LobeNumbers<N>) -> Self {
        let (first, rest) = numbers.split_at(FIRST_NUMBERS);
        let world = Matrix3::new(
            Vector3::new(rest[1], rest[2], rest[3]),
            Vector3::new(rest[4], rest[5], rest[6]),
            Vector3::new(first[0], first[1], first[2]),
        );
        Self {
            roughness: [first[8], rest[0]],
            to_surface_frame: world.transpose(),
        }
    }

    /// Those of an isotropic surface, in any frame around `normal`.
    #[inline(always)]
    pub fn isotropic(roughness: N, normal: Vector3<N>) -> Self {
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        Self {
            roughness: [roughness; 2],
            to_surface_frame: Matrix3::new(tangent, bitangent, normal).transpose(),
        }
    }

    /// D at a half vector of any length.
    #[inline(always)]
    pub fn ndf(&self, half_vector: Vector3<N>) -> N {
        anisotropic_ndf(self.roughness, self.to_surface_frame * half_vector)
    }

    /// D where (x √(1/α_x² − 1), y √(1/α_y² − 1)) has this length for the unit half vector (x, y, z).
    #[inline(always)]
    pub fn ndf_of_scaled_sine(&self, scaled_sine: N) -> N {
        ndf_of_scaled_sine(self.roughness, scaled_sine)
    }

    /// The root of Smith's masking functions.
    #[inline(always)]
    pub fn masking_root(&self, direction: Vector3<N>) -> N {
        anisotropic_masking_root(self.roughness, self.to_surface_frame * direction)
    }

    /// 1 − α_x² and 1 − α_y²
    #[inline(always)]
    pub fn rests(&self) -> [N; 2] {
        let [along, across] = self.roughness;
        [
            along.one_minus() * (along + 1.0),
            across.one_minus() * (across + 1.0),
        ]
    }

    /// α_x²/(1 − α_x²) and α_y²/(1 − α_y²): the reciprocal squares of the scales of the sine.
    #[inline(always)]
    pub fn inverse_squared_scales(&self) -> [N; 2] {
        // Where α is 1, u is as good as zero.
        let square = |alpha: N, rest: N| alpha * alpha / Real::max(rest, rest.splat(UNIT_ROUNDOFF));
        let ([along, across], rests) = (self.roughness, self.rests());
        [square(along, rests[0]), square(across, rests[1])]
    }
}
