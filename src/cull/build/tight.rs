//! GGX lights, isotropic, with the tight bound.

use core::f32::consts::FRAC_1_PI;
use core::marker::PhantomData;

use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask};

use super::place::any_orthonormal_pair;
use super::source::{Fours, Frame, OfShape, Source, scale};
use super::spheroids::{max_fresnel, mirror_direction};
use super::vector::{Vectors, cross, fifth_power, length, round_up};
use super::view::Ellipsoids;
use crate::bound::table::{self, Axis};
use crate::cull::lanes::{LANES, load_fours, splat};
use crate::cull::wide_lanes::Wide;
use crate::tile::Number;
use crate::{Fresnel, FresnelMajorant, GgxLobe, MaskingShadowing, Stretch, Vpl, Xi, math};

/// The tight bound of a GGX lobe.
#[derive(Clone, Copy, Debug)]
pub struct Tight<F, G>(PhantomData<(F, G)>);

impl<F: Fresnel, G: MaskingShadowing> Source for Tight<F, G> {
    type Light = Vpl<GgxLobe<F, G>>;
    type Given = Xi;
    type Shape = Stretch;
    /// Those of the lobe, and after α the majorant of F: its value head-on, and its rise.
    type Fours = Fours<4>;
    type Rest = F;

    #[inline]
    fn numbers(light: &Self::Light, xi: Xi) -> [[f32; 4]; 4] {
        let FresnelMajorant { base, rise } = light.lobe().fresnel().majorant();
        let [a, b, c, [alpha, ..]] = <GgxLobe<F, G> as Source>::numbers(light, xi);
        [a, b, c, [alpha, base, rise, 0.0]]
    }

    #[inline]
    fn rest(light: &Self::Light) -> F {
        *light.lobe().fresnel()
    }

    #[inline]
    fn may_reach(light: &Self::Light, xi: Xi) -> bool {
        <GgxLobe<F, G> as Source>::may_reach(light, xi)
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
        let [[n_x, n_y, n_z, cosine], [w_x, w_y, w_z, root], numbers] = numbers;
        let [alpha, base, rise, _] = numbers;
        let n = Vectors::<S>::new(n_x, n_y, n_z).widened();
        let w = Vectors::<S>::new(w_x, w_y, w_z).widened();
        let u = mirror_direction(n, w);
        let (across, sine) = across(simd, n, w, u);
        let lobe = Lobes {
            alpha,
            cosine,
            sine,
            root,
            masking: S::f32s::splat(simd, 0.5) / (cosine + root),
        };
        let shape = lobe.shapes(simd, [base, rise], fresnels);
        let unit = lobe.ellipsoids(simd, shape, u, across);

        let zero = S::f32s::splat(simd, 0.0);
        let scale = scale(simd, &frame.roulette, flux, xi);
        let somewhere =
            cosine.simd_gt(zero) & unit.semi_axes.min_element().simd_gt(zero) & scale.simd_gt(zero);
        let placed = unit.placed(simd, Vectors::new(p_x, p_y, p_z), scale);
        (placed.stretched(simd, &frame.view), somewhere)
    }
}

/// [`GgxLobe::mirror_and_across`] but for ω_u = `mirror`: ω_w, and √(1 − μ²).
#[inline(always)]
fn across<S: Simd>(
    simd: S,
    n: [Wide<S>; 3],
    w: [Wide<S>; 3],
    mirror: Vectors<S>,
) -> (Vectors<S>, S::f32s) {
    let cross = cross(n, w);
    let length = length(cross);
    let over = Wide::splat(simd, 1.0) / length;
    let unit = |x: Wide<S>| (x * over).narrowed();
    let any = any_orthonormal_pair(simd, mirror).1;
    let is_oblique = length.is_greater(length.constant(0.0));
    let across = Vectors::new(
        is_oblique.select(unit(cross[0]), any.x),
        is_oblique.select(unit(cross[1]), any.y),
        is_oblique.select(unit(cross[2]), any.z),
    );
    (across, length.narrowed())
}

/// What the tight bound takes of a lobe, in each lane.
#[derive(Clone, Copy)]
struct Lobes<S: Simd> {
    alpha: S::f32s,
    cosine: S::f32s,
    sine: S::f32s,
    /// √(kμ² + α²)
    root: S::f32s,
    /// G1(μ)/(4μ)
    masking: S::f32s,
}

/// What the scalar bound calls `Shape`, in each lane.
#[derive(Clone, Copy)]
struct Shapes<S: Simd> {
    reflected: S::f32s,
    center: [S::f32s; 2],
    axes: Axes<S>,
    across: S::f32s,
}

/// What it calls `Axes`.
#[derive(Clone, Copy)]
struct Axes<S: Simd> {
    long: S::f32s,
    short: S::f32s,
    cosine: S::f32s,
    sine: S::f32s,
}

impl<S: Simd> Lobes<S> {
    /// The smaller of the ellipsoid of the table and the paper's spheroid.
    #[inline(always)]
    fn shapes<F: Fresnel>(self, simd: S, [base, rise]: [S::f32s; 2], fresnels: &[F]) -> Shapes<S> {
        let Self {
            alpha,
            cosine,
            sine,
            root,
            masking,
        } = self;
        let [zero, one] = splat(simd, [0.0, 1.0]);
        let half_incidence = sine / (cosine + 1.0);
        let half_delta = alpha * 2.0 * sine * masking;
        let rises = rise.simd_gt(zero);
        let least = round_up::<S>(rise * table::LEAST_SHARE, 2);
        let base = rises.select(base.max(least), base);
        let share = base / (base + rise);
        let coordinates = [
            alpha.sqrt(),
            half_incidence + half_delta,
            share.sqrt().sqrt(),
        ];
        let [c_1, c_2, a_11, a_21, a_22, a_33] = interpolated(simd, coordinates, rises);
        let reflected = round_up::<S>(base + rise * fifth_power::<S>((one - cosine).max(0.0)), 192);

        let most = max_fresnel::<S, F>(simd, fresnels, cosine / ((sine + 1.0) * 2.0).sqrt());
        let over_spheroid = reflected / most;
        let over_alpha = one / alpha;
        let across = a_33 * root;
        let volume = a_11 * a_22 * across;
        let along_of_spheroid = alpha * 0.5 * alpha + 0.5;
        let is_smaller = (volume * volume * (over_spheroid * over_spheroid * over_spheroid))
            .simd_le(along_of_spheroid * along_of_spheroid);
        let axes = Axes::of_ellipse(simd, a_11 * over_alpha, a_21, a_22);
        let ahead = (one - alpha) * 0.5 * (alpha + 1.0) * over_alpha;
        Shapes {
            reflected: is_smaller.select(reflected, most),
            center: [
                is_smaller.select(c_1 * over_alpha, ahead),
                is_smaller.select(c_2, zero),
            ],
            axes: Axes {
                long: is_smaller.select(axes.long, along_of_spheroid * over_alpha),
                short: is_smaller.select(axes.short, one),
                cosine: is_smaller.select(axes.cosine, one),
                sine: is_smaller.select(axes.sine, zero),
            },
            across: is_smaller.select(across, one),
        }
    }

    /// The ellipsoids around lights at the origin.
    #[inline(always)]
    fn ellipsoids(
        self,
        simd: S,
        shape: Shapes<S>,
        u: Vectors<S>,
        across: Vectors<S>,
    ) -> Ellipsoids<S> {
        let radius = (shape.reflected * self.masking * FRAC_1_PI).sqrt();
        let Axes {
            long,
            short,
            cosine,
            sine,
        } = shape.axes;
        let down = Vectors::<S>::new(
            u.y * across.z - u.z * across.y,
            u.z * across.x - u.x * across.z,
            u.x * across.y - u.y * across.x,
        );
        let semi_axes = Vectors::<S>::new(long, short, shape.across);
        let (least, most) = (short.min(shape.across), long.max(shape.across));
        let tilt = most / least * (12.0 * math::UNIT_ROUNDOFF);
        let growth = radius * round_up::<S>(tilt + 1.0, 96);
        let zero = S::f32s::splat(simd, 0.0);
        Ellipsoids {
            parts: [
                Vectors::new(zero, zero, zero),
                (u * shape.center[0] + down * shape.center[1]) * radius,
            ],
            axes: [
                u * cosine + down * sine,
                down * cosine - u * sine,
                Vectors::new(-across.x, -across.y, -across.z),
            ],
            semi_axes: semi_axes * growth,
        }
    }
}

impl<S: Simd> Axes<S> {
    #[inline(always)]
    fn of_ellipse(simd: S, along: S::f32s, slant: S::f32s, aside: S::f32s) -> Self {
        let (first, mixed) = (along * along, along * slant);
        let second = slant * slant + aside * aside;
        let difference = first - second;
        let apart = difference.abs().max(1e-15);
        let h = (apart * apart + mixed * 4.0 * mixed).sqrt();
        let long = ((first + second + h) * 0.5).sqrt();
        let short = along * aside / long;
        let larger = (apart + h) * 0.5;
        let over = S::f32s::splat(simd, 1.0) / (larger * h).sqrt();
        let (larger, smaller) = (larger * over, mixed * over);
        let is_along = difference.simd_ge(S::f32s::splat(simd, 0.0));
        Self {
            long,
            short,
            cosine: is_along.select(larger, smaller),
            sine: is_along.select(smaller, larger),
        }
    }
}

/// [`table::ellipsoid`]: its rows are fetched and interpolated one lane after the other.
#[inline(always)]
fn interpolated<S: Simd>(
    simd: S,
    [roughness, incidence, reflectance]: [S::f32s; 3],
    rises: S::mask32s,
) -> [S::f32s; table::NUMBERS] {
    let (i, u) = split::<S>(Axis::ROUGHNESS, roughness);
    let (j, v) = split::<S>(Axis::INCIDENCE, incidence);
    let (k, w) = split::<S>(Axis::REFLECTANCE, reflectance);
    let last = S::f32s::splat(simd, (table::REFLECTANCES - 1) as f32);
    let k = rises.select(k, last);
    let first = (i * table::INCIDENCES as f32 + j) * table::REFLECTANCES as f32 + k;
    let [mut firsts, mut us, mut vs, mut ws] = [[0.0; LANES]; 4];
    (first + table::WHOLE).store_slice(&mut firsts[..S::f32s::LEN]);
    u.store_slice(&mut us[..S::f32s::LEN]);
    v.store_slice(&mut vs[..S::f32s::LEN]);
    w.store_slice(&mut ws[..S::f32s::LEN]);
    let rises = rises.to_bitmask();
    let [mut head, mut tail] = [[[0.0; 4]; LANES]; 2];
    for lane in 0..S::f32s::LEN {
        let w = (rises >> lane & 1 != 0).then_some(ws[lane]);
        let found = table::between(table::first_knot(firsts[lane]), [us[lane], vs[lane]], w);
        (head[lane], tail[lane]) = (found[0].into(), found[1].into());
    }
    let [c_1, c_2, a_11, a_21] = load_fours(simd, &head[..S::f32s::LEN]);
    let [a_22, a_33, ..] = load_fours(simd, &tail[..S::f32s::LEN]);
    [c_1, c_2, a_11, a_21, a_22, a_33]
}

/// `Axis::split`, but with the knot's place as a number.
#[inline(always)]
fn split<S: Simd>(axis: Axis, x: S::f32s) -> (S::f32s, S::f32s) {
    let x = (x - axis.first) * axis.scale;
    let whole = (x - 0.5).max(0.0).min(axis.last) + table::WHOLE;
    let knot = whole - table::WHOLE;
    (knot, x - knot)
}
