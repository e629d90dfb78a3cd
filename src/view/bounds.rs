use super::{DepthInterval, TileRectangle};
use crate::num::Single;

/// Ranges of slopes and depths that hold a tile, or what a shape reaches. Each is \[least, greatest\].
///
/// For an orthographic projection, coordinates x and y take the place of slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewBounds<N> {
    /// Slopes x/z, or x.
    pub across: [N; 2],
    /// Slopes y/z, or y.
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

    /// The ranges that the two have in common. Reversed if there are none.
    #[inline(always)]
    pub fn common(&self, other: &Self) -> Self {
        Self {
            across: common(self.across, other.across),
            down: common(self.down, other.down),
            depths: common(self.depths, other.depths),
        }
    }

    /// Whether the two have a slope across, a slope down and a depth in common.
    #[inline(always)]
    pub fn meet(&self, other: &Self) -> N::Mask {
        meet(self.across, other.across)
            & meet(self.down, other.down)
            & meet(self.depths, other.depths)
    }
}

/// The numbers that two ranges have in common. Reversed if there are none.
#[inline(always)]
pub fn common<N: Single>([a_min, a_max]: [N; 2], [b_min, b_max]: [N; 2]) -> [N; 2] {
    [a_min.max(b_min), a_max.min(b_max)]
}

/// Whether two ranges have a number in common. False if an end is NaN.
#[inline(always)]
pub fn meet<N: Single>([a_min, a_max]: [N; 2], [b_min, b_max]: [N; 2]) -> N::Mask {
    a_min.le(b_max) & b_min.le(a_max)
}
