//! Gives the vectors and matrices of Bevy to this crate, and takes them back.

use bevy_math::{Mat3, Mat4, Vec2, Vec3, proj as directx};

#[path = "../../frame.rs"]
mod frame;

pub use frame::touched_tiles;
