use core::ops::{Bound, Range};

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::{Interleave, PixelRectangle, TileGrid, TileRectangle};
use crate::base::{Direction, Error, finite, number_in, orthonormal};
use crate::num::{Double, Matrix3, Single, UNIT_ROUNDOFF, Vector3, tan};

/// Budget for the rounding that grows with the anchor's image, in [`Camera::move_anchor_to_eye`].
const ANCHOR_ROUNDINGS: f32 = 10.0;
/// Budget for the sums in `f64` of [`Camera::to_camera_space`], in units of `f64::EPSILON` and the terms.
const TERM_ROUNDINGS: f32 = 8.0;

/// Upper limit of the secant of the angle to a corner of the view: corners within 89.7°.
const MAX_CORNER_SECANT: f32 = 200.0;
/// Tolerance for the orthonormality of a view's rotation, element by element.
const RIGID_TOLERANCE: f32 = 1e-4;
/// Tolerance for the last row of a matrix.
const LAST_ROW_TOLERANCE: f32 = 1e-6;

/// A camera: its position and orientation, and the slopes that its pixels cover.
///
/// *Camera space* has x to the right, y up and z = depth, the positive distance along the viewing
/// direction, for a view space of either handedness. A *slope* is x/z or y/z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    rotation: Mat3,
    translation: Vec3,
    /// The rows of `rotation`, and `translation`, in the precision in which points are transformed.
    rows: [Vector3<f64>; 3],
    translation_f64: Vector3<f64>,
    /// δ, the largest element of RᵀR − 1 in magnitude.
    rotation_deviation: f32,
    /// A point of world space that is as near to the eye as `f32` allows.
    anchor: Vec3,
    /// The anchor in camera space: its distance from the eye, which rounding causes.
    anchor_image: Vec3,
    /// Upper bound, in length, of the error that grows with `anchor_image`.
    rounding_of_anchor: f32,
    /// Slope = NDC · scale + offset.
    slope_scale: Vec2,
    slope_offset: Vec2,
    /// 1/cos of the angle between the viewing direction and the farthest corner of the view.
    corner_secant: f32,
    /// depth = numerator/(NDC z + offset)
    depth_numerator: f32,
    depth_offset: f32,
}

/// The fields of a camera from which the others follow.
#[derive(Clone, Copy)]
pub(crate) struct CameraParts {
    pub rotation: Mat3,
    pub translation: Vec3,
    pub slope_scale: Vec2,
    pub slope_offset: Vec2,
    pub depth_numerator: f32,
    pub depth_offset: f32,
}

impl Camera {
    /// Creates a camera from the two matrices of an engine: `view` takes world space to view space, and
    /// `projection` takes view space to clip space.
    ///
    /// The view must not scale. The projection may
    ///
    /// - be symmetric or off-centre;
    /// - be of either handedness: its last row says whether the camera looks along −z or +z;
    /// - map depth to \[0, 1\] or \[−1, 1\], rising or falling (*reversed z*);
    /// - have a finite or an infinite far plane;
    /// - negate y, for Vulkan, whose NDC y points down. The first row of pixels is at the top of the view
    ///   either way. For an image that is upside down on purpose, count its rows from the other end.
    ///
    /// Both matrices are stored by columns. A projection that is stored by rows is refused, since its last
    /// row depends on the near plane and is not (0, 0, ±1, 0). There is one exception: if element (2, 3) is
    /// ±1, as for an infinite far plane and a near plane at distance 1, the transposed matrix is a valid
    /// perspective too, and the mistake cannot be detected.
    ///
    /// # Errors
    ///
    /// [`Error::Matrix`] if `view` is not rigid to 10⁻⁴, or `projection` is not a perspective (an
    /// orthographic one has no depth to divide by) whose last row is (0, 0, ±1, 0) to 10⁻⁶, with distinct
    /// near and far planes and with corners within 89.7° of the viewing direction. [`Error::Vector`] if the
    /// translation of `view` is not finite.
    pub fn new(view: Mat4, projection: Mat4) -> Result<Self, Error> {
        let (toward, slope_scale, slope_offset) = slopes(projection)?;
        let (depth_numerator, depth_offset) = depths(projection, toward);

        let last_row = view.row(3);
        let drift = (last_row - Vec4::W).abs().max_element();
        if !view.is_finite() || drift > LAST_ROW_TOLERANCE {
            return Err(Error::Matrix {
                quantity: "view matrix",
                element: drift,
                valid: "its last row must be (0, 0, 0, 1); deviation",
            });
        }
        let to_depth = Vec3::new(1.0, 1.0, toward);
        Self::from_parts(CameraParts {
            rotation: Mat3::from_diagonal(to_depth) * Mat3::from_mat4(view),
            translation: to_depth * view.w_axis.truncate(),
            slope_scale,
            slope_offset,
            depth_numerator,
            depth_offset,
        })
    }

    /// Creates a camera at `eye` that looks at `target`, with a symmetric view.
    ///
    /// `up` is a direction of world space that appears upright, of any length. It need not be perpendicular
    /// to the viewing direction. Values of the depth buffer rise from 0 at the start of `depths` to 1 at its
    /// end, which may be infinite.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `eye` is not finite, equals `target`, or `up` is parallel to the view.
    /// [`Error::Number`] if `vertical_fov_radians` is outside (0, 3.1\], `aspect_ratio` (width over
    /// height) is outside \[0.01, 100\], the start of `depths` is not positive and finite, or its end is
    /// not greater than the start. [`Error::Matrix`] if a corner of the view is not within 89.7° of the
    /// viewing direction, or the ends of `depths` are too close for `f32`.
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
        // Differences of 1/near and 1/far, in the form that is finite for an infinite far plane.
        let shrink = 1.0 - near / far;
        let slope = tan(0.5 * fov);
        Self::from_parts(CameraParts {
            rotation,
            translation,
            slope_scale: Vec2::new(slope * aspect, slope),
            slope_offset: Vec2::ZERO,
            depth_numerator: -near / shrink,
            depth_offset: -1.0 / shrink,
        })
    }

    /// Creates a camera from its parts. All constructors and deserialization end here.
    pub(crate) fn from_parts(parts: CameraParts) -> Result<Self, Error> {
        let refused = |element, valid| Error::Matrix {
            quantity: "projection matrix",
            element,
            valid,
        };
        let CameraParts {
            rotation,
            translation,
            slope_scale,
            slope_offset,
            depth_numerator,
            depth_offset,
        } = parts;
        let farthest = slope_scale.abs() + slope_offset.abs();
        let corner_secant = farthest.extend(1.0).length();
        if corner_secant.is_nan() || corner_secant > MAX_CORNER_SECANT {
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
            rotation_deviation: orthonormal("view matrix", rotation, RIGID_TOLERANCE)?,
            anchor: Vec3::ZERO,
            anchor_image: translation,
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

    /// Moves the anchor from the world's origin to the eye, as far as `f32` allows.
    ///
    /// Any anchor is valid. A nearer one has less rounding.
    fn move_anchor_to_eye(&mut self) {
        // The second step corrects for a rotation that is not quite orthonormal.
        for _ in 0..2 {
            let anchor = self.anchor - self.rotation.transpose() * self.anchor_image;
            let image = self.to_camera_space(anchor);
            if image.is_finite() {
                (self.anchor, self.anchor_image) = (anchor, image);
            }
        }
        self.rounding_of_anchor =
            ANCHOR_ROUNDINGS * UNIT_ROUNDOFF * self.anchor_image.abs().element_sum()
                + self.rounding_of_terms([self.anchor, Vec3::ZERO].map(Vector3::from));
    }

    /// The parts that [`from_parts`](Self::from_parts) makes this camera from.
    #[cfg(feature = "serde")]
    pub(crate) fn parts(&self) -> CameraParts {
        CameraParts {
            rotation: self.rotation,
            translation: self.translation,
            slope_scale: self.slope_scale,
            slope_offset: self.slope_offset,
            depth_numerator: self.depth_numerator,
            depth_offset: self.depth_offset,
        }
    }

    /// The rotation from world space to camera space. Its columns are the axes of world space.
    ///
    /// Camera space is left-handed. So the determinant is −1 for a right-handed world, which
    /// [`look_at`](Self::look_at) assumes, and 1 for a left-handed one.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        self.rotation
    }

    /// Transforms a `point` from world space to camera space.
    ///
    /// Computed in `f64` and rounded once. So nothing of a near point is lost where it and the camera are far
    /// from the world's origin. Not finite if `point` is not, or if the result overflows.
    #[inline]
    #[must_use]
    pub fn to_camera_space(&self, point: Vec3) -> Vec3 {
        let point = Vector3::from(point).widen();
        let [x, y, z] = self.rows.map(|row| row.dot(point));
        Vector3::narrow(Vector3::new(x, y, z) + self.translation_f64).into()
    }

    /// Rotates a unit `direction` from world space to camera space, and rounds once.
    pub(crate) fn direction_to_camera_space(&self, direction: Vec3) -> Vec3 {
        let direction = Vector3::from(direction).widen();
        let [x, y, z] = self.rows.map(|row| row.dot(direction));
        Vector3::narrow(Vector3::new(x, y, z)).into()
    }

    /// Transforms the exact sum of `parts` from world space to camera space, and rounds once.
    #[inline(always)]
    pub(crate) fn sum_to_camera_space<N: Single>(&self, parts: [Vector3<N>; 2]) -> Vector3<N> {
        let parts = [parts[0].widen(), parts[1].widen()];
        let [x, y, z] = self.rows;
        let rotated = Vector3::new(dot_sum(x, parts), dot_sum(y, parts), dot_sum(z, parts));
        Vector3::narrow(rotated + Vector3::splat(rotated.x, self.translation_f64))
    }

    /// Transforms a `point` from world space to camera space in `f32` alone.
    ///
    /// Errs by at most 9u of the length of the result plus [`rounding_of_anchor`](Self::rounding_of_anchor),
    /// wherever the world's origin is.
    #[inline(always)]
    pub(crate) fn relative_to_anchor<N: Single>(&self, point: Vector3<N>) -> Vector3<N> {
        let anchor = Vector3::splat(point.x, self.anchor.into());
        let anchor_image = Vector3::splat(point.x, self.anchor_image.into());
        self.rotation_in_lanes(point.x) * (point - anchor) + anchor_image
    }

    /// [`rotation`](Self::rotation) in as many lanes as `like` has.
    #[inline(always)]
    pub(crate) fn rotation_in_lanes<N: Single>(&self, like: N) -> Matrix3<N> {
        Matrix3::splat(like, self.rotation.into())
    }

    /// Upper bound, in length, of the error of [`relative_to_anchor`](Self::relative_to_anchor) that is due
    /// to the distance between anchor and eye.
    pub(crate) fn rounding_of_anchor(&self) -> f32 {
        self.rounding_of_anchor
    }

    /// Transforms a `point` from camera space to world space, to within rounding. The origin becomes the
    /// eye.
    #[must_use]
    pub fn to_world_space(&self, point: Vec3) -> Vec3 {
        self.rotation.transpose() * (point - self.translation)
    }

    /// Upper bound, in length, of the error of the sums in `f64` of
    /// [`sum_to_camera_space`](Self::sum_to_camera_space) for these `parts`, before the result is rounded.
    #[inline(always)]
    pub(crate) fn rounding_of_terms<N: Single>(&self, parts: [Vector3<N>; 2]) -> N {
        let translation = Vector3::splat(parts[0].x, self.translation.abs().into());
        let terms = parts[0].abs() + parts[1].abs() + translation;
        terms.element_sum() * (TERM_ROUNDINGS * f64::EPSILON as f32)
    }

    /// δ, the largest element of RᵀR − 1 in magnitude: how far the rotation R is from orthonormal.
    pub(crate) fn rotation_deviation(&self) -> f32 {
        self.rotation_deviation
    }

    /// 1/cos of the angle between the viewing direction and the farthest corner of the view.
    pub(crate) fn corner_secant(&self) -> f32 {
        self.corner_secant
    }

    /// Converts a value of the depth buffer to a depth in camera space.
    ///
    /// Infinite at an infinite far plane, and NaN for NaN. [`DepthInterval`](crate::DepthInterval) takes both
    /// for sky.
    #[inline]
    #[must_use]
    pub fn depth(&self, ndc_depth: f32) -> f32 {
        self.depth_numerator / (ndc_depth + self.depth_offset)
    }

    /// The slopes that a tile of `grid` covers.
    ///
    /// Of a tile outside the grid, an edge or a corner of the view.
    #[inline]
    #[must_use]
    pub fn tile(&self, grid: &TileGrid, tile: [u32; 2]) -> TileRectangle {
        self.tile_rectangle(grid.image_size(), grid.pixels(tile))
    }

    /// The slopes that a tile of `grid` covers, where `grid` is of the image of a `subregion` of interleaved
    /// sampling.
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

    /// The slopes that `pixels` cover in an image of `image_size` = \[width, height\] pixels. Pixel (0, 0)
    /// is at the top left.
    ///
    /// `image_size` must not be zero. Pixels outside the image are left out.
    #[inline]
    #[must_use]
    pub fn tile_rectangle(&self, image_size: [u32; 2], pixels: PixelRectangle) -> TileRectangle {
        let [width, height] = image_size.map(|n| n as f32);
        let slope = |[x, y]: [u32; 2]| {
            // A tile has no slopes outside the view.
            let (x, y) = (x.min(image_size[0]), y.min(image_size[1]));
            let ndc = Vec2::new(2.0 * x as f32 / width - 1.0, 1.0 - 2.0 * y as f32 / height);
            ndc * self.slope_scale + self.slope_offset
        };
        TileRectangle::from_corners(slope(pixels.min), slope(pixels.max))
    }

    /// The point of camera space at `depth` behind the middle of `pixel`, in an image of `image_size` =
    /// \[width, height\] pixels.
    #[inline]
    #[must_use]
    pub fn point_in_pixel(&self, image_size: [u32; 2], pixel: [u32; 2], depth: f32) -> Vec3 {
        let [width, height] = image_size.map(|n| n as f32);
        let [x, y] = pixel.map(|n| n as f32 + 0.5);
        let ndc = Vec2::new(2.0 * x / width - 1.0, 1.0 - 2.0 * y / height);
        (ndc * self.slope_scale + self.slope_offset).extend(1.0) * depth
    }
}

/// The sum of the dot products of `row` with both parts.
#[inline(always)]
fn dot_sum<D: Double>(row: Vector3<f64>, parts: [Vector3<D>; 2]) -> D {
    let row = Vector3::splat(parts[0].x, row);
    row.dot(parts[0]) + row.dot(parts[1])
}

/// The sign of view-space z ahead of the camera (−1 or 1), and the scale and offset from NDC to slopes.
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
    if weight.is_nan() || (weight - 1.0).abs() > LAST_ROW_TOLERANCE {
        let valid =
            "its last row must be (0, 0, ±1, 0), and it must be stored by columns; element (3, 2)";
        return Err(refused(w.z, valid));
    }
    // Where NDC y points down, the first row of pixels is at NDC y = −1. Negating both changes nothing.
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
