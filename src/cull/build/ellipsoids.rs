//! Ellipsoids, and lights whose ellipsoid is found one by one.

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::source::{Fours, Frame, OfShape, Place, Source, four, scale};
use super::vector::Vectors;
use super::view::Ellipsoids;
use crate::{
    AnisotropicGgxLobe, Bound, Bounded, Ellipsoid, Fresnel, MaskingShadowing, Stretch, Vpl, Xi,
};

/// Both parts of the centre, the columns of R and the semi-axes, in the order in which an ellipsoid holds
/// them, which is how they are copied fastest; then Φ, and the position.
#[inline]
fn numbers(ellipsoid: &Ellipsoid, flux: f32, position: Vec3) -> [[f32; 4]; 6] {
    let ([q, o], r) = (ellipsoid.center_parts(), ellipsoid.rotation());
    let ([u, v, w], s) = ([r.x_axis, r.y_axis, r.z_axis], ellipsoid.semi_axes());
    [
        four(q, o.x),
        [o.y, o.z, u.x, u.y],
        [u.z, v.x, v.y, v.z],
        four(w, s.x),
        [s.y, s.z, flux, 0.0],
        four(position, 0.0),
    ]
}

/// The ellipsoids, Φ and the positions.
#[inline(always)]
fn ellipsoids<S: Simd>(numbers: &[[S::f32s; 4]; 6]) -> (Ellipsoids<S>, S::f32s, Vectors<S>) {
    let [[q_x, q_y, q_z, o_x], [o_y, o_z, u_x, u_y], numbers @ ..] = *numbers;
    let [[u_z, v_x, v_y, v_z], [w_x, w_y, w_z, s_x], numbers @ ..] = numbers;
    let [[s_y, s_z, flux, _], [p_x, p_y, p_z, _]] = numbers;
    let unit = Ellipsoids {
        parts: [Vectors::new(q_x, q_y, q_z), Vectors::new(o_x, o_y, o_z)],
        axes: [
            Vectors::new(u_x, u_y, u_z),
            Vectors::new(v_x, v_y, v_z),
            Vectors::new(w_x, w_y, w_z),
        ],
        semi_axes: Vectors::new(s_x, s_y, s_z),
    };
    (unit, flux, Vectors::new(p_x, p_y, p_z))
}

/// The stretches of ellipsoids around the origin, in place.
#[inline(always)]
fn placed_ellipsoids<S: Simd>(
    simd: S,
    unit: Ellipsoids<S>,
    position: Vectors<S>,
    scale: S::f32s,
    frame: &Frame,
) -> (OfShape<S, Stretch>, S::mask32s) {
    let zero = S::f32s::splat(simd, 0.0);
    let somewhere = unit.semi_axes.min_element().simd_gt(zero) & scale.simd_gt(zero);
    let placed = unit.placed(simd, position, scale);
    (placed.stretched(simd, &frame.view), somewhere)
}

impl Source for Ellipsoid {
    type Light = Self;
    type Given = Place;
    type Shape = Stretch;
    /// With no flux.
    type Fours = Fours<6>;
    type Rest = ();

    #[inline]
    fn numbers(ellipsoid: &Self, (position, _): Place) -> [[f32; 4]; 6] {
        numbers(ellipsoid, 0.0, position)
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
        numbers: &[[S::f32s; 4]; 6],
        scale: S::f32s,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let (unit, _, position) = ellipsoids(numbers);
        placed_ellipsoids(simd, unit, position, scale, frame)
    }
}

impl<F: Fresnel, G: MaskingShadowing> Source for AnisotropicGgxLobe<F, G> {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = Stretch;
    type Fours = Fours<6>;
    type Rest = ();

    #[inline]
    fn numbers(light: &Self::Light, _: Xi) -> [[f32; 4]; 6] {
        let unit = light.lobe().unit_bound();
        numbers(&unit, light.flux(), light.position())
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
        numbers: &[[S::f32s; 4]; 6],
        xi: S::f32s,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let (unit, flux, position) = ellipsoids(numbers);
        let scale = scale(simd, &frame.roulette, flux, xi);
        placed_ellipsoids(simd, unit, position, scale, frame)
    }
}
