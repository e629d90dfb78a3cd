//! The numbers of lobes, drawn from the whole domain, most often from its edges.

use std::f32::consts::PI;
use std::f64::consts::{FRAC_PI_2, TAU};

use fastrand::Rng;
use stochastic_light_culling::{Direction, Incidence, LtcLobe};

use super::{log_uniform, up_to_one};
use crate::reference::{Fresnel, Masking};

/// α_x and α_y: apart, nearly equal, and equal.
pub fn two_roughnesses(rng: &mut Rng) -> [f32; 2] {
    let alpha = up_to_one(rng, 1e-6);
    let other = match rng.u8(0..6) {
        0 => alpha,
        1 => (alpha * (1.0 - log_uniform(rng, 1e-7, 0.1))).max(1e-6),
        _ => up_to_one(rng, 1e-6),
    };
    let pair = if rng.bool() {
        [alpha, other]
    } else {
        [other, alpha]
    };
    pair.map(|alpha| alpha as f32)
}

/// Inner and outer half angle of a spot light: from 10⁻³ to π, hard edges and none among them.
pub fn cone_angles(rng: &mut Rng) -> [f32; 2] {
    let outer = match rng.u8(0..6) {
        0 => PI,
        1 => FRAC_PI_2 as f32,
        2 => log_uniform(rng, 1e-3, 3.0) as f32,
        // About the angle from which on light is emitted backwards.
        3 => (FRAC_PI_2 + log_uniform(rng, 1e-7, 1.0)) as f32,
        _ => PI * rng.f32(),
    };
    let inner = match rng.u8(0..6) {
        0 => outer,
        1 => 0.0,
        2 => outer * (1.0 - log_uniform(rng, 1e-7, 0.5) as f32),
        _ => outer * rng.f32(),
    };
    [inner.min(outer), outer]
}

pub fn masking(rng: &mut Rng) -> Masking {
    match rng.u8(0..5) {
        0 | 1 => Masking::HeightCorrelated,
        2 | 3 => Masking::Separable,
        _ => Masking::MaskedAlone,
    }
}

pub fn fresnel(rng: &mut Rng) -> Fresnel {
    let index = |rng: &mut Rng| match rng.u8(0..4) {
        0 => 1.0 + log_uniform(rng, 1e-7, 1.0),
        1 => 1.0 - log_uniform(rng, 1e-7, 0.9),
        2 => log_uniform(rng, 1e-3, 1e3),
        _ => 0.3 + 3.0 * rng.f64(),
    };
    match rng.u8(0..8) {
        0 => Fresnel::Dielectric(index(rng) as f32),
        1 => Fresnel::Conductor(index(rng) as f32, log_uniform(rng, 1e-4, 1e2) as f32),
        2 => Fresnel::Schlick(rng.f32()),
        3 => Fresnel::Schlick(0.0),
        _ => Fresnel::None,
    }
}

/// Any sharpness of an SG.
pub fn sharpness(rng: &mut Rng) -> f32 {
    let sharpness = match rng.u8(0..8) {
        0 => 0.0,
        1 => 4_194_304.0,
        2 | 3 => 20.0 * rng.f64(),
        _ => log_uniform(rng, 1e-6, 4_194_304.0),
    };
    sharpness as f32
}

/// Any exponent of Phong's that is a multiple of 1/16, as the exact model needs it.
pub fn exponent(rng: &mut Rng) -> f32 {
    let exponent = match rng.u8(0..8) {
        0 => 0.0,
        1 => 1_048_576.0,
        2 | 3 => 4.0 * rng.f64(),
        _ => log_uniform(rng, 0.06, 1_048_576.0),
    };
    ((16.0 * exponent).round() / 16.0) as f32
}

/// The elements of a matrix that [`LtcLobe::with_matrix`] accepts: rows over seven decades, at angles down to 2·10⁻⁴ of
/// each other.
pub fn matrix(rng: &mut Rng) -> [f32; 4] {
    loop {
        let (angle, between) = (rng.f64() * TAU, up_to_one(rng, 2e-4) * FRAC_PI_2);
        let [long, short] = [(); 2].map(|()| log_uniform(rng, 0.1, 1e5));
        let [first, third] = [(angle, long), (angle + between, short)]
            .map(|(angle, length)| [angle.cos() * length, angle.sin() * length]);
        let elements = [first[0], first[1], third[0], third[1]].map(|x| x as f32);
        if LtcLobe::with_matrix(elements, 1.0, Incidence::head_on(Direction::Z)).is_ok() {
            return elements;
        }
    }
}
