use core::ops::{Bound, Range};

use glam::{Mat3, Mat4, Vec2, Vec3};

use super::camera::{Camera, CameraParts, LAST_ROW_TOLERANCE, aspect_ratio, parts_of_view};
use super::projection::{Projection, refused, sealed};
use super::rigid::looking_at;
use crate::base::{Error, number_in};
use crate::num::{Single, Vector3, tan};

/// Upper limit of the secant of the angle to a corner of the view: corners within 89.7°.
const MAX_CORNER_SECANT: f32 = 200.0;

/// The projection of a [`Camera`] whose rays meet in the eye.
///
/// Depth is the distance from the eye along the viewing direction. The rectangle of a tile lies in the plane at
/// depth 1, so its coordinates are the *slopes* x/z and y/z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    /// 1/cos of the angle between the viewing direction and the farthest corner of the view.
    corner_secant: f32,
    /// depth = numerator/(NDC z + offset)
    depth_numerator: f32,
    depth_offset: f32,
}

impl Perspective {
    /// The projection with depth = numerator/(NDC z + offset), to be [checked](Projection::checked).
    pub(crate) fn with_depths([depth_numerator, depth_offset]: [f32; 2]) -> Self {
        Self {
            corner_secant: f32::NAN,
            depth_numerator,
            depth_offset,
        }
    }

    #[cfg(any(feature = "bytemuck", feature = "serde"))]
    pub(crate) fn depths(&self) -> [f32; 2] {
        [self.depth_numerator, self.depth_offset]
    }

    #[cfg(feature = "bytemuck")]
    pub(crate) fn corner_secant(&self) -> f32 {
        self.corner_secant
    }
}

impl Camera {
    /// Creates a camera from the two matrices of an engine: `view` takes world space to view space, and
    /// `projection` takes view space to clip space.
    ///
    /// The view must not scale. The projection may
    ///
    /// - be symmetric or off-centre, as with jitter;
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
    /// [`Camera::orthographic`] takes an orthographic projection, and [`AnyCamera::new`](crate::AnyCamera::new)
    /// either.
    ///
    /// # Errors
    ///
    /// [`Error::Matrix`] if `view` is not rigid to 10⁻⁴, or `projection` is not a perspective whose last row
    /// is (0, 0, ±1, 0) to 10⁻⁶, with distinct near and far planes and with corners within 89.7° of the
    /// viewing direction. [`Error::Vector`] if the translation of `view` is not finite.
    pub fn new(view: Mat4, projection: Mat4) -> Result<Self, Error> {
        let (toward, scale, offset) = slopes(projection)?;
        let (rotation, translation) = parts_of_view(view)?;
        let to_depth = Vec3::new(1.0, 1.0, toward);
        Self::from_parts(CameraParts {
            rotation: Mat3::from_diagonal(to_depth) * rotation,
            translation: to_depth * translation,
            scale,
            offset,
            projection: depths(projection, toward),
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
        let (rotation, translation) = looking_at(eye, target, up)?;
        let positive = f32::MIN_POSITIVE;
        let valid = "in (0, 3.1] radians";
        let fov = number_in(
            "vertical field of view",
            vertical_fov_radians,
            valid,
            positive..=3.1,
        )?;
        let aspect = self::aspect_ratio(aspect_ratio)?;
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
            scale: Vec2::new(slope * aspect, slope),
            offset: Vec2::ZERO,
            projection: Perspective::with_depths([-near / shrink, -1.0 / shrink]),
        })
    }
}

impl sealed::Sealed for Perspective {}

impl Projection for Perspective {
    const IS_PERSPECTIVE: bool = true;

    fn checked(self, half_size: Vec2, middle: Vec2) -> Result<Self, Error> {
        let farthest = half_size.abs() + middle.abs();
        let corner_secant = farthest.extend(1.0).length();
        if corner_secant.is_nan() || corner_secant > MAX_CORNER_SECANT {
            let valid =
                "the corners of the view must be within 89.7° of its direction; their 1/cos";
            return Err(refused(corner_secant, valid));
        }
        let numerator = self.depth_numerator;
        if !(numerator.is_finite() && numerator != 0.0 && self.depth_offset.is_finite()) {
            let valid = "its near and far planes must be positive and distinct; element (2, 3)";
            return Err(refused(numerator, valid));
        }
        Ok(Self {
            corner_secant,
            ..self
        })
    }

    #[inline]
    fn depth(&self, ndc_depth: f32) -> f32 {
        self.depth_numerator / (ndc_depth + self.depth_offset)
    }

    #[inline]
    fn point(slopes: Vec2, depth: f32) -> Vec3 {
        slopes.extend(1.0) * depth
    }

    /// The secant of the corner of the view times the greatest depth.
    #[inline(always)]
    fn farthest<N: Single>(&self, center: Vector3<N>, radius: N, factor: f32) -> N {
        let farthest_depth = center.z.max(radius.zero()) + radius;
        farthest_depth * (factor * self.corner_secant)
    }
}

/// The sign of view-space z ahead of the camera (−1 or 1), and the scale and offset from NDC to slopes.
fn slopes(projection: Mat4) -> Result<(f32, Vec2, Vec2), Error> {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| projection.row(row));
    if w.w != 0.0 {
        let valid = "it must be a perspective, stored by columns, and not orthographic, which \
                     `Camera::orthographic` takes; element (3, 3)";
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

/// The projection with the depths of a matrix.
fn depths(projection: Mat4, toward: f32) -> Perspective {
    let [_, _, z, w] = projection.row(2).to_array();
    let weight = projection.row(3).z.abs();
    Perspective::with_depths([w / weight, -toward * z / weight])
}
