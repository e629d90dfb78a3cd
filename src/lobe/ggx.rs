use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::base::{Error, number_in};
use crate::num::{Single, Vector3};

/// A GGX microsurface of roughness α: the distribution of its facets, and how they mask each other
/// [Walter et al. 2007; Trowbridge & Reitz 1975].
///
/// ```
/// use stochastic_light_culling::Ggx;
///
/// let (satin, matt) = (Ggx::new(0.2)?, Ggx::new(0.8)?);
/// assert!(satin.ndf(1.0) > matt.ndf(1.0) && satin.masking(0.1) > matt.masking(0.1));
/// // A perfect mirror has no lobe, a nearly perfect one a narrow lobe.
/// assert!(Ggx::new(0.0).is_err() && Ggx::new(Ggx::MIN_ROUGHNESS).is_ok());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    roughness: f32,
}

impl Ggx {
    /// The smallest valid roughness, 2⁻²⁰ ≈ 9.5·10⁻⁷. Below it the lobe is narrower than the spacing of `f32`
    /// directions.
    pub const MIN_ROUGHNESS: f32 = 9.536_743e-7;

    /// Creates a microsurface with `roughness` = α. Most engines show artists the *perceptual* roughness √α.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `roughness` is outside \[[`Self::MIN_ROUGHNESS`], 1\] or NaN. A perfect
    /// mirror, α = 0, has no radiant intensity to bound.
    pub fn new(roughness: f32) -> Result<Self, Error> {
        number_in(
            "roughness α",
            roughness,
            "in (0, 1], and at least 2⁻²⁰",
            Self::MIN_ROUGHNESS..=1.0,
        )
        .map(|roughness| Self { roughness })
    }

    /// Creates a microsurface with a roughness that is known to be valid.
    pub(super) fn of_valid(roughness: f32) -> Self {
        debug_assert!((Self::MIN_ROUGHNESS..=1.0).contains(&roughness));
        Self { roughness }
    }

    /// The roughness α.
    #[must_use]
    pub fn roughness(self) -> f32 {
        self.roughness
    }

    /// The normal distribution function D(cosθ_m) in sr⁻¹: the area of microfacets per solid angle of their
    /// normals [Tokuyoshi & Harada 2017, Eq. 7].
    ///
    /// `cosine` = cosθ_m is in \[−1, 1\]. D is largest at cosθ_m = 1, where it is 1/(πα²). It is zero for
    /// cosθ_m ≤ 0 and for NaN. A rounded cosine cannot resolve a lobe narrower than about 10⁻³ radians. Where
    /// the half vector is known, use [`ndf_at`](Self::ndf_at).
    #[must_use]
    pub fn ndf(self, cosine: f32) -> f32 {
        if cosine > 0.0 {
            let sine_squared = (1.0 - cosine) * (1.0 + cosine);
            let alpha_squared = self.roughness * self.roughness;
            ndf_of_squares(alpha_squared, cosine * cosine, sine_squared, 1.0)
        } else {
            0.0
        }
    }

    /// The normal distribution function in sr⁻¹ at `half_vector`, of any finite length, on a surface with the
    /// unit vector `normal`.
    ///
    /// It is as accurate as the vectors are, since sin²θ_m comes from their cross product, not from
    /// 1 − cos²θ_m. Zero at and below the horizon, and for NaN.
    #[inline]
    #[must_use]
    pub fn ndf_at(self, half_vector: Vec3, normal: Vec3) -> f32 {
        ndf_at(self.roughness, half_vector.into(), normal.into())
    }

    /// Smith's masking function G1(μ) = 2μ/(μ + √(kμ² + α²)), k = 1 − α², for `cosine` = μ
    /// [Tokuyoshi & Harada 2017, Eq. 8]: the visible share of the facets that face the viewer.
    ///
    /// In \[0, 1\] for μ in (0, 1]. Zero for μ ≤ 0 and for NaN.
    #[must_use]
    pub fn masking(self, cosine: f32) -> f32 {
        if cosine > 0.0 {
            2.0 * cosine / (cosine + masking_root(self.roughness, cosine))
        } else {
            0.0
        }
    }
}

/// The NDF for a half vector and a unit normal; see [`Ggx::ndf_at`].
#[inline(always)]
pub(super) fn ndf_at<N: Single>(roughness: N, half_vector: Vector3<N>, normal: Vector3<N>) -> N {
    let cosine = half_vector.dot(normal);
    let is_above = cosine.is_positive();
    if N::is_known_false(is_above) {
        return cosine.zero();
    }
    let sine_squared = half_vector.cross(normal).length_squared();
    let length_squared = half_vector.length_squared();
    let ndf = ndf_of_squares(
        roughness * roughness,
        cosine * cosine,
        sine_squared,
        length_squared,
    );
    N::select(is_above, ndf, cosine.zero())
}

/// D for the squared sine of θ_m, which is at most 1.
#[inline(always)]
pub(super) fn ndf_of_squared_sine<N: Single>(alpha_squared: N, squared_sine: N) -> N {
    let spread = alpha_squared * squared_sine.one_minus() + squared_sine;
    alpha_squared * FRAC_1_PI / (spread * spread)
}

/// D = α²/(π (α²c² + s²)²), with c² and s² given times `length_squared`.
#[inline(always)]
fn ndf_of_squares<N: Single>(
    alpha_squared: N,
    cosine_squared: N,
    sine_squared: N,
    length_squared: N,
) -> N {
    let spread = (alpha_squared * cosine_squared + sine_squared) / length_squared;
    // At least α² but for rounding, which is unbounded where lengths underflow.
    let spread = spread.max(alpha_squared);
    alpha_squared / spread * FRAC_1_PI / spread
}

/// The root √(kμ² + α²), k = 1 − α², of Smith's masking functions, in \[α, 1\].
#[inline(always)]
pub(super) fn masking_root<N: Single>(roughness: N, cosine: N) -> N {
    let alpha = roughness;
    (alpha.one_minus() * (alpha + 1.0) * cosine * cosine + alpha * alpha).sqrt()
}
