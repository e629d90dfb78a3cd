//! What a surface reflects: microfacet terms, Fresnel factors, and the lobes made of them.

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

/// The light that a point sends out for light that came in from one fixed direction.
///
/// Everything after this module sees a lobe only through this trait and its bound
/// ([`Bounded`](crate::Bounded)).
pub trait Lobe {
    /// f(ω_i, ω_o)·max(ω_o·n, 0) in sr⁻¹, for the unit direction `outgoing` = ω_o that leaves the
    /// surface.
    ///
    /// Finite and not negative; zero at and below the horizon, where the lobe has one. Never NaN.
    fn value(&self, outgoing: Vec3) -> f32;

    /// The normal of the surface below whose horizon the lobe is zero; `None` if it has none.
    fn horizon_normal(&self) -> Option<Direction> {
        None
    }

    /// Whether the lobe is known to be zero in every direction. A batch leaves such lights out before it
    /// computes their bounds.
    fn is_empty(&self) -> bool {
        false
    }
}
