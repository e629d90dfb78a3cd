//! What others do with the same lights: their ranges as polyhedra, drawn by a rasteriser, or fewer
//! lights and no culling at all.

pub mod cluster;
pub mod fewer;
mod polyhedron;
pub mod splat;

pub use polyhedron::{Polyhedron, Raster, Span};
