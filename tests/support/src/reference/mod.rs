//! The model that the crate is tested against: the papers' formulas as printed, in `f64`, sharing
//! no code with `src/`.

pub mod camera;
pub mod cluster;
pub mod exact;
pub mod fresnel;
pub mod frustum;
pub mod given;
pub mod lobe;
pub mod shape;
pub mod smallest;
pub mod vector;

pub use camera::View;
pub use cluster::Cluster;
pub use fresnel::Fresnel;
pub use frustum::Frustum;
pub use given::{GivenFresnel, MaskedAlone};
pub use lobe::{
    Brdf, Masking, Surface, SurfaceFrame, anisotropic_g2, anisotropic_ndf, ggx_ndf, ltc_rows,
    ltc_value, smith_g1, smith_g2,
};
pub use shape::Shape;
pub use smallest::Smallest;
pub use vector::Vector;
