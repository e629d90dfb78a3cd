//! GGX lights, isotropic, with the paper's spheroid; and spheroids.

use core::f32::consts::FRAC_1_PI;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat};

use super::place::Spheroids;
use super::source::{Fours, Frame, OfShape, Place, Source, four, scale};
use super::vector::{Vectors, cross, dot, length, round_up};
use crate::bound::AXIS_TILT_RADIANS;
use crate::cull::lanes::LANES;
use crate::cull::wide_lanes::Wide;
use crate::{Bound, Fresnel, GgxLobe, MaskingShadowing, Spheroid, Stretch, Vpl, Xi};

impl<F: Fresnel, G: MaskingShadowing> Source for GgxLobe<F, G> {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = Stretch;
    /// The position and Φ, n and μ, ω_i and √(kμ² + α²), and α.
    type Fours = Fours<4>;
    type Rest = F;

    #[inline]
    fn numbers(light: &Self::Light, _: Xi) -> [[f32; 4]; 4] {
        let lobe = light.lobe();
        [
            four(light.position(), light.flux()),
            four(*lobe.normal(), lobe.incident_cosine()),
            four(*lobe.incoming(), lobe.incident_root()),
            [lobe.ggx().roughness(), 0.0, 0.0, 0.0],
        ]
    }

    #[inline]
    fn rest(light: &Self::Light) -> F {
        *light.lobe().fresnel()
    }

    #[inline]
    fn may_reach(light: &Self::Light, _: Xi) -> bool {
        light.flux() > 0.0 && light.lobe().incident_cosine() > 0.0
    }

    #[inline(always)]
    fn shapes<S: Simd>(
        simd: S,
        numbers: &[[S::f32s; 4]; 4],
        xi: S::f32s,
        fresnels: &[F],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let [[p_x, p_y, p_z, flux], numbers @ ..] = *numbers;
        let [[n_x, n_y, n_z, cosine], [w_x, w_y, w_z, root], [alpha, ..]] = numbers;
        let n = Vectors::<S>::new(n_x, n_y, n_z).widened();
        let w = Vectors::<S>::new(w_x, w_y, w_z).widened();

        let sine = length(cross(n, w)).narrowed();
        let smallest_cosine = cosine / ((sine + 1.0) * 2.0).sqrt();
        let most = max_fresnel::<S, F>(simd, fresnels, smallest_cosine);
        let lit = cosine.simd_gt(S::f32s::splat(simd, 0.0));
        let reflected = lit.select(most, S::f32s::splat(simd, 0.0));
        let masking = S::f32s::splat(simd, 0.5) / (cosine + root);
        let radius = (reflected * masking * FRAC_1_PI).sqrt();
        let unit = Spheroids {
            focus: Vectors::new(p_x, p_y, p_z),
            axis: mirror_direction(n, w),
            radius: enlarged_for_tilt(simd, radius, alpha),
            roughness: alpha,
        };
        let scale = scale(simd, &frame.roulette, flux, xi);
        let placed = unit.placed_at_light(simd, unit.focus, scale);
        stretched_spheroids(simd, placed, frame)
    }
}

/// [`Fresnel::maximum`], one lane after the other.
#[inline(always)]
pub(super) fn max_fresnel<S: Simd, F: Fresnel>(
    simd: S,
    fresnels: &[F],
    cosines: S::f32s,
) -> S::f32s {
    let mut most = [0.0; LANES];
    let mut lanes = [0.0; LANES];
    cosines.store_slice(&mut lanes[..S::f32s::LEN]);
    for ((most, fresnel), cosine) in most.iter_mut().zip(fresnels).zip(lanes) {
        *most = fresnel.maximum(cosine);
    }
    S::f32s::from_slice(simd, &most[..S::f32s::LEN])
}

/// [`GgxLobe::mirror_direction`].
#[inline(always)]
pub(super) fn mirror_direction<S: Simd>(n: [Wide<S>; 3], w: [Wide<S>; 3]) -> Vectors<S> {
    let twice = dot(n, w) * 2.0 / dot(n, n);
    Vectors::new(
        (twice * n[0] - w[0]).narrowed(),
        (twice * n[1] - w[1]).narrowed(),
        (twice * n[2] - w[2]).narrowed(),
    )
}

/// The radius that `Spheroid::around_tilted_axis` gives a lobe's unit bound.
#[inline(always)]
fn enlarged_for_tilt<S: Simd>(simd: S, radius: S::f32s, alpha: S::f32s) -> S::f32s {
    let one = S::f32s::splat(simd, 1.0);
    let x = (one - alpha) * AXIS_TILT_RADIANS * (alpha + 1.0) / (alpha * 2.0);
    round_up::<S>(radius * (x * (x + 1.0) + 1.0), 16)
}

impl Source for Spheroid {
    type Light = Self;
    type Given = Place;
    type Shape = Stretch;
    /// The focus and r, the axis and α, and the position.
    type Fours = Fours<3>;
    type Rest = ();

    #[inline]
    fn numbers(spheroid: &Self, (p, _): Place) -> [[f32; 4]; 3] {
        [
            four(spheroid.focus(), spheroid.radius()),
            four(*spheroid.axis(), spheroid.roughness()),
            four(p, 0.0),
        ]
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
        numbers: &[[S::f32s; 4]; 3],
        scale: S::f32s,
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let [[f_x, f_y, f_z, radius], numbers @ ..] = *numbers;
        let [[u_x, u_y, u_z, roughness], [p_x, p_y, p_z, _]] = numbers;
        let unit = Spheroids::<S> {
            focus: Vectors::new(f_x, f_y, f_z),
            axis: Vectors::new(u_x, u_y, u_z),
            radius,
            roughness,
        };
        let placed = unit.placed(simd, Vectors::new(p_x, p_y, p_z), scale);
        stretched_spheroids(simd, placed, frame)
    }
}

/// What is left of spheroids in place: their stretches.
#[inline(always)]
fn stretched_spheroids<S: Simd>(
    simd: S,
    spheroids: Spheroids<S>,
    frame: &Frame,
) -> (OfShape<S, Stretch>, S::mask32s) {
    let somewhere = spheroids.radius.simd_gt(S::f32s::splat(simd, 0.0));
    let seen = spheroids.ellipsoids(simd).stretched(simd, &frame.view);
    (seen, somewhere)
}
