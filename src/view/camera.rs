use core::ops::{Bound, Range};

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::{Interleave, PixelRectangle, TileGrid, TileRectangle};
use crate::base::{Direction, Error, finite, number_in, orthonormal};
use crate::num::{Double, Matrix3, Single, UNIT_ROUNDOFF, Vector3, tan};

/// The eye: where it is, which way it looks, and how its pixels spread over the view.
///
/// Its *camera space* has x to the right, y up and z = depth, the positive distance along the
/// viewing direction, whichever handedness the engine's view space has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    rotation: Mat3,
    translation: Vec3,
    /// The same two in the precision in which points are transformed.
    rows: [Vector3<f64>; 3],
    translation_f64: Vector3<f64>,
    /// How far the rotation is from orthonormal.
    rotation_deviation: f32,
    /// A point of world space, next to the eye where `f32` reaches it.
    anchor: Vec3,
    /// The same in camera space: what rounding leaves between it and the eye.
    anchor_seen: Vec3,
    /// What is lost because of that, in length.
    rounding_of_anchor: f32,
    /// Slope (x/z, y/z) of a point = NDC · scale + offset.
    slope_scale: Vec2,
    slope_offset: Vec2,
    /// 1/cos of the angle between the viewing direction and the farthest corner of the view.
    corner_secant: f32,
    /// depth = numerator/(NDC z + offset)
    depth_numerator: f32,
    depth_offset: f32,
}

/// The fields of a camera that do not follow from the others.
#[derive(Clone, Copy)]
pub(crate) struct Parts {
    pub rotation: Mat3,
    pub translation: Vec3,
    pub slope_scale: Vec2,
    pub slope_offset: Vec2,
    pub depth_numerator: f32,
    pub depth_offset: f32,
}

impl Camera {
    /// The camera with the engine's own two matrices: `view` from world to view space, and
    /// `projection` from view space to clip space.
    ///
    /// The view must not scale. The projection may be symmetric or off-centre, of either handedness
    /// (its last row says whether the eye looks along −z or +z), with depth that rises or falls
    /// (*reversed z*), to a finite or infinite far plane, over \[0, 1\] or \[−1, 1\]. One that turns y
    /// is Vulkan's, whose NDC y points down: the first row of pixels is at the top of what is seen either
    /// way. (For a picture that is drawn upside down on purpose, count its rows from the other end.)
    ///
    /// Both matrices are stored by columns. A projection that was stored by rows is refused: its last row
    /// holds what the near plane has made of it, not ±1. But one with element (2, 3) = ±1, such as a
    /// symmetric one to an infinite far plane with the near plane at distance 1, is a perspective when
    /// transposed as well, and cannot be told from one that is meant.
    ///
    /// # Errors
    ///
    /// [`Error::Matrix`] if `view` is not rigid to 10⁻⁴, or `projection` is not a perspective (an
    /// orthographic one has no depth to divide by) whose last row is (0, 0, ±1, 0) to 10⁻⁶, with distinct
    /// near and far planes and with corners within 89.7° of the viewing direction.
    pub fn new(view: Mat4, projection: Mat4) -> Result<Self, Error> {
        let (toward, slope_scale, slope_offset) = slopes(projection)?;
        let (depth_numerator, depth_offset) = depths(projection, toward);

        let last_row = view.row(3);
        let drift = (last_row - Vec4::W).abs().max_element();
        if !view.is_finite() || drift > 1e-6 {
            return Err(Error::Matrix {
                quantity: "view matrix",
                element: drift,
                valid: "its last row must be (0, 0, 0, 1); deviation",
            });
        }
        let to_depth = Vec3::new(1.0, 1.0, toward);
        Self::of_parts(Parts {
            rotation: Mat3::from_diagonal(to_depth) * Mat3::from_mat4(view),
            translation: to_depth * view.w_axis.truncate(),
            slope_scale,
            slope_offset,
            depth_numerator,
            depth_offset,
        })
    }

    /// A camera at `eye` that looks at `target`, with a symmetric view and depth-buffer values from 0
    /// at the start of `depths` to 1 at its end, which may be infinite.
    ///
    /// `up` is any direction that appears upright; it need not be perpendicular to the view.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `eye` is not finite, equals `target`, or `up` is parallel to the view.
    /// [`Error::Number`] if `vertical_fov_radians` is outside (0, 3.1\], `aspect_ratio` (width over
    /// height) outside \[0.01, 100\], the near end of `depths` not positive and finite, or the far
    /// end not greater than it. [`Error::Matrix`] if both angles together are so wide that a corner of
    /// the view is not within 89.7° of its direction, or no depth of `depths` is an `f32`.
    pub fn look_at(
        eye: Vec3,
        target: Vec3,
        up: Vec3,
        vertical_fov_radians: f32,
        aspect_ratio: f32,
        depths: Range<f32>,
    ) -> Result<Self, Error> {
        let eye = finite("eye", eye)?;
        let forward = Direction::of("way from the eye to its target", target - eye)?;
        let right = Direction::of("viewing direction × up", forward.cross(up))?;
        let rotation = Mat3::from_cols(*right, right.cross(*forward), *forward).transpose();
        let translation = -(rotation * eye);

        let positive = f32::MIN_POSITIVE;
        let valid = "in (0, 3.1] radians";
        let fov = number_in(
            "vertical field of view",
            vertical_fov_radians,
            valid,
            positive..=3.1,
        )?;
        let valid = "in [0.01, 100]";
        let aspect = number_in("aspect ratio", aspect_ratio, valid, 0.01..=100.0)?;
        let valid = "positive and finite";
        let near = number_in("near plane", depths.start, valid, positive..=f32::MAX)?;
        let valid = "greater than the near plane";
        let beyond_near = (Bound::Excluded(near), Bound::Unbounded);
        let far = number_in("far plane", depths.end, valid, beyond_near)?;
        // 1/far − 1/near and so on, in the form that an infinite far plane leaves finite.
        let shrink = 1.0 - near / far;
        let slope = tan(0.5 * fov);
        Self::of_parts(Parts {
            rotation,
            translation,
            slope_scale: Vec2::new(slope * aspect, slope),
            slope_offset: Vec2::ZERO,
            depth_numerator: -near / shrink,
            depth_offset: -1.0 / shrink,
        })
    }

    /// The camera with these parts: what all constructors end in, and what is read goes through.
    pub(crate) fn of_parts(parts: Parts) -> Result<Self, Error> {
        let refused = |element, valid| Error::Matrix {
            quantity: "projection matrix",
            element,
            valid,
        };
        let Parts {
            rotation,
            translation,
            slope_scale,
            slope_offset,
            depth_numerator,
            depth_offset,
        } = parts;
        // 1/cos of the angle to the farthest corner.
        let farthest = slope_scale.abs() + slope_offset.abs();
        let corner_secant = farthest.extend(1.0).length();
        if corner_secant.is_nan() || corner_secant > 200.0 {
            let valid =
                "the corners of the view must be within 89.7° of its direction; their 1/cos";
            return Err(refused(corner_secant, valid));
        }
        let distinct = depth_numerator.is_finite() && depth_numerator != 0.0;
        if !(distinct && depth_offset.is_finite()) {
            let valid = "its near and far planes must be positive and distinct; element (2, 3)";
            return Err(refused(depth_numerator, valid));
        }
        let translation = finite("translation of the view", translation)?;
        let mut camera = Self {
            rotation,
            translation,
            rows: [0, 1, 2].map(|i| Vector3::from(rotation.row(i)).widen()),
            translation_f64: Vector3::from(translation).widen(),
            rotation_deviation: orthonormal("view matrix", rotation, 1e-4)?,
            anchor: Vec3::ZERO,
            anchor_seen: translation,
            rounding_of_anchor: 0.0,
            slope_scale,
            slope_offset,
            corner_secant,
            depth_numerator,
            depth_offset,
        };
        camera.move_anchor_to_eye();
        Ok(camera)
    }

    /// Any anchor will do, and the world's origin where the eye is too far for `f32`.
    fn move_anchor_to_eye(&mut self) {
        // Once more for what the rotation is off from orthonormal.
        for _ in 0..2 {
            let anchor = self.anchor - self.rotation.transpose() * self.anchor_seen;
            let seen = self.to_camera_space(anchor);
            if seen.is_finite() {
                (self.anchor, self.anchor_seen) = (anchor, seen);
            }
        }
        // `anchor_seen` is rounded itself, and counts as a part of what is seen.
        self.rounding_of_anchor = 10.0 * UNIT_ROUNDOFF * self.anchor_seen.abs().element_sum()
            + self.rounding_of_terms([self.anchor, Vec3::ZERO].map(Vector3::from));
    }

    /// What [`of_parts`](Self::of_parts) makes this camera of.
    #[cfg(feature = "serde")]
    pub(crate) fn parts(&self) -> Parts {
        Parts {
            rotation: self.rotation,
            translation: self.translation,
            slope_scale: self.slope_scale,
            slope_offset: self.slope_offset,
            depth_numerator: self.depth_numerator,
            depth_offset: self.depth_offset,
        }
    }

    /// The axes of world space in camera space, as columns.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        self.rotation
    }

    /// `point` of world space in camera space, rounded once: where world and camera are far from the
    /// origin, nothing of a near point is lost.
    #[inline]
    #[must_use]
    pub fn to_camera_space(&self, point: Vec3) -> Vec3 {
        let point = Vector3::from(point).widen();
        let [x, y, z] = self.rows.map(|row| row.dot(point));
        Vector3::narrow(Vector3::new(x, y, z) + self.translation_f64).into()
    }

    /// The unit `direction` of world space in camera space, rounded once.
    pub(crate) fn turn(&self, direction: Vec3) -> Vec3 {
        let direction = Vector3::from(direction).widen();
        let [x, y, z] = self.rows.map(|row| row.dot(direction));
        Vector3::narrow(Vector3::new(x, y, z)).into()
    }

    /// The exact sum of `parts` in camera space, rounded once.
    #[inline(always)]
    pub(crate) fn sum_to_camera_space<N: Single>(&self, parts: [Vector3<N>; 2]) -> Vector3<N> {
        let parts = [parts[0].widen(), parts[1].widen()];
        let [x, y, z] = self.rows;
        let turned = Vector3::new(turned(x, parts), turned(y, parts), turned(z, parts));
        Vector3::narrow(turned + Vector3::splat(turned.x, self.translation_f64))
    }

    /// What [`to_camera_space`](Self::to_camera_space) gives, but in `f32` alone: off by at most 9u of its
    /// length and [`rounding_of_anchor`](Self::rounding_of_anchor), wherever the world's origin is.
    #[inline(always)]
    pub(crate) fn relative_to_anchor<N: Single>(&self, point: Vector3<N>) -> Vector3<N> {
        let anchor = Vector3::splat(point.x, self.anchor.into());
        let anchor_seen = Vector3::splat(point.x, self.anchor_seen.into());
        self.rotation_in_lanes(point.x) * (point - anchor) + anchor_seen
    }

    /// [`rotation`](Self::rotation) in as many lanes as `like` has.
    #[inline(always)]
    pub(crate) fn rotation_in_lanes<N: Single>(&self, like: N) -> Matrix3<N> {
        Matrix3::splat(like, self.rotation.into())
    }

    /// What [`relative_to_anchor`](Self::relative_to_anchor) loses because the anchor is
    /// not the eye, in length.
    pub(crate) fn rounding_of_anchor(&self) -> f32 {
        self.rounding_of_anchor
    }

    /// The anchor in world space and in camera space.
    #[cfg(feature = "cull")]
    pub(crate) fn anchor(&self) -> [Vec3; 2] {
        [self.anchor, self.anchor_seen]
    }

    /// `point` of camera space in world space, to rounding; the eye is where the origin goes.
    #[must_use]
    pub fn to_world_space(&self, point: Vec3) -> Vec3 {
        self.rotation.transpose() * (point - self.translation)
    }

    /// What the sums of [`to_camera_space`](Self::to_camera_space) lose, as a share of their terms.
    pub(crate) const ROUNDINGS_OF_TERMS: f32 = 8.0 * f64::EPSILON as f32;

    /// What [`to_camera_space`](Self::to_camera_space) can be off by before it rounds, in length: the
    /// rounding of `f64` in terms this large.
    #[inline(always)]
    pub(crate) fn rounding_of_terms<N: Single>(&self, parts: [Vector3<N>; 2]) -> N {
        let translation = Vector3::splat(parts[0].x, self.translation.abs().into());
        let terms = parts[0].abs() + parts[1].abs() + translation;
        terms.element_sum() * Self::ROUNDINGS_OF_TERMS
    }

    /// How far the rotation is from orthonormal, element by element.
    pub(crate) fn rotation_deviation(&self) -> f32 {
        self.rotation_deviation
    }

    /// 1/cos of the angle between the viewing direction and the farthest corner of the view.
    pub(crate) fn corner_secant(&self) -> f32 {
        self.corner_secant
    }

    /// The depth of a point from its `ndc_depth`, the value in a depth buffer.
    ///
    /// Infinite for the far plane of an infinite projection, NaN for NaN; both are sky to
    /// [`DepthInterval`](crate::DepthInterval).
    #[inline]
    #[must_use]
    pub fn depth(&self, ndc_depth: f32) -> f32 {
        self.depth_numerator / (ndc_depth + self.depth_offset)
    }

    /// What a tile of `grid` covers of the view.
    #[inline]
    #[must_use]
    pub fn tile(&self, grid: &TileGrid, tile: [u32; 2]) -> TileRectangle {
        self.tile_rectangle(grid.image_size(), grid.pixels(tile))
    }

    /// What a tile of `grid`, which is of a `subregion` of interleaved sampling, covers of the view.
    #[inline]
    #[must_use]
    pub fn interleaved_tile(
        &self,
        interleave: &Interleave,
        subregion: u32,
        grid: &TileGrid,
        tile: [u32; 2],
    ) -> TileRectangle {
        let pixels = interleave.join_pixels(subregion, grid.pixels(tile));
        self.tile_rectangle(interleave.image_size(), pixels)
    }

    /// The tile that `pixels` of an image of `image_size` see. Pixel (0, 0) is at the top left.
    ///
    /// `image_size` must not be zero. Pixels outside the image are left out.
    #[inline]
    #[must_use]
    pub fn tile_rectangle(&self, image_size: [u32; 2], pixels: PixelRectangle) -> TileRectangle {
        let [width, height] = image_size.map(|n| n as f32);
        let slope = |[x, y]: [u32; 2]| {
            // Slopes far outside the view are more than a tile may have.
            let (x, y) = (x.min(image_size[0]), y.min(image_size[1]));
            let ndc = Vec2::new(2.0 * x as f32 / width - 1.0, 1.0 - 2.0 * y as f32 / height);
            ndc * self.slope_scale + self.slope_offset
        };
        TileRectangle::from_corners(slope(pixels.min), slope(pixels.max))
    }

    /// The point of camera space at `depth` that the middle of `pixel` sees.
    #[inline]
    #[must_use]
    pub fn point_in_pixel(&self, image_size: [u32; 2], pixel: [u32; 2], depth: f32) -> Vec3 {
        let [width, height] = image_size.map(|n| n as f32);
        let [x, y] = pixel.map(|n| n as f32 + 0.5);
        let ndc = Vec2::new(2.0 * x / width - 1.0, 1.0 - 2.0 * y / height);
        (ndc * self.slope_scale + self.slope_offset).extend(1.0) * depth
    }
}

/// The sum of `row` times both parts.
#[inline(always)]
fn turned<D: Double>(row: Vector3<f64>, parts: [Vector3<D>; 2]) -> D {
    let row = Vector3::splat(parts[0].x, row);
    row.dot(parts[0]) + row.dot(parts[1])
}

/// Which way the eye looks along view-space z (−1 or 1), and the scale and offset from NDC to slopes.
fn slopes(projection: Mat4) -> Result<(f32, Vec2, Vec2), Error> {
    let refused = |element, valid| Error::Matrix {
        quantity: "projection matrix",
        element,
        valid,
    };
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| projection.row(row));
    if w.w != 0.0 {
        let valid =
            "it must be a perspective, not orthographic, and stored by columns; element (3, 3)";
        return Err(refused(w.w, valid));
    }
    let stray = [x.y, x.w, y.x, y.w, z.x, z.y, w.x, w.y];
    if let Some(element) = stray.into_iter().find(|e| *e != 0.0) {
        let valid = "it must be a perspective along the z axis, with zeros off its pattern";
        return Err(refused(element, valid));
    }
    let toward = w.z.signum();
    let weight = w.z.abs();
    // A transposed matrix has element (2, 3) here, which follows from the near plane.
    if weight.is_nan() || (weight - 1.0).abs() > 1e-6 {
        let valid =
            "its last row must be (0, 0, ±1, 0), as it is if stored by columns; element (3, 2)";
        return Err(refused(w.z, valid));
    }
    // Where NDC y points down, the first row of pixels is at −1: as if both were turned.
    let scale = Vec2::new(weight / x.x, (weight / y.y).abs());
    let offset = Vec2::new(-toward * x.z / x.x, -toward * y.z / y.y);
    Ok((toward, scale, offset))
}

/// The numerator and the offset of depth = numerator/(NDC z + offset).
fn depths(projection: Mat4, toward: f32) -> (f32, f32) {
    let weight = projection.row(3).z.abs();
    let (offset, numerator) = (projection.row(2).z, projection.row(2).w);
    (numerator / weight, -toward * offset / weight)
}
