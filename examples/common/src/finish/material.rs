//! What a surface reflects to the eye.

use std::f32::consts::FRAC_1_PI;

use stochastic_light_culling::{Direction, Ggx, GgxLobe, Incidence, Lobe, Schlick, glam::Vec3};

use crate::scene::{Gloss, Material};

/// A surface, seen from one direction. Since a BRDF is reciprocal, its lobe is that of light from the eye.
pub struct Reflector {
    pub normal: Direction,
    pub albedo: Vec3,
    pub tint: Vec3,
    pub lobe: Option<GgxLobe<Schlick>>,
}

impl Reflector {
    /// `gloss` is that of glossy materials without one of their own.
    pub fn new(material: &Material, gloss: Gloss, normal: Direction, to_eye: Direction) -> Self {
        let Gloss { ggx, fresnel, .. } = material.gloss.unwrap_or(gloss);
        let incoming = to_eye;
        let incidence = Incidence { normal, incoming };
        Self {
            normal,
            albedo: material.true_albedo(),
            tint: material.tint,
            lobe: material
                .glossy
                .then(|| GgxLobe::new(ggx, fresnel, incidence)),
        }
    }

    /// The same, no smoother than `ggx`: a light that is met by chance is no spark then.
    pub fn smoothed(self, ggx: Ggx) -> Self {
        let rougher = |lobe: GgxLobe<Schlick>| {
            if lobe.ggx().roughness() < ggx.roughness() {
                GgxLobe::new(ggx, *lobe.fresnel(), lobe.incidence())
            } else {
                lobe
            }
        };
        Self {
            lobe: self.lobe.map(rougher),
            ..self
        }
    }

    /// f·cos θ towards the unit direction `to_light`.
    pub fn value(&self, to_light: Vec3) -> Vec3 {
        let cosine = self.normal.dot(to_light).max(0.0);
        let glossy = self.lobe.map_or(0.0, |lobe| lobe.value(to_light));
        self.albedo * (FRAC_1_PI * cosine) + self.tint * glossy
    }
}
