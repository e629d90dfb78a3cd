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
//! `ARCHITECTURE.md` counts the roundings, and those of a sphere, which is not stretched and has fewer.

use glam::{Mat3, Vec3};

use crate::{Bound, Camera, Ellipsoid, Sphere, math};

/// S, the symmetric matrix that stretches camera space so that `ellipsoid` becomes a unit sphere
/// [Tokuyoshi & Harada 2017, Eq. 16].
///
/// For a look at the method and for single uses; [`Stretch`] does not need it. Not finite for an
/// empty ellipsoid.
///
/// ```
/// use stochastic_light_culling::{
///     Camera, Ellipsoid, Stretch, glam::{Mat3, Vec3}, stretch_matrix, stretch_rotation,
/// };
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::X, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let ellipsoid = Ellipsoid::new(Vec3::X, Mat3::IDENTITY, Vec3::new(1.0, 2.0, 4.0))?;
/// let s = stretch_matrix(&ellipsoid, &camera);
/// let both = stretch_rotation(s) * s;
/// let stretch = Stretch::new(&ellipsoid, &camera).expect("not empty");
/// assert!((both * Vec3::ONE - stretch.matrix() * Vec3::ONE).length() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
pub fn stretch_matrix(ellipsoid: &Ellipsoid, camera: &Camera) -> Mat3 {
    let axes = camera.rotation() * ellipsoid.rotation();
    axes * Mat3::from_diagonal(ellipsoid.semi_axes().recip()) * axes.transpose()
}

/// B, the rotation that takes the images under `stretch` = S of planes of constant depth to planes of
/// constant z [Tokuyoshi & Harada 2017, Eq. 17].
///
/// Not finite if S is singular or not finite itself.
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
/// use stochastic_light_culling::{Camera, Ellipsoid, Stretch, glam::{Mat3, Vec3}};
///
/// let camera = Camera::look_at(Vec3::ZERO, -Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let ellipsoid = Ellipsoid::new(Vec3::new(0.0, 0.0, -8.0), Mat3::IDENTITY, Vec3::new(1.0, 2.0, 4.0))?;
/// let stretch = Stretch::new(&ellipsoid, &camera).expect("not empty");
/// assert!((stretch.center() - Vec3::new(0.0, 0.0, 2.0)).length() < 1e-4);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    matrix: Mat3,
    center: Vec3,
}

impl Stretch {
    /// Of the centre and of the box of a tile.
    pub(crate) const ROUNDINGS: [f32; 2] = [6.0, 9.0];
    /// Of its reciprocal M is made, which is not to overflow times a slope and a depth.
    pub(crate) const LEAST_SEMI_AXIS: f32 = 1e-30;

    /// The stretch of `ellipsoid` before `camera`; `None` if it is empty.
    ///
    /// Of an ellipsoid too large to be finite, the stretch takes all of space into the unit sphere.
    pub fn new(ellipsoid: &Ellipsoid, camera: &Camera) -> Option<Self> {
        if ellipsoid.is_empty() {
            return None;
        }
        let semi_axes = ellipsoid.semi_axes();
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        let parts = ellipsoid.center_parts();
        let center = camera.sum_to_camera_space(parts);
        if !(longest.is_finite() && center.is_finite()) {
            return Some(Self {
                matrix: Mat3::ZERO,
                center: Vec3::ZERO,
            });
        }
        let unscaled = triangular_stretch(camera.rotation() * ellipsoid.rotation(), semi_axes);
        let rounding = rounding_before(camera, center, longest, Self::ROUNDINGS)
            + camera.rounding_of_terms(parts);
        let tilt = longest * (128.0 * math::UNIT_ROUNDOFF + 6.0 * camera.rotation_deviation());
        let enlarged = math::round_up(shortest + (rounding + tilt), 4).max(Self::LEAST_SEMI_AXIS);
        let matrix = unscaled * (1.0 / enlarged);
        Some(Self {
            matrix,
            center: matrix * center,
        })
    }

    /// The stretch with these M and Mc′.
    #[cfg(feature = "cull")]
    pub(crate) fn from_parts(matrix: Mat3, center: Vec3) -> Self {
        Self { matrix, center }
    }

    /// M: the columns are the images of the axes of camera space. Its third row is (0, 0, m), and one
    /// of its other two elements off the diagonal of the first two columns is zero.
    pub fn matrix(&self) -> Mat3 {
        self.matrix
    }

    /// Mc′, the centre of the unit sphere.
    pub fn center(&self) -> Vec3 {
        self.center
    }
}

/// M·r_min, for axes that are the columns of `axes`.
fn triangular_stretch(axes: Mat3, semi_axes: Vec3) -> Mat3 {
    let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
    let inverse = Vec3::splat(shortest) / semi_axes;
    let direct = semi_axes / longest;
    // A r_min² and C/r_max², of which only these elements are needed.
    let [x, y, z] = [0, 1, 2].map(|i| axes.row(i));
    let (inverse_squared, direct_squared) = (inverse * inverse, direct * direct);
    let a_xx = (inverse_squared * x).dot(x);
    let a_yy = (inverse_squared * y).dot(y);
    let a_xy = (inverse_squared * x).dot(y);
    let c_xz = (direct_squared * x).dot(z);
    let c_yz = (direct_squared * y).dot(z);
    let c_zz = (direct_squared * z).dot(z);

    let depth_reach = math::sqrt(c_zz);
    // √(A_xx A_yy − A_xy²): of √det A, the factor 1/(r_min r_max) is in the units chosen.
    let root = depth_reach * (shortest / median(semi_axes));
    // The longer image first, in the same operations whichever it is.
    let x_first = a_xx > a_yy;
    let first = math::sqrt(if x_first { a_xx } else { a_yy });
    let (mixed, second) = (a_xy / first, root / first);
    let [xx, xy, yx, yy] = if x_first {
        [first, mixed, 0.0, second]
    } else {
        [second, 0.0, mixed, first]
    };
    let shear = Vec3::new(xx * c_xz + xy * c_yz, yx * c_xz + yy * c_yz, 0.0) / c_zz;
    let m = shortest / (longest * depth_reach);
    Mat3::from_cols(
        Vec3::new(xx, yx, 0.0),
        Vec3::new(xy, yy, 0.0),
        Vec3::new(-shear.x, -shear.y, m),
    )
}

fn median(v: Vec3) -> f32 {
    v.x.max(v.y).min(v.x.min(v.y).max(v.z))
}

/// The length by which rounding can move a point within `reach` of `center`, in camera space, against
/// the box of a tile that holds it, if that takes so many roundings of the centre and of the box.
fn rounding_before(
    camera: &Camera,
    center: Vec3,
    reach: f32,
    [of_center, of_box]: [f32; 2],
) -> f32 {
    let farthest_depth = center.z.max(0.0) + reach;
    // In place of its length, which is no larger and a root more.
    let of_center = of_center * center.abs().element_sum();
    let of_box = of_box * camera.corner_secant() * farthest_depth;
    math::UNIT_ROUNDOFF * (of_center + of_box)
}

/// A sphere as a tile test wants it: in camera space, with nothing stretched.
///
/// ```
/// use stochastic_light_culling::{Camera, CameraSphere, Sphere, glam::Vec3};
///
/// let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.0, 0.1..100.0)?;
/// let sphere = Sphere::new(Vec3::new(0.0, 0.0, -8.0), 3.0)?;
/// let seen = CameraSphere::new(&sphere, &camera).expect("not empty");
/// assert_eq!(seen.center(), Vec3::new(0.0, 0.0, 8.0));
/// assert!(9.0 < seen.radius_squared() && seen.radius_squared() < 9.001);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSphere {
    center: Vec3,
    radius_squared: f32,
}

impl CameraSphere {
    /// Of the centre and of the box of a tile.
    pub(crate) const ROUNDINGS: [f32; 2] = [9.0, 2.0];
    /// Its square, and those of distances as long, are far above the subnormal numbers.
    pub(crate) const LEAST_RADIUS: f32 = 1e-18;

    /// `sphere` before `camera`; `None` if it is empty.
    #[inline]
    pub fn new(sphere: &Sphere, camera: &Camera) -> Option<Self> {
        let radius = sphere.radius();
        if radius == 0.0 {
            return None;
        }
        let center = camera.seen_from_anchor(sphere.center());
        let rounding = rounding_before(camera, center, radius, Self::ROUNDINGS);
        let rounding = rounding + camera.rounding_of_anchor();
        let scaling = 3.0 * camera.rotation_deviation() * radius;
        let enlarged = math::round_up(radius + rounding + scaling, 10);
        // Where the centre is not finite, nor is the radius by now.
        if !(enlarged * enlarged).is_finite() {
            return Some(Self {
                center: Vec3::ZERO,
                radius_squared: f32::INFINITY,
            });
        }
        let enlarged = enlarged.max(Self::LEAST_RADIUS);
        Some(Self {
            center,
            radius_squared: enlarged * enlarged,
        })
    }

    /// The sphere with this centre and squared radius.
    #[cfg(feature = "cull")]
    pub(crate) fn from_parts(center: Vec3, radius_squared: f32) -> Self {
        Self {
            center,
            radius_squared,
        }
    }

    /// The centre in camera space.
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// The square of the radius, enlarged by what rounding can take.
    pub fn radius_squared(&self) -> f32 {
        self.radius_squared
    }
}
