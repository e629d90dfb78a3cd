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
//! All names begin with `slc_`, `Slc` or `SLC_`. There are no directives, no bindings and no entry points, so the text
//! works in wgpu, in Bevy, and wherever else WGSL is read.
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
/// Bounds in the space of a camera. Needs [`NUM`], [`LOBE`] and [`BOUND`].
pub const PROJECT: &str = include_str!("../../shaders/project.wgsl");
/// The test of a projected bound against a tile. Needs what [`PROJECT`] needs, and that.
pub const TOUCH: &str = include_str!("../../shaders/touch.wgsl");
/// Interleaved sampling. Needs no other text.
pub const VIEW: &str = include_str!("../../shaders/view.wgsl");

/// The table of the tight bound, 42 kB: each knot is two `vec4f`.
pub static TABLE: &[[f32; 8]] = &KNOTS;
