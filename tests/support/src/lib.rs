//! What the tests share, and the examples and benches with them.
#![allow(
    missing_docs,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc,
    clippy::must_use_candidate,
    clippy::return_self_not_must_use,
    reason = "public to the tests alone, where names say it"
)]

/// Evaluates the last expression with the camera that is in the first, of either projection.
#[macro_export]
macro_rules! with_camera {
    ($any:expr, $camera:ident => $body:expr) => {
        match $any {
            stochastic_light_culling::AnyCamera::Perspective($camera) => $body,
            stochastic_light_culling::AnyCamera::Orthographic($camera) => $body,
        }
    };
}

pub mod adversary;
pub mod caps;
pub mod certificate;
pub mod command;
pub mod direct_port;
pub mod generators;
pub mod ggx_nodes;
pub mod ltc_errors;
pub mod ltc_inequality;
pub mod parts;
pub mod quadrature;
pub mod reference;
pub mod tightness;
pub mod workload;
