//! How far a GGX lobe reaches along a direction, without a shape around it: exactly, but for what F and
//! G2 take from the NDF.
//!
//! With the surface as the image of a sphere, x(m) = (r/α) (2(ω_i·Pm) Pm − ω_i ‖Pm‖²) (see
//! `triaxial`), the largest d·x(m) over unit m is r/α times the largest eigenvalue of the symmetric
//! matrix
//!
//! Q = P (ω_i dᵀ + d ω_iᵀ − (d·ω_i) 1) P = a bᵀ + b aᵀ − (d·ω_i) P², a = Pω_i, b = Pd.
//!
//! That is the largest root of a cubic which is convex beyond it. Newton's method from above stays
//! above, so where it ends is an upper bound.

use crate::base::Direction;
use crate::lobe::{Fresnel, GgxLobe, MaskingShadowing, unit};
use crate::num::{Vector3, round_up, sqrt};

/// Pays for rounding the eigenvalue to `f32`.
const EIGENVALUE_ROUNDINGS: u16 = 1;
/// Pays for the rounding of r/α and of its product with the eigenvalue.
const EXTENT_ROUNDINGS: u16 = 16;
/// Newton's method ends where the cubic is below this share of the squared root: there it is mostly rounding.
const NEGLIGIBLE_VALUE: f64 = 1e-13;
/// Newton's method ends where its step is below this share of the root.
const NEGLIGIBLE_STEP: f64 = 1e-9;
/// Pays for the rounding of the cubic's coefficients, which counts most at a double root.
const DOUBLE_ROOT_SHARE: f64 = 1e-7;

impl<F: Fresnel, G: MaskingShadowing> GgxLobe<F, G> {
    /// An upper bound of d·x over the isosurface for Φ/(δξ) = 1 and a light at the origin, where d is the
    /// unit `direction`. Exact but for rounding, which is upward, for the surface of the NDF alone, with F·G2
    /// at its [joint maximum](GgxLobe::max_reflected) everywhere. Scale it by
    /// [`Roulette::scale`](crate::Roulette::scale).
    ///
    /// The extents along ±x, ±y and ±z of any frame are the lobe's box in it, and a plane n·x = c with
    /// c above the extent along n does not meet the lobe. Not negative, for the light itself belongs to
    /// it; zero for a light from below. Costs about three times as much as the tighter bound.
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
        // Of the f32 vectors, whose products are exact: of the unit vectors it may be all rounding.
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
/// In the frame (tangent, bitangent, n), where P is diagonal, each term carries its power of α as a
/// factor, so that small α cost no accuracy. The matrix between the two P has the eigenvalues 1, −1
/// and −d·ω_i, hence the determinant d·ω_i.
struct Cubic {
    /// No root is larger.
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
        // At normal incidence ω_i has no tangent part, and its frame no say.
        let bitangent = if length > 0.0 {
            Vector3::new(across.x / length, across.y / length, across.z / length)
        } else {
            Vector3::zero(0.0)
        };
        let tangent = bitangent.cross(n);
        let (w_t, w_n) = (w.dot(tangent), w.dot(n));
        let [d_t, d_b, d_n] = [tangent, bitangent, n].map(|axis| axis.dot(d));
        // Of a frame without a say, d's part in the tangent plane as a whole is the tangent part.
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

    /// The largest root λ, or a little more: by 4·10⁻⁷ of it at most where it is double, else by far less.
    ///
    /// α² ≤ λ, since Q's Rayleigh quotient at P⁻¹(ω_i + d) is ‖ω_i + d‖²/‖P⁻¹(ω_i + d)‖². The least root
    /// is not positive, since the matrix between the two P has the eigenvalue −1. So the cubic at λ + e
    /// is at least e²λ.
    fn largest_root_above(&self) -> f64 {
        let (mut root, mut step) = (self.norm, self.norm);
        // Towards the largest of three real roots steps become smaller, until rounding says otherwise.
        while step > NEGLIGIBLE_STEP * root {
            let value = ((root - self.trace) * root + self.minors) * root - self.determinant;
            // Near a double root both are mostly rounding, and their quotient means nothing. The roundings
            // of `value` and of the coefficients come to less than a quarter of this, since α² ≤ root.
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
        // At a double root half of the digits are rounding.
        root * (1.0 + DOUBLE_ROOT_SHARE)
    }
}
