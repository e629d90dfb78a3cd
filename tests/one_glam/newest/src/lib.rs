//! Gives the vectors and matrices of glam to this crate, and takes them back.

use glam::{Mat3, Mat4, Vec2, Vec3, camera::rh::proj::directx};

#[path = "../../frame.rs"]
mod frame;

pub use frame::touched_tiles;
