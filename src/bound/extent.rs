//! The extent of a GGX lobe along a direction, without a shape around the lobe. It is exact for the NDF
//! alone, with F and G2 at their joint maximum.
//!
//! The surface is the image of a sphere, x(m) = (r/α) (2(ω_i·Pm) Pm − ω_i ‖Pm‖²) (see `triaxial`). So the
//! largest d·x(m) over all unit vectors m is r/α times the largest eigenvalue of the symmetric matrix
//!
//! Q = P (ω_i dᵀ + d ω_iᵀ − (d·ω_i) 1) P = a bᵀ + b aᵀ − (d·ω_i) P², a = Pω_i, b = Pd.
//!
//! That is the largest root of a cubic, which is convex beyond it. Newton's method from above stays above, so
//! its result is an upper bound wherever it ends.

use crate::base::Direction;
use crate::lobe::{Fresnel, GgxLobe, MaskingShadowing, unit};
use crate::num::{Vector3, round_up, sqrt};

/// Pays for rounding the eigenvalue to `f32`.
const EIGENVALUE_ROUNDINGS: u16 = 1;
/// Pays for the rounding of r/α and of its product with the eigenvalue.
const EXTENT_ROUNDINGS: u16 = 16;
/// Newton's method ends where the cubic is below this share of the squared root, since there it is mostly
/// rounding.
const NEGLIGIBLE_VALUE: f64 = 1e-13;
/// Newton's method ends where its step is below this share of the root.
const NEGLIGIBLE_STEP: f64 = 1e-9;
/// Pays for the rounding of the cubic's coefficients, which counts most at a double root.
const DOUBLE_ROOT_SHARE: f64 = 1e-7;

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// The extent of the isosurface for Φ/(δξ) = 1 along the unit vector `direction` = d: an upper bound of
    /// d·x over its points x, for a light at the origin. Multiply it by
    /// [`Roulette::scale`](crate::Roulette::scale).
    ///
    /// For the surface that the NDF alone gives, with F·G2 at its [joint maximum](GgxLobe::max_reflected), it
    /// is exact but for rounding, which is upward. It is not negative, since the light itself belongs to the
    /// lobe, and zero if the lobe is empty.
    ///
    /// The extents along ±x, ±y and ±z of any frame give the bounding box of the lobe in that frame. A plane
    /// n·x = c with c above the extent along n does not intersect the lobe.
    ///
    /// The computation takes two to three times as long as that of the triaxial bound.
    ///
    /// ```
    /// use stochastic_light_culling::{Direction, Ggx, GgxLobe, Incidence, NoFresnel, glam::Vec3};
    ///
    /// let incoming = Direction::new(Vec3::new(-0.6, 0.0, 0.8))?;
    /// let lobe = GgxLobe::new(Ggx::new(0.2)?, NoFresnel, Incidence { normal: Direction::Z, incoming });
    /// let ahead = lobe.extent(lobe.mirror_direction());
    /// let behind = lobe.extent(-lobe.mirror_direction());
    /// assert!((behind / ahead / (0.2 * 0.2) - 1.0).abs() < 1e-4);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn extent(&self, direction: Direction) -> f32 {
        if self.incident_cosine() <= 0.0 {
            return 0.0;
        }
        let alpha = self.ggx().roughness();
        let [normal, incoming, direction] =
            [self.normal(), self.incoming(), direction].map(Vector3::from);
        let [n, w, d] = [normal, incoming, direction].map(unit);
        // From the f32 vectors, whose products are exact: that of the unit vectors could be mostly rounding.
        let across = normal.widen().cross(incoming.widen());
        let eigenvalue = Cubic::new(f64::from(alpha), n, w, d, across).largest_root_above();
        let masking = self.lanes().masking_over_four_cosines();
        let radius_squared = self.max_reflected() * masking * core::f32::consts::FRAC_1_PI;
        let over_alpha = sqrt(radius_squared) / alpha;
        let eigenvalue = round_up(eigenvalue as f32, EIGENVALUE_ROUNDINGS);
        round_up(over_alpha * eigenvalue, EXTENT_ROUNDINGS)
    }
}

/// The characteristic polynomial λ³ − trace λ² + minors λ − determinant of Q.
///
/// In the frame (tangent, bitangent, n), in which P is diagonal, each term has its power of α as a factor, so
/// that small α cost no accuracy. The matrix between the two factors P has the eigenvalues 1, −1 and −d·ω_i,
/// hence the determinant d·ω_i.
struct Cubic {
    /// The largest sum of absolute values in a row; no root is larger.
    norm: f64,
    trace: f64,
    minors: f64,
    determinant: f64,
}

impl Cubic {
    /// `across` is along n × ω_i.
    fn new(
        alpha: f64,
        n: Vector3<f64>,
        w: Vector3<f64>,
        d: Vector3<f64>,
        across: Vector3<f64>,
    ) -> Self {
        let length = across.length();
        // At normal incidence ω_i has no tangential part, and the frame does not matter.
        let bitangent = if length > 0.0 {
            across / length
        } else {
            Vector3::zero(0.0)
        };
        let tangent = bitangent.cross(n);
        let (w_t, w_n) = (w.dot(tangent), w.dot(n));
        let [d_t, d_b, d_n] = [tangent, bitangent, n].map(|axis| axis.dot(d));
        // The tangent then lies along the tangential part of d.
        let d_t = if length > 0.0 {
            d_t
        } else {
            n.cross(d).length()
        };
        let cosine = w_t * d_t + w_n * d_n;

        let [tt, bb, nn] = [2.0 * w_t * d_t - cosine, -cosine, 2.0 * w_n * d_n - cosine];
        let [tb, bn, tn] = [w_t * d_b, w_n * d_b, w_t * d_n + w_n * d_t];
        let alpha_squared = alpha * alpha;
        let upper = (bb * nn - bn * bn) + (tt * nn - tn * tn);
        let rows = [
            alpha * (alpha * (tt.abs() + tb.abs()) + tn.abs()),
            alpha * (alpha * (tb.abs() + bb.abs()) + bn.abs()),
            alpha * (tn.abs() + bn.abs()) + nn.abs(),
        ];
        Self {
            norm: rows[0].max(rows[1]).max(rows[2]),
            trace: alpha_squared * (tt + bb) + nn,
            minors: alpha_squared * (alpha_squared * (tt * bb - tb * tb) + upper),
            determinant: alpha_squared * alpha_squared * cosine,
        }
    }

    /// The largest root λ, enlarged: by at most 4·10⁻⁷ of itself where it is double, elsewhere by far less.
    ///
    /// α² ≤ λ, since the Rayleigh quotient of Q at P⁻¹(ω_i + d) is ‖ω_i + d‖²/‖P⁻¹(ω_i + d)‖². The smallest
    /// root is not positive, since the matrix between the two factors P has the eigenvalue −1. So the cubic
    /// at λ + e is at least e²λ.
    fn largest_root_above(&self) -> f64 {
        let (mut root, mut step) = (self.norm, self.norm);
        // Towards the largest of three real roots the steps become smaller, until they are mostly rounding.
        while step > NEGLIGIBLE_STEP * root {
            let value = ((root - self.trace) * root + self.minors) * root - self.determinant;
            // Near a double root value and slope are mostly rounding. The rounding of `value` and of the
            // coefficients is less than a quarter of this, since α² ≤ root.
            if value <= NEGLIGIBLE_VALUE * root * root {
                break;
            }
            let slope = (3.0 * root - 2.0 * self.trace) * root + self.minors;
            let next_step = value / slope;
            if !(0.0..step).contains(&next_step) {
                break;
            }
            step = next_step;
            root -= step;
        }
        root * (1.0 + DOUBLE_ROOT_SHARE)
    }
}
