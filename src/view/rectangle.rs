use glam::Vec2;

use crate::base::Error;

/// What a tile covers, with its edges.
///
/// For a [`Perspective`](crate::Perspective), slopes (x/z, y/z): a rectangle of the plane at depth 1. For an
/// [`Orthographic`](crate::Orthographic) projection, coordinates (x, y): the same rectangle at each depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileRectangle {
    min: Vec2,
    max: Vec2,
}

/// Upper limit of a coordinate. Slopes in a view are at most 200.
///
/// Keeps infinities out of the sums of the tile test. The shortest semi-axis of a projected ellipsoid is at
/// least 10⁻²⁴, and M = BS with B orthonormal, so the elements of M are at most 10²⁴, below 2·10²⁴ with their
/// rounding. So the image of a point at depth 1 is below 10³⁷, and its product with a depth of zero is zero.
/// With an infinity that product would be NaN.
pub(super) const MAX_COORDINATE: f32 = 1e12;

impl TileRectangle {
    /// Creates the rectangle from `min` to `max`.
    ///
    /// It should lie within the view of the camera that lights are projected with. Outside the view of a
    /// perspective, rounding can lose a light. [`Camera::tile`](crate::Camera::tile) gives the tiles of a view.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if a coordinate is NaN or outside ±10¹², or a component of `min` is greater than that of
    /// `max`.
    pub fn new(min: Vec2, max: Vec2) -> Result<Self, Error> {
        let refused = |value: Vec2, valid| Error::Vector {
            quantity: "corner of a tile",
            value: value.extend(1.0),
            valid,
        };
        let within = |corner: Vec2| corner.abs().cmple(Vec2::splat(MAX_COORDINATE)).all();
        if !within(min) {
            return Err(refused(min, "within ±10¹²"));
        }
        if !(within(max) && min.cmple(max).all()) {
            return Err(refused(
                max,
                "within ±10¹² and not less than the least corner",
            ));
        }
        Ok(Self { min, max })
    }

    /// The rectangle between two opposite corners, whose coordinates are within
    /// ±[`MAX_COORDINATE`].
    #[inline]
    pub(crate) fn from_corners(a: Vec2, b: Vec2) -> Self {
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// The least x/z and y/z, or x and y.
    #[must_use]
    pub fn min(&self) -> Vec2 {
        self.min
    }

    /// The greatest x/z and y/z, or x and y.
    #[must_use]
    pub fn max(&self) -> Vec2 {
        self.max
    }
}
