//! A frame's lights, bounded, culled and shaded, with the time that each step takes.

use std::time::Instant;

use stochastic_light_culling::{BoxTest, Camera, Error, LambertLobe, Lobe, Roulette};

use super::bounds::{self, BoundKind, GlossyLight};
use super::cull::Cullers;
use super::shade::{Shading, count_facing};
use super::{Frame, Light, Shaded, Tiles};

/// What one bound costs and what comes of it.
pub struct Measured {
    pub bound: BoundKind,
    pub refined: bool,
    pub bound_ms: f64,
    pub cull_ms: f64,
    pub shade_ms: f64,
    pub shaded: Shaded,
}

/// What to cull by.
#[derive(Clone, Copy)]
pub struct Tiling<'a> {
    pub tiles: &'a Tiles,
    /// Whether tiles are single pixels: a light that touches one is inside the bound there, or nearly.
    pub refined: bool,
}

/// The frame by its glossy lights, bounded by `bound`, with each of `tilings`.
pub fn measure_glossy(
    frame: &Frame,
    tilings: &[Tiling],
    camera: &Camera,
    lights: &[GlossyLight],
    bound: BoundKind,
    done: impl Fn() + Sync,
) -> Result<Vec<Measured>, Error> {
    let frame = (frame, tilings, camera);
    match bound {
        BoundKind::Sphere => measure(frame, lights, bound, bounds::sphere_at_light, done),
        BoundKind::Enclosing => measure(frame, lights, bound, bounds::enclosing_sphere, done),
        BoundKind::Spheroid => measure(frame, lights, bound, bounds::spheroid, done),
        BoundKind::Triaxial => measure(frame, lights, bound, bounds::triaxial, done),
        BoundKind::Tight => measure(frame, lights, bound, bounds::tight, done),
    }
}

/// The frame by its diffuse lights, with each of `tilings`.
pub fn measure_diffuse(
    frame: &Frame,
    tilings: &[Tiling],
    camera: &Camera,
    lights: &[Light<LambertLobe>],
    done: impl Fn() + Sync,
) -> Result<Vec<Measured>, Error> {
    let frame = (frame, tilings, camera);
    measure(
        frame,
        lights,
        BoundKind::Sphere,
        bounds::diffuse_sphere,
        done,
    )
}

fn measure<L: Lobe + Copy + Send + Sync, T: BoxTest + Send + Sync>(
    (frame, tilings, camera): (&Frame, &[Tiling], &Camera),
    lights: &[Light<L>],
    bound: BoundKind,
    shape: fn(&Light<L>, &Roulette, &Camera) -> Option<T>,
    done: impl Fn() + Sync,
) -> Result<Vec<Measured>, Error> {
    let shape = |light: &_| shape(light, &frame.roulette, camera);
    let (batches, bound_ms) = timed(|| bounds::batches(lights, &frame.interleave, shape));
    let measured = |tiling: &Tiling| {
        let subregions = tiling.tiles.subregions();
        let count = subregions.len();
        // Enough to keep all threads busy, but not all: their lists would be most of the memory in use.
        let group = (2 * rayon::current_num_threads()).min(count.div_ceil(2));
        let mut cullers = Cullers::new(group);
        let mut shaded = Shaded::black(frame.surfaces.surfaces.len());
        let (shading, mut shade_ms) = timed(|| Shading::new(frame, lights));
        let mut cull_ms = 0.0;
        for start in (0..count).step_by(group) {
            let end = (start + group).min(count);
            let mut cull = || cullers.cull(&subregions[start..end], &batches[start..end]);
            // The first time makes room for the lists. Like a later frame, the second does not.
            cull()?;
            let (culled, ms) = timed(cull);
            culled?;
            cull_ms += ms;
            let list_of = |pixel, depth| {
                let place = tiling.tiles.place_of(pixel, depth)?;
                Some(cullers.lists[place.subregion - start].of(place.tile, place.interval))
            };
            let group = start as u32..end as u32;
            let shade = || {
                let (group, by_list) = (group.clone(), !tiling.refined);
                shading.shade_subregions(frame, group, by_list, list_of, &mut shaded, &done);
            };
            shade_ms += timed(shade).1;
            if tiling.refined {
                count_facing(frame, group, lights, list_of, &mut shaded);
            }
        }
        Ok(Measured {
            bound,
            refined: tiling.refined,
            bound_ms,
            cull_ms,
            shade_ms,
            shaded,
        })
    };
    tilings.iter().map(measured).collect()
}

/// What `step` gives, and the milliseconds it takes.
pub fn timed<T>(step: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = step();
    (result, 1e3 * start.elapsed().as_secs_f64())
}
