//! Errors and unit directions.

mod direction;
mod error;

pub use direction::Direction;
pub(crate) use direction::mirrored;
pub use error::Error;
pub(crate) use error::{finite, number_in, orthonormal};
