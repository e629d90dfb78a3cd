//! Stochastic light culling: tens of thousands of glossy and diffuse lights, culled per tile without
//! losing energy on average.
//!
//! A light's range in each frame is drawn by Russian roulette, so that what is culled is made up for
//! by what is kept [Tokuyoshi & Harada 2016]. Around a glossy light the range is a lobe, which an
//! ellipsoid encloses [Tokuyoshi & Harada 2017]. The crate is the mathematics of that method, from a
//! lit surface point to "does this light touch this tile", as pure functions over [`glam`].
//!
//! # The corridor
//!
//! | step | from | to | items |
//! |---|---|---|---|
//! | lobe | surface, incoming direction | what it reflects | [`GgxLobe`], [`AnisotropicGgxLobe`], [`LambertLobe`], [`PhongLobe`], [`ConstantLobe`] |
//! | light | lobe, position, flux | radiant intensity | [`Vpl`] |
//! | range | intensity, ξ | probability, range, estimate | [`Roulette`], [`Xi`], [`FrameSeed`] |
//! | bound | lobe, range | shape around all it may light | [`Ellipsoid`], [`Spheroid`], [`Sphere`] by [`Tight`], [`Triaxial`], [`Paper`]; [`HalfSpace`]; [`Proxy`] to rasterise it |
//! | view | camera, image | tiles and their depths | [`Camera`], [`TileGrid`], [`DepthInterval`], [`Interleave`] |
//! | project | bound, camera | unit sphere in camera space | [`ProjectedEllipsoid`], [`ProjectedSphere`], [`ProjectedHalfSpace`] |
//! | touch | projected shape, tile | touched or not | [`ProjectedEllipsoid::touches`] |
//! | cull | many lights, many tiles | a list of lights for each tile | `BatchBuilder`, `LightBatch`, `TileDepths`, `Culler`, `LightLists` (feature `cull`) |
//!
//! Each step can be used alone, and knows nothing of the steps after it.
//!
//! ```
//! use stochastic_light_culling::{
//!     Camera, DepthInterval, Direction, FrameSeed, Ggx, GgxLobe, Incidence, Roulette, Schlick,
//!     TileGrid, Vpl, glam::Vec3,
//! };
//!
//! // A point on a gold floor that a photon of 2 W reached from the upper left.
//! let incidence = Incidence {
//!     normal: Direction::Y,
//!     incoming: Direction::new(Vec3::new(-1.0, 1.0, 0.0))?,
//! };
//! let lobe = GgxLobe::new(Ggx::new(0.1)?, Schlick::new(0.9)?, incidence);
//! let light = Vpl::new(Vec3::ZERO, 2.0, lobe)?;
//!
//! // How far it reaches in this frame, and an ellipsoid around that.
//! let roulette = Roulette::new(0.01)?;
//! let xi = FrameSeed { frame: 0, seed: 0 }.xi(0);
//! let bound = light.bound(&roulette, xi);
//!
//! // In the space of the camera it becomes a unit sphere,
//! let camera = Camera::look_at(Vec3::new(0.0, 2.0, 9.0), Vec3::Y, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
//! let projected = bound.project(&camera).expect("light with flux reaches somewhere");
//!
//! // which is tested against the tiles and what they see between two depths.
//! let grid = TileGrid::new([128, 128], 16)?;
//! let depths = DepthInterval::new(7.0, 11.0)?;
//! let touched = grid
//!     .tiles()
//!     .filter(|tile| projected.touches(&camera.tile(&grid, *tile), &depths))
//!     .count();
//! assert!(0 < touched && touched < 64);
//!
//! // At a point in one of those tiles the light is accepted or not; the mean over ξ is exact.
//! let to_point = Vec3::new(1.5, 1.4, 0.0);
//! let distance_squared = to_point.length_squared();
//! let intensity = light.radiant_intensity(to_point.normalize());
//! let radiance = roulette.estimate(intensity, distance_squared, xi);
//! assert!(radiance == 0.0 || radiance >= roulette.delta());
//! # Ok::<(), stochastic_light_culling::Error>(())
//! ```
//!
//! # Conventions
//!
//! - `f32` and [`glam`] types; column vectors. Directions point away from the surface.
//! - Camera space has x to the right, y up and z = depth, positive ahead, for views of either
//!   handedness ([`Camera`]). Pixel (0, 0) is at the top left, whether NDC y points up or, as Vulkan's,
//!   down.
//! - Radians, sr, W, W/sr; a light's radiance at distance l is I/l².
//! - α is the GGX roughness; artists' *perceptual* roughness is usually √α.
//! - n is the surface normal, ω_i and ω_o point to where light came from and goes to, μ = ω_i·n,
//!   μ_o = ω_o·n, ω_h is the half vector, and k = 1 − α².
//!
//! # Errors, NaN and the hot loop
//!
//! Constructors check, and say what is wrong and with which value ([`Error`]). What they return is
//! valid: nothing after them panics, allocates or makes NaN from finite arguments; but for culling, which
//! allocates in its first frame, and `TileDepths`, which panics if asked about a tile that it does not
//! have. A light that reflects nothing, because its flux is zero or it is lit from behind, is no error but
//! has an empty range; it drops out before any tile is looked at ([`Ellipsoid::project`] gives `None`).
//!
//! # No light is lost
//!
//! Roulette is unbiased only if culling never drops a light that a point would accept. The bounds and
//! tests promise this of the `f32` numbers that they compute, not of the real numbers that they stand
//! for:
//!
//! **If a tile, as the `f32` numbers of its rectangle and depth interval define it, contains a point p
//! with ‖p − q‖ ≤ l_max(ω_o), in exact arithmetic on the `f32` numbers that were given, then
//! [`touches`](TileTest::touches) and [`touches_exactly`](TileTest::touches_exactly) are true** of the
//! projected bounds that [`Paper`], [`Triaxial`] and [`Tight`] give, of both of a spheroid's spheres, and of the
//! [`HalfSpace`] above the light's surface. Directions stand for the unit vectors along them, and a point of the world for
//! its image under the camera's matrix.
//!
//! This holds for every α from 2⁻²⁰ to 1, every μ > 0, ranges from 10⁻¹² to 10¹², lights up to 10⁶
//! ranges from the origin and the eye, ξ from 2⁻³², views of any rotation, handedness and offset with
//! corners up to 89.7° off, lights around and behind the eye, and depth intervals of no thickness.
//! Farther out a bound is merely large, the whole view if it must be, or 10⁻¹⁸ at least. The one step that is not proved
//! is the quasi-convexity of [`Conductor`]'s F, which a search bears out. The ellipsoids of the table behind
//! [`Tight`], between whose knots it is interpolated, are proved to enclose by a computer,
//! box by box: `examples/tabulate -- --prove`.
//!
//! What it costs: at α ≥ 0.01, and r at least 10⁻³ of the distance to eye and origin, ellipsoids grow
//! by less than 0.1 % in volume on average; at α = 10⁻⁶ by a large factor. `examples/stability` prints
//! the table, `docs/rounding.md` counts the roundings.
//!
//! # Scope
//!
//! Here: lobes and their bounds, roulette, projection, tile tests, culling, interleaved sampling. Not here:
//! finding lit points, visibility, shading, denoising, GPU code, and anything that stores a scene;
//! `examples/render.rs` shows one way to supply these.
//!
//! # Features
//!
//! - `std` (default): floating-point functions from the standard library.
//! - `libm`: the same from the [libm](https://docs.rs/libm) crate. The crate is `no_std` without
//!   `std`. One of the two is needed; with both, `std` is used.
//! - `cull`: many lights against many tiles, in vectors as wide as the processor has. Needs an
//!   allocator, and Rust 1.89.
//! - `rayon`: the same on many cores. Brings `cull` and `std`.
//! - `serde`: materials, lobes and lights, cameras, and settings such as roulette, ξ, tile grids, depth
//!   intervals and interleaving can be saved, most under the names of their constructors' arguments, and
//!   are read bit for bit. What is read goes through the constructors, and what they refuse is an error
//!   with their words. Bounds, stretches, batches and lists, which follow from these, are made again.
//! - `bytemuck`: `GpuEllipsoid` and `GpuSphere`, lights as the records that a shader reads. The lists of
//!   `LightLists` are such buffers as they are.
//!
//! # Sources
//!
//! - Dachsbacher & Stamminger 2006, *Splatting indirect illumination*.
//! - Ericson 2005, *Real-time collision detection*.
//! - Heitz 2014, *Understanding the masking-shadowing function in microfacet-based BRDFs*.
//! - Jarzynski & Olano 2020, *Hash functions for GPU rendering*.
//! - Keller 1997, *Instant radiosity*.
//! - Olsson, Billeter & Assarsson 2012, *Clustered deferred and forward shading*.
//! - Phong 1975, *Illumination for computer generated pictures*.
//! - Schlick 1994, *An inexpensive BRDF model for physically-based rendering*.
//! - Segovia et al. 2006, *Non-interleaved deferred shading of interleaved sample patterns*.
//! - Stewart 2015, *Compute-based tiled culling*.
//! - Tokuyoshi & Harada 2016, *Stochastic light culling*; 2017, *Stochastic light culling for VPLs on
//!   GGX microsurfaces*.
//! - Trowbridge & Reitz 1975, *Average irregularity representation of a rough surface for ray
//!   reflection*; Walter et al. 2007, *Microfacet models for refraction through rough surfaces*.

#![no_std]
#![forbid(unsafe_code)]
#![warn(clippy::disallowed_methods)]

#[cfg(feature = "cull")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

// In the order of the corridor: each room knows those above it.
mod num;

mod base;
mod lobe;

mod light;

mod bound;
mod view;

mod project;

mod touch;

#[cfg(feature = "cull")]
mod cull;
#[cfg(any(feature = "bytemuck", feature = "serde"))]
mod interop;

pub use base::{Direction, Error};
pub use bound::{
    BoundStrategy, Bounded, Ellipsoid, HalfSpace, OwnBound, Paper, Proxy, Shape, Sphere, Spheroid,
    Tight, Triaxial,
};
#[cfg(feature = "cull")]
pub use cull::{
    BatchBuilder, CullCounters, Culler, DepthOrder, LightBatch, LightLists, TileDepths,
};
#[cfg(feature = "bytemuck")]
pub use interop::{GpuEllipsoid, GpuSphere};
pub use light::{FrameSeed, Roulette, Vpl, Xi};
pub use lobe::{
    AnisotropicGgx, AnisotropicGgxLobe, Conductor, ConstantLobe, Dielectric, Fresnel,
    FresnelMajorant, Ggx, GgxLobe, HeightCorrelated, Incidence, LambertLobe, Lobe,
    MaskingShadowing, NoFresnel, PhongLobe, Schlick, Separable,
};
pub use project::{
    Project, Projected, ProjectedBound, ProjectedEllipsoid, ProjectedHalfSpace, ProjectedSphere,
    stretch_matrix, stretch_rotation,
};
pub use touch::{BoxTest, TileTest};
pub use view::{Camera, DepthInterval, Interleave, PixelRectangle, TileGrid, TileRectangle};

pub use glam;

/// The README's program is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
