//! Random inputs, and what follows from them in f64.

use std::f64::consts::PI;

use stochastic_light_culling::{Direction, Ggx, GgxLobe, Incidence, Seed, glam::Vec3};
use support::reference::{Brdf, Fresnel, Masking, Surface, Vector, smith_g1};

/// What the functions are given.
#[derive(Clone, Copy)]
pub struct Case {
    pub roughness: f32,
    pub normal: Direction,
    pub incoming: Direction,
    pub outgoing: Direction,
    pub position: Vec3,
    pub index: u32,
}

impl Case {
    /// With a roughness from 0.01 to 1, and both directions a degree above the surface or more.
    pub fn new(index: u32) -> Self {
        let random = |frame| 2.0 * Seed(1).frame(frame).hashed_xi(index).get() - 1.0;
        let vector = |first| Vec3::new(random(first), random(first + 1), random(first + 2));
        let direction = |vector| Direction::new(vector).expect("random vectors are not zero");
        let normal = direction(vector(0));
        let above = |first| {
            let other = direction(vector(first));
            let height = other.dot(*normal);
            direction(*other * height.signum() + 0.02 * *normal)
        };
        Self {
            roughness: 10_f32.powf(-1.0 + random(9)),
            normal,
            incoming: above(3),
            outgoing: above(6),
            position: 10.0 * vector(10),
            index,
        }
    }

    pub fn ggx(&self) -> Ggx {
        Ggx::new(self.roughness).expect("in range")
    }

    pub fn lobe<F: stochastic_light_culling::Fresnel>(&self, fresnel: F) -> GgxLobe<F> {
        GgxLobe::new(self.ggx(), fresnel, self.incidence())
    }

    pub fn incidence(&self) -> Incidence {
        Incidence {
            normal: self.normal,
            incoming: self.incoming,
        }
    }

    pub fn surface(&self) -> Surface {
        let [normal, incoming] = [self.normal, self.incoming].map(|v| Vector::from(*v).unit());
        Surface { normal, incoming }
    }

    pub fn cosines(&self) -> [f32; 2] {
        [self.incoming, self.outgoing].map(|direction| direction.dot(*self.normal))
    }

    pub fn exact_cosines(&self) -> [f64; 2] {
        let Surface { normal, incoming } = self.surface();
        [incoming, Vector::from(*self.outgoing).unit()].map(|direction| direction.dot(normal))
    }

    pub fn half(&self) -> Vector {
        (self.surface().incoming + Vector::from(*self.outgoing).unit()).unit()
    }

    pub fn half_cosine(&self) -> f64 {
        self.half().dot(self.surface().incoming)
    }

    pub fn value(&self, brdf: Brdf) -> f64 {
        self.surface()
            .value(brdf, Vector::from(*self.outgoing).unit())
    }

    pub fn brdf(&self, fresnel: Fresnel) -> Brdf {
        let masking = Masking::HeightCorrelated;
        Brdf::Ggx {
            roughness: self.roughness,
            fresnel,
            masking,
        }
    }

    /// r of the paper's bound for Φ/(δξ) = 1.
    pub fn radius(&self, fresnel: Fresnel) -> f64 {
        let mu = self.exact_cosines()[0];
        let reflected = fresnel.max_above_surface(mu) * smith_g1(self.roughness.into(), mu);
        (reflected / (4.0 * PI * mu)).sqrt()
    }
}
