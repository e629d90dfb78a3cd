//! The steps of the crate as functions of WGSL, for shaders of the caller.
//!
//! Each constant is the text of one room of the crate. Join `NUM` and those that a shader calls, in any order, before
//! the shader's own text:
//!
//! ```
//! use stochastic_light_culling::wgsl;
//!
//! let culling = "fn may_light(shape: SlcProjected, tile: SlcTile, depths: vec2f) -> bool {
//!     return slc_touches(shape, tile, depths);
//! }";
//! let shader = [wgsl::NUM, wgsl::LOBE, wgsl::BOUND, wgsl::PROJECT, wgsl::TOUCH, culling].concat();
//! # assert!(shader.contains("fn slc_touches"));
//! ```
//!
//! All names begin with `slc_`, `Slc` or `SLC_`. There are no directives, and outside of the kernels no bindings and no
//! entry points, so the text works in wgpu, in Bevy, and wherever else WGSL is read.
//!
//! # Kernels
//!
//! A frame is two passes: [`BOUNDS_KERNEL`], then [`TILE_KERNEL`], which parts a tile's depths, lists its lights in shared
//! memory and shades its pixels. Where shading is a pass of its own, such as one over transparent surfaces too, the second is
//! three: [`DEPTHS_KERNEL`], [`LISTS_KERNEL`] and [`SHADE_KERNEL`] or a shader of the caller's. The text of [`KERNEL`] says
//! which functions the caller defines. With the feature `bytemuck`, `GpuFrame` has the numbers of a frame, the sizes of its
//! buffers and the numbers of workgroups, `GpuBuffer` the bindings, and `GpuKernel` what each kernel binds. The program
//! `gpu/examples/cull_and_shade.rs` of the repository is a whole one.
//!
//! Any number of lights may touch a tile: no list overflows, or else its pixels are shaded by all lights.
//!
//! # No light is lost
//!
//! WGSL promises less than `f32` does on a CPU: sums round either way, divisions err by 2.5 units in the last place,
//! compilers reorder operations, and infinities need not exist. The margins of these functions pay for all that is
//! allowed, so the promise of the crate holds for them: **a light reaches no point of a tile that
//! `slc_touches` is false for.** They do not decide bit for bit as the CPU does. `docs/rounding.md` counts the margins.
//!
//! It holds for cameras with a perspective, for ξ from 2⁻³², and where δ, fluxes and the other numbers of a light are
//! normal `f32` numbers, with ranges from 10⁻¹² to 10¹², roughnesses from 2⁻²⁰, and lights up to 10⁶ ranges from the eye.

use crate::bound::TABLE as KNOTS;

/// Outward rounding. All others need it.
pub const NUM: &str = include_str!("../../shaders/num.wgsl");
/// The record of a light, and what it reflects into a direction. Needs [`NUM`].
pub const LOBE: &str = include_str!("../../shaders/lobe.wgsl");
/// ξ of a light in a frame, and Russian roulette. Needs [`NUM`].
pub const LIGHT: &str = include_str!("../../shaders/light.wgsl");
/// The bounds of the paper. Needs [`NUM`] and [`LOBE`].
pub const BOUND: &str = include_str!("../../shaders/bound.wgsl");
/// The [tight](crate::Tight) bound. Needs [`NUM`], [`LOBE`] and [`BOUND`], and a variable that the caller declares,
/// with the contents of [`TABLE`]: `var<storage, read> slc_table: array<vec4f>;`.
pub const TIGHT: &str = include_str!("../../shaders/tight.wgsl");
/// The lobe of a spot light, and its bound. Needs [`NUM`], [`LOBE`] and [`BOUND`].
pub const SPOT: &str = include_str!("../../shaders/spot.wgsl");
/// A spherical Gaussian, and its bound. Needs [`NUM`], [`LOBE`] and [`BOUND`].
pub const GAUSSIAN: &str = include_str!("../../shaders/gaussian.wgsl");
/// An anisotropic GGX lobe. Needs [`NUM`] and [`LOBE`].
pub const ANISOTROPIC: &str = include_str!("../../shaders/anisotropic.wgsl");
/// Bounds in the space of a camera. Needs [`NUM`], [`LOBE`] and [`BOUND`].
pub const PROJECT: &str = include_str!("../../shaders/project.wgsl");
/// The test of a projected bound against a tile. Needs what [`PROJECT`] needs, and that.
pub const TOUCH: &str = include_str!("../../shaders/touch.wgsl");
/// Interleaved sampling. Needs no other text.
pub const VIEW: &str = include_str!("../../shaders/view.wgsl");

/// What the kernels of a frame share: the record of a frame, ξ of its lights, and depths. Needs the texts above but
/// [`TIGHT`], [`TOUCH`] and those of single lobes.
pub const FRAME: &str = include_str!("../../shaders/frame.wgsl");

/// The texts above, joined, but [`TIGHT`], [`SPOT`], [`GAUSSIAN`] and [`ANISOTROPIC`].
pub const FUNCTIONS: &str = concat!(
    include_str!("../../shaders/num.wgsl"),
    include_str!("../../shaders/lobe.wgsl"),
    include_str!("../../shaders/light.wgsl"),
    include_str!("../../shaders/bound.wgsl"),
    include_str!("../../shaders/project.wgsl"),
    include_str!("../../shaders/touch.wgsl"),
    include_str!("../../shaders/view.wgsl"),
    include_str!("../../shaders/frame.wgsl"),
);
/// What the kernels share: their bindings, and the depth intervals of a workgroup. Needs [`FUNCTIONS`].
pub const KERNEL: &str = include_str!("../../shaders/kernel.wgsl");
/// `slc_bound_lights`: draws ξ of each light, and bounds its range. Needs [`KERNEL`].
pub const BOUNDS_KERNEL: &str = include_str!("../../shaders/bounds_kernel.wgsl");
/// `slc_cull_and_shade`: depths, lists and shading of a tile in one pass. Needs [`KERNEL`].
pub const TILE_KERNEL: &str = include_str!("../../shaders/tile_kernel.wgsl");
/// `slc_part_depths`: the depth intervals of tiles. Needs [`KERNEL`].
pub const DEPTHS_KERNEL: &str = include_str!("../../shaders/depths_kernel.wgsl");
/// `slc_list_lights`: lists of lights for all depth intervals, as `LightLists` holds them. Needs [`KERNEL`].
pub const LISTS_KERNEL: &str = include_str!("../../shaders/lists_kernel.wgsl");
/// `slc_shade`: shades by such lists. Needs [`KERNEL`].
pub const SHADE_KERNEL: &str = include_str!("../../shaders/shade_kernel.wgsl");

/// The table of the tight bound, 42 kB: each knot is two `vec4f`.
pub static TABLE: &[[f32; 8]] = &KNOTS;
