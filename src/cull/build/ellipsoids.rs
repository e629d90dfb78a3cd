//! Ellipsoids, and lights whose ellipsoid is found one by one.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::source::{Frame, OfShape, Place, Source, scale};
use super::vector::Vectors;
use super::view::Ellipsoids;
use crate::cull::shape::Lane;
use crate::{
    AnisotropicGgxLobe, Bound, Bounded, Ellipsoid, Fresnel, MaskingShadowing, Stretch, Vpl, Xi,
};

/// The numbers of an ellipsoid: both parts of the centre, the columns of R and the semi-axes.
type OfEllipsoid<T> = [T; 18];

#[inline]
fn of_ellipsoid(ellipsoid: &Ellipsoid) -> OfEllipsoid<f32> {
    let ([q, o], r) = (ellipsoid.center_parts(), ellipsoid.rotation());
    let ([u, v, w], s) = ([r.x_axis, r.y_axis, r.z_axis], ellipsoid.semi_axes());
    [
        q.x, q.y, q.z, o.x, o.y, o.z, u.x, u.y, u.z, v.x, v.y, v.z, w.x, w.y, w.z, s.x, s.y, s.z,
    ]
}

/// The stretches of ellipsoids around the origin, in place.
#[inline(always)]
fn placed_ellipsoids<S: Simd>(
    simd: S,
    numbers: OfEllipsoid<S::f32s>,
    position: Vectors<S>,
    scale: S::f32s,
    frame: &Frame,
) -> (OfShape<S, Stretch>, S::mask32s) {
    let [
        q_x,
        q_y,
        q_z,
        o_x,
        o_y,
        o_z,
        u_x,
        u_y,
        u_z,
        v_x,
        v_y,
        v_z,
        w_x,
        w_y,
        w_z,
        s_x,
        s_y,
        s_z,
    ] = numbers;
    let semi_axes = Vectors::<S>::new(s_x, s_y, s_z);
    let unit = Ellipsoids {
        parts: [Vectors::new(q_x, q_y, q_z), Vectors::new(o_x, o_y, o_z)],
        axes: [
            Vectors::new(u_x, u_y, u_z),
            Vectors::new(v_x, v_y, v_z),
            Vectors::new(w_x, w_y, w_z),
        ],
        semi_axes,
    };
    let zero = S::f32s::splat(simd, 0.0);
    let somewhere = semi_axes.min_element().simd_gt(zero) & scale.simd_gt(zero);
    let placed = unit.placed(simd, position, scale);
    (placed.stretched(simd, &frame.view), somewhere)
}

impl Source for Ellipsoid {
    type Light = Self;
    type Given = Place;
    type Shape = Stretch;
    /// Those of the ellipsoid, the position and the scale.
    type Numbers<T: Lane> = [T; 22];
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> [T; 22] {
        [value; 22]
    }

    #[inline]
    fn numbers(ellipsoid: &Self, (p, scale): Place) -> [f32; 22] {
        let mut numbers = [0.0; 22];
        let (unit, of_place) = numbers.split_at_mut(18);
        unit.copy_from_slice(&of_ellipsoid(ellipsoid));
        of_place.copy_from_slice(&[p.x, p.y, p.z, scale]);
        numbers
    }

    #[inline]
    fn rest(_: &Self::Light) {}

    #[inline]
    fn may_reach(light: &Self, (_, scale): Place) -> bool {
        !light.is_empty() && scale > 0.0
    }

    #[inline(always)]
    fn shapes<S: Simd>(
        simd: S,
        numbers: &[S::f32s; 22],
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let [of_ellipsoid @ .., p_x, p_y, p_z, scale] = *numbers;
        placed_ellipsoids(
            simd,
            of_ellipsoid,
            Vectors::new(p_x, p_y, p_z),
            scale,
            frame,
        )
    }
}

/// The numbers of an ellipsoid around the origin, the position that it is put at, Φ and ξ.
type OfLight<T> = [T; 23];

#[inline]
fn of_light(unit: &Ellipsoid, p: Vec3, flux: f32, xi: Xi) -> OfLight<f32> {
    let mut numbers = [0.0; 23];
    let (of_unit, of_place) = numbers.split_at_mut(18);
    of_unit.copy_from_slice(&of_ellipsoid(unit));
    of_place.copy_from_slice(&[p.x, p.y, p.z, flux, xi.get()]);
    numbers
}

/// The stretches of the ellipsoids of lights.
#[inline(always)]
fn lit_ellipsoids<S: Simd>(
    simd: S,
    numbers: &OfLight<S::f32s>,
    frame: &Frame,
) -> (OfShape<S, Stretch>, S::mask32s) {
    let [unit @ .., p_x, p_y, p_z, flux, xi] = *numbers;
    let scale = scale(simd, &frame.roulette, flux, xi);
    placed_ellipsoids(simd, unit, Vectors::new(p_x, p_y, p_z), scale, frame)
}

impl<F: Fresnel, G: MaskingShadowing> Source for AnisotropicGgxLobe<F, G> {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = Stretch;
    type Numbers<T: Lane> = OfLight<T>;
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> OfLight<T> {
        [value; 23]
    }

    #[inline]
    fn numbers(light: &Self::Light, xi: Xi) -> OfLight<f32> {
        let unit = light.lobe().unit_bound();
        of_light(&unit, light.position(), light.flux(), xi)
    }

    #[inline]
    fn rest(_: &Self::Light) {}

    #[inline]
    fn may_reach(light: &Self::Light, _: Xi) -> bool {
        light.flux() > 0.0 && light.lobe().incident_cosine() > 0.0
    }

    #[inline(always)]
    fn shapes<S: Simd>(
        simd: S,
        numbers: &OfLight<S::f32s>,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        lit_ellipsoids(simd, numbers, frame)
    }
}
