use glam::{Mat3, Vec3};

use crate::base::{Direction, Error, finite, orthonormal};
use crate::num::{Matrix3, Single, UNIT_ROUNDOFF, Vector3};

/// Budget for the rounding that grows with the anchor's image, in [`RigidView::move_anchor_to_eye`].
const ANCHOR_ROUNDINGS: f32 = 10.0;
/// Budget for the sums in `f64` of [`RigidView::transform_point`], in units of `f64::EPSILON` and the terms.
const TERM_ROUNDINGS: f32 = 8.0;

/// Tolerance for the orthonormality of a view's rotation, element by element.
const RIGID_TOLERANCE: f32 = 1e-4;

/// The rigid map from world space to camera space: the position and orientation of a camera.
///
/// The *eye* is the origin of camera space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidView {
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
}

impl RigidView {
    /// Creates the map x ↦ `rotation` x + `translation`.
    pub fn new(rotation: Mat3, translation: Vec3) -> Result<Self, Error> {
        let translation = finite("translation of the view", translation)?;
        let mut view = Self {
            rotation,
            translation,
            rows: [0, 1, 2].map(|i| Vector3::from(rotation.row(i)).widen()),
            translation_f64: Vector3::from(translation).widen(),
            rotation_deviation: orthonormal("view matrix", rotation, RIGID_TOLERANCE)?,
            anchor: Vec3::ZERO,
            anchor_image: translation,
            rounding_of_anchor: 0.0,
        };
        view.move_anchor_to_eye();
        Ok(view)
    }

    /// Moves the anchor from the world's origin to the eye, as far as `f32` allows.
    ///
    /// Any anchor is valid. A nearer one has less rounding.
    fn move_anchor_to_eye(&mut self) {
        // The second step corrects for a rotation that is not quite orthonormal.
        for _ in 0..2 {
            let anchor = self.anchor - self.rotation.transpose() * self.anchor_image;
            let image = self.transform_point(anchor);
            if image.is_finite() {
                (self.anchor, self.anchor_image) = (anchor, image);
            }
        }
        self.rounding_of_anchor =
            ANCHOR_ROUNDINGS * UNIT_ROUNDOFF * self.anchor_image.abs().element_sum()
                + self.rounding_of_terms(Vector3::from(self.anchor));
    }

    pub fn rotation(&self) -> Mat3 {
        self.rotation
    }

    #[cfg(feature = "serde")]
    pub fn translation(&self) -> Vec3 {
        self.translation
    }

    /// Transforms a `point` from world space to camera space. Computed in `f64` and rounded once.
    #[inline]
    pub fn transform_point(&self, point: Vec3) -> Vec3 {
        self.transform_points(Vector3::from(point)).into()
    }

    /// Transforms a `point` from camera space to world space, to within rounding.
    pub fn inverse_transform_point(&self, point: Vec3) -> Vec3 {
        self.rotation.transpose() * (point - self.translation)
    }

    /// Rotates a unit `direction` from world space to camera space, and rounds once.
    pub fn direction_to_camera_space(&self, direction: Vec3) -> Vec3 {
        let direction = Vector3::from(direction).widen();
        let [x, y, z] = self.rows.map(|row| row.dot(direction));
        Vector3::narrow(Vector3::new(x, y, z)).into()
    }

    /// [`transform_point`](Self::transform_point) in lanes.
    #[inline(always)]
    pub fn transform_points<N: Single>(&self, points: Vector3<N>) -> Vector3<N> {
        let (points, [x, y, z]) = (points.widen(), self.rows);
        let like = points.x;
        // No closure, which is a call through memory if N is a vector.
        let x = Vector3::splat(like, x).dot(points);
        let y = Vector3::splat(like, y).dot(points);
        let z = Vector3::splat(like, z).dot(points);
        let rotated = Vector3::new(x, y, z);
        Vector3::narrow(rotated + Vector3::splat(rotated.x, self.translation_f64))
    }

    /// Transforms a `point` from world space to camera space in `f32` alone.
    ///
    /// Errs by at most 9u of the length of the result plus [`rounding_of_anchor`](Self::rounding_of_anchor),
    /// wherever the world's origin is.
    #[inline(always)]
    pub fn relative_to_anchor<N: Single>(&self, point: Vector3<N>) -> Vector3<N> {
        let anchor = Vector3::splat(point.x, self.anchor.into());
        let anchor_image = Vector3::splat(point.x, self.anchor_image.into());
        self.rotation_in_lanes(point.x) * (point - anchor) + anchor_image
    }

    /// [`rotation`](Self::rotation) in as many lanes as `like` has.
    #[inline(always)]
    pub fn rotation_in_lanes<N: Single>(&self, like: N) -> Matrix3<N> {
        Matrix3::splat(like, self.rotation.into())
    }

    /// Upper bound, in length, of the error of [`relative_to_anchor`](Self::relative_to_anchor) that is due
    /// to the distance between anchor and eye.
    pub fn rounding_of_anchor(&self) -> f32 {
        self.rounding_of_anchor
    }

    /// Upper bound, in length, of the error of the sums in `f64` of [`transform_points`](Self::transform_points),
    /// before the result is rounded.
    #[inline(always)]
    pub fn rounding_of_terms<N: Single>(&self, points: Vector3<N>) -> N {
        let translation = Vector3::splat(points.x, self.translation.abs().into());
        let terms = points.abs() + translation;
        terms.element_sum() * (TERM_ROUNDINGS * f64::EPSILON as f32)
    }

    /// The anchor in world space, and its image in camera space.
    #[cfg(feature = "bytemuck")]
    pub fn anchor(&self) -> [Vec3; 2] {
        [self.anchor, self.anchor_image]
    }

    /// δ, the largest element of RᵀR − 1 in magnitude: how far the rotation R is from orthonormal.
    pub fn rotation_deviation(&self) -> f32 {
        self.rotation_deviation
    }
}

/// The rotation and translation of a camera at `eye` that looks at `target`, with `up` upright.
pub fn looking_at(eye: Vec3, target: Vec3, up: Vec3) -> Result<(Mat3, Vec3), Error> {
    let eye = finite("eye", eye)?;
    let forward = Direction::of("way from the eye to its target", target - eye)?;
    let right = Direction::of("viewing direction × up", forward.cross(up))?;
    let rotation = Mat3::from_cols(*right, right.cross(*forward), *forward).transpose();
    Ok((rotation, -(rotation * eye)))
}
