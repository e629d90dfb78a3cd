//! A frame's lights, bounded, culled and shaded, with the time that each step takes.

use std::time::Instant;

use stochastic_light_culling::{Camera, LambertLobe, Lobe, TileTest};

use super::bounds::{self, BoundKind, GlossyLight};
use super::cull::cull;
use super::shade::shade;
use super::{Frame, Light, Shaded};

/// What one bound costs and what comes of it.
pub struct Measured {
    pub bound: BoundKind,
    pub bound_ms: f64,
    pub cull_ms: f64,
    pub shade_ms: f64,
    pub shaded: Shaded,
}

/// The frame by its glossy lights, bounded by `bound`.
pub fn measure_glossy(
    frame: &Frame,
    camera: &Camera,
    lights: &[GlossyLight],
    bound: BoundKind,
    done: impl Fn() + Sync,
) -> Measured {
    let roulette = &frame.roulette;
    match bound {
        BoundKind::Sphere => {
            let test = |light: &_| bounds::sphere_at_light(light, roulette, camera);
            measure(frame, lights, bound, test, done)
        }
        BoundKind::Enclosing => {
            let test = |light: &_| bounds::enclosing_sphere(light, roulette, camera);
            measure(frame, lights, bound, test, done)
        }
        BoundKind::Spheroid => {
            let test = |light: &_| bounds::spheroid(light, roulette, camera);
            measure(frame, lights, bound, test, done)
        }
        BoundKind::Tight => {
            let test = |light: &_| bounds::tight(light, roulette, camera);
            measure(frame, lights, bound, test, done)
        }
    }
}

/// The frame by its diffuse lights.
pub fn measure_diffuse(
    frame: &Frame,
    camera: &Camera,
    lights: &[Light<LambertLobe>],
    done: impl Fn() + Sync,
) -> Measured {
    let test = |light: &_| bounds::diffuse_sphere(light, &frame.roulette, camera);
    measure(frame, lights, BoundKind::Sphere, test, done)
}

fn measure<L: Lobe + Sync, T: TileTest + Send + Sync>(
    frame: &Frame,
    lights: &[Light<L>],
    bound: BoundKind,
    test: impl Fn(&Light<L>) -> Option<T> + Sync,
    done: impl Fn() + Sync,
) -> Measured {
    let (candidates, bound_ms) = timed(|| bounds::candidates(lights, &frame.interleave, test));
    let (lists, cull_ms) = timed(|| cull(frame.tiles, &candidates));
    let (shaded, shade_ms) = timed(|| shade(frame, lights, &lists, done));
    Measured {
        bound,
        bound_ms,
        cull_ms,
        shade_ms,
        shaded,
    }
}

/// What `step` gives, and the milliseconds it takes.
pub fn timed<T>(step: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = step();
    (result, 1e3 * start.elapsed().as_secs_f64())
}
