//! Whether a shape in camera space touches a tile.

mod box_test;
mod frustum;

pub use box_test::BoxTest;
pub(crate) use box_test::TileBounds;
pub(crate) use frustum::Frustum;

use crate::project::{ProjectedEllipsoid, ProjectedHalfSpace, ProjectedSphere};
use crate::view::{DepthInterval, TileRectangle};

/// Whether a light may touch a tile. For generic code: what implements it has these functions itself.
pub trait TileTest {
    /// Whether the light may reach a point whose slopes lie in `rectangle` and whose depth lies in
    /// `depths`.
    ///
    /// Never false where it does reach one, and true for some tiles that it does not.
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool;

    /// Whether the light may reach such a point, as nearly as it can be told: false of all that
    /// [`touches`](Self::touches) is false of, and of more where there is an exact test.
    ///
    /// Never false where the light does reach a point of the tile. Takes several times as long; worth
    /// it where what is done with each light of a list takes longer.
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }
}

impl ProjectedEllipsoid {
    /// The paper's test of the box around the tile's image [Tokuyoshi & Harada 2017, Sec. 5.2].
    ///
    /// Never false where the light reaches a point whose slopes lie in `rectangle` and whose depth lies in
    /// `depths`, and true for some tiles that it does not reach.
    #[inline]
    #[must_use]
    pub fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        touches_box(self, &TileBounds::new(rectangle, depths))
    }

    /// The box test, and then the distance from the centre of the unit sphere to the tile's image
    /// itself, a frustum.
    ///
    /// Takes several times as long as [`touches`](Self::touches); worth it where what is done with each light
    /// of a list takes longer.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Camera, DepthInterval, Ellipsoid, TileRectangle, glam::{Mat3, Vec2, Vec3},
    /// };
    ///
    /// // Beside a deep tile far off the axis, but in the box around it.
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.5, 1.0, 0.1..100.0)?;
    /// let center = Vec3::new(5.5, 0.0, -5.2);
    /// let ellipsoid = Ellipsoid::new(center, Mat3::IDENTITY, Vec3::new(0.5, 1.0, 0.5))?;
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
        let tile = TileBounds::new(rectangle, depths);
        touches_box(self, &tile) && touches_frustum(self, &tile)
    }
}

impl ProjectedSphere {
    /// The test against the tile's box in camera space.
    ///
    /// Never false where the light reaches a point whose slopes lie in `rectangle` and whose depth lies in
    /// `depths`, and true for some tiles that it does not reach.
    #[inline]
    #[must_use]
    pub fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        touches_box(self, &TileBounds::new(rectangle, depths))
    }

    /// The box test, and then the distance to the tile itself.
    #[inline]
    #[must_use]
    pub fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let tile = TileBounds::new(rectangle, depths);
        touches_box(self, &tile) && touches_frustum(self, &tile)
    }
}

impl ProjectedHalfSpace {
    /// The test of the corner of the tile that lies farthest along the normal.
    ///
    /// Never false where a point whose slopes lie in `rectangle` and whose depth lies in `depths` is in the
    /// half-space.
    #[inline]
    #[must_use]
    pub fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let slopes = [rectangle.min().extend(1.0), rectangle.max().extend(1.0)];
        let [a, b] = slopes.map(|corner| self.normal() * corner);
        let farthest = a.max(b);
        let at_one = farthest.x + farthest.y + farthest.z + self.rounding_at_one();
        let most = (at_one * depths.near()).max(at_one * depths.far());
        // Not `>=`: an overflow to NaN does not lose the light.
        !matches!(
            most.partial_cmp(&self.offset()),
            Some(core::cmp::Ordering::Less)
        )
    }
}

#[inline(always)]
fn touches_box<P: BoxTest>(shape: &P, tile: &TileBounds<f32>) -> bool {
    let fields = shape.to_fields();
    !P::misses(&fields, &P::row(&fields, tile.down), tile)
}

#[inline(always)]
fn touches_frustum<P: BoxTest>(shape: &P, tile: &TileBounds<f32>) -> bool {
    let fields = shape.to_fields();
    let mut image = P::fields_of(0.0_f64);
    for (double, single) in image.as_mut().iter_mut().zip(fields.as_ref()) {
        *double = f64::from(*single);
    }
    Frustum::new(P::image(&image), tile.widen()).meets_ball()
}

impl TileTest for ProjectedEllipsoid {
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }

    #[inline]
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches_exactly(rectangle, depths)
    }
}

impl TileTest for ProjectedSphere {
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }

    #[inline]
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches_exactly(rectangle, depths)
    }
}

impl TileTest for ProjectedHalfSpace {
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths)
    }
}
