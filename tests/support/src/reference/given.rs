//! The crate's own Fresnel factors by the model's parameters, as one type; and a caller's own masking.

use stochastic_light_culling as crate_under_test;
use stochastic_light_culling::{Conductor, Dielectric, Error, FresnelMajorant, NoFresnel, Schlick};

use super::Fresnel;

#[derive(Clone, Copy, Debug)]
pub enum GivenFresnel {
    None,
    Schlick(Schlick),
    Dielectric(Dielectric),
    Conductor(Conductor),
}

impl TryFrom<Fresnel> for GivenFresnel {
    type Error = Error;

    fn try_from(fresnel: Fresnel) -> Result<Self, Error> {
        Ok(match fresnel {
            Fresnel::None => Self::None,
            Fresnel::Schlick(f0) => Self::Schlick(Schlick::new(f0)?),
            Fresnel::Dielectric(eta) => Self::Dielectric(Dielectric::new(eta)?),
            Fresnel::Conductor(eta, kappa) => Self::Conductor(Conductor::new(eta, kappa)?),
        })
    }
}

impl crate_under_test::Fresnel for GivenFresnel {
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        match self {
            Self::None => NoFresnel.reflectance(half_angle_cosine),
            Self::Schlick(fresnel) => fresnel.reflectance(half_angle_cosine),
            Self::Dielectric(fresnel) => fresnel.reflectance(half_angle_cosine),
            Self::Conductor(fresnel) => fresnel.reflectance(half_angle_cosine),
        }
    }

    fn maximum(&self, smallest_cosine: f32) -> f32 {
        match self {
            Self::None => NoFresnel.maximum(smallest_cosine),
            Self::Schlick(fresnel) => fresnel.maximum(smallest_cosine),
            Self::Dielectric(fresnel) => fresnel.maximum(smallest_cosine),
            Self::Conductor(fresnel) => fresnel.maximum(smallest_cosine),
        }
    }

    fn critical_cosine(&self) -> f32 {
        match self {
            Self::None => NoFresnel.critical_cosine(),
            Self::Schlick(fresnel) => fresnel.critical_cosine(),
            Self::Dielectric(fresnel) => fresnel.critical_cosine(),
            Self::Conductor(fresnel) => fresnel.critical_cosine(),
        }
    }

    fn majorant(&self) -> FresnelMajorant {
        match self {
            Self::None => NoFresnel.majorant(),
            Self::Schlick(fresnel) => fresnel.majorant(),
            Self::Dielectric(fresnel) => fresnel.majorant(),
            Self::Conductor(fresnel) => fresnel.majorant(),
        }
    }
}

/// No facet shadows another: G2 = G1(μ_i).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaskedAlone;

impl crate_under_test::MaskingShadowing for MaskedAlone {
    fn over_four_incident_cosines(cosine: f32, root: f32, _: f32, _: f32) -> f32 {
        0.5 / (cosine + root)
    }
}
