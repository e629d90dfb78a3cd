//! What lights are made of, whatever their lobes, for tests that compare many at once with one by one; and a lobe
//! and a Fresnel factor as callers bring them.

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Bounded, Conductor, Direction, Fresnel, Ggx, GgxLobe,
    Incidence, Lobe, OwnBound, Sphere, Vpl, Xi, glam::Vec3,
};

use crate::generators::{self, Lit, log_uniform};

/// What a light is made of, whatever its lobe.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    pub position: Vec3,
    pub flux: f32,
    pub xi: Xi,
    pub lit: Lit,
    pub roughness: f32,
    /// An albedo, or a reflectance.
    pub share: f32,
}

impl Parts {
    pub fn vpl<L: Lobe>(&self, lobe: L) -> (Vpl<L>, Xi) {
        (Vpl::new(self.position, self.flux, lobe).unwrap(), self.xi)
    }

    pub fn incidence(&self) -> Incidence {
        let Lit {
            normal, incoming, ..
        } = self.lit;
        Incidence { normal, incoming }
    }

    pub fn ggx<F: Fresnel>(&self, fresnel: F) -> GgxLobe<F> {
        GgxLobe::new(Ggx::new(self.roughness).unwrap(), fresnel, self.incidence())
    }

    pub fn brushed<F: Fresnel>(&self, fresnel: F) -> AnisotropicGgxLobe<F> {
        // Now and then of the same roughness along and across.
        let across = if self.share > 0.9 {
            self.roughness
        } else {
            self.share.max(1e-3)
        };
        let ggx = AnisotropicGgx::new(self.roughness, across).unwrap();
        let tangent = Direction::new(self.lit.normal.any_orthonormal_vector()).unwrap();
        AnisotropicGgxLobe::new(ggx, fresnel, self.incidence(), tangent).unwrap()
    }

    pub fn conductor(&self) -> Conductor {
        Conductor::new(0.1 + self.share, 3.0).unwrap()
    }
}

/// Often ordinary, now and then out of all bounds: dark, blinding, lit from behind, and narrow.
pub fn parts() -> impl Strategy<Value = Parts> {
    let position = prop_oneof![
        20 => generators::position(),
        1 => Just(Vec3::splat(3e38)),
    ];
    let flux = prop_oneof![
        20 => log_uniform(1e-6, 1e6).prop_map(|x| x as f32),
        1 => Just(0.0),
        1 => Just(f32::from_bits(1)),
        1 => Just(1e-40),
        1 => Just(f32::MAX),
    ];
    let xi = prop_oneof![
        20 => log_uniform(2.3e-10, 1.0).prop_map(|x| x as f32),
        2 => log_uniform(1e-45, 2.3e-10).prop_map(|x| x as f32),
        1 => Just(1.0),
        1 => Just(f32::from_bits(1)),
    ];
    let lit = prop_oneof![
        20 => generators::lit(),
        1 => generators::lit().prop_map(|lit| Lit { incoming: -lit.incoming, ..lit }),
        1 => generators::lit().prop_map(|lit| Lit { incoming: lit.normal, ..lit }),
    ];
    let roughness = prop_oneof![
        20 => generators::roughness(),
        1 => Just(Ggx::MIN_ROUGHNESS),
    ];
    let share = prop_oneof![
        20 => 0.0..=1.0_f32,
        1 => Just(0.0),
        1 => Just(1.0),
        1 => Just(f32::from_bits(1)),
    ];
    (position, flux, xi, lit, roughness, share).prop_map(
        |(position, flux, xi, lit, roughness, share)| Parts {
            position,
            flux,
            xi: Xi::new(xi).unwrap(),
            lit,
            roughness,
            share,
        },
    )
}

/// A lobe that the crate does not know: a cosine within a window.
#[derive(Clone, Copy)]
pub struct Windowed(pub Direction);

impl Lobe for Windowed {
    fn value(&self, outgoing: Vec3) -> f32 {
        let cosine = self.0.dot(outgoing);
        if cosine > 0.5 { cosine } else { 0.0 }
    }
}

impl Bounded for Windowed {
    type Shape = Sphere;
    type Strategy = OwnBound;

    fn unit_bound(&self) -> Sphere {
        Sphere::new(*self.0 * 0.5, 0.9).unwrap()
    }
}

/// A Fresnel factor that the crate does not know.
#[derive(Clone, Copy)]
pub struct Coat(pub f32);

impl Fresnel for Coat {
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        self.0.max(0.04 + 0.96 * (1.0 - half_angle_cosine).powi(5))
    }
}
