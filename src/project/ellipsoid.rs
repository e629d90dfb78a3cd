//! The projection of an ellipsoid to a unit sphere.
//!
//! A linear map M takes the ellipsoid, in camera space, to a unit sphere. The ellipsoid meets a tile exactly
//! if the unit sphere meets the image of the tile under M. With the axes R′ = V R and the centre
//! c′ = V c + o in camera space, the stretch
//!
//! S = R′ diag(1/r_u, 1/r_v, 1/r_w) R′ᵀ
//!
//! takes the ellipsoid to a unit sphere. The rotation B then takes the images of planes of constant depth
//! to planes of constant z: M = BS has the third row (0, 0, m) [Tokuyoshi & Harada 2017, Eqs. 16–17].
//!
//! # M without S and B
//!
//! B is orthonormal, so MᵀM = S² = A, and B puts a zero at M₂₁ or at M₁₂. So M is a triangular factor of A,
//! as in a Cholesky decomposition. The product B S would lose accuracy: its rows are differences of elements
//! as large as 1/r_w whose result can be as small as 1/r_u, so errors grow with the square of the aspect
//! ratio. Instead let C = A⁻¹ = R′ diag(r_u², r_v², r_w²) R′ᵀ. From M C Mᵀ = 1 follow
//!
//! - m = 1/√C_zz: the ellipsoid reaches √C_zz in depth;
//! - A_xx A_yy − A_xy² = C_zz det A, the cofactor rule;
//! - (M₁₃, M₂₃) = −M₂ₓ₂ (C_xz, C_yz)/C_zz.
//!
//! All elements but A_xy, C_xz and C_yz are sums of squares. By Cauchy–Schwarz the errors of these three are
//! bounded by those of the diagonal. So no error exceeds the aspect ratio times a few roundings, which is
//! the effect of one ulp of the axes in any case.
//!
//! # Rounding
//!
//! Let u = 2⁻²⁴, s the secant of the corner of the view, and δ the deviation of V from orthonormal. Rounding
//! moves the image of a point p of the ellipsoid against the box of a tile that holds p by at most
//!
//! - (r_max/r_min)(128u + 6δ) for the axes and the elements of M ([`AXES_ROUNDINGS`], [`AXES_DEVIATIONS`]),
//! - 7u (‖c′‖ + ‖o′‖)/r_min for c′ and M c′, where o′ is the way from the light to the centre
//!   ([`CENTER_ROUNDINGS`], [`OFFSET_ROUNDINGS`]),
//! - 9u s z/r_min for the box ([`BOX_ROUNDINGS`]), where z ≤ max(c′_z, 0) + r_max is the greatest depth of p.
//!
//! The semi-axes are enlarged by r_min times the sum, so the test never misses such a tile.
//! `docs/rounding.md` counts the roundings.

use core::marker::PhantomData;

use glam::{Mat3, Vec3};

use super::projected::{Field, Projected, bounds_around, outward};
use super::slopes::TangentPlanes;
use super::{Project, margin};
use crate::bound::{Ellipsoid, Ellipsoids};
use crate::num::{Matrix3, Real, Single, UNIT_ROUNDOFF, Vector3};
use crate::view::{Camera, Perspective, Projection, ViewBounds};

/// Budget for c′ and M c′, in units of the sum of the coordinates of c′.
const CENTER_ROUNDINGS: f32 = 7.0;
/// Budget for c′, in units of the sum of the coordinates of the offset of the centre from the light.
const OFFSET_ROUNDINGS: f32 = 7.0;
/// Budget for the box of a tile, in units of s z.
const BOX_ROUNDINGS: f32 = 9.0;
/// Budget for the axes and the elements of M, in units of the longest semi-axis.
const AXES_ROUNDINGS: f32 = 128.0;
/// Budget for the axes of a view that is not orthonormal, in units of its deviation δ and the longest
/// semi-axis.
const AXES_DEVIATIONS: f32 = 6.0;
/// Budget for the enlarged shortest semi-axis, the row of m and the comparison of the box test.
const SEMI_AXIS_ROUNDINGS: u16 = 4;
/// Lower clamp of the enlarged shortest semi-axis. Its reciprocal times a slope and a depth is finite.
const LEAST_SEMI_AXIS: f32 = 1e-24;

/// S, the symmetric matrix that stretches camera space such that `ellipsoid` becomes a unit sphere
/// [Tokuyoshi & Harada 2017, Eq. 16].
///
/// Shows the method of the paper; [`ProjectedEllipsoid`] does not use it. Neither enlarged for rounding nor
/// accurate for high aspect ratios. Not finite for an empty ellipsoid.
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
/// let projected = ellipsoid.project(&camera).expect("not empty");
/// assert!((both * Vec3::ONE - projected.matrix() * Vec3::ONE).length() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[must_use]
pub fn stretch_matrix<P: Projection>(ellipsoid: &Ellipsoid, camera: &Camera<P>) -> Mat3 {
    let axes = camera.rotation() * ellipsoid.rotation();
    axes * Mat3::from_diagonal(ellipsoid.semi_axes().recip()) * axes.transpose()
}

/// B, the rotation that takes the images of planes of constant depth under `stretch` = S to planes of
/// constant z [Tokuyoshi & Harada 2017, Eq. 17].
///
/// Not finite if S is singular or not finite.
#[must_use]
pub fn stretch_rotation(stretch: Mat3) -> Mat3 {
    // `normalize` panics at zero if glam is built with its assertions.
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

/// An ellipsoid projected to camera space, as tile tests take it: the matrix M = BS, which takes the
/// ellipsoid to a unit sphere, and the centre Mc′ of that sphere.
///
/// The ellipsoid is enlarged for rounding. One that is too large for `f32` has M = 0 and
/// Mc′ = 0, and touches every tile.
///
/// ```
/// use stochastic_light_culling::{Camera, Ellipsoid, glam::{Mat3, Vec3}};
///
/// let camera = Camera::look_at(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let ellipsoid = Ellipsoid::new(Vec3::new(0.0, 0.0, -8.0), Mat3::IDENTITY, Vec3::new(1.0, 2.0, 4.0))?;
/// let projected = ellipsoid.project(&camera).expect("not empty");
/// assert!((projected.center() - Vec3::new(0.0, 0.0, 2.0)).length() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedEllipsoid<P = Perspective> {
    /// M₁₁, M₁₂, M₁₃, M₂₁, M₂₂, M₂₃, m, Mc′, and the bounds of x/z, of y/z and of z: in the layout of a batch, so
    /// that one is copied as a whole.
    fields: [f32; FIELDS],
    projection: PhantomData<P>,
}

/// The number of fields of a projected ellipsoid.
const FIELDS: usize = 16;

impl<P> ProjectedEllipsoid<P> {
    /// M. Its columns are the images of the axes of camera space. Its third row is (0, 0, m), and M₁₂ or
    /// M₂₁ is zero.
    #[must_use]
    pub fn matrix(&self) -> Mat3 {
        let [m_11, m_12, m_13, m_21, m_22, m_23, m, ..] = self.fields;
        Mat3::from_cols(
            Vec3::new(m_11, m_21, 0.0),
            Vec3::new(m_12, m_22, 0.0),
            Vec3::new(m_13, m_23, m),
        )
    }

    /// Mc′, the centre of the unit sphere.
    #[must_use]
    pub fn center(&self) -> Vec3 {
        let [.., x, y, z, _, _, _, _, _, _] = self.fields;
        Vec3::new(x, y, z)
    }
}

impl Ellipsoid {
    /// Projects the ellipsoid to a unit sphere in the space of `camera`. `None` if the ellipsoid is empty.
    ///
    /// For an ellipsoid too large to be finite, M is zero and takes all of space into the unit sphere.
    #[must_use]
    pub fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<ProjectedEllipsoid<P>> {
        if self.is_empty() {
            return None;
        }
        Some(ProjectedEllipsoid::from_fields(self.lanes().fields(camera)))
    }
}

impl Project for Ellipsoid {
    type Projected<P: Projection> = ProjectedEllipsoid<P>;

    fn project<P: Projection>(&self, camera: &Camera<P>) -> Option<ProjectedEllipsoid<P>> {
        self.project(camera)
    }

    #[inline(always)]
    fn project_lanes<N: Single, P: Projection>(
        lanes: Ellipsoids<N>,
        camera: &Camera<P>,
    ) -> [N; FIELDS] {
        lanes.fields(camera)
    }
}

impl<N: Single> Ellipsoids<N> {
    /// The fields of the projected ellipsoids, none of which is empty.
    #[inline(always)]
    pub(super) fn fields<P: Projection>(self, camera: &Camera<P>) -> [N; FIELDS] {
        let view = camera.view();
        let semi_axes = self.semi_axes;
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        let rotation = view.rotation_in_lanes(shortest);
        let light = self.light_or_origin();
        let offset = rotation * self.offset;
        let center = view.transform_points(light) + offset;
        let is_finite = semi_axes.is_finite() & center.is_finite();
        let zero = shortest.zero();
        let axes = rotation * self.axes;
        let [xx, xy, xz, yx, yy, yz, m] = triangular_stretch(axes, semi_axes);
        let rounding = margin(camera, center, longest, CENTER_ROUNDINGS, BOX_ROUNDINGS)
            + offset.abs().element_sum() * (OFFSET_ROUNDINGS * UNIT_ROUNDOFF)
            + view.rounding_of_terms(light);
        let tilt = longest
            * (AXES_ROUNDINGS * UNIT_ROUNDOFF + AXES_DEVIATIONS * view.rotation_deviation());
        let enlarged = (shortest + (rounding + tilt)).round_up(SEMI_AXIS_ROUNDINGS);
        let factor = enlarged.max(zero.splat(LEAST_SEMI_AXIS)).recip();

        let x = Vector3::new(xx, xy, xz) * factor;
        let y = Vector3::new(yx, yy, yz) * factor;
        let z = Vector3::new(factor * 0.0, factor * 0.0, m * factor);
        let c = Vector3::new(x.dot(center), y.dot(center), z.dot(center));
        // The bounds of M = 0 hold everything.
        let [xx, xy, xz, yx, yy, yz, zz, c_x, c_y, c_z] = N::select_all(
            is_finite,
            [x.x, x.y, x.z, y.x, y.y, y.z, z.z, c.x, c.y, c.z],
            [zero; 10],
        );
        let matrix = [xx, xy, xz, yx, yy, yz, zz];
        let c = Vector3::new(c_x, c_y, c_z);
        let ViewBounds {
            across,
            down,
            depths,
        } = if P::IS_PERSPECTIVE {
            bounds(matrix, c)
        } else {
            bounds_around(center, reach(axes, semi_axes, enlarged))
        };
        let [left, right] = across;
        let [bottom, top] = down;
        let [near, far] = depths;
        [
            xx, xy, xz, yx, yy, yz, zz, c.x, c.y, c.z, left, right, bottom, top, near, far,
        ]
    }
}

/// Bounds of the slopes and depths of the points that M, given row by row without the two zeros of its last
/// row, takes into the unit ball around `center`.
#[inline(always)]
fn bounds<N: Single>([xx, xy, xz, yx, yy, yz, m]: [N; 7], center: Vector3<N>) -> ViewBounds<N> {
    let one = m.splat(1.0);
    let planes = TangentPlanes::new(center.z, one);
    // The first two rows of m M⁻¹ are (g_x, h_x, K_x) and (h_y, g_y, K_y). M₁₂ or M₂₁ is zero.
    let (per_xx, per_yy) = (xx.recip(), yy.recip());
    let (g_x, g_y) = (m * per_xx, m * per_yy);
    let (h_x, h_y) = (-(g_y * (xy * per_xx)), -(g_x * (yx * per_yy)));
    let axis_x = [xy * (yz * per_yy) * per_xx, -(xz * per_xx)];
    let axis_y = [yx * (xz * per_xx) * per_yy, -(yz * per_yy)];
    ViewBounds {
        across: planes.slopes_of_ellipsoid(axis_x, [g_x, h_x], [center.x, center.y]),
        down: planes.slopes_of_ellipsoid(axis_y, [g_y, h_y], [center.y, center.x]),
        depths: outward([(center.z - one) / m, (center.z + one) / m]),
    }
}

/// How far ellipsoids reach from their centers along the axes of camera space, where their semi-axes, along the columns
/// R′ = `axes`, grow in proportion until the shortest is `enlarged`.
///
/// Along an axis e the reach is √(eᵀCe), a sum of squares. It is nowhere less than the shortest semi-axis.
#[inline(always)]
fn reach<N: Single>(axes: Matrix3<N>, semi_axes: Vector3<N>, enlarged: N) -> Vector3<N> {
    let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
    let Vector3 { x, y, z } = semi_axes;
    let relative = Vector3::new(x / longest, y / longest, z / longest);
    let (largest, one) = (longest / shortest, shortest.splat(1.0));
    let squared = relative.times(relative);
    let along = |row: Vector3<N>| {
        let share = squared.times(row).dot(row).sqrt() * largest;
        share.max(one) * enlarged
    };
    let Matrix3 { x, y, z } = axes.transpose();
    Vector3::new(along(x), along(y), along(z))
}

/// The elements of M·r_min, row by row without the two zeros of the last row, for the columns R′ = `axes`.
#[inline(always)]
fn triangular_stretch<N: Real>(axes: Matrix3<N>, semi_axes: Vector3<N>) -> [N; 7] {
    let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
    let Vector3 { x, y, z } = semi_axes;
    let inverse = Vector3::new(shortest / x, shortest / y, shortest / z);
    let direct = Vector3::new(x / longest, y / longest, z / longest);
    // The elements of A r_min² and C/r_max² that are needed.
    let Matrix3 { x, y, z } = axes.transpose();
    let (inverse_squared, direct_squared) = (inverse.times(inverse), direct.times(direct));
    let a_xx = inverse_squared.times(x).dot(x);
    let a_yy = inverse_squared.times(y).dot(y);
    let a_xy = inverse_squared.times(x).dot(y);
    let c_xz = direct_squared.times(x).dot(z);
    let c_yz = direct_squared.times(y).dot(z);
    let c_zz = direct_squared.times(z).dot(z);

    let depth_reach = c_zz.sqrt();
    // √(A_xx A_yy − A_xy²). The factor 1/(r_min r_max) of √det A is part of the scales of A and C.
    let root = depth_reach * (shortest / semi_axes.median());
    // The longer of the images of the x and y axes comes first. Both cases take the same operations.
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

impl<P: Projection> Projected for ProjectedEllipsoid<P> {
    type Fields<T: Field> = [T; FIELDS];

    const STORED: usize = FIELDS;

    /// The bounds hold nothing.
    const NOWHERE: [f32; FIELDS] = {
        const FAR: f32 = f32::INFINITY;
        [
            0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, FAR, -FAR, FAR, -FAR, FAR, -FAR,
        ]
    };

    fn fields_of<T: Field>(value: T) -> [T; FIELDS] {
        [value; FIELDS]
    }

    #[inline(always)]
    fn complete<N: Single>(_: &mut [N; FIELDS]) {}

    #[inline(always)]
    fn to_fields(&self) -> [f32; FIELDS] {
        self.fields
    }

    #[inline(always)]
    fn from_fields(fields: [f32; FIELDS]) -> Self {
        Self {
            fields,
            projection: PhantomData,
        }
    }

    #[inline(always)]
    fn bounds_of<N: Single>(fields: &[N; FIELDS]) -> ViewBounds<N> {
        let [.., left, right, bottom, top, near, far] = *fields;
        ViewBounds {
            across: [left, right],
            down: [bottom, top],
            depths: [near, far],
        }
    }
}
