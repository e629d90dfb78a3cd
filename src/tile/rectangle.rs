use glam::Vec2;

use crate::Error;

/// What a tile covers of the plane at depth 1: a rectangle of slopes (x/z, y/z), its edges included.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        into = "crate::unchecked::TileRectangle",
        try_from = "crate::unchecked::TileRectangle"
    )
)]
pub struct TileRectangle {
    min: Vec2,
    max: Vec2,
}

impl TileRectangle {
    /// The rectangle from `min` to `max`, within the view that lights are stretched for; see
    /// [`Camera::tile_rectangle`](crate::Camera::tile_rectangle).
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if a bound is not finite, or a component of `min` exceeds that of `max`.
    pub fn new(min: Vec2, max: Vec2) -> Result<Self, Error> {
        let refused = |value: Vec2, valid| Error::Vector {
            quantity: "corner of a tile",
            value: value.extend(1.0),
            valid,
        };
        if !min.is_finite() {
            return Err(refused(min, "finite"));
        }
        if !(max.is_finite() && min.cmple(max).all()) {
            return Err(refused(max, "finite and not less than its least corner"));
        }
        Ok(Self { min, max })
    }

    #[inline]
    pub(crate) fn from_corners(a: Vec2, b: Vec2) -> Self {
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// The least slopes.
    pub fn min(&self) -> Vec2 {
        self.min
    }

    /// The greatest slopes.
    pub fn max(&self) -> Vec2 {
        self.max
    }
}
