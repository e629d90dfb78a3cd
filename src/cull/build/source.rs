//! What shapes are made of: lights, and bounds with the places that they are put in.

use core::f32::consts::FRAC_1_PI;
use core::marker::PhantomData;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask};
use glam::Vec3;

use super::place::Spheroids;
use super::vector::{Vectors, Wide, dot, length_of_cross, round_up};
use super::view::{Ellipsoids, Seen, Spheres, View};
use crate::bound::AXIS_TILT_RADIANS;
use crate::cull::batch::Chunk;
use crate::cull::lanes::{LANES, Lanes, load, parts, splat, store};
use crate::cull::shape::{InLanes, Lane};
use crate::{
    AnisotropicGgxLobe, BatchShape, Bound, Bounded, CameraSphere, ConstantLobe, Ellipsoid, Fresnel,
    GgxLobe, LambertLobe, MaskingShadowing, Roulette, Sphere, Spheroid, Stretch, Vpl, Xi,
};

/// Something that shapes are made of, sixteen at a time.
pub trait Source: Copy {
    type Light;
    /// What a light is given besides in a frame.
    type Given: Copy;
    type Shape: BatchShape;
    /// The numbers of a light, each of type `T`.
    type Numbers<T: Lane>: Lane + AsRef<[T]> + AsMut<[T]>;
    /// What a light has besides numbers.
    type Rest: Copy;

    fn numbers_of<T: Lane>(value: T) -> Self::Numbers<T>;
    fn numbers(light: &Self::Light, given: Self::Given) -> Self::Numbers<f32>;
    fn rest(light: &Self::Light) -> Self::Rest;

    /// Whether a light may reach somewhere. That is but a guess, which spares the work on those that do
    /// not.
    fn may_reach(light: &Self::Light, given: Self::Given) -> bool;

    /// The shapes of lights, and which of them are shapes of lights that reach somewhere.
    fn shapes<S: Simd>(
        simd: S,
        numbers: &Self::Numbers<S::f32s>,
        rest: &[Self::Rest],
        frame: &Frame,
    ) -> (OfShape<S, Self::Shape>, S::mask32s);
}

type OfShape<S, T> = Seen<S, <T as InLanes>::Fields<<S as Simd>::f32s>>;

/// What all lights of a frame share.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub(super) roulette: Roulette,
    pub(super) view: View,
}

/// Sixteen lights, and the shapes that are made of them.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Lights<T: Source> {
    numbers: T::Numbers<Lanes>,
    rest: [T::Rest; LANES],
    pub chunk: Chunk<T::Shape>,
    /// Those that have a shape, as bits, and the depths that these reach.
    pub shaped: u32,
    pub reach: [f32; 2],
}

impl<T: Source> Lights<T> {
    /// `light` in all lanes.
    pub fn splat(light: &T::Light, given: T::Given) -> Self {
        let mut numbers = T::numbers_of([0.0; LANES]);
        let of_light = T::numbers(light, given);
        for (lanes, number) in numbers.as_mut().iter_mut().zip(of_light.as_ref()) {
            *lanes = [*number; LANES];
        }
        Self {
            numbers,
            rest: [T::rest(light); LANES],
            chunk: Chunk::NOWHERE,
            shaped: 0,
            reach: [0.0; 2],
        }
    }

    #[inline]
    pub fn set(&mut self, lane: usize, name: u32, light: &T::Light, given: T::Given) {
        let numbers = self.numbers.as_mut().iter_mut();
        for (lanes, number) in numbers.zip(T::numbers(light, given).as_ref()) {
            lanes[lane] = *number;
        }
        self.rest[lane] = T::rest(light);
        self.chunk.numbers[lane] = name;
    }

    /// Makes the shapes; only those that bits of `wanted` tell have any.
    #[inline(always)]
    pub fn shape<S: Simd>(&mut self, simd: S, wanted: u32, frame: &Frame) {
        let zero = S::f32s::splat(simd, 0.0);
        let [mut nearest, mut farthest] = splat(simd, [f32::INFINITY, f32::NEG_INFINITY]);
        self.shaped = 0;
        for part in 0..parts::<S>() {
            let mut numbers = T::numbers_of(zero);
            for (vector, lanes) in numbers.as_mut().iter_mut().zip(self.numbers.as_ref()) {
                *vector = load(simd, lanes, part);
            }
            let first = part * S::f32s::LEN;
            let rest = &self.rest[first..][..S::f32s::LEN];
            let (seen, somewhere) = T::shapes(simd, &numbers, rest, frame);
            for (lanes, vector) in self
                .chunk
                .fields
                .as_mut()
                .iter_mut()
                .zip(seen.fields.as_ref())
            {
                store::<S>(lanes, part, *vector);
            }

            let of_part = u64::from(wanted >> first) & ((1 << S::f32s::LEN) - 1);
            let shaped = somewhere & S::mask32s::from_bitmask(simd, of_part);
            let [near, far] = seen.reach;
            nearest = shaped.select(nearest.min(near), nearest);
            farthest = shaped.select(farthest.max(far), farthest);
            self.shaped |= (shaped.to_bitmask() as u32) << first;
        }
        self.reach = [nearest.reduce_min(), farthest.reduce_max()];
    }
}

/// [`Roulette::scale`].
#[inline(always)]
fn scale<S: Simd>(simd: S, roulette: &Roulette, flux: S::f32s, xi: S::f32s) -> S::f32s {
    let zero = S::f32s::splat(simd, 0.0);
    let radius = flux.sqrt() / (xi.sqrt() * roulette.delta_root());
    let normal = round_up::<S>(radius, 5)
        .max(f32::MIN_POSITIVE)
        .min(f32::MAX);
    flux.simd_gt(zero).select(normal, zero)
}

impl<F: Fresnel, G: MaskingShadowing> Source for GgxLobe<F, G> {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = Stretch;
    /// The position, Φ, ξ, n, ω_i, μ, √(kμ² + α²) and α.
    type Numbers<T: Lane> = [T; 14];
    type Rest = F;

    fn numbers_of<T: Lane>(value: T) -> [T; 14] {
        [value; 14]
    }

    #[inline]
    fn numbers(light: &Self::Light, xi: Xi) -> [f32; 14] {
        let (p, lobe) = (light.position(), light.lobe());
        let (n, w) = (lobe.normal(), lobe.incoming());
        [
            p.x,
            p.y,
            p.z,
            light.flux(),
            xi.get(),
            n.x,
            n.y,
            n.z,
            w.x,
            w.y,
            w.z,
            lobe.incident_cosine(),
            lobe.incident_root(),
            lobe.ggx().roughness(),
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
        numbers: &[S::f32s; 14],
        fresnels: &[F],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let [p_x, p_y, p_z, flux, xi, numbers @ ..] = *numbers;
        let [n_x, n_y, n_z, w_x, w_y, w_z, cosine, root, alpha] = numbers;
        let n = Vectors::<S>::new(n_x, n_y, n_z).widened();
        let w = Vectors::<S>::new(w_x, w_y, w_z).widened();

        let sine = length_of_cross(n, w).narrowed();
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
fn max_fresnel<S: Simd, F: Fresnel>(simd: S, fresnels: &[F], cosines: S::f32s) -> S::f32s {
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
fn mirror_direction<S: Simd>(n: [Wide<S>; 3], w: [Wide<S>; 3]) -> Vectors<S> {
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

impl Source for LambertLobe {
    type Light = Vpl<Self>;
    type Given = Xi;
    type Shape = CameraSphere;
    /// The position, Φ, ξ, n and ρ.
    type Numbers<T: Lane> = [T; 9];
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> [T; 9] {
        [value; 9]
    }

    #[inline]
    fn numbers(light: &Self::Light, xi: Xi) -> [f32; 9] {
        let (p, n) = (light.position(), light.lobe().normal());
        let albedo = light.lobe().albedo();
        [p.x, p.y, p.z, light.flux(), xi.get(), n.x, n.y, n.z, albedo]
    }

    #[inline]
    fn rest(_: &Self::Light) {}

    #[inline]
    fn may_reach(light: &Self::Light, _: Xi) -> bool {
        light.flux() > 0.0 && light.lobe().albedo() > 0.0
    }

    #[inline(always)]
    fn shapes<S: Simd>(
        simd: S,
        numbers: &[S::f32s; 9],
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, CameraSphere>, S::mask32s) {
        let [p_x, p_y, p_z, flux, xi, n_x, n_y, n_z, albedo] = *numbers;
        let reach = albedo.sqrt() * Self::ROOT_OF_ONE_OVER_PI;
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
    /// The position, Φ and ξ.
    type Numbers<T: Lane> = [T; 5];
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> [T; 5] {
        [value; 5]
    }

    #[inline]
    fn numbers(light: &Self::Light, xi: Xi) -> [f32; 5] {
        let p = light.position();
        [p.x, p.y, p.z, light.flux(), xi.get()]
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
        numbers: &[S::f32s; 5],
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, CameraSphere>, S::mask32s) {
        let [p_x, p_y, p_z, flux, xi] = *numbers;
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

/// The position and the scale that a bound is placed with.
type Place = (Vec3, f32);

impl Source for Sphere {
    type Light = Self;
    type Given = Place;
    type Shape = CameraSphere;
    /// The centre, the radius, the position and the scale.
    type Numbers<T: Lane> = [T; 8];
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> [T; 8] {
        [value; 8]
    }

    #[inline]
    fn numbers(sphere: &Self, (p, scale): Place) -> [f32; 8] {
        let c = sphere.center();
        [c.x, c.y, c.z, sphere.radius(), p.x, p.y, p.z, scale]
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
        numbers: &[S::f32s; 8],
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, CameraSphere>, S::mask32s) {
        let [x, y, z, radius, p_x, p_y, p_z, scale] = *numbers;
        let center = Vectors::new(x, y, z);
        let unit = Spheres { center, radius };
        placed_spheres(simd, unit, Vectors::new(p_x, p_y, p_z), scale, frame)
    }
}

impl Source for Spheroid {
    type Light = Self;
    type Given = Place;
    type Shape = Stretch;
    /// The focus, the axis, r, α, the position and the scale.
    type Numbers<T: Lane> = [T; 12];
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> [T; 12] {
        [value; 12]
    }

    #[inline]
    fn numbers(spheroid: &Self, (p, scale): Place) -> [f32; 12] {
        let (f, u) = (spheroid.focus(), spheroid.axis());
        let (radius, alpha) = (spheroid.radius(), spheroid.roughness());
        [
            f.x, f.y, f.z, u.x, u.y, u.z, radius, alpha, p.x, p.y, p.z, scale,
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
        numbers: &[S::f32s; 12],
        _: &[()],
        frame: &Frame,
    ) -> (OfShape<S, Stretch>, S::mask32s) {
        let [
            f_x,
            f_y,
            f_z,
            u_x,
            u_y,
            u_z,
            radius,
            roughness,
            p_x,
            p_y,
            p_z,
            scale,
        ] = *numbers;
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

/// The tighter bound of a GGX lobe.
#[derive(Clone, Copy, Debug)]
pub struct Tight<F, G>(PhantomData<(F, G)>);

impl<F: Fresnel, G: MaskingShadowing> Source for Tight<F, G> {
    type Light = Vpl<GgxLobe<F, G>>;
    type Given = Xi;
    type Shape = Stretch;
    type Numbers<T: Lane> = OfLight<T>;
    type Rest = ();

    fn numbers_of<T: Lane>(value: T) -> OfLight<T> {
        [value; 23]
    }

    #[inline]
    fn numbers(light: &Self::Light, xi: Xi) -> OfLight<f32> {
        let unit = light.lobe().tight_bound();
        of_light(&unit, light.position(), light.flux(), xi)
    }

    #[inline]
    fn rest(_: &Self::Light) {}

    #[inline]
    fn may_reach(light: &Self::Light, xi: Xi) -> bool {
        <GgxLobe<F, G> as Source>::may_reach(light, xi)
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
