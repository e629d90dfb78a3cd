//! What importance needs to know of a receiver.

use stochastic_light_culling::{GgxLobe, LambertLobe, Lobe, LobeSum, Schlick, glam::Vec3};

/// A diffuse part and a glossy part of what a surface reflects to the eye.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    pub normal: Vec3,
    pub to_eye: Vec3,
    /// The albedo over π.
    pub diffuse: f32,
    /// The factor of the glossy part: zero without one.
    pub glossy: f32,
    pub alpha: f32,
    pub f0: f32,
}

/// A lobe of a receiver that has a [`Profile`].
pub trait Profiled: Lobe + Clone + Sync {
    fn profile(&self) -> Profile;
}

impl Profiled for LambertLobe {
    fn profile(&self) -> Profile {
        let normal = *self.normal();
        Profile {
            normal,
            to_eye: normal,
            diffuse: self.albedo() * std::f32::consts::FRAC_1_PI,
            glossy: 0.0,
            alpha: 1.0,
            f0: 0.0,
        }
    }
}

impl Profiled for GgxLobe<Schlick> {
    fn profile(&self) -> Profile {
        Profile {
            normal: *self.normal(),
            to_eye: *self.incoming(),
            diffuse: 0.0,
            glossy: 1.0,
            alpha: self.ggx().roughness(),
            f0: self.fresnel().f0(),
        }
    }
}

/// A coat over a diffuse base.
impl Profiled for LobeSum<LambertLobe, GgxLobe<Schlick>> {
    fn profile(&self) -> Profile {
        let ((base, coat), [of_base, of_coat]) = (self.lobes(), self.weights());
        Profile {
            diffuse: of_base * base.profile().diffuse,
            glossy: of_coat,
            ..coat.profile()
        }
    }
}
