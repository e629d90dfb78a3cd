//! From an ellipsoid in the world to the unit sphere before the eye.
//!
//! An ellipsoid meets a tile exactly when its image, a unit sphere, meets the image of the tile.
//! With the axes R′ = V R and the centre c′ = V c + o in camera space,
//!
//! S = R′ diag(1/r_u, 1/r_v, 1/r_w) R′ᵀ
//!
//! takes it to a unit sphere, and the rotation B after it turns planes of constant depth back to
//! planes of constant depth: M = BS has the third row (0, 0, m)
//! [Tokuyoshi & Harada 2017, Eqs. 16–17].
//!
//! # M without S and B
//!
//! B is orthonormal, so MᵀM = S² = A, and B puts a zero at M₂₁ or at M₁₂: M is triangular, the
//! Cholesky factor of A. Reckoned as B times S, its rows are differences of entries as large as
//! 1/r_w that must leave 1/r_u, and errors grow with the square of the aspect ratio. But let C = A⁻¹
//! = R′ diag(r_u², r_v², r_w²) R′ᵀ. From M C Mᵀ = 1 follow
//!
//! - m = 1/√C_zz: the ellipsoid reaches √C_zz in depth;
//! - A_xx A_yy − A_xy² = C_zz det A, the cofactor rule;
//! - (M₁₃, M₂₃) = −M₂ₓ₂ (C_xz, C_yz)/C_zz.
//!
//! Sums of squares all but A_xy, C_xz and C_yz, whose rounding Cauchy–Schwarz bounds by that of the
//! diagonal: no error is worse than the aspect ratio times a few roundings, which is what one ulp of
//! the axes costs in any case.
//!
//! # What rounding costs
//!
//! With u = 2⁻²⁴, s the secant of the corner of the view, and δ the deviation of V and R from
//! orthonormal, the image of a point p of the ellipsoid and the box of a tile that holds it are
//! computed apart from each other by at most
//!
//! - (r_max/r_min)(128u + 6δ) for the axes and the elements of M,
//! - 6u ‖c′‖/r_min for c′ and M c′,
//! - 9u s z/r_min for the box, z ≤ max(c′_z, 0) + r_max the greatest depth of p.
//!
//! The semi-axes are enlarged by the sum, so that such a tile is never found apart from the light.
//! `docs/rounding.md` counts the roundings, and those of a sphere, which is not stretched and has fewer.

use glam::{Mat3, Vec3};

use super::projected::{Field, Projected, ProjectedLanes, outward};
use super::{Project, margin};
use crate::bound::{Ellipsoid, Ellipsoids};
use crate::num::{Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3};
use crate::view::Camera;

/// S, the symmetric matrix that stretches camera space so that `ellipsoid` becomes a unit sphere
/// [Tokuyoshi & Harada 2017, Eq. 16].
///
/// For a look at the method and for single uses; [`ProjectedEllipsoid`] does not need it. Not finite for an
/// empty ellipsoid.
///
/// ```
/// use stochastic_light_culling::{
///     Camera, Ellipsoid, glam::{Mat3, Vec3}, stretch_matrix, stretch_rotation,
/// };
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let ellipsoid = Ellipsoid::new(Vec3::X, Mat3::IDENTITY, Vec3::new(1.0, 2.0, 4.0))?;
/// let s = stretch_matrix(&ellipsoid, &camera);
/// let both = stretch_rotation(s) * s;
/// let stretch = ellipsoid.project(&camera).expect("not empty");
/// assert!((both * Vec3::ONE - stretch.matrix() * Vec3::ONE).length() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[must_use]
pub fn stretch_matrix(ellipsoid: &Ellipsoid, camera: &Camera) -> Mat3 {
    let axes = camera.rotation() * ellipsoid.rotation();
    axes * Mat3::from_diagonal(ellipsoid.semi_axes().recip()) * axes.transpose()
}

/// B, the rotation that takes the images under `stretch` = S of planes of constant depth to planes of
/// constant z [Tokuyoshi & Harada 2017, Eq. 17].
///
/// Not finite if S is singular or not finite itself.
#[must_use]
pub fn stretch_rotation(stretch: Mat3) -> Mat3 {
    // Not `normalize`, which panics at zero where glam is built with its assertions.
    let unit = |v: Vec3| v * v.length().recip();
    let (x, y) = (stretch.x_axis, stretch.y_axis);
    let z = unit(x.cross(y));
    if x.length_squared() > y.length_squared() {
        let x = unit(x);
        Mat3::from_cols(x, z.cross(x), z).transpose()
    } else {
        let y = unit(y);
        Mat3::from_cols(y.cross(z), y, z).transpose()
    }
}

/// An ellipsoid as a tile test wants it: M = BS, which takes it to a unit sphere, and the sphere's
/// centre Mc′.
///
/// ```
/// use stochastic_light_culling::{Camera, Ellipsoid, glam::{Mat3, Vec3}};
///
/// let camera = Camera::look_at(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let ellipsoid = Ellipsoid::new(Vec3::new(0.0, 0.0, -8.0), Mat3::IDENTITY, Vec3::new(1.0, 2.0, 4.0))?;
/// let stretch = ellipsoid.project(&camera).expect("not empty");
/// assert!((stretch.center() - Vec3::new(0.0, 0.0, 2.0)).length() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedEllipsoid {
    matrix: Mat3,
    center: Vec3,
}

impl ProjectedEllipsoid {
    /// M: the columns are the images of the axes of camera space. Its third row is (0, 0, m), and one
    /// of its other two elements off the diagonal of the first two columns is zero.
    #[must_use]
    pub fn matrix(&self) -> Mat3 {
        self.matrix
    }

    /// Mc′, the centre of the unit sphere.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }
}

impl Ellipsoid {
    /// The ellipsoid in the space of `camera`, as a unit sphere; `None` if it is empty.
    ///
    /// Of an ellipsoid too large to be finite, the stretch takes all of space into the unit sphere.
    #[must_use]
    pub fn project(&self, camera: &Camera) -> Option<ProjectedEllipsoid> {
        if self.is_empty() {
            return None;
        }
        Some(ProjectedEllipsoid::from_fields(self.lanes().fields(camera)))
    }
}

impl Project for Ellipsoid {
    type Projected = ProjectedEllipsoid;

    fn project(&self, camera: &Camera) -> Option<ProjectedEllipsoid> {
        self.project(camera)
    }

    #[inline(always)]
    fn project_lanes<N: Single>(
        lanes: Ellipsoids<N>,
        camera: &Camera,
    ) -> ProjectedLanes<N, ProjectedEllipsoid> {
        lanes.projected(camera)
    }
}

/// Roundings of the centre and of the box of a tile.
const ROUNDINGS: [f32; 2] = [6.0, 9.0];
/// M is made of its reciprocal, which is not to overflow times a slope and a depth.
const LEAST_SEMI_AXIS: f32 = 1e-30;

impl<N: Single> Ellipsoids<N> {
    #[inline(always)]
    pub(super) fn projected(self, camera: &Camera) -> ProjectedLanes<N, ProjectedEllipsoid> {
        let fields = self.fields(camera);
        ProjectedLanes {
            reach: ProjectedEllipsoid::reach_of_fields(&fields),
            fields,
        }
    }

    /// The fields of projected ellipsoids, none of which is empty.
    #[inline(always)]
    fn fields(self, camera: &Camera) -> [N; 10] {
        let semi_axes = self.semi_axes;
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        let center = camera.sum_to_camera_space(self.parts);
        let is_finite = semi_axes.is_finite() & center.is_finite();
        let zero = shortest.zero();
        if N::is_known_false(is_finite) {
            return [zero; 10];
        }

        let axes = camera.rotation_in_lanes(shortest) * self.axes;
        let [xx, xy, xz, yx, yy, yz, m] = triangular_stretch(axes, semi_axes);
        let rounding =
            margin(camera, center, longest, ROUNDINGS) + camera.rounding_of_terms(self.parts);
        let tilt = longest * (128.0 * UNIT_ROUNDOFF + 6.0 * camera.rotation_deviation());
        let enlarged = (shortest + (rounding + tilt)).round_up(4);
        let factor = enlarged.max(zero.splat(LEAST_SEMI_AXIS)).recip();

        let x = Vector3::new(xx, xy, xz) * factor;
        let y = Vector3::new(yx, yy, yz) * factor;
        let z = Vector3::new(factor * 0.0, factor * 0.0, m * factor);
        let c = Vector3::new(x.dot(center), y.dot(center), z.dot(center));
        let fields = [x.x, x.y, x.z, y.x, y.y, y.z, z.z, c.x, c.y, c.z];
        N::select_all(is_finite, fields, [zero; 10])
    }
}

/// The elements of M·r_min that are not zero, row by row, for axes that are the columns of `axes`.
#[inline(always)]
fn triangular_stretch<N: Real>(axes: Matrix3<N>, semi_axes: Vector3<N>) -> [N; 7] {
    let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
    let Vector3 { x, y, z } = semi_axes;
    let inverse = Vector3::new(shortest / x, shortest / y, shortest / z);
    let direct = Vector3::new(x / longest, y / longest, z / longest);
    // A r_min² and C/r_max², of which only these elements are needed.
    let Matrix3 { x, y, z } = axes.transpose();
    let (inverse_squared, direct_squared) = (inverse.times(inverse), direct.times(direct));
    let a_xx = inverse_squared.times(x).dot(x);
    let a_yy = inverse_squared.times(y).dot(y);
    let a_xy = inverse_squared.times(x).dot(y);
    let c_xz = direct_squared.times(x).dot(z);
    let c_yz = direct_squared.times(y).dot(z);
    let c_zz = direct_squared.times(z).dot(z);

    let depth_reach = c_zz.sqrt();
    // √(A_xx A_yy − A_xy²): of √det A, the factor 1/(r_min r_max) is in the units chosen.
    let root = depth_reach * (shortest / semi_axes.median());
    // The longer image first, in the same operations whichever it is.
    let zero = root.zero();
    let x_first = a_xx.gt(a_yy);
    let first = N::select(x_first, a_xx, a_yy).sqrt();
    let (mixed, second) = (a_xy / first, root / first);
    let [xx, xy, yx, yy] = N::select_all(
        x_first,
        [first, mixed, zero, second],
        [second, zero, mixed, first],
    );
    let shear_x = (xx * c_xz + xy * c_yz) / c_zz;
    let shear_y = (yx * c_xz + yy * c_yz) / c_zz;
    let m = shortest / (longest * depth_reach);
    [xx, xy, -shear_x, yx, yy, -shear_y, m]
}

impl Projected for ProjectedEllipsoid {
    /// M₁₁, M₁₂, M₁₃, M₂₁, M₂₂, M₂₃, m, and Mc′.
    type Fields<T: Field> = [T; 10];

    /// At an infinite distance.
    const NOWHERE: [f32; 10] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, f32::INFINITY, 0.0, 0.0];

    fn fields_of<T: Field>(value: T) -> [T; 10] {
        [value; 10]
    }

    #[inline(always)]
    fn to_fields(&self) -> [f32; 10] {
        let (m, c) = (&self.matrix, self.center);
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
        [x.x, y.x, z.x, x.y, y.y, z.y, z.z, c.x, c.y, c.z]
    }

    #[inline(always)]
    fn from_fields([m_11, m_12, m_13, m_21, m_22, m_23, m, x, y, z]: [f32; 10]) -> Self {
        let matrix = Mat3::from_cols(
            Vec3::new(m_11, m_21, 0.0),
            Vec3::new(m_12, m_22, 0.0),
            Vec3::new(m_13, m_23, m),
        );
        Self {
            matrix,
            center: Vec3::new(x, y, z),
        }
    }

    #[inline(always)]
    fn reach_of_fields<N: Single>(fields: &[N; 10]) -> [N; 2] {
        let [.., m, _, _, depth] = *fields;
        outward([(depth - UNIT_REACH) / m, (depth + UNIT_REACH) / m])
    }
}

/// The unit sphere's reach in m z, enlarged by what the test rounds there: m z, and its difference from the
/// centre. [`outward`] covers the part of it that grows with the depth.
const UNIT_REACH: f32 = 1.0 + 4.0 * UNIT_ROUNDOFF;
