//! What a frame is judged by.

use stochastic_light_culling::glam::Vec3;

use crate::scene::SurfaceBuffer;

/// The mean of `counts` over the pixels that see a surface; zero if none does.
pub fn mean_over_surfaces(surfaces: &SurfaceBuffer, counts: &[u32]) -> f64 {
    let (mut sum, mut pixels) = (0.0, 0.0);
    for (surface, count) in surfaces.surfaces.iter().zip(counts) {
        if !surface.is_sky() {
            sum += f64::from(*count);
            pixels += 1.0;
        }
    }
    if pixels > 0.0 { sum / pixels } else { 0.0 }
}

/// The root of the mean squared error, over `pixels` and three channels, of the radiance that follows
/// from `irradiance`, for all pixels, against that from `reference`, for `pixels` alone; zero for no
/// pixels.
pub fn rmse(
    surfaces: &SurfaceBuffer,
    irradiance: &[Vec3],
    pixels: &[usize],
    reference: &[Vec3],
) -> f64 {
    let squared = |(pixel, reference): (&usize, &Vec3)| {
        let error = irradiance[*pixel] - reference;
        let error = surfaces.surfaces[*pixel].reflected(error);
        f64::from(error.length_squared()) / 3.0
    };
    let sum: f64 = pixels.iter().zip(reference).map(squared).sum();
    (sum / pixels.len().max(1) as f64).sqrt()
}
