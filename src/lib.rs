//! Stochastic light culling: tens of thousands of glossy and diffuse lights, culled per tile without
//! losing energy on average.
//!
//! In each frame, Russian roulette draws a range for each light. A point beyond the range ignores the light;
//! a point within it weights the light up, so that the mean over frames is exact [Tokuyoshi & Harada 2016].
//! The range of a light on a glossy surface depends on direction: it is a lobe, which an ellipsoid encloses
//! [Tokuyoshi & Harada 2017]. This crate is the mathematics of that method as pure functions over [`glam`],
//! from a lit surface point to the question whether its light touches a tile.
//!
//! # Steps
//!
//! | step | from | to |
//! |---|---|---|
//! | lobe | surface, incoming direction | what it reflects: [`GgxLobe`], [`LambertLobe`] and others |
//! | light | lobe, position, flux | radiant intensity: [`Vpl`] |
//! | cluster | many lights, or a reflective shadow map | smooth lights: [`ClusterSums`], [`MipPyramid`], [`Vsgl`] |
//! | ξ | rank of a light, frame | random number: [`Xi`], [`Seed`], [`rank_along_curve`] |
//! | range | radiant intensity, ξ | range and weight: [`Roulette`] |
//! | bound | lobe, range | shape that encloses the range: [`Ellipsoid`], [`Spheroid`], [`Sphere`] |
//! | view | camera, image | tiles and their depths: [`Camera`], [`TileGrid`], [`DepthInterval`] |
//! | project | bound, camera | unit sphere: [`ProjectedEllipsoid`], [`ProjectedSphere`] |
//! | touch | projected bound, tile | [`ProjectedEllipsoid::touches`] |
//! | cull | many lights, many tiles | a list of lights for each tile: `Culler` (feature `cull`) |
//!
//! - Lobes: [`GgxLobe`], [`AnisotropicGgxLobe`], [`LambertLobe`], [`PhongLobe`], or any type that implements
//!   [`Lobe`]. Ordinary lamps have a [`ConstantLobe`] or a [`SpotLobe`]: [`Vpl::point`], [`Vpl::spot`].
//!   [`DistanceWindow`] is the end that engines give them.
//! - Bounds: [`Vpl::bound`] gives the recommended bound of a lobe. [`Vpl::bound_by`] takes a strategy:
//!   [`Tight`], [`Triaxial`] or [`Paper`]. [`HalfSpace`] is the lit side of a surface, and [`Proxy`] is a
//!   mesh around a bound, to rasterise it.
//! - Culling: `BatchBuilder` fills a `LightBatch` with lights, `TileDepths` holds the depths of the tiles,
//!   and `Culler` fills `LightLists`. `RadianceEstimator` evaluates the lights of a list at many points.
//!   [`Interleave`] splits image and lights for interleaved sampling.
//!
//! Each step can be used alone and does not depend on the steps after it.
//!
//! ```
//! use stochastic_light_culling::{
//!     Camera, DepthInterval, Direction, Ggx, GgxLobe, Incidence, Roulette, Schlick, Seed,
//!     TileGrid, Vpl, glam::Vec3,
//! };
//!
//! // A point on a gold floor, lit from the upper left by a photon of 0.1 W.
//! let incidence = Incidence {
//!     normal: Direction::Y,
//!     incoming: Direction::new(Vec3::new(-1.0, 1.0, 0.0))?,
//! };
//! let lobe = GgxLobe::new(Ggx::new(0.1)?, Schlick::new(0.9)?, incidence);
//! let light = Vpl::new(Vec3::ZERO, 0.1, lobe)?;
//!
//! // Its range in this frame, enclosed by an ellipsoid.
//! let roulette = Roulette::new(0.01)?;
//! let xi = Seed(0).frame(0).xi(0);
//! let bound = light.bound(&roulette, xi);
//!
//! // The ellipsoid in camera space, projected to a unit sphere.
//! let camera = Camera::look_at(Vec3::new(0.0, 2.0, 9.0), Vec3::Y, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
//! let projected = bound.project(&camera).expect("light with flux reaches somewhere");
//!
//! // The tiles of the image that it touches between two depths.
//! let grid = TileGrid::new([128, 128], 16)?;
//! let depths = DepthInterval::new(7.0, 11.0)?;
//! let touched = grid
//!     .tiles()
//!     .filter(|tile| projected.touches(&camera.tile(&grid, *tile), &depths))
//!     .count();
//! assert!(0 < touched && touched < 64);
//!
//! // A point in one of those tiles accepts the light or not. The mean over ξ is exact.
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
//! - `f32` and the types of [`glam`]. Vectors are columns. Version 0.1 of this crate has the types of glam 0.33,
//!   as Bevy 0.20 does, and version 0.2 those of glam 0.34. They differ in nothing else. If the compiler expects
//!   `stochastic_light_culling::glam::Vec3` and finds another `Vec3`, the other version is the right one.
//! - Directions point away from the surface. A [`Direction`] has unit length to within rounding; where a
//!   function takes a direction as a `Vec3`, it must have unit length to 10⁻⁴.
//! - Camera space has x to the right, y up and z = depth, positive ahead, for an engine's view space of
//!   either handedness ([`Camera`], and [`Orthographic`] for parallel rays). Pixel (0, 0) is at the top left, whether NDC y points up or, as in
//!   Vulkan, down.
//! - Lengths are in the unit of the scene. Angles are in radians, solid angles in sr, flux in W, radiant
//!   intensity in W/sr, radiance in W/(m²·sr). A light of intensity I has the radiance I/l² at distance l.
//! - α is the GGX roughness. The *perceptual* roughness of artists is usually √α.
//! - n is the surface normal. ω_i and ω_o point to where light comes from and goes to, and ω_h is the half
//!   vector. μ = ω_i·n, μ_o = ω_o·n, k = 1 − α². u = 2⁻²⁴ is the unit roundoff of `f32`.
//!
//! # Views
//!
//! A [`Camera`] has a [`Perspective`] or an [`Orthographic`] projection, and is made of an engine's two matrices
//! ([`Camera::new`], [`Camera::orthographic`], or [`AnyCamera::new`] for either) or by hand ([`Camera::look_at`],
//! [`Camera::orthographic_look_at`]). The projection is a type parameter of the camera, and of projected shapes and their
//! batches. So a program that has one kind contains nothing of the other, and shapes of one are not tested in a batch of
//! the other. Tiles of an orthographic view are boxes. There is no eye, so [`Orthographic`] says where its depths begin.
//!
//! *Jitter* is part of the projection matrix, or [`Camera::jittered`]. `TileDepths::set_view` follows the camera without
//! allocating.
//!
//! Several views of a frame share lights, ξ, kept bounds and a `ShadingBatch`, none of which knows of a camera. They also
//! share a batch and a culler, one after the other; views that are culled at the same time need one for each. Each view
//! has its own tiles and its own lists. Nothing is allocated after the first frame:
//!
//! ```
//! use std::f32::consts::FRAC_PI_2;
//! use stochastic_light_culling::{
//!     BatchBuilder, Camera, ConstantLobe, Culler, DepthInterval, Error, LightBatch, LightLists,
//!     ProjectedSphere, Projection, Roulette, Seed, TileDepths, TileGrid, Vpl,
//!     glam::Vec3,
//! };
//!
//! /// What all views with one kind of projection share.
//! struct Shared<P: Projection> {
//!     batch: LightBatch<ProjectedSphere<P>>,
//!     culler: Culler<ProjectedSphere<P>>,
//! }
//!
//! /// What a view keeps from frame to frame.
//! struct View<P: Projection> {
//!     camera: Camera<P>,
//!     tiles: TileDepths,
//!     lists: LightLists,
//! }
//!
//! impl<P: Projection> View<P> {
//!     fn new(camera: Camera<P>, grid: &TileGrid) -> Result<Self, Error> {
//!         let tiles = TileDepths::new(grid, &camera, 8)?;
//!         Ok(Self { camera, tiles, lists: LightLists::new() })
//!     }
//!
//!     fn cull(
//!         &mut self,
//!         grid: &TileGrid,
//!         slices: impl Iterator<Item = DepthInterval> + Clone,
//!         lights: &[Vpl<ConstantLobe>],
//!         frame: u32,
//!         shared: &mut Shared<P>,
//!     ) -> Result<(), Error> {
//!         // The camera may have moved.
//!         self.tiles.set_view(grid, &self.camera)?;
//!         for tile in grid.tiles() {
//!             // In an engine, of the depth buffer of this view.
//!             self.tiles.set(tile, slices.clone());
//!         }
//!         let (roulette, seed) = (Roulette::new(0.1)?, Seed(0).frame(frame));
//!         shared.batch.clear();
//!         let with_xi = (0..).zip(lights).map(|(i, light)| (i, light, seed.xi(i)));
//!         BatchBuilder::new(&roulette, &self.camera).add(with_xi, &mut shared.batch);
//!         shared.culler.cull(&shared.batch, &self.tiles, &mut self.lists)?;
//!         Ok(())
//!     }
//! }
//!
//! let lights: Vec<_> = (0..500)
//!     .map(|i| Vpl::point(Vec3::new((i % 25) as f32, 1.0, (i / 25) as f32), 1.0))
//!     .collect::<Result<_, _>>()?;
//! let (eye, grid) = (Vec3::new(12.0, 2.0, 10.0), TileGrid::new([256, 256], 32)?);
//!
//! // The faces of a cube around a probe. A split screen is the same with two cameras.
//! let mut faces = Vec::new();
//! for (ahead, up) in [
//!     (Vec3::X, Vec3::Y), (Vec3::NEG_X, Vec3::Y), (Vec3::Y, Vec3::Z),
//!     (Vec3::NEG_Y, Vec3::Z), (Vec3::Z, Vec3::Y), (Vec3::NEG_Z, Vec3::Y),
//! ] {
//!     let camera = Camera::look_at(eye, eye + ahead, up, FRAC_PI_2, 1.0, 0.1..100.0)?;
//!     faces.push(View::new(camera, &grid)?);
//! }
//! // Cascades of a map from above, each twice as wide as the one before.
//! let mut cascades = Vec::new();
//! for height in [8.0, 16.0, 32.0] {
//!     let camera = Camera::orthographic_look_at(eye, eye - Vec3::Y, Vec3::Z, height, 1.0, -10.0..10.0)?;
//!     cascades.push(View::new(camera, &grid)?);
//! }
//!
//! // Each frame:
//! let mut to_faces = Shared { batch: LightBatch::new(), culler: Culler::new() };
//! for face in &mut faces {
//!     let slices = DepthInterval::new(0.1, 100.0)?.exponential_slices(8);
//!     face.cull(&grid, slices, &lights, 0, &mut to_faces)?;
//! }
//! let mut to_cascades = Shared { batch: LightBatch::new(), culler: Culler::new() };
//! for cascade in &mut cascades {
//!     let [near, far] = [0.0, 1.0].map(|value| cascade.camera.depth(value));
//!     let slices = DepthInterval::new(near, far)?.uniform_slices(8);
//!     cascade.cull(&grid, slices, &lights, 0, &mut to_cascades)?;
//! }
//! assert!(faces.iter().all(|face| !face.lists.is_empty()));
//! assert!(cascades.iter().all(|cascade| !cascade.lists.is_empty()));
//! # Ok::<(), Error>(())
//! ```
//!
//! # Errors and panics
//!
//! Constructors check their arguments and return an [`Error`] that names the quantity and its value. What
//! they return is valid: no later step fails, panics, allocates or makes NaN from finite arguments. The
//! exceptions are in culling. It allocates, in general only in its first frame, and returns an error if its
//! lists would hold 2³² lights. `TileDepths::set` and `TileDepths::interval_of` panic for a tile outside the
//! grid, `ShadingBatch::set_xi` and `RadianceEstimator` for a light outside the batch.
//!
//! A light that reflects nothing, because its flux is zero or it is lit from behind, is not an error. Its
//! bound is empty, and projecting an empty bound gives `None` ([`Ellipsoid::project`]).
//!
//! # No light is lost
//!
//! Roulette is unbiased only if culling never drops a light that a point accepts. The promise is about the
//! `f32` numbers that the functions take, and not about real numbers that were rounded to them:
//!
//! **Let a tile lie in the view of a camera, and let it contain a point p, as the `f32` numbers of its
//! rectangle and depth interval define it, with ‖p − q‖ ≤ l_max(ω_o) in exact arithmetic on the `f32`
//! numbers of the light at q. Then [`touches`](TileTest::touches) and
//! [`touches_exactly`](TileTest::touches_exactly) are true** of these bounds of the light, projected with
//! that camera: those that [`Paper`], [`Triaxial`], [`Tight`] and [`Focal`] give, both spheres of a [`Spheroid`], and
//! the [`HalfSpace`] above the light's surface. The bound of a [`Vsgl`] keeps it for points where E ≥ δξ. Here a
//! direction stands for the vector of exactly unit length along it, and a point of world space for its exact image
//! under the camera's matrix.
//!
//! It holds for
//!
//! - α from 2⁻²⁰ to 1, every μ > 0, sharpnesses to 2²², and ξ from 2⁻³²;
//! - spot lights with an outer cone from 10⁻³ rad to 180°, of which the numbers are [`SpotLobe::versines`];
//! - ranges from 10⁻¹² to 10¹², and lights up to 10⁶ ranges from the origin and from the eye;
//! - views of any rotation, handedness and offset: perspectives with corners up to 89.7° from the viewing direction,
//!   and orthographic views with edges up to 10¹² from their axis;
//! - lights around and behind the eye, and depth intervals of zero thickness.
//!
//! Outside these ranges a bound is only larger, up to the whole view. The radius of a projected sphere is at
//! least 10⁻¹⁸, and the semi-axes of a projected ellipsoid are at least 10⁻²⁴.
//!
//! F of a [`Dielectric`] and of a [`Conductor`] is largest at an end of a range of angles, which is proved for
//! all of their indices. Three bounds rest on more than proofs by hand and counted roundings. The ellipsoids of
//! the table behind [`Tight`], between whose knots it interpolates, are proved to enclose by a computer, box by
//! box: `examples/tabulate -- --prove`. So are those of [`Vsgl::bound`]. The ellipsoid of a [`SphericalGaussian`] is
//! proved likewise, by a test.
//!
//! The cost: at α ≥ 0.01 and ranges of at least 10⁻³ of the distance to the eye and to the origin, the
//! volume of ellipsoids grows by less than 0.1 % on average; at α = 10⁻⁶ by a large factor.
//! `examples/stability` prints the table, and `docs/rounding.md` counts the roundings.
//!
//! # Scope
//!
//! The crate has lobes and their bounds, roulette, projection, tile tests, culling and interleaved sampling.
//! A [`Receiver`] is a surface point with what it reflects to the eye; of those of a tile, or of a block of tiles, there
//! is a bound, so that lights are culled and drawn by what the eye sees of them.
//! The crate does not find lit points, trace visibility, shade, denoise, talk to a GPU or store a scene.
//! `examples/render` shows one way to do these.
//!
//! # Features
//!
//! - `std` (default): floating-point functions from the standard library.
//! - `libm`: floating-point functions from the [libm](https://docs.rs/libm) crate. Without `std` the crate
//!   is `no_std`. One of the two is required; with both, `std` is used.
//! - `cull`: many lights against many tiles, and their evaluation, in the widest vectors of the processor. Needs an allocator and
//!   Rust 1.89.
//! - `ltc`: `LtcLobe`, a linearly transformed cosine in the place of a GGX lobe, with its table of 49 kB.
//! - `rayon`: culling on many cores. Enables `cull` and `std`.
//! - `serde`: serialization of materials, lobes, lights, cameras, and settings such as roulette, ξ, tile
//!   grids, depth intervals and interleaving, most under the names of the constructors' arguments. Values
//!   are restored bit for bit. Deserialization goes through the constructors and returns their errors.
//!   Bounds, projected shapes, batches and lists follow from these and are not serialized.
//! - `wgsl`: the steps as text in WGSL, and kernels that cull and shade ([`wgsl`]).
//! - `bytemuck`: records that shaders can read: lights (`GpuLight`), bounds (`GpuBound`), projected shapes (`GpuEllipsoid`,
//!   `GpuSphere`), and the camera and numbers of a frame (`GpuCamera`, `GpuFrame`). The two arrays of `LightLists` can be
//!   uploaded unchanged.
//!
//! # Sources
//!
//! - Clarberg, Jarosz, Akenine-Möller & Jensen 2005, *Wavelet importance sampling*.
//! - Dachsbacher & Stamminger 2005, *Reflective shadow maps*; 2006, *Splatting indirect illumination*.
//! - Ericson 2005, *Real-time collision detection*.
//! - Heitz 2014, *Understanding the masking-shadowing function in microfacet-based BRDFs*.
//! - Heitz, Dupuy, Hill & Neubelt 2016, *Real-time polygonal-light shading with linearly transformed
//!   cosines*.
//! - Jarzynski & Olano 2020, *Hash functions for GPU rendering*.
//! - Karis 2013, *Real shading in Unreal Engine 4*.
//! - Keller 1997, *Instant radiosity*.
//! - Kollig & Keller 2002, *Efficient multidimensional sampling*; Sobol' 1967, *On the distribution of points in a
//!   cube and the approximate evaluation of integrals*.
//! - Křivánek & Colbert 2008, *Real-time shading with filtered importance sampling*.
//! - Olsson, Billeter & Assarsson 2012, *Clustered deferred and forward shading*.
//! - Phong 1975, *Illumination for computer generated pictures*.
//! - Schlick 1994, *An inexpensive BRDF model for physically-based rendering*.
//! - Segovia et al. 2006, *Non-interleaved deferred shading of interleaved sample patterns*.
//! - Stewart 2015, *Compute-based tiled culling*.
//! - Toksvig 2005, *Mipmapping normal maps*.
//! - Tokuyoshi 2015, *Virtual spherical Gaussian lights for real-time glossy indirect illumination*.
//! - Tokuyoshi 2016, *Modified filtered importance sampling for virtual spherical Gaussian lights*, the
//!   supplemental material; Tokuyoshi et al. 2024, *Hierarchical light sampling with accurate spherical
//!   Gaussian lighting*.
//! - Tokuyoshi & Harada 2016, *Stochastic light culling*; 2017, *Stochastic light culling for VPLs on
//!   GGX microsurfaces*.
//! - Wang et al. 2009, *All-frequency rendering of dynamic, spatially-varying reflectance*; Xu et al. 2013,
//!   *Anisotropic spherical Gaussians*.
//! - Trowbridge & Reitz 1975, *Average irregularity representation of a rough surface for ray
//!   reflection*; Walter et al. 2007, *Microfacet models for refraction through rough surfaces*.
//! - Xia, Liu, Zeng, Pu & Zhang 2023, *Real-time indirect glossy reflection based on linearly transformed
//!   spherical distributions*.

#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![warn(clippy::disallowed_methods)]

#[cfg(feature = "cull")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

// Each module uses only those above it.
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
mod interop;

pub use base::{Direction, Error};
pub use bound::{
    BoundStrategy, Bounded, Ellipsoid, Focal, HalfSpace, OwnBound, Paper, Proxy, Shape, Sphere,
    Spheroid, Tight, Triaxial,
};
#[cfg(feature = "cull")]
pub use cull::{
    AtPoint, AtReceiver, BatchBuilder, BlockEstimates, CullCounters, Culler, Decision, Estimate,
    InList, LightBatch, LightLists, PointBlock, PointDecision, RadianceEstimator, Receiver,
    ReceiverBlock, ReceiverCuller, ShadedLight, ShadedPoint, ShadingBatch, TileDepths,
    TileReceivers, WeightedList, WeightedLists,
};
#[cfg(feature = "wgsl")]
pub use interop::wgsl;
#[cfg(feature = "bytemuck")]
pub use interop::{
    GpuBound, GpuBuffer, GpuCamera, GpuEllipsoid, GpuFrame, GpuKernel, GpuLight, GpuProjected,
    GpuSphere, GpuTile,
};
pub use light::{
    ClusterSums, DistanceWindow, EvenNoise, FilteredSample, FilteredSampling, FrameSeed,
    MipPyramid, Roulette, Seed, TileProbability, Vpl, Vsgl, Xi, pyramid_len, rank_along_curve,
};
pub use lobe::{
    AnisotropicGgx, AnisotropicGgxLobe, AnisotropicSphericalGaussian, Blind, Cap, Conductor,
    ConstantLobe, Dielectric, Fresnel, FresnelMajorant, Ggx, GgxFamily, GgxLobe, HeightCorrelated,
    Incidence, LambertFamily, LambertLobe, Lobe, LobeFamily, LobeSum, MaskingShadowing, NoFresnel,
    PhongFamily, PhongLobe, ReceiverLobe, Schlick, Separable, SphericalGaussian,
    SphericalGaussianFamily, SpotLobe, SumFamily,
};
#[cfg(feature = "ltc")]
pub use lobe::{LtcFamily, LtcLobe};
pub use project::{
    Project, Projected, ProjectedBound, ProjectedEllipsoid, ProjectedHalfSpace, ProjectedSphere,
    stretch_matrix, stretch_rotation,
};
pub use touch::{BoxTest, TileTest};
pub use view::{
    AnyCamera, Camera, DepthInterval, Interleave, Orthographic, Perspective, PixelRectangle,
    Projection, ReceiverCluster, TileGrid, TileRectangle,
};

/// The vectors and matrices of the interface.
pub use glam;

/// Compiles and runs the programs of the README and of the guide.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
#[doc = include_str!("../docs/guide.md")]
struct Readme;
