//! The kernels, and what each binds.

use super::GpuBuffer::{
    self, Edges, Frame, Intervals, Lights, Lists, Needed, Projected, Ranges, Xis,
};
use super::GpuFrame;

/// A kernel of the shader text (feature `wgsl`).
///
/// A frame is [`Bounds`](Self::Bounds) and [`Tiles`](Self::Tiles); or `Bounds`, [`Depths`](Self::Depths),
/// [`Lists`](Self::Lists) and [`Shade`](Self::Shade).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GpuKernel {
    /// Draws ξ of each light, and bounds its range.
    Bounds,
    /// Parts the depths of a tile, lists its lights in shared memory, and shades its pixels.
    Tiles,
    /// Parts the depths of tiles.
    Depths,
    /// Lists the lights of each depth interval of each tile.
    Lists,
    /// Shades pixels by such lists.
    Shade,
}

impl GpuKernel {
    /// The name of its entry point.
    #[must_use]
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::Bounds => "slc_bound_lights",
            Self::Tiles => "slc_cull_and_shade",
            Self::Depths => "slc_part_depths",
            Self::Lists => "slc_list_lights",
            Self::Shade => "slc_shade",
        }
    }

    /// The buffers that it binds in group 0.
    #[must_use]
    pub fn buffers(self) -> &'static [GpuBuffer] {
        match self {
            Self::Bounds => &[Frame, Lights, Projected, Xis],
            Self::Tiles => &[Frame, Lights, Projected, Xis, Edges],
            Self::Depths => &[Frame, Intervals],
            Self::Lists => &[Frame, Projected, Edges, Intervals, Ranges, Lists, Needed],
            Self::Shade => &[Frame, Lights, Xis, Intervals, Ranges, Lists],
        }
    }
}

/// Lights that a workgroup of the kernel of bounds takes.
pub(super) const LIGHTS_OF_WORKGROUP: u32 = 64;

impl GpuFrame {
    /// How many workgroups a kernel takes: one for 64 lights, or one for each tile of each subregion.
    #[must_use]
    pub fn workgroups(&self, kernel: GpuKernel) -> [u32; 3] {
        let [columns, rows] = self.tiles;
        match kernel {
            GpuKernel::Bounds => [self.lights.div_ceil(LIGHTS_OF_WORKGROUP).max(1), 1, 1],
            _ => [columns, rows, self.interleave * self.interleave],
        }
    }
}
