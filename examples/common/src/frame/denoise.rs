//! Cross-bilateral filter: a blur that stops where the surface bends or ends
//! [Petschnigg et al. 2004; Eisemann & Durand 2004].

use rayon::prelude::*;
use stochastic_light_culling::glam::Vec3;

use crate::scene::{Surface, SurfaceBuffer};

/// In pixels, as in the paper.
const RADIUS: i64 = 8;
/// The standard deviation of the blur in pixels: as wide as the radius lets it be.
const SPREAD: f32 = 4.0;
/// The cosine between two normals is raised to this power.
const NORMAL_SHARPNESS: i32 = 32;

/// The `N` images of irradiance, blurred with the same weights; calls `done` after each row.
pub fn cross_bilateral<const N: usize>(
    surfaces: &SurfaceBuffer,
    images: [&[Vec3]; N],
    done: impl Fn() + Sync,
) -> [Vec<Vec3>; N] {
    let [width, height] = surfaces.image_size;
    let row = |y: u32| {
        let row: Vec<[Vec3; N]> = (0..width)
            .map(|x| filtered(surfaces, images, [x, y]))
            .collect();
        done();
        row
    };
    let pixels: Vec<[Vec3; N]> = (0..height).into_par_iter().flat_map_iter(row).collect();
    std::array::from_fn(|i| pixels.iter().map(|pixel| pixel[i]).collect())
}

fn filtered<const N: usize>(
    surfaces: &SurfaceBuffer,
    images: [&[Vec3]; N],
    pixel: [u32; 2],
) -> [Vec3; N] {
    let center = surfaces.at(pixel);
    if center.is_sky() {
        return [Vec3::ZERO; N];
    }
    let [columns, rows] = [0, 1].map(|i| {
        let last = i64::from(surfaces.image_size[i]) - 1;
        let middle = i64::from(pixel[i]);
        (middle - RADIUS).max(0) as u32..=(middle + RADIUS).min(last) as u32
    });
    let mut sums = [Vec3::ZERO; N];
    let mut total = 0.0;
    for y in rows {
        for x in columns.clone() {
            let index = surfaces.index([x, y]);
            let offset = [x.abs_diff(pixel[0]), y.abs_diff(pixel[1])].map(|n| n as f32);
            let apart = (offset[0] * offset[0] + offset[1] * offset[1]) / (SPREAD * SPREAD);
            let weight = likeness(center, &surfaces.surfaces[index], apart);
            total += weight;
            for (sum, image) in sums.iter_mut().zip(images) {
                *sum += weight * image[index];
            }
        }
    }
    // The pixel itself has weight 1.
    sums.map(|sum| sum / total)
}

/// How much of one surface's irradiance the other is taken to have, in \[0, 1\].
fn likeness(center: &Surface, other: &Surface, apart: f32) -> f32 {
    let cosine = center.normal.dot(other.normal);
    if cosine <= 0.0 {
        return 0.0; // Also for sky, whose normal is zero.
    }
    // From the plane of the one to the other, of which a pixel's share of the view is a part.
    let off_plane = (other.position - center.position).dot(center.normal) / (0.01 * center.depth);
    (-0.5 * (apart + off_plane * off_plane)).exp() * cosine.powi(NORMAL_SHARPNESS)
}
