//! Bounding shapes, and the strategies that enclose a lobe in one.
//!
//! The isosurface of a light is {√(Φ·value(ω)/(δξ))·ω : ω a unit vector}, so its shape depends only on the
//! lobe. A lobe is bounded once, at the origin and for Φ/(δξ) = 1 ([`BoundStrategy`]). In each frame the
//! bound is scaled for that frame's ξ and moved to the light ([`Shape`]). Each step rounds outward.

mod anisotropic_ggx;
mod cluster;
mod cluster_table;
mod constant;
mod cosine_power;
mod ellipsoid;
mod extent;
mod half_space;
mod lambert;
#[cfg(feature = "ltc")]
mod ltc;
#[cfg(feature = "ltc")]
mod ltc_rows;
mod paper;
mod phong;
mod principal_axes;
mod proxy;
mod revolved;
mod shape;
mod sphere;
mod spherical_gaussian;
mod spheroid;
mod spot;
mod strategy;
mod table;
mod tight;
mod triaxial;

#[cfg(feature = "cull")]
pub(crate) use cluster::{around_clusters, quads_of_cluster};
pub use ellipsoid::Ellipsoid;
pub(crate) use ellipsoid::Ellipsoids;
pub use half_space::HalfSpace;
pub use proxy::Proxy;
pub use shape::Shape;
#[cfg(feature = "cull")]
pub(crate) use shape::{MAX_QUADS, Quads, ShapeLanes};
pub use sphere::Sphere;
pub(crate) use sphere::Spheres;
pub use spheroid::Spheroid;
pub(crate) use spheroid::Spheroids;
pub use strategy::{BoundStrategy, Bounded, Focal, OwnBound, Paper, Tight, Triaxial};
#[cfg(feature = "wgsl")]
pub(crate) use table::TABLE;
