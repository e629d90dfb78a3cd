use glam::Vec3;

use super::frustum::{Frustum, Image};
use super::{DepthInterval, TileRectangle};
use crate::{CameraSphere, HalfSpace, Stretch};

/// Whether a light may touch a tile.
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

impl TileTest for Stretch {
    /// The paper's test [Tokuyoshi & Harada 2017, Sec. 5.2]: M takes the rectangle, at depth 1, to a
    /// parallelogram; the box of that, drawn out over the depths, is an axis-aligned box, which is
    /// apart from the unit sphere if its nearest point is.
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let m = self.matrix();
        let (min, max) = (rectangle.min(), rectangle.max());
        let across = ends(m.x_axis * min.x, m.x_axis * max.x);
        let down = ends(m.y_axis * min.y, m.y_axis * max.y);
        let low = across[0] + (down[0] + m.z_axis);
        let high = across[1] + (down[1] + m.z_axis);
        box_reaches(low, high, depths, self.center(), 1.0)
    }

    /// The box test, and then the distance from the centre of the unit sphere to the tile's image
    /// itself, a frustum.
    ///
    /// ```
    /// use stochastic_light_culling::{
    ///     Camera, DepthInterval, Ellipsoid, Stretch, TileRectangle, TileTest,
    ///     glam::{Mat3, Vec2, Vec3},
    /// };
    ///
    /// // Beside a deep tile far off the axis, but in the box around it.
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.5, 1.0, 0.1..100.0)?;
    /// let center = Vec3::new(5.5, 0.0, -5.2);
    /// let ellipsoid = Ellipsoid::new(center, Mat3::IDENTITY, Vec3::new(0.5, 1.0, 0.5))?;
    /// let light = Stretch::new(&ellipsoid, &camera).expect("not empty");
    /// let tile = TileRectangle::new(Vec2::new(0.5, 0.0), Vec2::new(0.6, 0.1))?;
    /// let depths = DepthInterval::new(5.0, 10.0)?;
    /// assert!(light.touches(&tile, &depths));
    /// assert!(!light.touches_exactly(&tile, &depths));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[inline]
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths) && {
            let m = self.matrix();
            let ([a0, a1, _], [b0, b1, _]) = (wide(m.x_axis), wide(m.y_axis));
            let light = Image {
                a: [a0, a1],
                b: [b0, b1],
                d: wide(m.z_axis),
                center: wide(self.center()),
                radius: 1.0,
                radius_squared: 1.0,
            };
            Frustum::new(light, sides(rectangle, depths)).meets_ball()
        }
    }
}

impl TileTest for CameraSphere {
    /// The same test with nothing stretched: against the tile's box in camera space.
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let (low, high) = (rectangle.min().extend(1.0), rectangle.max().extend(1.0));
        box_reaches(low, high, depths, self.center(), self.radius_squared())
    }

    /// The box test, and then the distance to the tile itself.
    #[inline]
    fn touches_exactly(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        self.touches(rectangle, depths) && {
            let light = Image::of_sphere(wide(self.center()), self.radius_squared().into());
            Frustum::new(light, sides(rectangle, depths)).meets_ball()
        }
    }
}

impl TileTest for HalfSpace {
    /// Against the corner of the tile that lies farthest along the normal.
    #[inline]
    fn touches(&self, rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
        let slopes = [rectangle.min().extend(1.0), rectangle.max().extend(1.0)];
        let [a, b] = slopes.map(|corner| self.normal() * corner);
        let farthest = a.max(b);
        let at_one = farthest.x + farthest.y + farthest.z + self.rounding_at_one();
        let most = (at_one * depths.near()).max(at_one * depths.far());
        // As for the box: an overflow to NaN does not lose the light.
        !matches!(
            most.partial_cmp(&self.offset()),
            Some(core::cmp::Ordering::Less)
        )
    }
}

/// Whether the box from `low` to `high` at depth 1, drawn out over `depths`, comes as near to
/// `center` as the square root of `radius_squared`.
///
/// Each operation here and above is monotone, and rounding is too: of two tiles, one inside the
/// other, the larger is touched by whatever touches the smaller, bit for bit. That is what lets blocks
/// of tiles be tested first.
#[inline]
fn box_reaches(
    low: Vec3,
    high: Vec3,
    depths: &DepthInterval,
    center: Vec3,
    radius_squared: f32,
) -> bool {
    let [low, _] = ends(low * depths.near(), low * depths.far());
    let [_, high] = ends(high * depths.near(), high * depths.far());
    let [_, not_below] = ends(center, low);
    let [nearest, _] = ends(not_below, high);
    let apart = center - nearest;
    let apart_squared = apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
    // Written so that an overflow to NaN does not lose the light.
    !matches!(
        apart_squared.partial_cmp(&radius_squared),
        Some(core::cmp::Ordering::Greater)
    )
}

/// From the least to the greatest x/z, y/z and z.
#[inline]
fn sides(rectangle: &TileRectangle, depths: &DepthInterval) -> [[f64; 2]; 3] {
    let (min, max) = (rectangle.min(), rectangle.max());
    [
        [min.x, max.x],
        [min.y, max.y],
        [depths.near(), depths.far()],
    ]
    .map(|side| side.map(f64::from))
}

#[inline]
fn wide(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// The lesser and the greater of each component.
#[inline]
fn ends(a: Vec3, b: Vec3) -> [Vec3; 2] {
    [a.min(b), a.max(b)]
}
