//! Cross-bilateral filter: a blur that stops where the surface bends or ends
//! [Petschnigg et al. 2004; Eisemann & Durand 2004].

use std::f32::consts::{LN_2, LOG2_E};

use fearless_simd::{Level, Simd, SimdBase, SimdFloat, dispatch};
use rayon::prelude::*;
use stochastic_light_culling::glam::Vec3;

use crate::scene::{Surface, SurfaceBuffer};

/// In pixels, as in the paper.
const RADIUS: usize = 8;
/// The standard deviation of the blur in pixels: as wide as the radius lets it be.
const SPREAD: f32 = 4.0;
/// That of the distance from the plane of a surface, over the depth of the surface.
const PLANE_SPREAD: f32 = 0.01;
/// The number of lanes of the widest vectors.
const MAX_LANES: usize = 16;

/// The `N` images of irradiance, blurred with the same weights; calls `done` after each row.
///
/// At a surface with normal n, position p and depth z, a pixel d pixels away that sees the normal n′ and the
/// position p′ has the weight exp(−½ (d/4)² − ½ ((p′ − p)·n / (0.01 z))²) max(n·n′, 0)³².
pub fn cross_bilateral<const N: usize>(
    surfaces: &SurfaceBuffer,
    images: [&[Vec3]; N],
    done: impl Fn() + Sync,
) -> [Vec<Vec3>; N] {
    let width = surfaces.image_size[0] as usize;
    let level = Level::try_detect().unwrap_or(Level::baseline());
    let row = |(y, row): (usize, &[Surface])| {
        Row::new(row, images.map(|image| &image[y * width..][..width]))
    };
    let rows = surfaces.surfaces.par_chunks(width).enumerate().map(row);
    let rows: Vec<Row<N>> = rows.collect();
    let blurred_row = |y: usize| {
        let first = y.saturating_sub(RADIUS);
        let last = (y + RADIUS).min(rows.len() - 1);
        let mut blurred = vec![[Vec3::ZERO; N]; width];
        dispatch!(level, simd => blur(simd, &rows[first..=last], y - first, &mut blurred));
        done();
        blurred
    };
    let pixels = (0..rows.len()).into_par_iter().flat_map_iter(blurred_row);
    let pixels: Vec<[Vec3; N]> = pixels.collect();
    std::array::from_fn(|i| pixels.iter().map(|pixel| pixel[i]).collect())
}

/// A row of pixels, with a plane for each number. There is sky at both ends, so that no window leaves the row.
struct Row<const N: usize> {
    normal: [Vec<f32>; 3],
    position: [Vec<f32>; 3],
    /// The normal, scaled so that 2^−((p′ − p)·n)² is the factor of a weight.
    scaled_normal: [Vec<f32>; 3],
    irradiance: [[Vec<f32>; 3]; N],
}

/// Of exp(−½ t²) = 2^(−½ log₂ e · t²).
const HALF_LOG2_E: f32 = 0.5 * LOG2_E;

impl<const N: usize> Row<N> {
    fn new(surfaces: &[Surface], irradiance: [&[Vec3]; N]) -> Self {
        let scale = HALF_LOG2_E.sqrt() / PLANE_SPREAD;
        Self {
            normal: planes(surfaces, |surface| surface.normal),
            position: planes(surfaces, |surface| surface.position),
            scaled_normal: planes(surfaces, |surface| surface.normal * (scale / surface.depth)),
            irradiance: irradiance.map(|row| planes(row, |irradiance| *irradiance)),
        }
    }
}

/// The coordinates of a vector that each pixel has, with zeros before and after them.
fn planes<T>(pixels: &[T], vector: impl Fn(&T) -> Vec3) -> [Vec<f32>; 3] {
    let length = RADIUS + pixels.len().next_multiple_of(MAX_LANES) + RADIUS;
    let mut planes = [0, 1, 2].map(|_| vec![0.0; length]);
    for (i, pixel) in pixels.iter().enumerate() {
        let vector = vector(pixel).to_array();
        for (plane, coordinate) in planes.iter_mut().zip(vector) {
            plane[RADIUS + i] = coordinate;
        }
    }
    planes
}

/// Blurs row `y` of `rows`, which are those of its windows.
#[inline(always)]
fn blur<S: Simd, const N: usize>(simd: S, rows: &[Row<N>], y: usize, blurred: &mut [[Vec3; N]]) {
    simd.vectorize(
        #[inline(always)]
        || {
            for (i, blurred) in blurred.chunks_mut(S::f32s::LEN).enumerate() {
                blur_pixels(simd, rows, y, i * S::f32s::LEN, blurred);
            }
        },
    );
}

/// Blurs as many pixels of row `y` as a vector has lanes, from column `x`.
#[inline(always)]
fn blur_pixels<S: Simd, const N: usize>(
    simd: S,
    rows: &[Row<N>],
    y: usize,
    x: usize,
    blurred: &mut [[Vec3; N]],
) {
    let zero = S::f32s::splat(simd, 0.0);
    let row = &rows[y];
    let normal = load(simd, windows_of::<S>(&row.normal, x), RADIUS);
    let position = load(simd, windows_of::<S>(&row.position, x), RADIUS);
    let scaled_normal = load(simd, windows_of::<S>(&row.scaled_normal, x), RADIUS);
    let mut weights = zero;
    let mut sums = [[zero; 3]; N];
    for (other_y, row) in rows.iter().enumerate() {
        let down = other_y.abs_diff(y);
        let normals = windows_of::<S>(&row.normal, x);
        let positions = windows_of::<S>(&row.position, x);
        let mut irradiance = [[&[][..]; 3]; N];
        for (windows, planes) in irradiance.iter_mut().zip(&row.irradiance) {
            *windows = windows_of::<S>(planes, x);
        }
        for offset in 0..=2 * RADIUS {
            let across = offset.abs_diff(RADIUS);
            let apart = (across * across + down * down) as f32 / (SPREAD * SPREAD);
            let cosine = dot(normal, load(simd, normals, offset));
            let other_position = load(simd, positions, offset);
            // From the plane of the one to the other, of which a pixel's share of the view is a part.
            let off_plane = dot(subtract(other_position, position), scaled_normal);
            let likeness = exp2_of_negative(simd, off_plane * off_plane + HALF_LOG2_E * apart);
            // Zero for sky too, whose normal is zero.
            let weight = likeness * power_of_32(cosine.max(zero));
            weights += weight;
            for (sum, irradiance) in sums.iter_mut().zip(irradiance) {
                let irradiance = load(simd, irradiance, offset);
                for axis in 0..3 {
                    sum[axis] += weight * irradiance[axis];
                }
            }
        }
    }
    for (lane, blurred) in blurred.iter_mut().enumerate() {
        // A surface itself has weight 1, and sky no weights.
        let weight = weights[lane];
        if weight > 0.0 {
            *blurred = sums.map(|sum| Vec3::from(sum.map(|sum| sum[lane])) / weight);
        }
    }
}

/// The numbers of the pixels from column `x` that a vector holds, and those to either side that blur them.
#[inline(always)]
fn windows_of<S: Simd>(planes: &[Vec<f32>; 3], x: usize) -> [&[f32]; 3] {
    let window = |axis: usize| &planes[axis][x..][..S::f32s::LEN + 2 * RADIUS];
    [window(0), window(1), window(2)]
}

#[inline(always)]
fn load<S: Simd>(simd: S, windows: [&[f32]; 3], offset: usize) -> [S::f32s; 3] {
    let load = |axis: usize| S::f32s::from_slice(simd, &windows[axis][offset..][..S::f32s::LEN]);
    [load(0), load(1), load(2)]
}

#[inline(always)]
fn subtract<V: SimdBase<S>, S: Simd>(a: [V; 3], b: [V; 3]) -> [V; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn dot<V: SimdBase<S>, S: Simd>(a: [V; 3], b: [V; 3]) -> V {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn power_of_32<V: SimdBase<S>, S: Simd>(x: V) -> V {
    let x2 = x * x;
    let x4 = x2 * x2;
    let x8 = x4 * x4;
    let x16 = x8 * x8;
    x16 * x16
}

/// 2^−t for t ≥ 0, within 3e-7 of itself; 2^−126 beyond.
#[inline(always)]
fn exp2_of_negative<S: Simd>(simd: S, t: S::f32s) -> S::f32s {
    /// 1.5 · 2²³: the floats around it are the integers, in the order of their bits.
    const TO_INTEGER: f32 = 12_582_912.0;
    let t = t.min(S::f32s::splat(simd, 126.0));
    let shifted = t + TO_INTEGER;
    let x = shifted - TO_INTEGER - t;
    // Taylor's series of 2^x for |x| ≤ ½, whose coefficients are (ln 2)ⁿ/n!.
    let series = x * 1.540_353e-4 + 1.333_355_8e-3;
    let series = series * x + 9.618_129e-3;
    let series = series * x + 5.550_411e-2;
    let series = series * x + 0.240_226_5;
    let series = series * x + LN_2;
    let series = series * x + 1.0;
    // The exponent of a float follows its 23 bits of mantissa.
    let one = S::f32s::splat(simd, 1.0).to_bits();
    series * S::f32s::from_bits(one - (shifted.to_bits() << 23))
}
