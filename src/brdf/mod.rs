//! What a surface reflects: microfacet terms, Fresnel factors, and the lobes made of them.

mod anisotropic;
mod anisotropic_lobe;
mod conductor;
mod constant;
mod dielectric;
mod fresnel;
mod ggx;
mod ggx_lobe;
mod lambert;
mod masking;
mod phong;

pub use anisotropic::AnisotropicGgx;
pub use anisotropic_lobe::AnisotropicGgxLobe;
pub use conductor::Conductor;
pub use constant::ConstantLobe;
pub use dielectric::Dielectric;
pub use fresnel::{Fresnel, FresnelMajorant, NoFresnel, Schlick};
pub use ggx::Ggx;
pub use ggx_lobe::GgxLobe;
pub use lambert::LambertLobe;
pub use masking::{HeightCorrelated, MaskingShadowing, Separable};
pub use phong::PhongLobe;

use glam::Vec3;

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
}
