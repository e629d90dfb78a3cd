use core::ops::{Bound, Range};

use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::camera::{Camera, CameraParts, LAST_ROW_TOLERANCE, aspect_ratio, parts_of_view};
use super::projection::{Projection, refused, sealed};
use super::rectangle::MAX_COORDINATE;
use super::rigid::looking_at;
use crate::base::{Error, number_in};
use crate::num::{Single, Vector3};

/// The depth at which NDC z is 0, in units of NDC z.
///
/// So depths are positive for NDC z from −1 on, which is all of a view by either convention.
const DEPTH_AT_ZERO: f64 = 2.0;

/// The projection of a [`Camera`] whose rays are parallel.
///
/// There is no eye to measure depths from. *Depth* is (2 + v) H where v is the value of the depth buffer and H the
/// length along the view over which that grows by 1. So depths of a view are positive, by either convention
/// of NDC depth and wherever the near plane is. They grow with the depth buffer's values: away from the
/// camera, or, with reversed z, towards it.
///
/// The rectangle of a tile has the coordinates x and y of camera space, which are lengths. With its depths it is
/// a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// H
    depth_per_ndc: f32,
}

impl Orthographic {
    /// The projection with depth = (2 + NDC z) H, to be [checked](Projection::checked).
    pub(crate) fn with_depth_per_ndc(depth_per_ndc: f32) -> Self {
        Self { depth_per_ndc }
    }

    #[cfg(feature = "serde")]
    pub(crate) fn depth_per_ndc(&self) -> f32 {
        self.depth_per_ndc
    }
}

impl Camera<Orthographic> {
    /// Creates an orthographic camera from the two matrices of an engine: `view` takes world space to view
    /// space, and `projection` takes view space to clip space.
    ///
    /// The view must not scale. The projection may
    ///
    /// - be symmetric or off-centre, as with jitter;
    /// - be of either handedness, and have its near plane behind the camera;
    /// - map depth to \[0, 1\] or \[−1, 1\], rising or falling (*reversed z*);
    /// - negate y, as [`Camera::new`] says.
    ///
    /// Both matrices are stored by columns. A projection that is stored by rows is refused, unless it is
    /// symmetric with its near plane at distance 0, which looks the same either way.
    ///
    /// ```
    /// use stochastic_light_culling::{Camera, Sphere, TileGrid, glam::{Mat4, Vec3}};
    ///
    /// // 32 units wide and 18 high, from 100 in front of the camera to 100 behind it: as
    /// // `Mat4::orthographic_rh(-16.0, 16.0, -9.0, 9.0, -100.0, 100.0)` of glam, or Bevy's.
    /// let mut projection = Mat4::from_scale(Vec3::new(1.0 / 16.0, 1.0 / 9.0, -1.0 / 200.0));
    /// projection.w_axis.z = 0.5;
    /// let camera = Camera::orthographic(Mat4::IDENTITY, projection)?;
    /// let depths = [0.0, 0.5, 1.0].map(|value| camera.depth(value));
    /// assert_eq!(depths, [400.0, 500.0, 600.0]);
    ///
    /// // A tile is as large wherever it is.
    /// let tile = camera.tile(&TileGrid::new([1920, 1080], 60)?, [31, 0]);
    /// assert_eq!((tile.min().to_array(), tile.max().to_array()), ([15.0, 8.0], [16.0, 9.0]));
    /// let sphere = Sphere::new(Vec3::new(15.5, 8.5, 0.0), 1.0)?.project(&camera);
    /// assert_eq!(sphere.expect("not empty").center(), Vec3::new(15.5, 8.5, 500.0));
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Matrix`] if `view` is not rigid to 10⁻⁴, or `projection` is not orthographic along the z axis,
    /// with the last row (0, 0, 0, 1) to 10⁻⁶, a width, a height and a depth that are positive and finite, and edges
    /// within 10¹² of its axis. [`Error::Vector`] if the translation of `view` is not finite.
    pub fn orthographic(view: Mat4, projection: Mat4) -> Result<Self, Error> {
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| projection.row(row));
        // A transposed matrix has the offsets here.
        let drift = (w - Vec4::W).abs().max_element();
        if !projection.is_finite() || drift > LAST_ROW_TOLERANCE {
            let valid = "it must be finite and stored by columns, with the last row (0, 0, 0, 1); deviation";
            return Err(refused(drift, valid));
        }
        let stray = [x.y, x.z, y.x, y.z, z.x, z.y];
        if let Some(element) = stray.into_iter().find(|e| *e != 0.0) {
            let valid = "it must be orthographic along the z axis, with zeros off its pattern";
            return Err(refused(element, valid));
        }
        let (rotation, translation) = parts_of_view(view)?;
        let toward = z.z.signum();
        let depth_per_ndc = (f64::from(w.w) / f64::from(z.z)).abs();
        let depth_at_origin = (DEPTH_AT_ZERO + f64::from(z.w) / f64::from(w.w)) * depth_per_ndc;
        let depth = f64::from(toward * translation.z) + depth_at_origin;
        Self::from_parts(CameraParts {
            rotation: Mat3::from_diagonal(Vec3::new(1.0, 1.0, toward)) * rotation,
            translation: translation.truncate().extend(depth as f32),
            // As for a perspective, y is where NDC y points up.
            scale: Vec2::new(w.w / x.x, (w.w / y.y).abs()),
            offset: Vec2::new(-x.w / x.x, -y.w / y.y),
            projection: Orthographic::with_depth_per_ndc(depth_per_ndc as f32),
        })
    }

    /// Creates an orthographic camera at `eye` that looks at `target`, with a symmetric view of this `height`.
    ///
    /// `up` is a direction of world space that appears upright, of any length. It need not be perpendicular
    /// to the viewing direction. `depths` are distances from `eye` along the viewing direction, negative
    /// behind it. Values of the depth buffer rise from 0 at their start to 1 at their end.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `eye` is not finite, equals `target`, or `up` is parallel to the view.
    /// [`Error::Number`] if `height` is not positive and finite, `aspect_ratio` (width over height) is outside
    /// \[0.01, 100\], or `depths` are not finite or do not end after they start. [`Error::Matrix`] if the view is larger than
    /// 10¹².
    pub fn orthographic_look_at(
        eye: Vec3,
        target: Vec3,
        up: Vec3,
        height: f32,
        aspect_ratio: f32,
        depths: Range<f32>,
    ) -> Result<Self, Error> {
        let (rotation, translation) = looking_at(eye, target, up)?;
        let valid = "positive and finite";
        let height = number_in(
            "height of the view",
            height,
            valid,
            f32::MIN_POSITIVE..=f32::MAX,
        )?;
        let aspect = self::aspect_ratio(aspect_ratio)?;
        let near = number_in("near plane", depths.start, "finite", f32::MIN..=f32::MAX)?;
        let valid = "finite and greater than the near plane";
        let beyond_near = (Bound::Excluded(near), Bound::Included(f32::MAX));
        let far = number_in("far plane", depths.end, valid, beyond_near)?;
        let [near, far] = [near, far].map(f64::from);
        let depth = f64::from(translation.z) - near + DEPTH_AT_ZERO * (far - near);
        Self::from_parts(CameraParts {
            rotation,
            translation: translation.truncate().extend(depth as f32),
            scale: Vec2::new(0.5 * height * aspect, 0.5 * height),
            offset: Vec2::ZERO,
            projection: Orthographic::with_depth_per_ndc((far - near) as f32),
        })
    }
}

impl sealed::Sealed for Orthographic {}

impl Projection for Orthographic {
    const IS_PERSPECTIVE: bool = false;

    fn checked(self, half_size: Vec2, middle: Vec2) -> Result<Self, Error> {
        let is_length = |x: f32| (f32::MIN_POSITIVE..=MAX_COORDINATE).contains(&x);
        for (half, middle) in [(half_size.x, middle.x), (half_size.y, middle.y)] {
            let (half, farthest) = (half.abs(), half.abs() + middle.abs());
            if !(is_length(half) && is_length(farthest)) {
                let valid = "its width and height must be positive, and its edges within 10¹² of \
                             its axis; half the size, or the farthest edge";
                return Err(refused(
                    if is_length(half) { farthest } else { half },
                    valid,
                ));
            }
        }
        if !is_length(self.depth_per_ndc) {
            let valid = "its near and far planes must be distinct, and within 10¹² of each other; \
                         the depth of one unit of NDC z";
            return Err(refused(self.depth_per_ndc, valid));
        }
        Ok(self)
    }

    #[inline]
    fn depth(&self, ndc_depth: f32) -> f32 {
        (DEPTH_AT_ZERO as f32 + ndc_depth) * self.depth_per_ndc
    }

    #[inline]
    fn point(coordinates: Vec2, depth: f32) -> Vec3 {
        coordinates.extend(depth)
    }

    /// The sum of the coordinates of `center`, which is no less than its length, and the radius.
    #[inline(always)]
    fn farthest<N: Single>(&self, center: Vector3<N>, radius: N, factor: f32) -> N {
        (center.abs().element_sum() + radius) * factor
    }
}
