use glam::Vec2;

use crate::base::Error;

/// What a tile covers of the plane at depth 1: a rectangle of slopes (x/z, y/z), its edges included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileRectangle {
    min: Vec2,
    max: Vec2,
}

/// The greatest slope, far beyond those in a view, which are at most 200.
///
/// It keeps infinities out of the tile test's sums: since M = BS with B orthonormal, its elements are at most
/// 10³⁰, the reciprocal of the least semi-axis that a projected ellipsoid has, and below 10³³ with their
/// rounding, so that its image of a point at depth 1 is below 10³⁷. The product of that and a depth of zero is
/// zero, where it would be NaN of an infinity.
const MOST_SLOPE: f32 = 1e6;

impl TileRectangle {
    /// The rectangle from `min` to `max`, within the view that lights are stretched for; see
    /// [`Camera::tile_rectangle`](crate::Camera::tile_rectangle).
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if a slope is NaN or beyond ±10⁶, or a component of `min` exceeds that of `max`.
    pub fn new(min: Vec2, max: Vec2) -> Result<Self, Error> {
        let refused = |value: Vec2, valid| Error::Vector {
            quantity: "corner of a tile",
            value: value.extend(1.0),
            valid,
        };
        let within = |corner: Vec2| corner.abs().cmple(Vec2::splat(MOST_SLOPE)).all();
        if !within(min) {
            return Err(refused(min, "within ±10⁶"));
        }
        if !(within(max) && min.cmple(max).all()) {
            return Err(refused(
                max,
                "within ±10⁶ and not less than its least corner",
            ));
        }
        Ok(Self { min, max })
    }

    /// The rectangle between two corners, both within the greatest slope.
    #[inline]
    pub(crate) fn from_corners(a: Vec2, b: Vec2) -> Self {
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// The least slopes.
    #[must_use]
    pub fn min(&self) -> Vec2 {
        self.min
    }

    /// The greatest slopes.
    #[must_use]
    pub fn max(&self) -> Vec2 {
        self.max
    }
}
