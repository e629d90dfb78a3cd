//! From photons to the points that light others.

use stochastic_light_culling::{
    Direction, Error, Ggx, GgxLobe, LambertLobe, Schlick,
    glam::{FloatExt, Vec3},
};

use super::mesh::{Gloss, Material};
use super::photon::{Photon, Texel};

/// A point that sends on light: what becomes a virtual point light.
#[derive(Clone, Copy, Debug)]
pub struct LitPoint<L> {
    pub position: Vec3,
    pub normal: Direction,
    /// In W, for red, green and blue; the lobe is the same for the three.
    pub flux: Vec3,
    pub lobe: L,
    /// Which ray it was lit by.
    pub texel: Texel,
}

/// The lit points of a scene, by what they reflect.
pub struct LitPoints {
    pub glossy: Vec<LitPoint<GgxLobe<Schlick>>>,
    pub diffuse: Vec<LitPoint<LambertLobe>>,
    /// The mean area of surface that a point stands for.
    pub footprint: f32,
}

impl LitPoints {
    /// One glossy point, one diffuse point or both for each of `photons`, as its material reflects: with `ggx` and
    /// `fresnel`, unless it has its own.
    pub fn new(
        photons: &[Photon],
        materials: &[Material],
        ggx: Ggx,
        fresnel: Schlick,
    ) -> Result<Self, Error> {
        let mut points = Self {
            glossy: Vec::new(),
            diffuse: Vec::new(),
            footprint: 0.0,
        };
        for (i, photon) in photons.iter().enumerate() {
            let material = &materials[photon.material];
            let normal = photon.incidence.normal;
            points.footprint = (points.footprint).lerp(photon.footprint, 1.0 / (i + 1) as f32);
            if material.glossy {
                let gloss = material.gloss.unwrap_or(Gloss::new(ggx, fresnel));
                points.glossy.push(LitPoint {
                    position: photon.position,
                    normal,
                    flux: photon.flux * material.tint,
                    lobe: GgxLobe::new(gloss.light_ggx, gloss.fresnel, photon.incidence),
                    texel: photon.texel,
                });
            }
            let albedo = material.albedo.max_element();
            if albedo > 0.0 {
                points.diffuse.push(LitPoint {
                    position: photon.position,
                    normal,
                    flux: photon.flux * (material.albedo / albedo),
                    lobe: LambertLobe::new(albedo, normal)?,
                    texel: photon.texel,
                });
            }
        }
        Ok(points)
    }
}
