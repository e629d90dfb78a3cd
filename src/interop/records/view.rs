//! Cameras and tiles in the memory layout of shaders.

use bytemuck::{Pod, Zeroable};

use crate::view::{Camera, TileRectangle};

/// A [`Camera`] with a perspective, for shaders: `SlcCamera`, 80 bytes.
///
/// Shaders have no `f64`. So they take points relative to an anchor near the eye, and nothing is lost where both are far
/// from the world's origin.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuCamera {
    /// The first row of the rotation from world space to camera space; offset 0.
    pub right: [f32; 3],
    /// How far the rotation is from orthonormal; offset 12.
    pub deviation: f32,
    /// The second row; offset 16.
    pub up: [f32; 3],
    /// 1/cos of the angle between the viewing direction and the farthest corner of the view; offset 28.
    pub secant: f32,
    /// The third row; offset 32.
    pub forward: [f32; 3],
    /// An upper bound of the error of `image`, in the unit of length; offset 44.
    pub rounding: f32,
    /// A point of world space at the eye, as nearly as `f32` allows; offset 48.
    pub anchor: [f32; 3],
    /// Depth = `depth_numerator`/(value of the depth buffer + `depth_offset`); offset 60.
    pub depth_numerator: f32,
    /// The anchor in camera space; offset 64.
    pub image: [f32; 3],
    /// See `depth_numerator`; offset 76.
    pub depth_offset: f32,
}

impl From<&Camera> for GpuCamera {
    fn from(camera: &Camera) -> Self {
        let view = camera.view();
        let [right, up, forward] = [0, 1, 2].map(|i| view.rotation().row(i).to_array());
        let [anchor, image] = view.anchor().map(|point| point.to_array());
        let [depth_numerator, depth_offset] = camera.projection().depths();
        Self {
            right,
            deviation: view.rotation_deviation(),
            up,
            secant: camera.projection().corner_secant(),
            forward,
            rounding: view.rounding_of_anchor(),
            anchor,
            depth_numerator,
            image,
            depth_offset,
        }
    }
}

/// A [`TileRectangle`] for shaders: `SlcTile`, 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuTile {
    /// The least x/z and y/z; offset 0.
    pub min: [f32; 2],
    /// The greatest x/z and y/z; offset 8.
    pub max: [f32; 2],
}

impl From<&TileRectangle> for GpuTile {
    fn from(tile: &TileRectangle) -> Self {
        Self {
            min: tile.min().to_array(),
            max: tile.max().to_array(),
        }
    }
}
