//! Evaluation of listed lights at the points that they may reach, in lanes.
//!
//! [`ShadingBatch`] holds a line of 64 bytes for each light. [`RadianceEstimator`] evaluates a list of lights
//! in one of two ways (`estimator`). For the points of a tile, a light's line is broadcast, and a vector holds
//! one point in each lane (`block`). For points with lists of their own, a vector holds a light and a point in
//! each lane, and as many lines are transposed (`pairs`). Both call one function (`kernel`, and `cluster` for
//! clusters of lights).
//!
//! A receiver (`receiver`) is a point with a lobe of its own, that of light from the eye. Transformed cosines are made in
//! lanes too (`transformed`).
//!
//! What arrives at a point is known before it is decided whether it counts. There are three ways to decide
//! (`decision`): by what arrives, by what the receiver reflects of it, and not at all, where lists were drawn as
//! they were made. The way is a type parameter, so that each is compiled by itself.
//!
//! Direction, lobe and roulette are the generic functions that scalar code runs, so that estimates have the
//! same bits.

mod batch;
mod block;
mod cluster;
mod decision;
mod estimator;
mod kernel;
mod pairs;
mod point;
mod receiver;
#[cfg(feature = "ltc")]
mod transformed;

pub use batch::ShadingBatch;
pub use block::{BlockEstimates, PointBlock};
pub use decision::{AtPoint, AtReceiver, Decision, InList, PointDecision};
pub use estimator::RadianceEstimator;
pub(super) use kernel::Lights;
pub use kernel::ShadedLight;
pub use point::{Estimate, ShadedPoint};
pub use receiver::{Receiver, ReceiverBlock};
