//! What the surface of each pixel reflects to the eye.

use rayon::prelude::*;
use stochastic_light_culling::{Camera, Direction, Incidence, Receiver, ReceiverLobe, glam::Vec3};

use crate::scene::SurfaceBuffer;

/// A lobe that surfaces of a frame may have.
pub trait Receiving: ReceiverLobe + Send + Sync {}

impl<R: ReceiverLobe + Send + Sync> Receiving for R {}

/// The receivers of all pixels, with the lobes that `lobe_of` gives for a pixel's place and light from the eye; none
/// for sky.
pub fn receivers_of<R: Send>(
    surfaces: &SurfaceBuffer,
    camera: &Camera,
    lobe_of: impl Fn(usize, Incidence) -> R + Sync,
) -> Vec<Option<Receiver<R>>> {
    let eye = camera.to_world_space(Vec3::ZERO);
    let receiver = |(pixel, surface): (usize, &crate::scene::Surface)| {
        if surface.is_sky() {
            return None;
        }
        let incidence = Incidence {
            normal: Direction::new(surface.normal).ok()?,
            incoming: Direction::new(eye - surface.position).ok()?,
        };
        Some(Receiver {
            position: surface.position,
            lobe: lobe_of(pixel, incidence),
        })
    };
    let surfaces = surfaces.surfaces.par_iter().enumerate();
    surfaces.map(receiver).collect()
}
