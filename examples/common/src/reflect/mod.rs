//! A frame by what its surfaces reflect to the eye: receivers, lights that are culled with or without knowing of them, and
//! shading by the lists.

mod even;
mod lists;
mod palette;
mod receivers;
mod shade;

pub use even::Shown;
pub use lists::{Decided, Known, Roulettes};
pub use palette::{Palette, Sums, White};
pub use receivers::{Receiving, receivers_of};

use stochastic_light_culling::{Camera, Error, LightLists, Receiver, glam::Vec3};

use crate::frame::{Frame, GlossyLight, Tiles};

/// A frame by its glossy lights, and the time that each step takes.
pub struct Reflected {
    /// Batches of lights, and bounds or the clusters of receivers of tiles.
    pub build_ms: f64,
    pub cull_ms: f64,
    pub shade_ms: f64,
    /// Of each pixel, row by row, to the eye.
    pub radiance: Vec<Vec3>,
    /// The lights in the list of each pixel, and those of them that add something.
    pub evaluated: Vec<u32>,
    pub contributing: Vec<u32>,
    /// What tiles show. Nothing where lists are by bounds.
    pub shown: Shown,
}

impl Reflected {
    pub fn ms(&self) -> f64 {
        self.build_ms + self.cull_ms + self.shade_ms
    }

    /// An image of `count` pixels without light.
    fn black(count: usize, tiles: &Tiles) -> Self {
        Self {
            build_ms: 0.0,
            cull_ms: 0.0,
            shade_ms: 0.0,
            radiance: vec![Vec3::ZERO; count],
            evaluated: vec![0; count],
            contributing: vec![0; count],
            shown: Shown::nothing(tiles),
        }
    }
}

/// What all ways to light a frame share.
pub struct Scenery<'a, R, P> {
    pub frame: &'a Frame<'a>,
    pub camera: &'a Camera,
    pub lights: &'a [GlossyLight],
    /// For each pixel, none for sky.
    pub receivers: &'a [Option<Receiver<R>>],
    pub palette: P,
    /// What tiles showed with random numbers of another seed, if they have a δ in proportion to it.
    pub before: Option<&'a Shown>,
}

/// What to cull by.
#[derive(Clone, Copy)]
pub struct Division<'a> {
    pub tiles: &'a Tiles,
    /// In how many parts a tile is divided, in each direction, if lights are tested against receivers.
    pub parts: u32,
}

impl<R: Receiving, P: Palette> Scenery<'_, R, P> {
    /// Lights the frame.
    pub fn light(&self, roulettes: Roulettes, division: Division) -> Result<Reflected, Error> {
        lists::light(self, roulettes, division)
    }

    /// For each subregion and each tile, the lights that a receiver of it may accept by what it reflects. A light has the
    /// index of its turn in the subregion.
    pub fn lights_to_accept(&self, division: Division) -> Result<Vec<LightLists>, Error> {
        lists::lights_to_accept(self, division)
    }
}
