//! Tests of a projected shape against a tile: the box test and the exact test.

mod box_test;
mod frustum;
mod receivers;

pub use box_test::BoxTest;
#[cfg(feature = "cull")]
pub(crate) use box_test::Outline;
pub(crate) use frustum::Frustum;
#[cfg(feature = "cull")]
pub(crate) use receivers::LitFrom;

use crate::project::{ProjectedEllipsoid, ProjectedHalfSpace, ProjectedSphere};
use crate::view::{DepthInterval, Projection, TileRectangle, ViewBounds};

/// Tests whether a projected bound touches a tile.
///
/// For generic code. Each implementor also has these as inherent functions, but for the half-space, which has
/// no exact test.
pub trait TileTest {
    /// Whether the bound may hold a point that `rectangle` covers and whose depth lies in `depths`.
    ///
    /// Conservative: always true if it holds such a point, and true for some tiles without one.
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool;

    /// The exact test: [`touches`](Self::touches) with fewer false positives.
    ///
    /// Always true if the bound holds a point of the tile. False whenever [`touches`](Self::touches) is
    /// false, and for nearly all other tiles without a point of the bound, if there is an exact test.
    ///
    /// Takes several times as long, and rejects few per cent of what [`touches`](Self::touches) accepts. Worth
    /// it only if the work for each light of a list takes a hundred times as long as this test.
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }
}

impl<P: Projection> ProjectedEllipsoid<P> {
    /// The bounds of the ellipsoid against the tile, then the box test: the unit sphere against the bounding
    /// box of the tile's image at the depths that both have [Tokuyoshi & Harada 2017, Sec. 5.2].
    ///
    /// Always true if the ellipsoid holds a point that `rectangle` covers and whose depth lies in
    /// `depths`. True for some tiles without such a point.
    #[inline]
    #[must_use]
    pub fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        touches_box(self, &ViewBounds::of_tile(rectangle, depths))
    }

    /// The exact test: [`touches`](Self::touches), then the unit sphere against the tile's image itself, a
    /// frustum.
    ///
    /// Always true if the ellipsoid holds a point of the tile. Takes several times as long as
    /// [`touches`](Self::touches), and rejects few per cent of what that accepts.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Camera, DepthInterval, Ellipsoid, TileRectangle, glam::{Mat3, Vec2, Vec3},
    /// };
    ///
    /// // Beside a deep tile, and turned so that its bounds and the tile's box meet.
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.5, 1.0, 0.1..100.0)?;
    /// let center = Vec3::new(4.5, 0.0, -11.0);
    /// let ellipsoid = Ellipsoid::new(center, Mat3::from_rotation_y(1.0), Vec3::new(2.0, 1.0, 1.0))?;
    /// let light = ellipsoid.project(&camera).expect("not empty");
    /// let tile = TileRectangle::new(Vec2::new(0.5, 0.0), Vec2::new(0.6, 0.1))?;
    /// let depths = DepthInterval::new(5.0, 10.0)?;
    /// assert!(light.touches(&tile, &depths));
    /// assert!(!light.touches_exactly(&tile, &depths));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[inline]
    #[must_use]
    pub fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let tile = ViewBounds::of_tile(rectangle, depths);
        touches_box(self, &tile) && touches_frustum(self, &tile)
    }
}

impl<P: Projection> ProjectedSphere<P> {
    /// The bounds of the sphere against the tile, then the box test: the sphere against the bounding box of
    /// the tile, at the depths that both have, in camera space.
    ///
    /// Always true if the sphere holds a point that `rectangle` covers and whose depth lies in
    /// `depths`. True for some tiles without such a point.
    #[inline]
    #[must_use]
    pub fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        touches_box(self, &ViewBounds::of_tile(rectangle, depths))
    }

    /// The exact test: [`touches`](Self::touches), then the sphere against the tile itself.
    ///
    /// Always true if the sphere holds a point of the tile. Takes several times as long as
    /// [`touches`](Self::touches).
    #[inline]
    #[must_use]
    pub fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let tile = ViewBounds::of_tile(rectangle, depths);
        touches_box(self, &tile) && touches_frustum(self, &tile)
    }
}

impl<P: Projection> ProjectedHalfSpace<P> {
    /// Tests the corner of the tile that is farthest along the normal.
    ///
    /// Always true if the half-space holds a point that `rectangle` covers and whose depth lies in
    /// `depths`. False for all other tiles, but for rounding.
    #[inline]
    #[must_use]
    pub fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let (min, max) = (rectangle.min(), rectangle.max());
        let (normal, [near, far]) = (self.normal(), [depths.near(), depths.far()]);
        let max = if P::IS_PERSPECTIVE {
            let [a, b] = [min, max].map(|corner| normal * corner.extend(1.0));
            let farthest = a.max(b);
            let at_one = farthest.x + farthest.y + farthest.z + self.rounding_at_one();
            (at_one * near).max(at_one * far)
        } else {
            let [a, b] = [min.extend(near), max.extend(far)].map(|corner| normal * corner);
            let farthest = a.max(b);
            // No less than the length of any point of the tile.
            let length = min.abs().max(max.abs()).element_sum() + far;
            farthest.x + farthest.y + farthest.z + self.rounding_at_one() * length
        };
        // Not `>=`, which would be false if an overflow makes NaN.
        !matches!(
            max.partial_cmp(&self.offset()),
            Some(core::cmp::Ordering::Less)
        )
    }
}

/// The test by bounds and box of one shape.
#[inline(always)]
fn touches_box<P: BoxTest>(shape: &P, tile: &ViewBounds<f32>) -> bool {
    let fields = shape.to_fields();
    let bounds = P::bounds_of(&fields);
    let outline = P::outline(&fields, tile.across, tile.down);
    bounds.meet(tile) && !P::misses(&fields, &outline, tile.depths)
}

/// The exact test of one shape, after the box test.
#[inline(always)]
fn touches_frustum<P: BoxTest>(shape: &P, tile: &ViewBounds<f32>) -> bool {
    let fields = shape.to_fields();
    let tile = P::clipped(&fields, tile).widen();
    let mut image = P::fields_of(0.0_f64);
    for (double, single) in image.as_mut().iter_mut().zip(fields.as_ref()) {
        *double = f64::from(*single);
    }
    Frustum::<_, P::Projection>::new(P::image(&image), tile).meets_ball()
}

impl<P: Projection> TileTest for ProjectedEllipsoid<P> {
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }

    #[inline]
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches_exactly(rectangle, depths)
    }
}

impl<P: Projection> TileTest for ProjectedSphere<P> {
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }

    #[inline]
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches_exactly(rectangle, depths)
    }
}

impl<P: Projection> TileTest for ProjectedHalfSpace<P> {
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }
}
