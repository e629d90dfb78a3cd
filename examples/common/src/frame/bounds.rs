//! Bounds of the lights' ranges, made ready for the tile test.

use clap::ValueEnum;
use rayon::prelude::*;
use stochastic_light_culling::{
    Camera, GgxLobe, Interleave, LambertLobe, LightBatch, Paper, Projected, ProjectedEllipsoid,
    ProjectedSphere, Roulette, Schlick, Spheroid, Tight, Triaxial,
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

pub fn spheroid(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<ProjectedEllipsoid> {
    range(light, roulette).project(camera)
}

pub fn triaxial(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<ProjectedEllipsoid> {
    light
        .vpl
        .bound_by(Triaxial, roulette, light.xi)
        .project(camera)
}

pub fn tight(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<ProjectedEllipsoid> {
    light
        .vpl
        .bound_by(Tight, roulette, light.xi)
        .project(camera)
}

pub fn enclosing_sphere(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<ProjectedSphere> {
    range(light, roulette).enclosing_sphere().project(camera)
}

pub fn sphere_at_light(
    light: &GlossyLight,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<ProjectedSphere> {
    range(light, roulette).sphere_at_focus().project(camera)
}

pub fn diffuse_sphere(
    light: &Light<LambertLobe>,
    roulette: &Roulette,
    camera: &Camera,
) -> Option<ProjectedSphere> {
    light.vpl.bound(roulette, light.xi).project(camera)
}

fn range(light: &GlossyLight, roulette: &Roulette) -> Spheroid {
    light.vpl.bound_by(Paper, roulette, light.xi)
}

/// The lights of each subregion, by index; those that reach nowhere are left out.
pub fn batches<L: Sync, T: Projected + Send>(
    lights: &[Light<L>],
    interleave: &Interleave,
    shape: impl Fn(&Light<L>) -> Option<T> + Sync,
) -> Vec<LightBatch<T>> {
    let count = lights.len() as u32;
    (0..interleave.subregions())
        .into_par_iter()
        .map(|subregion| {
            let mut batch = LightBatch::new();
            let indices = (0..interleave.lights_in(subregion, count))
                .map(|local| interleave.join_light(subregion, local));
            batch.extend(indices.filter_map(|i| Some((i, shape(&lights[i as usize])?))));
            batch
        })
        .collect()
}
