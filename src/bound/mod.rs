//! What encloses a light's isosurface.
//!
//! The isosurface of light is {√(Φ·value(ω)/(δξ))·ω}, so its shape is the lobe's alone: a lobe is
//! bounded once for unit scale and at the origin ([`Bounded`]), and each frame's ξ scales the bound
//! and puts it in place ([`Bound`]). Each step rounds outward.

mod anisotropic;
mod constant;
mod cosine_power;
mod ellipsoid;
mod ggx;
mod lambert;
mod phong;
mod principal_axes;
mod proxy;
mod smallest;
mod sphere;
mod spheroid;
mod support;
pub(crate) mod table;
mod triaxial;

pub use ellipsoid::Ellipsoid;
#[cfg(feature = "cull")]
pub(crate) use ggx::AXIS_TILT_RADIANS;
pub use proxy::Proxy;
pub use sphere::Sphere;
pub use spheroid::Spheroid;

use glam::Vec3;

use crate::{Lobe, Roulette, Vpl, Xi};

/// A lobe whose isosurface has a closed bound.
pub trait Bounded: Lobe {
    /// The shape of the bound.
    type Bound: Bound;

    /// A shape that contains the unit isosurface {√value(ω)·ω : ω a unit vector}, for a light at
    /// the origin.
    fn unit_bound(&self) -> Self::Bound;
}

/// A shape around a light.
pub trait Bound: Copy {
    /// The shape scaled by `scale ≥ 0` about the origin and then moved by `position`, rounded
    /// outward. Scaled by zero it is [empty](Self::is_empty).
    fn placed(self, position: Vec3, scale: f32) -> Self;

    /// Whether nothing lies inside: the light reaches nowhere.
    fn is_empty(&self) -> bool;
}

impl<L: Bounded> Vpl<L> {
    /// The bound of everything that accepts this light in a frame with `roulette` and `xi`.
    ///
    /// For a light that does not change, keep [`unit_bound`](Bounded::unit_bound) and place that
    /// anew each frame.
    #[inline]
    pub fn bound(&self, roulette: &Roulette, xi: Xi) -> L::Bound {
        let scale = roulette.scale(self.flux(), xi);
        self.lobe().unit_bound().placed(self.position(), scale)
    }
}

/// `length` times `scale`, rounded up; zero only if one of them is, however small the product.
fn scaled(length: f32, scale: f32) -> f32 {
    if length > 0.0 && scale > 0.0 {
        crate::math::round_up(length * scale, 1).max(f32::MIN_POSITIVE)
    } else {
        0.0
    }
}

/// What `x + y` can differ from its exact value by, in each component, is at most this length.
fn rounding_of_sum(sum: Vec3) -> f32 {
    2.0 * crate::math::UNIT_ROUNDOFF * sum.abs().max_element()
}
