use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::{Ggx, MaskingShadowing};
use crate::base::{Error, number_in};
use crate::num::{Real, Single, Vector3};

/// An anisotropic GGX microsurface, with one roughness along the tangent and one across it, such as brushed
/// metal [Heitz 2014; Trowbridge & Reitz 1975].
///
/// Its functions take vectors in the frame of the surface: components along the tangent, the bitangent
/// n × tangent, and the normal n.
///
/// ```
/// use stochastic_light_culling::{AnisotropicGgx, Ggx, HeightCorrelated, Separable, glam::Vec3};
///
/// let brushed = AnisotropicGgx::new(0.4, 0.1)?;
/// // Facets lean along the tangent more often than across it.
/// assert!(brushed.ndf(Vec3::new(0.3, 0.0, 1.0)) > brushed.ndf(Vec3::new(0.0, 0.3, 1.0)));
///
/// let (even, plain) = (AnisotropicGgx::new(0.2, 0.2)?, Ggx::new(0.2)?);
/// let slanted = Vec3::new(0.6, 0.0, 0.8);
/// assert!((even.masking(slanted) - plain.masking(0.8)).abs() < 1e-6);
/// // Masking and shadowing are correlated: a lit facet is more likely to be visible.
/// let independent = brushed.masking_shadowing::<Separable>(slanted, slanted);
/// assert!(independent < brushed.masking_shadowing::<HeightCorrelated>(slanted, slanted));
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnisotropicGgx {
    roughness: [f32; 2],
}

impl AnisotropicGgx {
    /// Creates a microsurface with the roughness `along` = α_x along the tangent and `across` = α_y along the
    /// bitangent.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if one of them is outside \[[`Ggx::MIN_ROUGHNESS`], 1\] or NaN.
    pub fn new(along: f32, across: f32) -> Result<Self, Error> {
        let valid = Ggx::MIN_ROUGHNESS..=1.0;
        let named = |quantity, roughness| {
            number_in(
                quantity,
                roughness,
                "in (0, 1], and at least 2⁻²⁰",
                valid.clone(),
            )
        };
        Ok(Self {
            roughness: [
                named("roughness α_x", along)?,
                named("roughness α_y", across)?,
            ],
        })
    }

    /// The roughness \[α_x, α_y\].
    #[must_use]
    pub fn roughness(self) -> [f32; 2] {
        self.roughness
    }

    /// Whether α_x = α_y.
    pub(crate) fn is_isotropic(self) -> bool {
        let [along, across] = self.roughness;
        along == across
    }

    /// The normal distribution function D = 1/(π α_x α_y (x²/α_x² + y²/α_y² + z²)²) in sr⁻¹
    /// [Heitz 2014], where (x, y, z) is the unit vector along `half_vector`. `half_vector` itself may
    /// have any finite length.
    ///
    /// D is largest at the normal, where it is 1/(πα_xα_y). Zero at and below the horizon, z ≤ 0, and for
    /// NaN.
    #[inline]
    #[must_use]
    pub fn ndf(self, half_vector: Vec3) -> f32 {
        anisotropic_ndf(self.roughness, half_vector.into())
    }

    #[inline]
    fn masking_root(self, direction: Vec3) -> f32 {
        anisotropic_masking_root(self.roughness, direction.into())
    }

    /// Smith's masking function G1 = 2z/(z + √(α_x²x² + α_y²y² + z²)) for the unit vector
    /// `direction` = (x, y, z): the visible share of the facets that face the viewer [Heitz 2014].
    ///
    /// In \[0, 1\]. Zero for z ≤ 0 and for NaN.
    #[must_use]
    pub fn masking(self, direction: Vec3) -> f32 {
        if direction.z > 0.0 {
            2.0 * direction.z / (direction.z + self.masking_root(direction))
        } else {
            0.0
        }
    }

    /// The masking-shadowing function G2 in \[0, 1\], of the form `G`, for the unit vectors `incoming` = ω_i
    /// and `outgoing` = ω_o. Zero if either is not above the surface, and for NaN.
    #[must_use]
    pub fn masking_shadowing<G: MaskingShadowing>(self, incoming: Vec3, outgoing: Vec3) -> f32 {
        if !(incoming.z > 0.0 && outgoing.z > 0.0) {
            return 0.0;
        }
        4.0 * incoming.z
            * G::over_four_incident_cosines(
                incoming.z,
                self.masking_root(incoming),
                outgoing.z,
                self.masking_root(outgoing),
            )
    }

    /// The isotropic microsurface with the smaller roughness.
    pub(super) fn smoother(self) -> Ggx {
        Ggx::of_valid(self.roughness[0].min(self.roughness[1]))
    }
}

/// The NDF at a half vector in the frame of the surface; see [`AnisotropicGgx::ndf`].
#[inline(always)]
pub(super) fn anisotropic_ndf<N: Single>([along, across]: [N; 2], half_vector: Vector3<N>) -> N {
    let Vector3 { x, y, z } = half_vector;
    let is_above = z.is_positive();
    if N::is_known_false(is_above) {
        return z.zero();
    }
    let (x, y) = (x / along, y / across);
    let spread = (x * x + y * y + z * z) / half_vector.length_squared();
    // At least 1 but for rounding, which is unbounded where lengths underflow.
    let spread = spread.max(z.splat(1.0));
    let ndf = z.splat(FRAC_1_PI) / (along * across) / spread / spread;
    N::select(is_above, ndf, z.zero())
}

/// The NDF where (x √(1/α_x² − 1), y √(1/α_y² − 1)) has the length `scaled_sine` for the unit half vector
/// (x, y, z): with z² = 1 − x² − y², D = 1/(π α_x α_y (1 + `scaled_sine`²)²).
#[inline(always)]
pub(super) fn ndf_of_scaled_sine<N: Single>([along, across]: [N; 2], scaled_sine: N) -> N {
    let spread = scaled_sine * scaled_sine + 1.0;
    scaled_sine.splat(FRAC_1_PI) / (along * across) / spread / spread
}

/// The root √(α_x²x² + α_y²y² + z²) of Smith's masking functions for the unit vector `direction` = (x, y, z)
/// in the frame of the surface. For equal z it lies between the roots of the smaller and of the larger
/// roughness.
#[inline(always)]
pub(super) fn anisotropic_masking_root<N: Real>(
    [along, across]: [N; 2],
    direction: Vector3<N>,
) -> N {
    Vector3::new(along * direction.x, across * direction.y, direction.z).length()
}
