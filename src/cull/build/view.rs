//! Shapes before a camera: what [`Stretch::new`](crate::Stretch::new) and
//! [`CameraSphere::new`](crate::CameraSphere::new) do, in lanes.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat};
use glam::{Mat3, Vec3};

use super::vector::{Vectors, dot_with, product, round_up};
use crate::cull::lanes::{Ends, splat};
use crate::cull::shape::{UNIT_REACH, outward_of};
use crate::{Camera, CameraSphere, Stretch, math};

/// A camera, with what is the same for all lights.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    rotation: Mat3,
    rows: [[f64; 3]; 3],
    translation: [f64; 3],
    translation_abs: Vec3,
    anchor: [Vec3; 2],
    rounding_of_anchor: f32,
    /// Roundings of the centre and of the box, the latter times the secant.
    of_ellipsoid: [f32; 2],
    of_sphere: [f32; 2],
    /// Shares of lengths.
    of_tilt: f32,
    of_scaling: f32,
}

impl View {
    pub fn new(camera: &Camera) -> Self {
        let rotation = camera.rotation();
        let rows = [0, 1, 2].map(|i| rotation.row(i));
        let deviation = camera.rotation_deviation();
        let before = |[center, of_box]: [f32; 2]| [center, of_box * camera.corner_secant()];
        Self {
            rotation,
            rows: rows.map(|row| row.to_array().map(f64::from)),
            translation: camera.translation().to_array().map(f64::from),
            translation_abs: camera.translation().abs(),
            anchor: camera.anchor(),
            rounding_of_anchor: camera.rounding_of_anchor(),
            of_ellipsoid: before(Stretch::ROUNDINGS),
            of_sphere: before(CameraSphere::ROUNDINGS),
            of_tilt: 128.0 * math::UNIT_ROUNDOFF + 6.0 * deviation,
            of_scaling: 3.0 * deviation,
        }
    }

    /// [`Camera::sum_to_camera_space`].
    #[inline(always)]
    fn sum_seen<S: Simd>(&self, parts: [Vectors<S>; 2]) -> Vectors<S> {
        let [first, second] = [parts[0].widened(), parts[1].widened()];
        let mut center = parts[0].to_array();
        for (i, coordinate) in center.iter_mut().enumerate() {
            let turned = dot_with(self.rows[i], first) + dot_with(self.rows[i], second);
            *coordinate = (turned + self.translation[i]).narrowed();
        }
        Vectors::from_array(center)
    }

    /// [`Camera::seen_from_anchor`].
    #[inline(always)]
    fn seen_from_anchor<S: Simd>(&self, point: Vectors<S>) -> Vectors<S> {
        let [anchor, anchor_seen] = self.anchor;
        product(self.rotation, point - anchor) + anchor_seen
    }

    /// [`Camera::rounding_of_terms`]; `terms` is the sum of the parts' absolute values.
    #[inline(always)]
    fn rounding_of_terms<S: Simd>(&self, terms: Vectors<S>) -> S::f32s {
        (terms + self.translation_abs).element_sum() * Camera::ROUNDINGS_OF_TERMS
    }
}

/// `rounding_before` of `stretch`; `of_box` includes the secant.
#[inline(always)]
fn rounding_before<S: Simd>(
    center: Vectors<S>,
    reach: S::f32s,
    [of_center, of_box]: [f32; 2],
) -> S::f32s {
    let farthest_depth = center.z.max(0.0) + reach;
    let of_center = center.abs().element_sum() * of_center;
    (of_center + farthest_depth * of_box) * math::UNIT_ROUNDOFF
}

/// The fields of the shape in each lane, and the depths that it reaches.
#[derive(Clone, Copy)]
pub struct Seen<S: Simd, F> {
    pub(super) fields: F,
    pub(super) reach: Ends<S>,
}

/// An [`Ellipsoid`](crate::Ellipsoid) in each lane.
#[derive(Clone, Copy)]
pub(super) struct Ellipsoids<S: Simd> {
    /// Whose exact sum is the centre.
    pub parts: [Vectors<S>; 2],
    /// The columns of R.
    pub axes: [Vectors<S>; 3],
    pub semi_axes: Vectors<S>,
}

impl<S: Simd> Ellipsoids<S> {
    /// The stretches, none of which is of an empty ellipsoid.
    #[inline(always)]
    pub fn stretched(self, simd: S, view: &View) -> Seen<S, [S::f32s; 10]> {
        let Self {
            parts,
            axes,
            semi_axes,
        } = self;
        let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
        let center = view.sum_seen(parts);
        let finite = semi_axes.is_finite() & center.is_finite();

        let axes = [
            product(view.rotation, axes[0]),
            product(view.rotation, axes[1]),
            product(view.rotation, axes[2]),
        ];
        let [xx, xy, xz, yx, yy, yz, m] = triangular_stretch(simd, axes, semi_axes);
        let terms = parts[0].abs() + parts[1].abs();
        let rounding = rounding_before::<S>(center, longest, view.of_ellipsoid)
            + view.rounding_of_terms(terms);
        let tilt = longest * view.of_tilt;
        let enlarged = round_up::<S>(shortest + (rounding + tilt), 4).max(Stretch::LEAST_SEMI_AXIS);
        let factor = S::f32s::splat(simd, 1.0) / enlarged;

        let [xx, xy, xz] = [xx * factor, xy * factor, xz * factor];
        let [yx, yy, yz] = [yx * factor, yy * factor, yz * factor];
        let (m, zero) = (m * factor, factor * 0.0);
        let mut fields = [
            xx,
            xy,
            xz,
            yx,
            yy,
            yz,
            m,
            xx * center.x + xy * center.y + xz * center.z,
            yx * center.x + yy * center.y + yz * center.z,
            zero * center.x + zero * center.y + m * center.z,
        ];
        for field in &mut fields {
            *field = finite.select(*field, S::f32s::splat(simd, 0.0));
        }
        let [.., m, _, _, depth] = fields;
        let reach = [(depth - UNIT_REACH) / m, (depth + UNIT_REACH) / m];
        Seen {
            fields,
            reach: outward_of(simd, reach),
        }
    }
}

/// The elements of M·r_min that are not zero, row by row.
#[inline(always)]
fn triangular_stretch<S: Simd>(
    simd: S,
    axes: [Vectors<S>; 3],
    semi_axes: Vectors<S>,
) -> [S::f32s; 7] {
    let (shortest, longest) = (semi_axes.min_element(), semi_axes.max_element());
    let inverse = Vectors::<S>::new(
        shortest / semi_axes.x,
        shortest / semi_axes.y,
        shortest / semi_axes.z,
    );
    let direct = Vectors::<S>::new(
        semi_axes.x / longest,
        semi_axes.y / longest,
        semi_axes.z / longest,
    );
    let [u, v, w] = axes;
    let x = Vectors::<S>::new(u.x, v.x, w.x);
    let y = Vectors::<S>::new(u.y, v.y, w.y);
    let z = Vectors::<S>::new(u.z, v.z, w.z);
    let (inverse_squared, direct_squared) = (inverse.times(inverse), direct.times(direct));
    let a_xx = inverse_squared.times(x).dot(x);
    let a_yy = inverse_squared.times(y).dot(y);
    let a_xy = inverse_squared.times(x).dot(y);
    let c_xz = direct_squared.times(x).dot(z);
    let c_yz = direct_squared.times(y).dot(z);
    let c_zz = direct_squared.times(z).dot(z);

    let depth_reach = c_zz.sqrt();
    let root = depth_reach * (shortest / semi_axes.median());
    let zero = S::f32s::splat(simd, 0.0);
    let x_first = a_xx.simd_gt(a_yy);
    let first = x_first.select(a_xx, a_yy).sqrt();
    let (mixed, second) = (a_xy / first, root / first);
    let (xx, xy) = (x_first.select(first, second), x_first.select(mixed, zero));
    let (yx, yy) = (x_first.select(zero, mixed), x_first.select(second, first));
    let shear_x = (xx * c_xz + xy * c_yz) / c_zz;
    let shear_y = (yx * c_xz + yy * c_yz) / c_zz;
    let m = shortest / (longest * depth_reach);
    [xx, xy, -shear_x, yx, yy, -shear_y, m]
}

/// A [`Sphere`](crate::Sphere) in each lane.
#[derive(Clone, Copy)]
pub(super) struct Spheres<S: Simd> {
    pub center: Vectors<S>,
    pub radius: S::f32s,
}

impl<S: Simd> Spheres<S> {
    /// The spheres before the camera, none of which is of an empty sphere.
    #[inline(always)]
    pub fn before(self, simd: S, view: &View) -> Seen<S, [S::f32s; 4]> {
        let center = view.seen_from_anchor(self.center);
        let rounding = rounding_before::<S>(center, self.radius, view.of_sphere);
        let rounding = rounding + view.rounding_of_anchor;
        let scaling = self.radius * view.of_scaling;
        let enlarged = round_up::<S>(self.radius + rounding + scaling, 10);
        let finite = (enlarged * enlarged).is_finite();
        let enlarged = enlarged.max(CameraSphere::LEAST_RADIUS);
        let squared = enlarged * enlarged;
        let [zero, infinite] = splat(simd, [0.0, f32::INFINITY]);
        let radius = round_up::<S>(finite.select(enlarged, infinite), 4);
        let depth = finite.select(center.z, zero);
        Seen {
            fields: [
                finite.select(center.x, zero),
                finite.select(center.y, zero),
                depth,
                finite.select(squared, infinite),
            ],
            reach: outward_of(simd, [depth - radius, depth + radius]),
        }
    }
}
