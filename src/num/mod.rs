//! The arithmetic that all formulas are written in.
//!
//! A formula is one function, generic over [`Real`]. With an `f32` or an `f64` it computes one value; with
//! [`F32Lanes`] or [`F64Lanes`] it computes one value in each lane of a vector register, and with [`Twice`] of these
//! in each lane of two. The operations and their order are the same, and none are fused. So all give the same bits.
//!
//! # NaN
//!
//! Every implementor follows the same rules on every processor:
//!
//! - `a.max(b)` and `a.min(b)` are `b` if either operand is NaN. Write the operand that is never NaN last.
//! - Comparisons with NaN are false, so `!(a > b)` is true for NaN.
//! - A flag is a [`Mask`], never a NaN.
//!
//! Outside of generic code, `max` and `min` of an `f32` or an `f64` are the inherent functions of the
//! standard library, which return the operand that is not NaN.

#[cfg(feature = "cull")]
mod double_lanes;
mod exponential;
mod float;
#[cfg(feature = "cull")]
mod lanes;
#[cfg(all(test, feature = "cull"))]
mod lanes_tests;
mod real;
mod rounding;
mod scalar;
#[cfg(feature = "cull")]
mod twice;
mod vector;

#[cfg(all(test, feature = "cull"))]
pub(crate) use lanes_tests::{LaneTest, at_every_level, to_array};

pub(crate) use exponential::{exponential, one_minus_exponential};
pub(crate) use float::{ln_1p_f64, power, sin_cos, sqrt, sqrt_f64, tan};
#[cfg(feature = "cull")]
pub(crate) use lanes::{F32Lanes, MAX_LANES};
pub(crate) use real::{Double, Quad, Real, Single};
pub(crate) use rounding::{UNIT_ROUNDOFF, round_down, round_up};
#[cfg(feature = "cull")]
pub(crate) use twice::{Twice, load_quads_twice};
pub(crate) use vector::{Matrix3, Vector3, dot_f64, exact_dot};
