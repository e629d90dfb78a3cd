//! Bounds in place: what [`Bound::placed`](crate::Bound::placed) does, in lanes, and from a spheroid to
//! an ellipsoid.

use fearless_simd::{Select, Simd, SimdBase, SimdFloat};

use super::vector::{Vectors, round_up};
use super::view::{Ellipsoids, Spheres};
use crate::math;

/// A [`Spheroid`](crate::Spheroid) in each lane.
#[derive(Clone, Copy)]
pub(super) struct Spheroids<S: Simd> {
    pub focus: Vectors<S>,
    pub axis: Vectors<S>,
    pub radius: S::f32s,
    pub roughness: S::f32s,
}

impl<S: Simd> Spheroids<S> {
    #[inline(always)]
    pub fn placed(self, simd: S, position: Vectors<S>, scale: S::f32s) -> Self {
        let radius = scaled(simd, self.radius, scale);
        let offset = self.focus * scale;
        let focus = position + offset;
        let rounding = rounding_of_sum(offset) + rounding_of_sum(focus);
        let grown = round_up::<S>(radius + rounding / self.roughness, 4);

        let zero = S::f32s::splat(simd, 0.0);
        let Vectors { x, y, z } = self.focus;
        let at_light = (x.simd_eq(zero) & y.simd_eq(zero) & z.simd_eq(zero)) | radius.simd_eq(zero);
        Self {
            focus: Vectors::new(
                at_light.select(position.x, focus.x),
                at_light.select(position.y, focus.y),
                at_light.select(position.z, focus.z),
            ),
            radius: at_light.select(radius, grown),
            ..self
        }
    }

    /// `placed` of spheroids around a light at the origin.
    #[inline(always)]
    pub fn placed_at_light(self, simd: S, position: Vectors<S>, scale: S::f32s) -> Self {
        Self {
            focus: position,
            radius: scaled(simd, self.radius, scale),
            ..self
        }
    }

    /// The ellipsoids; not finite where a spheroid is not.
    #[inline(always)]
    pub fn ellipsoids(self, simd: S) -> Ellipsoids<S> {
        let (alpha, u) = (self.roughness, self.axis);
        let one = S::f32s::splat(simd, 1.0);
        let long = self.radius * ((alpha * alpha + 1.0) / (alpha * 2.0));
        let distance = self.radius * ((one - alpha) * (alpha + 1.0) / (alpha * 2.0));
        let (v, w) = any_orthonormal_pair(simd, u);
        let offset = u * distance;
        let tilt = long * (8.0 * math::UNIT_ROUNDOFF);
        let growth = (rounding_of_sum(offset) + tilt) / self.radius + 1.0;
        let short = round_up::<S>(self.radius * growth, 8);
        Ellipsoids {
            parts: [self.focus, offset],
            axes: [u, v, w],
            semi_axes: Vectors::new(round_up::<S>(long * growth, 8), short, short),
        }
    }
}

impl<S: Simd> Ellipsoids<S> {
    #[inline(always)]
    pub fn placed(self, simd: S, position: Vectors<S>, scale: S::f32s) -> Self {
        let semi_axes = Vectors::<S>::new(
            scaled(simd, self.semi_axes.x, scale),
            scaled(simd, self.semi_axes.y, scale),
            scaled(simd, self.semi_axes.z, scale),
        );
        let [light, offset] = [self.parts[0] * scale, self.parts[1] * scale];
        let sum = light + offset;
        let rounding = rounding_of_sum(light) + rounding_of_sum(offset) + rounding_of_sum(sum);
        let growth = round_up::<S>(rounding / semi_axes.min_element() + 1.0, 4);
        Self {
            parts: [position, sum],
            axes: self.axes,
            semi_axes: semi_axes * growth,
        }
    }
}

impl<S: Simd> Spheres<S> {
    #[inline(always)]
    pub fn placed(self, simd: S, position: Vectors<S>, scale: S::f32s) -> Self {
        let radius = scaled(simd, self.radius, scale);
        let offset = self.center * scale;
        let center = position + offset;
        let rounding = rounding_of_sum(offset) + rounding_of_sum(center);
        Self {
            center,
            radius: round_up::<S>(radius + rounding, 2),
        }
    }
}

/// `scaled` of `bound`: zero only if one of the two is.
#[inline(always)]
fn scaled<S: Simd>(simd: S, length: S::f32s, scale: S::f32s) -> S::f32s {
    let zero = S::f32s::splat(simd, 0.0);
    let product = round_up::<S>(length * scale, 1).max(f32::MIN_POSITIVE);
    (length.simd_gt(zero) & scale.simd_gt(zero)).select(product, zero)
}

/// `rounding_of_sum` of `bound`.
#[inline(always)]
fn rounding_of_sum<S: Simd>(sum: Vectors<S>) -> S::f32s {
    sum.abs().max_element() * (2.0 * math::UNIT_ROUNDOFF)
}

/// [`Vec3::any_orthonormal_pair`](glam::Vec3::any_orthonormal_pair).
#[inline(always)]
pub(super) fn any_orthonormal_pair<S: Simd>(simd: S, u: Vectors<S>) -> (Vectors<S>, Vectors<S>) {
    let one = S::f32s::splat(simd, 1.0);
    let Vectors { x, y, z } = u;
    let sign = one.copysign(z);
    let a = -one / (sign + z);
    let b = x * y * a;
    (
        Vectors::new(sign * x * x * a + 1.0, sign * b, -sign * x),
        Vectors::new(b, sign + y * y * a, -y),
    )
}
