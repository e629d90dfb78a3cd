use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

use super::rigid::RigidView;
use super::{
    Interleave, Orthographic, Perspective, PixelRectangle, Projection, TileGrid, TileRectangle,
};
use crate::base::{Error, number_in};
use crate::num::{Single, Vector3};

/// Tolerance for the last row of a matrix.
pub(super) const LAST_ROW_TOLERANCE: f32 = 1e-6;

/// A camera: its position and orientation, its projection, and what its pixels cover.
///
/// [`Camera::new`] and [`Camera::look_at`] make one with a [`Perspective`], which is what `Camera` stands for as a
/// type; [`Camera::orthographic`] and [`Camera::orthographic_look_at`] a `Camera<Orthographic>`.
/// [`AnyCamera::new`] finds out from the matrices which it is.
///
/// *Camera space* has x to the right, y up and z = depth, for a view space of either handedness. Depth is the
/// positive distance along the viewing direction; for a parallel projection see [`Orthographic`].
///
/// Several views of a frame, such as those of a split screen or of the faces of a cube, are several cameras: see
/// [Views](crate#views).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera<P = Perspective> {
    view: RigidView,
    /// Coordinates in the rectangles of tiles = NDC · scale + offset.
    scale: Vec2,
    offset: Vec2,
    projection: P,
}

/// The fields of a camera from which the others follow.
#[derive(Clone, Copy)]
pub(crate) struct CameraParts<P> {
    pub rotation: Mat3,
    pub translation: Vec3,
    pub scale: Vec2,
    pub offset: Vec2,
    /// To be [checked](Projection::checked).
    pub projection: P,
}

impl<P: Projection> Camera<P> {
    /// Creates a camera from its parts. All constructors and deserialization end here.
    pub(crate) fn from_parts(parts: CameraParts<P>) -> Result<Self, Error> {
        let CameraParts { scale, offset, .. } = parts;
        Ok(Self {
            projection: parts.projection.checked(scale, offset)?,
            view: RigidView::new(parts.rotation, parts.translation)?,
            scale,
            offset,
        })
    }

    /// The parts that [`from_parts`](Self::from_parts) makes this camera from.
    #[cfg(feature = "serde")]
    pub(crate) fn parts(&self) -> CameraParts<P> {
        CameraParts {
            rotation: self.view.rotation(),
            translation: self.view.translation(),
            scale: self.scale,
            offset: self.offset,
            projection: self.projection,
        }
    }

    /// Returns this camera with its image moved by `pixels` = \[right, down\], in an image of `image_size` = \[width,
    /// height\] pixels: *jitter*, by shares of a pixel that change from frame to frame.
    ///
    /// The same as a translation of clip space by (2 right/width, −2 down/height) after the projection. A projection
    /// matrix that has its jitter already needs no more.
    ///
    /// ```
    /// use stochastic_light_culling::{Camera, glam::Vec3};
    ///
    /// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.5, 0.1..100.0)?;
    /// let size = [960, 640];
    /// let jittered = camera.jittered(size, [0.25, -0.5])?;
    /// let middle = camera.point_in_pixel(size, [480, 320], 5.0);
    /// let moved = jittered.point_in_pixel(size, [480, 320], 5.0);
    /// // What was a quarter of a pixel to the left and half of one below.
    /// assert!(moved.x < middle.x && moved.y < middle.y);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::Matrix`] if `pixels` are not finite, a side of `image_size` is zero, or the view would lie outside what the
    /// constructors of the camera accept.
    pub fn jittered(&self, image_size: [u32; 2], pixels: [f32; 2]) -> Result<Self, Error> {
        let [width, height] = image_size.map(|n| n as f32);
        let [right, down] = pixels;
        let ndc = Vec2::new(2.0 * right / width, -2.0 * down / height);
        let offset = self.offset - ndc * self.scale;
        Ok(Self {
            projection: self.projection.checked(self.scale, offset)?,
            offset,
            ..*self
        })
    }

    /// The map from world space to camera space.
    pub(crate) fn view(&self) -> &RigidView {
        &self.view
    }

    #[cfg(feature = "bytemuck")]
    pub(crate) fn projection(&self) -> &P {
        &self.projection
    }

    /// The rotation from world space to camera space. Its columns are the axes of world space.
    ///
    /// Camera space is left-handed. So the determinant is −1 for a right-handed world, which
    /// [`look_at`](Self::look_at) assumes, and 1 for a left-handed one. With an orthographic projection and
    /// reversed z it is the other way round, since depths then grow towards the camera.
    #[must_use]
    pub fn rotation(&self) -> Mat3 {
        self.view.rotation()
    }

    /// Transforms a `point` from world space to camera space.
    ///
    /// Computed in `f64` and rounded once. So nothing of a near point is lost where it and the camera are far
    /// from the world's origin. Not finite if `point` is not, or if the result overflows.
    #[inline]
    #[must_use]
    pub fn to_camera_space(&self, point: Vec3) -> Vec3 {
        self.view.transform_point(point)
    }

    /// Transforms a `point` from camera space to world space, to within rounding. The origin becomes the
    /// eye.
    #[must_use]
    pub fn to_world_space(&self, point: Vec3) -> Vec3 {
        self.view.inverse_transform_point(point)
    }

    /// `factor` times an upper bound of the distance from the origin of camera space of points in view that are
    /// within `radius` of `center`.
    #[inline(always)]
    pub(crate) fn farthest<N: Single>(&self, center: Vector3<N>, radius: N, factor: f32) -> N {
        self.projection.farthest(center, radius, factor)
    }

    /// Converts a value of the depth buffer to a depth in camera space.
    ///
    /// Infinite at an infinite far plane, and NaN for NaN. [`DepthInterval`](crate::DepthInterval) takes both
    /// for sky. At a finite far plane the depth is that of the plane, so leave out what an engine cleared to it.
    #[inline]
    #[must_use]
    pub fn depth(&self, ndc_depth: f32) -> f32 {
        self.projection.depth(ndc_depth)
    }

    /// What a tile of `grid` covers.
    ///
    /// Of a tile outside the grid, an edge or a corner of the view.
    #[inline]
    #[must_use]
    pub fn tile(&self, grid: &TileGrid, tile: [u32; 2]) -> TileRectangle {
        self.tile_rectangle(grid.image_size(), grid.pixels(tile))
    }

    /// What a tile of `grid` covers, where `grid` is of the image of a `subregion` of interleaved sampling.
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

    /// What `pixels` cover in an image of `image_size` = \[width, height\] pixels. Pixel (0, 0) is at the top
    /// left.
    ///
    /// `image_size` must not be zero. Pixels outside the image are left out.
    #[inline]
    #[must_use]
    pub fn tile_rectangle(&self, image_size: [u32; 2], pixels: PixelRectangle) -> TileRectangle {
        let corner = |[x, y]: [u32; 2]| {
            // A tile has nothing outside the view.
            let (x, y) = (x.min(image_size[0]), y.min(image_size[1]));
            self.coordinates(image_size, [x as f32, y as f32])
        };
        TileRectangle::from_corners(corner(pixels.min), corner(pixels.max))
    }

    /// The point of camera space at `depth` behind the middle of `pixel`, in an image of `image_size` =
    /// \[width, height\] pixels.
    #[inline]
    #[must_use]
    pub fn point_in_pixel(&self, image_size: [u32; 2], pixel: [u32; 2], depth: f32) -> Vec3 {
        let middle = pixel.map(|n| n as f32 + 0.5);
        P::point(self.coordinates(image_size, middle), depth)
    }

    /// The coordinates in the rectangles of tiles of a place in the image, in pixels from its top left.
    #[inline]
    fn coordinates(&self, image_size: [u32; 2], [x, y]: [f32; 2]) -> Vec2 {
        let [width, height] = image_size.map(|n| n as f32);
        let ndc = Vec2::new(2.0 * x / width - 1.0, 1.0 - 2.0 * y / height);
        ndc * self.scale + self.offset
    }
}

/// A camera whose projection is known when the program runs, as engines have it.
///
/// ```
/// use stochastic_light_culling::{AnyCamera, Camera, Error, Projection, Sphere, glam::Mat4};
///
/// fn draw<P: Projection>(camera: &Camera<P>) { /* … */ }
///
/// fn view(view: Mat4, projection: Mat4) -> Result<(), Error> {
///     match AnyCamera::new(view, projection)? {
///         AnyCamera::Perspective(camera) => draw(&camera),
///         AnyCamera::Orthographic(camera) => draw(&camera),
///     }
///     Ok(())
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum AnyCamera {
    /// A camera whose rays meet in the eye.
    Perspective(Camera),
    /// A camera whose rays are parallel.
    Orthographic(Camera<Orthographic>),
}

impl AnyCamera {
    /// Creates a camera from the two matrices of an engine, by [`Camera::orthographic`] if depth has no part in the
    /// last row of `projection`, and else by [`Camera::new`].
    ///
    /// # Errors
    ///
    /// Those of the two.
    pub fn new(view: Mat4, projection: Mat4) -> Result<Self, Error> {
        if projection.row(3).z == 0.0 {
            Camera::orthographic(view, projection).map(Self::Orthographic)
        } else {
            Camera::new(view, projection).map(Self::Perspective)
        }
    }
}

impl From<Camera> for AnyCamera {
    fn from(camera: Camera) -> Self {
        Self::Perspective(camera)
    }
}

impl From<Camera<Orthographic>> for AnyCamera {
    fn from(camera: Camera<Orthographic>) -> Self {
        Self::Orthographic(camera)
    }
}

/// The rotation and translation of a view matrix.
pub(super) fn parts_of_view(view: Mat4) -> Result<(Mat3, Vec3), Error> {
    let drift = (view.row(3) - Vec4::W).abs().max_element();
    if !view.is_finite() || drift > LAST_ROW_TOLERANCE {
        return Err(Error::Matrix {
            quantity: "view matrix",
            element: drift,
            valid: "its last row must be (0, 0, 0, 1); deviation",
        });
    }
    Ok((Mat3::from_mat4(view), view.w_axis.truncate()))
}

/// The width of a view over its height, if it is in range.
pub(super) fn aspect_ratio(ratio: f32) -> Result<f32, Error> {
    number_in("aspect ratio", ratio, "in [0.01, 100]", 0.01..=100.0)
}
