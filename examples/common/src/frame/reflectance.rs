//! How much of the light glossy surfaces reflect.

use std::collections::{HashMap, hash_map::Entry};
use std::f64::consts::TAU;

use stochastic_light_culling::{
    Direction, Error, Ggx, GgxLobe, Incidence, Lobe, Schlick, Seed,
    glam::{DVec3, Vec3},
};

/// The share of the light that surfaces reflect, each roughness and F0 computed once.
#[derive(Default)]
pub struct Reflectances(HashMap<[u32; 2], Reflectance>);

impl Reflectances {
    /// What `lobe` reflects of the light that makes it.
    pub fn of(&mut self, lobe: &GgxLobe<Schlick>) -> Result<f32, Error> {
        let key = [lobe.ggx().roughness(), lobe.fresnel().f0()].map(f32::to_bits);
        let cosine = lobe.incident_cosine();
        Ok(match self.0.entry(key) {
            Entry::Occupied(known) => known.get().at(cosine),
            Entry::Vacant(free) => {
                let reflectance = Reflectance::new(lobe.ggx(), *lobe.fresnel())?;
                free.insert(reflectance).at(cosine)
            }
        })
    }
}

/// The share of the light that a GGX surface reflects, the integral of its lobe, by the angle of incidence.
struct Reflectance {
    /// At cosines from 0 to 1, evenly spaced.
    knots: Vec<f32>,
}

const INTERVALS: u32 = 64;
const SAMPLES: u32 = 1024;

impl Reflectance {
    fn new(ggx: Ggx, fresnel: Schlick) -> Result<Self, Error> {
        let knot = |i: u32| -> Result<f32, Error> {
            // Not quite grazing, where there is no lobe.
            let cosine = (f64::from(i) / f64::from(INTERVALS)).max(1e-3);
            let sine = (1.0 - cosine * cosine).sqrt();
            let incidence = Incidence {
                normal: Direction::Z,
                incoming: Direction::new(Vec3::new(sine as f32, 0.0, cosine as f32))?,
            };
            let integral = integral(&GgxLobe::new(ggx, fresnel, incidence));
            Ok((integral as f32).min(1.0))
        };
        Ok(Self {
            knots: (0..=INTERVALS).map(knot).collect::<Result<_, _>>()?,
        })
    }

    fn at(&self, cosine: f32) -> f32 {
        let place = cosine.clamp(0.0, 1.0) * INTERVALS as f32;
        let first = (place as usize).min(INTERVALS as usize - 1);
        let share = place - first as f32;
        self.knots[first] * (1.0 - share) + self.knots[first + 1] * share
    }
}

/// The integral of a lobe about the z axis, by half vectors that are drawn as the microsurface has them.
fn integral(lobe: &GgxLobe<Schlick>) -> f64 {
    let alpha = f64::from(lobe.ggx().roughness());
    let incoming = lobe.incoming().as_dvec3();
    let mut sum = 0.0;
    for i in 0..SAMPLES {
        let [u, v] = Seed(0).frame(0).point(i).map(f64::from);
        // tan²θ = α²u/(1−u), of the density D cosθ.
        let squared_slope = alpha * alpha * u / (1.0 - u);
        let cosine = 1.0 / (1.0 + squared_slope).sqrt();
        let sine = squared_slope.sqrt() * cosine;
        let (turn_sine, turn_cosine) = (TAU * v).sin_cos();
        let half = DVec3::new(sine * turn_cosine, sine * turn_sine, cosine);
        let half_cosine = incoming.dot(half);
        let outgoing = 2.0 * half_cosine * half - incoming;
        if half_cosine > 0.0 && outgoing.z > 0.0 {
            let ndf = lobe.ggx().ndf_at(half.as_vec3(), Vec3::Z);
            let density = f64::from(ndf) * cosine / (4.0 * half_cosine);
            sum += f64::from(lobe.value(outgoing.as_vec3())) / density;
        }
    }
    sum / f64::from(SAMPLES)
}
