//! Lobes: what a surface reflects. Microfacet terms, Fresnel factors, and the lobes that they make.

mod anisotropic_ggx;
mod anisotropic_ggx_lobe;
mod conductor;
mod constant;
mod dielectric;
mod fresnel;
mod ggx;
mod ggx_lobe;
mod incidence;
mod lambert;
#[cfg(all(test, feature = "cull"))]
mod lanes_tests;
mod masking;
mod phong;

pub use anisotropic_ggx::AnisotropicGgx;
pub use anisotropic_ggx_lobe::AnisotropicGgxLobe;
pub(crate) use anisotropic_ggx_lobe::{SurfaceAxes, unit};
pub use conductor::Conductor;
pub use constant::ConstantLobe;
pub use dielectric::Dielectric;
pub use fresnel::{Fresnel, FresnelMajorant, NoFresnel, Schlick};
pub use ggx::Ggx;
pub use ggx_lobe::GgxLobe;
pub(crate) use ggx_lobe::{GgxLobes, PlaneOfIncidence};
pub use incidence::Incidence;
pub use lambert::LambertLobe;
pub use masking::{HeightCorrelated, MaskingShadowing, Separable};
pub use phong::PhongLobe;

use glam::Vec3;

use crate::base::Direction;

/// The light that a point reflects, as a function of the outgoing direction. The incoming direction is fixed.
///
/// The steps after this one know a lobe only by this trait and by its bound ([`Bounded`](crate::Bounded)).
pub trait Lobe {
    /// The value f(ω_i, ω_o)·max(ω_o·n, 0) in sr⁻¹ for the unit vector `outgoing` = ω_o, which points away
    /// from the surface.
    ///
    /// Finite, not negative and never NaN. Zero at and below the horizon, if the lobe has one.
    fn value(&self, outgoing: Vec3) -> f32;

    /// The normal of the surface below whose horizon the lobe is zero. `None` if the lobe has no horizon.
    fn horizon_normal(&self) -> Option<Direction> {
        None
    }

    /// Whether the lobe is known to be zero in every direction. A batch drops such lights before it computes
    /// their bounds.
    fn is_empty(&self) -> bool {
        false
    }
}
