//! The denoiser of the examples: the mean over a window, with the weights that its documentation gives.

use common::frame::cross_bilateral;
use common::scene::{Surface, SurfaceBuffer};
use fastrand::Rng;
use stochastic_light_culling::glam::{DVec3, Vec3};

/// A bent sheet with a crease down the middle, a step in depth and holes, all under noise.
fn surfaces(image_size: [u32; 2], random: &mut Rng) -> SurfaceBuffer {
    let [width, height] = image_size;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let surface = |[x, y]: [u32; 2]| {
        if random.u32(0..8) == 0 {
            return Surface {
                position: Vec3::ZERO,
                normal: Vec3::ZERO,
                depth: f32::INFINITY,
                albedo: Vec3::ZERO,
                material: 0,
            };
        }
        let step = if y % 20 < 10 { 0.0 } else { 0.3 };
        let depth = 7.0 + step + 0.01 * random.f32();
        let bend = if 2 * x < width { 0.02 } else { -0.04 } * x as f32;
        let tilt = 0.1 * random.f32();
        Surface {
            position: Vec3::new(0.02 * x as f32, 0.02 * y as f32, -depth),
            normal: Vec3::new(bend, tilt, 1.0).normalize(),
            depth,
            albedo: Vec3::ONE,
            material: 0,
        }
    };
    SurfaceBuffer {
        image_size,
        surfaces: pixels.map(surface).collect(),
    }
}

/// The blurred image, pixel by pixel, in `f64`.
fn reference(surfaces: &SurfaceBuffer, image: &[Vec3]) -> Vec<DVec3> {
    let [width, height] = surfaces.image_size;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let blurred = |[x, y]: [u32; 2]| {
        let center = surfaces.at([x, y]);
        if center.is_sky() {
            return DVec3::ZERO;
        }
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for other_y in y.saturating_sub(8)..(y + 9).min(height) {
            for other_x in x.saturating_sub(8)..(x + 9).min(width) {
                let other = surfaces.at([other_x, other_y]);
                let normal = center.normal.as_dvec3();
                let cosine = normal.dot(other.normal.as_dvec3()).max(0.0);
                let apart = f64::from(x.abs_diff(other_x)).hypot(f64::from(y.abs_diff(other_y)));
                let between = other.position.as_dvec3() - center.position.as_dvec3();
                let off_plane = between.dot(normal) / (0.01 * f64::from(center.depth));
                let exponent = -0.5 * ((apart / 4.0).powi(2) + off_plane.powi(2));
                let weight = exponent.exp() * cosine.powi(32);
                weights += weight;
                sum += weight * image[surfaces.index([other_x, other_y])].as_dvec3();
            }
        }
        sum / weights
    };
    pixels.map(blurred).collect()
}

#[test]
fn denoising_is_the_weighted_mean_of_a_window() {
    let mut random = Rng::with_seed(1);
    // Narrower and wider than a window and a vector, and neither a multiple of the latter.
    for image_size in [[1, 1], [3, 40], [16, 5], [70, 43], [129, 2]] {
        let surfaces = surfaces(image_size, &mut random);
        let mut image = || -> Vec<Vec3> {
            let color = |_: &_| Vec3::new(random.f32(), 10.0 * random.f32(), 0.0);
            surfaces.surfaces.iter().map(color).collect()
        };
        let images = [image(), image()];
        let blurred = cross_bilateral(&surfaces, images.each_ref().map(|image| &**image), || ());
        for (blurred, image) in blurred.iter().zip(&images) {
            let reference = reference(&surfaces, image);
            assert_eq!(blurred.len(), reference.len());
            for (pixel, (blurred, reference)) in blurred.iter().zip(reference).enumerate() {
                // A cosine is wrong by 3e-7 at most, so its power by 1e-5 of itself. A distance of up to ten
                // standard deviations is wrong by 2e-6 of one, which changes its weight by less than that.
                let error = (blurred.as_dvec3() - reference).abs();
                let tolerance = 3e-5 * reference;
                assert!(
                    error.cmple(tolerance).all(),
                    "{image_size:?}, pixel {pixel}: {blurred}, {reference}"
                );
            }
        }
    }
}

#[test]
fn each_row_is_counted() {
    let surfaces = surfaces([20, 30], &mut Rng::with_seed(2));
    let rows = std::sync::atomic::AtomicU32::new(0);
    let image = vec![Vec3::ONE; 600];
    let done = || {
        rows.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let [_] = cross_bilateral(&surfaces, [&image], done);
    assert_eq!(rows.into_inner(), 30);
}
