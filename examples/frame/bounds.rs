//! Bounds of the lights' ranges, made ready for the tile test.

use clap::ValueEnum;
use rayon::prelude::*;
use stochastic_light_culling::{
    BatchShape, Camera, CameraSphere, GgxLobe, Interleave, LambertLobe, LightBatch, Roulette,
    Schlick, Spheroid, Stretch,
};

use super::Light;

pub type GlossyLight = Light<GgxLobe<Schlick>>;

/// What encloses a glossy light's range.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd, ValueEnum)]
pub enum BoundKind {
    /// The sphere around the light itself
    Sphere,
    /// The sphere around the spheroid
    Enclosing,
    /// The spheroid
    Spheroid,
    /// The ellipsoid with three different axes, in closed form
    Triaxial,
    /// The smallest ellipsoid, nearly, from a table
    Tight,
}

impl BoundKind {
    pub const ALL: [Self; 5] = [
        Self::Sphere,
        Self::Enclosing,
        Self::Spheroid,
        Self::Triaxial,
        Self::Tight,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Enclosing => "enclosing",
            Self::Spheroid => "spheroid",
            Self::Triaxial => "triaxial",
            Self::Tight => "tight",
        }
    }
}

pub fn spheroid(light: &GlossyLight, roulette: &Roulette, camera: &Camera) -> Option<Stretch> {
    Stretch::new(&range(light, roulette).into(), camera)
}

pub fn triaxial(light: &GlossyLight, roulette: &Roulette, camera: &Camera) -> Option<Stretch> {
    Stretch::new(&light.vpl.triaxial_bound(roulette, light.xi), camera)
}

pub fn tight(light: &GlossyLight, roulette: &Roulette, camera: &Camera) -> Option<Stretch> {
    Stretch::new(&light.vpl.tight_bound(roulette, light.xi), camera)
}

pub fn enclosing_sphere(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<CameraSphere> {
    CameraSphere::new(&range(light, roulette).enclosing_sphere(), camera)
}

pub fn sphere_at_light(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<CameraSphere> {
    CameraSphere::new(&range(light, roulette).sphere_at_focus(), camera)
}

pub fn diffuse_sphere(
    light: &Light<LambertLobe>,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<CameraSphere> {
    CameraSphere::new(&light.vpl.bound(roulette, light.xi), camera)
}

fn range(light: &GlossyLight, roulette: &Roulette) -> Spheroid {
    light.vpl.bound(roulette, light.xi)
}

/// The lights of each subregion, in the order of their numbers; those that reach nowhere are left out.
pub fn batches<L: Sync, T: BatchShape + Send>(
    lights: &[Light<L>],
    interleave: &Interleave,
    shape: impl Fn(&Light<L>) -> Option<T> + Sync,
) -> Vec<LightBatch<T>> {
    let count = lights.len() as u32;
    (0..interleave.subregions())
        .into_par_iter()
        .map(|subregion| {
            let mut batch = LightBatch::new();
            let numbers = (0..interleave.lights_in(subregion, count))
                .map(|local| interleave.join_light(subregion, local));
            batch.extend(
                numbers.filter_map(|number| Some((number, shape(&lights[number as usize])?))),
            );
            batch
        })
        .collect()
}
