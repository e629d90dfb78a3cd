//! What the floor and all else are made of.

use common::reflect::{Receiving, receivers_of};
use common::sampling::Profiled;
use stochastic_light_culling::{Direction, GgxLobe, Incidence, LambertLobe, LobeSum, Receiver};

use super::super::F0;
use crate::subject::{Gloss, Subject};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    Lambert,
    /// Metal of this roughness.
    Metal(f32),
    /// A dielectric over a diffuse base.
    Coated,
}

/// What is done with receivers of any lobe.
pub trait Visitor {
    type Output;

    fn visit<R: Receiving + Profiled>(self, receivers: &[Option<Receiver<R>>]) -> Self::Output;
}

/// Of the dielectric.
const COAT: [f32; 2] = [0.06, 0.04];
/// What it covers.
const BASE: f32 = 0.5;
const ALBEDO: f32 = 0.8;

impl Material {
    pub const ALL: [Self; 7] = [
        Self::Lambert,
        Self::Metal(0.5),
        Self::Metal(0.25),
        Self::Metal(0.12),
        Self::Metal(0.06),
        Self::Metal(0.03),
        Self::Coated,
    ];

    pub fn name(self) -> String {
        match self {
            Self::Lambert => "Lambert".into(),
            Self::Metal(roughness) => format!("GGX {roughness}"),
            Self::Coated => format!("diffuse + dielectric {}", COAT[0]),
        }
    }

    /// Whether its curves are drawn; all are in the tables.
    pub fn is_drawn(self) -> bool {
        [
            Self::Lambert,
            Self::Metal(0.25),
            Self::Metal(0.06),
            Self::Coated,
        ]
        .contains(&self)
    }

    /// Where it is among roughnesses, if it has one.
    pub fn place(self) -> Option<f64> {
        match self {
            Self::Lambert => Some(1.0),
            Self::Metal(roughness) => Some(roughness.into()),
            Self::Coated => None,
        }
    }

    /// What `visitor` does with the receivers of all pixels.
    pub fn visit<V: Visitor>(self, subject: &Subject, visitor: V) -> V::Output {
        let lambert = |albedo: f32, normal: Direction| {
            LambertLobe::new(albedo, normal).expect("a share of the light")
        };
        let glossy = |roughness: f32, f0: f32| {
            let Gloss { ggx, fresnel } = Gloss::new(roughness, f0);
            move |incidence: Incidence| GgxLobe::new(ggx, fresnel, incidence)
        };
        let (surfaces, camera) = (&subject.surfaces, &subject.camera);
        match self {
            Self::Lambert => {
                let lobe = |_, incidence: Incidence| lambert(ALBEDO, incidence.normal);
                visitor.visit(&receivers_of(surfaces, camera, lobe))
            }
            Self::Metal(roughness) => {
                let lobe = glossy(roughness, F0);
                visitor.visit(&receivers_of(surfaces, camera, |_, incidence| {
                    lobe(incidence)
                }))
            }
            Self::Coated => {
                let [roughness, f0] = COAT;
                let coat = glossy(roughness, f0);
                let lobe = |_, incidence: Incidence| {
                    LobeSum::new(lambert(BASE, incidence.normal), coat(incidence))
                };
                visitor.visit(&receivers_of(surfaces, camera, lobe))
            }
        }
    }
}
