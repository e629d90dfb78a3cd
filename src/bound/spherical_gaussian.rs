//! The bounds of a spherical Gaussian.
//!
//! Let γ be the angle to the axis and κ = λ/2. In units of √c the isosurface is l = e^{−κ(1 − cosγ)}, a
//! surface of revolution, and z = l cosγ is the height along the axis.
//!
//! # The spheroid with its focus at the light
//!
//! ln l = −κ(1 − cosγ), so −l ln l = κ(l − z). The function −l ln l is concave, and so below its tangent at
//! l = e^{k−1}, which is e^{k−1} − kl. Hence **(κ + k)l ≤ κz + e^{k−1}** for every k > 0, a conic with a focus
//! at the light. In the form of a [`Spheroid`](crate::Spheroid) its roughness is √(k/(λ + k)) and its radius
//! e^{k−1}/√(k(λ + k)). For λ = 0, where k = 1, it is the isosurface itself. Its volume is smallest for a k that
//! falls from 1 to 2/3, and k = 2/3 + 1/(3(1 + 1.5λ + 1.3λ²)) is near that. It is then at most 1.2 times that of
//! the smallest ellipsoid (at λ ≈ 3), and the same in both limits.
//!
//! # The smallest ellipsoid
//!
//! It is a spheroid about the axis. For κ → 0 its semi-axes are 1 − κ and its centre is at κ; for κ → ∞ the
//! semi-axis along the axis and the distance of the centre are ¾e^{−1/3}, and the ratio of the squared
//! semi-axes is 4/(3κ), as for a power of the cosine. In between there is no closed form. With w = 1/(1 + κ)
//! and u = κw, its front, its rear and its squared semi-axis across are polynomials in w here, which were
//! fitted from above. They enclose with room of [`FIT_ROUNDINGS`] to spare, which is proved by a computer, box
//! by box in w and the angle (`tests/spherical_gaussian_bound.rs`), and the volume is within 1 % of the smallest.

use super::ellipsoid::Ellipsoids;
use super::revolved::Revolved;
use super::shape::{Quads, padded};
use super::spheroid::Spheroids;
use super::{BoundStrategy, Bounded, Ellipsoid, Focal, Spheroid, Tight};
use crate::lobe::SphericalGaussian;
use crate::num::{Real, Single, Vector3, exponential, sqrt};

/// Pays for the rounding of the polynomials, and leaves room for the proof that they enclose: 2⁻¹³.
const FIT_ROUNDINGS: u16 = 2048;

/// The quads of an SG: ξ and λ, and √c.
#[inline(always)]
fn to_quads(lobe: &SphericalGaussian) -> Quads<f32> {
    let axis = lobe.axis();
    let reach = sqrt(lobe.amplitude());
    padded([
        [axis.x, axis.y, axis.z, lobe.sharpness()],
        [reach, 0.0, 0.0, 0.0],
    ])
}

/// Bounds the SG by nearly the smallest ellipsoid, in a closed form that was fitted to it. Its volume is at
/// most 1.01 times that of the smallest.
impl BoundStrategy<SphericalGaussian> for Tight {
    type Shape = Ellipsoid;

    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self, lobe: &SphericalGaussian) -> (Quads<f32>, ()) {
        (to_quads(lobe), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Ellipsoids<N> {
        let [[x, y, z, sharpness], [reach, ..], ..] = *quads;
        around_gaussian(sharpness).along(Vector3::new(x, y, z), reach)
    }
}

/// Bounds the SG by a spheroid with a focus at the light, in a closed form. Its volume is at most 1.2 times
/// that of the smallest ellipsoid.
impl BoundStrategy<SphericalGaussian> for Focal {
    type Shape = Spheroid;

    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self, lobe: &SphericalGaussian) -> (Quads<f32>, ()) {
        (to_quads(lobe), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Spheroids<N> {
        let [[x, y, z, sharpness], [reach, ..], ..] = *quads;
        let [radius, roughness] = focal(sharpness);
        // The axis of an SG is given, not computed, and so has no tilt.
        Spheroids::around_tilted_axis(Vector3::new(x, y, z), radius * reach, roughness, 0.0)
    }
}

impl Bounded for SphericalGaussian {
    type Shape = Ellipsoid;
    type Strategy = Tight;

    fn unit_bound(&self) -> Ellipsoid {
        self.unit_bound_by(Tight)
    }
}

/// Σ coefficientᵢ wⁱ, the coefficient of the highest power first.
#[inline(always)]
fn polynomial<N: Single, const K: usize>(coefficients: [f32; K], w: N) -> N {
    let mut sum = w.zero();
    for coefficient in coefficients {
        sum = sum * w + coefficient;
    }
    sum
}

/// The ellipsoid around an SG with c = 1 and `sharpness` = λ.
#[inline(always)]
pub(super) fn around_gaussian<N: Single>(sharpness: N) -> Revolved<N> {
    const FRONT: [f32; 4] = [0.3028, -0.1291, -0.1709, 0.084];
    const REAR: [f32; 5] = [-5.4278, 23.6406, -35.9794, 20.754, -0.9873];
    const ACROSS: [f32; 6] = [0.6901, -1.9974, 2.1405, -0.5452, 0.3361, 0.3834];
    let kappa = sharpness * 0.5;
    let w = (kappa + 1.0).recip();
    let u = kappa * w;
    let front = u * polynomial(FRONT, w) + 1.0;
    let w_squared = w * w;
    let rear = w_squared * w_squared * (u * polynomial(REAR, w) + 1.0);
    let across = (w * polynomial(ACROSS, w)).sqrt();
    Revolved {
        center: (front - rear) * 0.5,
        along: ((front + rear) * 0.5).round_up(FIT_ROUNDINGS),
        across: across.round_up(FIT_ROUNDINGS),
    }
}

/// Radius and roughness of the spheroid around an SG with c = 1 and `sharpness` = λ.
#[inline(always)]
fn focal<N: Single>(sharpness: N) -> [N; 2] {
    let lambda = sharpness.widen();
    let one = lambda.splat(1.0);
    let third = one / (((lambda * 1.3 + 1.5) * lambda + 1.0) * 3.0);
    let k = third + 2.0 / 3.0;
    let sum = lambda + k;
    let radius = exponential(k - 1.0) / (k * sum).sqrt();
    [N::narrow(radius), N::narrow((k / sum).sqrt())]
}
