//! One combination of roughness, incidence, place and scale, and the lights drawn in it.

use fastrand::Rng;
use stochastic_light_culling::glam::Vec3;
use support::adversary::{Bound, Light, Reach, Tile, fresnel};
use support::reference::{Brdf, Masking};

use crate::tally::Tally;
use crate::{port, quantities};

pub const ALPHAS: [f32; 7] = [1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6];
pub const MUS: [f64; 6] = [1.0, 0.5, 0.1, 1e-2, 1e-4, 1e-6];
/// Of the light from the world's origin, over its range.
pub const DISTANCES: [f64; 5] = [0.0, 1.0, 1e2, 1e4, 1e6];
/// How far the light reaches at the peak of its lobe.
pub const RANGES: [f64; 5] = [1e-12, 1e-6, 1.0, 1e6, 1e12];

const LARGEST_RANGE: f64 = 1e12;

const TILES_PER_LIGHT: u64 = 8;

#[derive(Clone, Copy, Debug)]
pub struct Cell {
    pub alpha: f32,
    pub mu: f64,
    pub distance: f64,
    pub range: f64,
}

impl Cell {
    pub fn all() -> Vec<Self> {
        let mut cells = Vec::new();
        for alpha in ALPHAS {
            for mu in MUS {
                for distance in DISTANCES {
                    cells.extend(RANGES.map(|range| Self {
                        alpha,
                        mu,
                        distance,
                        range,
                    }));
                }
            }
        }
        cells
    }

    /// Draws `cases` lights and tiles that they reach.
    pub fn measure(&self, seed: u64, cases: u64) -> Tally {
        let mut rng = Rng::with_seed(seed);
        let mut tally = Tally::default();
        while tally.cases < cases {
            let light = self.draw(&mut rng);
            let bound = light.bound();
            let port = port::light(&light);
            for _ in 0..TILES_PER_LIGHT.min(cases - tally.cases) {
                let outgoing = Vec3::from_array(light.outgoing(&mut rng).0.map(|x| x.hi() as f32));
                tally.add_errors(quantities::errors(&light, port.as_ref(), &bound, outgoing));
                let Some(tile) = Tile::draw(&mut rng, &light) else {
                    continue;
                };
                tally.cases += 1;
                tally.lost += u64::from(!bound.that_lose(&tile).is_empty());
                if let Some(port) = port {
                    let lost = !port::touches(&port, &tile);
                    tally.port_lost.add(f64::from(u8::from(lost)));
                    tally.port_lost_cases += u64::from(lost);
                }
                self.add_inflation(&mut tally, &light, &bound, &tile);
            }
        }
        tally
    }

    fn draw(&self, rng: &mut Rng) -> Light {
        let masking = if rng.bool() {
            Masking::HeightCorrelated
        } else {
            Masking::Separable
        };
        let brdf = Brdf::Ggx {
            roughness: self.alpha,
            fresnel: fresnel(rng),
            masking,
        };
        Light::with(rng, brdf, self.mu, self.range, self.distance * self.range)
    }

    fn add_inflation(&self, tally: &mut Tally, light: &Light, bound: &Bound, tile: &Tile) {
        let (Some(r), Bound::Ggx { spheroid, .. }) = (quantities::exact_radius(light), *bound)
        else {
            return;
        };
        let Some(stretch) = spheroid.project(&tile.camera) else {
            return;
        };
        let (r, alpha) = (r.hi(), f64::from(self.alpha));
        let m = stretch.matrix().to_cols_array().map(f64::from);
        let tested = 1.0 / ((m[0] * m[4] - m[1] * m[3]) * m[8]);
        let inflation = tested / (r * r * r * (1.0 + alpha * alpha) / (2.0 * alpha)) - 1.0;
        // Where F is next to nothing at the peak, other directions reach out of the domain.
        if r / alpha > 10.0 * LARGEST_RANGE {
            return;
        }
        let eye = f64::from(tile.camera.to_camera_space(light.position).length());
        let farther = eye.max(f64::from(light.position.length()));
        if r >= 1e-3 * eye {
            tally.inflation_any_origin.add(inflation);
        }
        if r >= 1e-3 * farther {
            tally.inflation.add(inflation);
        }
        if r / alpha >= 1e-3 * farther {
            tally.inflation_by_reach.add(inflation);
        }
    }
}
