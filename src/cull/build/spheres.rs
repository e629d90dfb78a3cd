//! Diffuse lights, point lights, and spheres.

use fearless_simd::{Simd, SimdBase};

use super::source::{Fours, Frame, OfShape, Place, Source, four, scale};
use super::vector::{Vectors, round_up};
use super::view::Spheres;
use crate::{Bound, Bounded, CameraSphere, ConstantLobe, LambertLobe, Sphere, Vpl, Xi};

impl Source for LambertLobe {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = CameraSphere;
    /// The position and Φ, √ρ and n.
    type Fours = Fours<2>;
    type Rest = ();

    #[inline]
    fn numbers(light: &Self::Light, _: Xi) -> [[f32; 4]; 2] {
        let (lobe, n) = (light.lobe(), light.lobe().normal());
        [
            four(light.position(), light.flux()),
            [lobe.albedo_root(), n.x, n.y, n.z],
        ]
    }

    #[inline]
    fn rest(_: &Self::Light) {}

    #[inline]
    fn may_reach(light: &Self::Light, _: Xi) -> bool {
        // That a surface reflects nothing is too rare to ask each time.
        light.flux() > 0.0
    }

    #[inline(always)]
    fn shapes<S: Simd>(
        simd: S,
        numbers: &[[S::f32s; 4]; 2],
        xi: S::f32s,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, CameraSphere>, S::mask32s) {
        let [[p_x, p_y, p_z, flux], [root, n_x, n_y, n_z]] = *numbers;
        let reach = root * Self::ROOT_OF_ONE_OVER_PI;
        let unit = Spheres {
            center: Vectors::<S>::new(n_x, n_y, n_z) * (reach * Self::CENTER),
            radius: round_up::<S>(reach * Self::RADIUS, 16),
        };
        let scale = scale(simd, &frame.roulette, flux, xi);
        placed_spheres(simd, unit, Vectors::new(p_x, p_y, p_z), scale, frame)
    }
}

impl Source for ConstantLobe {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = CameraSphere;
    /// The position and Φ.
    type Fours = Fours<1>;
    type Rest = ();

    #[inline]
    fn numbers(light: &Self::Light, _: Xi) -> [[f32; 4]; 1] {
        [four(light.position(), light.flux())]
    }

    #[inline]
    fn rest(_: &Self::Light) {}

    #[inline]
    fn may_reach(light: &Self::Light, _: Xi) -> bool {
        light.flux() > 0.0
    }

    #[inline(always)]
    fn shapes<S: Simd>(
        simd: S,
        numbers: &[[S::f32s; 4]; 1],
        xi: S::f32s,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, CameraSphere>, S::mask32s) {
        let [[p_x, p_y, p_z, flux]] = *numbers;
        let bound = Self.unit_bound();
        let zero = S::f32s::splat(simd, 0.0);
        let unit = Spheres {
            center: Vectors::new(zero, zero, zero),
            radius: S::f32s::splat(simd, bound.radius()),
        };
        let scale = scale(simd, &frame.roulette, flux, xi);
        placed_spheres(simd, unit, Vectors::new(p_x, p_y, p_z), scale, frame)
    }
}

impl Source for Sphere {
    type Light = Self;
    type Given = Place;
    type Shape = CameraSphere;
    /// The centre and the radius, and the position.
    type Fours = Fours<2>;
    type Rest = ();

    #[inline]
    fn numbers(sphere: &Self, (p, _): Place) -> [[f32; 4]; 2] {
        [four(sphere.center(), sphere.radius()), four(p, 0.0)]
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
        numbers: &[[S::f32s; 4]; 2],
        scale: S::f32s,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, CameraSphere>, S::mask32s) {
        let [[x, y, z, radius], [p_x, p_y, p_z, _]] = *numbers;
        let center = Vectors::new(x, y, z);
        let unit = Spheres { center, radius };
        placed_spheres(simd, unit, Vectors::new(p_x, p_y, p_z), scale, frame)
    }
}

/// What is left of spheres around the origin: they in place and before the camera.
#[inline(always)]
fn placed_spheres<S: Simd>(
    simd: S,
    unit: Spheres<S>,
    position: Vectors<S>,
    scale: S::f32s,
    frame: &Frame,
) -> (OfShape<S, CameraSphere>, S::mask32s) {
    let zero = S::f32s::splat(simd, 0.0);
    let somewhere = unit.radius.simd_gt(zero) & scale.simd_gt(zero);
    let placed = unit.placed(simd, position, scale);
    (placed.before(simd, &frame.view), somewhere)
}
