use super::{DepthInterval, TileRectangle};
use crate::num::Single;

/// Ranges of slopes and depths that hold a tile, or what a shape reaches. Each is \[least, greatest\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewBounds<N> {
    /// Slopes x/z.
    pub across: [N; 2],
    /// Slopes y/z.
    pub down: [N; 2],
    /// Depths z.
    pub depths: [N; 2],
}

impl ViewBounds<f32> {
    #[inline(always)]
    pub fn of_tile(rectangle: &TileRectangle, depths: &DepthInterval) -> Self {
        let (min, max) = (rectangle.min(), rectangle.max());
        Self {
            across: [min.x, max.x],
            down: [min.y, max.y],
            depths: [depths.near(), depths.far()],
        }
    }
}

impl<N: Single> ViewBounds<N> {
    #[inline(always)]
    pub fn widen(self) -> ViewBounds<N::Double> {
        let widen = |[min, max]: [N; 2]| [min.widen(), max.widen()];
        ViewBounds {
            across: widen(self.across),
            down: widen(self.down),
            depths: widen(self.depths),
        }
    }

    /// Whether the two have no slope across, no slope down, or no depth in common.
    #[inline(always)]
    pub fn are_apart(&self, other: &Self) -> N::Mask {
        are_disjoint(self.across, other.across)
            | are_disjoint(self.down, other.down)
            | are_disjoint(self.depths, other.depths)
    }
}

/// Whether two ranges have nothing in common.
#[inline(always)]
fn are_disjoint<N: Single>([a_min, a_max]: [N; 2], [b_min, b_max]: [N; 2]) -> N::Mask {
    a_min.gt(b_max) | b_min.gt(a_max)
}
