//! The mean of the estimator is the unculled radiance, for single lights and for a whole image.
//!
//! Fixed seeds; an error of four standard errors has a chance of 6·10⁻⁵ per comparison.

use stochastic_light_culling::{
    Bounded, Camera, DepthInterval, Direction, Ggx, GgxLobe, Incidence, Interleave, PixelRectangle,
    ProjectedEllipsoid, Roulette, Schlick, Seed, TileGrid, TileRectangle, Vpl, Xi, glam::Vec3,
};
use support::reference::{Brdf, Fresnel, Masking, Surface, Vector};

const FRAMES: u32 = 100_000;

/// The variance of the estimate of a light of radiance `exact`: it is max(L, δ) with probability
/// min(L/δ, 1), so L(δ − L) where that is positive.
fn variance(exact: f64, delta: f64) -> f64 {
    (exact * (delta - exact)).max(0.0)
}

/// Whether the mean of `sum` over all frames is `exact` within four standard errors, one acceptance
/// (which is what a light that is hardly ever accepted varies by), and the rounding of f32.
fn agrees(sum: f64, exact: f64, variance: f64, delta: f64) -> bool {
    let frames = f64::from(FRAMES);
    let standard_error = (variance / frames).sqrt();
    (sum / frames - exact).abs() <= 4.0 * standard_error + delta / frames + 1e-5 * exact
}

#[test]
fn single_lights() {
    let roulette = Roulette::new(0.01).unwrap();
    let mut light = 0;
    for roughness in [0.05_f32, 0.3, 1.0] {
        for height in [0.1_f32, 0.7, 3.0] {
            // A fraction of the lobe's range, and beyond the range of half of all frames and of most.
            for probability in [2.0_f64, 0.5, 0.03] {
                let incoming = Direction::new(Vec3::new(-1.0, 0.2, height)).unwrap();
                let schlick = Schlick::new(0.3).unwrap();
                let lobe = GgxLobe::new(
                    Ggx::new(roughness).unwrap(),
                    schlick,
                    Incidence {
                        normal: Direction::Z,
                        incoming,
                    },
                );
                let vpl = Vpl::new(Vec3::ZERO, 2.0, lobe).unwrap();
                let outgoing = *Direction::new(Vec3::new(1.0, -0.1, height)).unwrap();

                let surface = Surface {
                    normal: Vector([0.0, 0.0, 1.0]),
                    incoming: Vector::from(*incoming).unit(),
                };
                let brdf = Brdf::Ggx {
                    roughness,
                    fresnel: Fresnel::Schlick(0.3),
                    masking: Masking::HeightCorrelated,
                };
                let intensity = 2.0 * surface.value(brdf, Vector::from(outgoing).unit());
                let distance_squared = (intensity / (0.01 * probability)) as f32;

                let (mut sum, mut weights) = (0.0, 0.0);
                for frame in 0..FRAMES {
                    let xi = Seed(2026).frame(frame).hashed_xi(light);
                    let intensity = vpl.radiant_intensity(outgoing);
                    sum += f64::from(roulette.estimate(intensity, distance_squared, xi));
                    weights += f64::from(roulette.weight(intensity, distance_squared, xi));
                }
                let radiance = intensity / f64::from(distance_squared);
                let spread = variance(radiance, 0.01);
                assert!(agrees(sum, radiance, spread, 0.01), "{sum} {radiance}");
                let spread = variance(1.0, 1.0 / probability);
                assert!(agrees(weights, 1.0, spread, 1.0 / probability), "{weights}");
                light += 1;
            }
        }
    }
}

const IMAGE: [u32; 2] = [24, 16];
const TILE: u32 = 4;

/// A floor seen at a slant, and glossy lights a little above it.
struct Scene {
    camera: Camera,
    lights: Vec<Vpl<GgxLobe<Schlick>>>,
    interleave: Interleave,
}

impl Scene {
    fn new() -> Self {
        let eye = Vec3::new(0.0, 3.0, 6.0);
        let camera = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, 0.9, 1.5, 0.1..100.0).unwrap();
        let interleave = Interleave::new(IMAGE, 2).unwrap();
        let lights = (0..24_u32).map(|i| {
            let random = |k: u32| 2.0 * Seed(99).frame(k).hashed_xi(i).get() - 1.0;
            let normal = Direction::new(Vec3::new(random(0), -0.5, random(1))).unwrap();
            let slant = Vec3::new(random(2), random(3), random(4));
            let incoming = Direction::new(*normal + 0.9 * slant).unwrap();
            let ggx = Ggx::new([0.05, 0.1, 0.3, 0.8][i as usize % 4]).unwrap();
            let lobe = GgxLobe::new(
                ggx,
                Schlick::new(0.5).unwrap(),
                Incidence { normal, incoming },
            );
            let position = Vec3::new(3.0 * random(5), 0.6 + 0.4 * random(6), 3.0 * random(7));
            Vpl::new(position, interleave.weight() * 0.2, lobe).unwrap()
        });
        Self {
            lights: lights.collect(),
            camera,
            interleave,
        }
    }

    /// The depth at which a pixel sees the floor y = 0.
    fn depth(&self, pixel: [u32; 2]) -> f32 {
        let at_one = self.camera.point_in_pixel(IMAGE, pixel, 1.0);
        let (up, origin) = (
            self.camera.rotation() * Vec3::Y,
            self.camera.to_camera_space(Vec3::ZERO),
        );
        origin.dot(up) / at_one.dot(up)
    }

    /// The point of the floor that a pixel sees, in the world.
    fn point(&self, pixel: [u32; 2]) -> Vec3 {
        let seen = self.camera.point_in_pixel(IMAGE, pixel, self.depth(pixel));
        self.camera.to_world_space(seen)
    }

    /// The intensity that a light sends to `point`, and its squared distance.
    fn light_at(&self, light: usize, point: Vec3) -> (f32, f32) {
        let way = point - self.lights[light].position();
        let intensity = self.lights[light].radiant_intensity(way.normalize());
        (intensity, way.length_squared())
    }
}

/// A tile between two depths, with what does not change from frame to frame.
struct Tile {
    /// The lights of its subregion.
    lights: Vec<usize>,
    rectangle: TileRectangle,
    depths: DepthInterval,
    /// Each pixel's number in the image, and the intensity and squared distance of each light.
    pixels: Vec<(usize, Vec<(f32, f32)>)>,
}

impl Scene {
    fn tiles(&self) -> Vec<Tile> {
        let mut tiles = Vec::new();
        for subregion in 0..self.interleave.subregions() {
            let size = self.interleave.subregion_size(subregion);
            let grid = TileGrid::new(size, TILE).unwrap();
            for tile in grid.tiles() {
                self.push_tile(&mut tiles, subregion, grid.pixels(tile));
            }
        }
        tiles
    }

    /// The tile of pixels `local` of a subregion, once for each interval of its depths.
    fn push_tile(&self, tiles: &mut Vec<Tile>, subregion: u32, local: PixelRectangle) {
        let light_count = self.lights.len() as u32;
        let lights: Vec<usize> = (0..self.interleave.lights_in(subregion, light_count))
            .map(|light| self.interleave.join_light(subregion, light) as usize)
            .collect();
        let pixels = local
            .pixels()
            .map(|pixel| self.interleave.join_pixel(subregion, pixel));
        let rectangle = self
            .camera
            .tile_rectangle(IMAGE, self.interleave.join_pixels(subregion, local));
        let depths = pixels.clone().map(|pixel| self.depth(pixel));
        for depths in DepthInterval::modified_half_z(depths).into_iter().flatten() {
            let inside = pixels.clone().filter(|pixel| {
                let depth = self.depth(*pixel);
                depths.near() <= depth && depth <= depths.far()
            });
            let pixels = inside.map(|[x, y]| {
                let point = self.point([x, y]);
                let lit = lights.iter().map(|light| self.light_at(*light, point));
                ((y * IMAGE[0] + x) as usize, lit.collect())
            });
            tiles.push(Tile {
                lights: lights.clone(),
                rectangle,
                depths,
                pixels: pixels.collect(),
            });
        }
    }
}

/// The ξ of a light in one of many draws.
type Draw = fn(draw: u32, light: u32, interleave: &Interleave) -> Xi;

#[test]
fn a_small_image_with_hashed_numbers() {
    image_is_exact_in_the_mean(|draw, light, _| Seed(7).frame(draw).hashed_xi(light));
}

/// Draws are seeds, of which each gives one frame: frames of one seed are not independent.
#[test]
fn a_small_image_with_numbers_spread_over_frames() {
    image_is_exact_in_the_mean(|draw, light, _| Seed(draw).frame(5).xi(light));
}

#[test]
fn a_small_image_with_numbers_spread_over_lights_and_frames() {
    image_is_exact_in_the_mean(|draw, light, interleave| {
        let (subregion, rank) = interleave.split_light(light);
        let seed = Seed(draw).subregion(subregion);
        seed.frame(5).xi_of_rank(rank)
    });
}

/// Tile culling, interleaving and roulette together, as a renderer puts them together.
fn image_is_exact_in_the_mean(draw: Draw) {
    let delta = 0.05;
    let scene = Scene::new();
    let roulette = Roulette::new(delta as f32).unwrap();
    let unit_bounds: Vec<_> = scene
        .lights
        .iter()
        .map(|light| light.lobe().unit_bound())
        .collect();
    let tiles = scene.tiles();

    let mut image = [0.0; (IMAGE[0] * IMAGE[1]) as usize];
    let (mut shaded, mut skipped) = (0, 0);
    for frame in 0..FRAMES {
        let lights: Vec<(Xi, Option<ProjectedEllipsoid>)> = (0_u32..)
            .zip(scene.lights.iter().zip(&unit_bounds))
            .map(|(i, (light, unit_bound))| {
                let xi = draw(frame, i, &scene.interleave);
                let scale = roulette.scale(light.flux(), xi);
                let bound = unit_bound.placed(light.position(), scale);
                (xi, bound.project(&scene.camera))
            })
            .collect();
        for tile in &tiles {
            let touching = |light: &usize| {
                let stretch = lights[*light].1;
                stretch.is_some_and(|stretch| stretch.touches(&tile.rectangle, &tile.depths))
            };
            let list: Vec<usize> = (0..tile.lights.len())
                .filter(|local| touching(&tile.lights[*local]))
                .collect();
            shaded += list.len() * tile.pixels.len();
            skipped += (tile.lights.len() - list.len()) * tile.pixels.len();
            for (pixel, lit) in &tile.pixels {
                for local in &list {
                    let (intensity, distance_squared) = lit[*local];
                    let xi = lights[tile.lights[*local]].0;
                    let radiance = roulette.estimate(intensity, distance_squared, xi);
                    image[*pixel] += f64::from(radiance);
                }
            }
        }
    }
    assert!(skipped > shaded, "{skipped} skipped, {shaded} shaded");

    let (mut whole, mut exact_whole, mut worst_deviation) = (0.0, 0.0, 0.0);
    for (pixel, lit) in tiles.iter().flat_map(|tile| &tile.pixels) {
        let radiances = lit.iter().map(|(i, d)| f64::from(*i) / f64::from(*d));
        let spread: f64 = radiances.clone().map(|l| variance(l, delta)).sum();
        let exact: f64 = radiances.sum();
        assert!(
            agrees(image[*pixel], exact, spread, delta),
            "{pixel}: {exact}"
        );
        whole += image[*pixel];
        exact_whole += exact;
        // A light's acceptances at two pixels are not independent: deviations add up at worst.
        worst_deviation += spread.sqrt();
    }
    let spread = worst_deviation * worst_deviation;
    assert!(
        agrees(whole, exact_whole, spread, delta),
        "{whole} {exact_whole}"
    );
}

/// Corners of the estimator: no light, no distance, and no overflow to NaN.
#[test]
fn estimator_at_its_edges() {
    let xi = Xi::new(0.5).unwrap();
    let roulette = Roulette::new(0.1).unwrap();
    for distance_squared in [0.0, 1.0, f32::MAX, f32::INFINITY] {
        assert_eq!(roulette.probability(0.0, distance_squared), 0.0);
        assert_eq!(roulette.estimate(0.0, distance_squared, xi), 0.0);
        assert_eq!(roulette.weight(0.0, distance_squared, xi), 0.0);
        for intensity in [1e-45, 1.0, f32::MAX] {
            assert!(!roulette.probability(intensity, distance_squared).is_nan());
            assert!(!roulette.estimate(intensity, distance_squared, xi).is_nan());
            assert!(!roulette.weight(intensity, distance_squared, xi).is_nan());
        }
    }
    assert_eq!(roulette.probability(1.0, 0.0), 1.0);
    assert_eq!(
        roulette.estimate(1.0, 0.0, Xi::new(1.0).unwrap()),
        f32::INFINITY
    );
    assert!((roulette.radius(0.8, xi) - 4.0).abs() < 1e-6);
    assert_eq!(roulette.scale(0.0, xi), 0.0);
}

/// √(Φ/(δξ)) is rounded up, wherever the three lie, and by little.
#[test]
fn scale_is_not_below_the_exact_one() {
    let least = f32::from_bits(1);
    let any = |rng: &mut fastrand::Rng, most: f32| {
        // Spread over decades, subnormal numbers and both ends included.
        match rng.u32(0..12) {
            0 => least,
            1 => most,
            2 => f32::from_bits(rng.u32(1..=16)),
            3 => f32::from_bits(rng.u32(1..=1 << 23)),
            _ => f32::from_bits(rng.u32(1..=most.to_bits())),
        }
    };
    let mut rng = fastrand::Rng::with_seed(5);
    for _ in 0..1_000_000 {
        let delta = any(&mut rng, f32::MAX);
        let xi = any(&mut rng, 1.0);
        let flux = any(&mut rng, f32::MAX);
        let roulette = Roulette::new(delta).unwrap();
        let scale = roulette.scale(flux, Xi::new(xi).unwrap());
        let exact = (f64::from(flux) / (f64::from(delta) * f64::from(xi))).sqrt();
        let (low, high) = (exact * (1.0 - 1e-15), exact * (1.0 + 1e-6));
        let normal = [f32::MIN_POSITIVE, f32::MAX].map(f64::from);
        let scaled = f64::from(scale);
        assert!(scaled >= low.min(normal[1]), "{flux:e} {delta:e} {xi:e}");
        assert!(scaled <= high.max(normal[0]), "{flux:e} {delta:e} {xi:e}");
        // To the bit what the plain formula gives where that has no subnormal number in it.
        let product = delta.sqrt() * xi.sqrt();
        if product >= f32::MIN_POSITIVE {
            let enlarged = flux.sqrt() / product * (1.0 + 3.5 * f32::EPSILON);
            assert_eq!(scale, enlarged.clamp(f32::MIN_POSITIVE, f32::MAX));
        }
    }
}
