//! Lobes that are no BRDFs of the model.

use std::f64::consts::TAU;

use stochastic_light_culling::{Bounded, Direction, PhongLobe};
use support::reference::{Shape, Vector};

/// The bound of a lobe for unit scale, and its value towards a unit vector.
pub struct OtherLobe {
    pub name: &'static str,
    pub bound: Shape,
    pub value: Box<dyn Fn(Vector) -> f64>,
}

impl OtherLobe {
    fn new<L: Bounded<Shape: Into<Shape>>>(
        name: &'static str,
        lobe: &L,
        value: impl Fn(Vector) -> f64 + 'static,
    ) -> Self {
        Self {
            name,
            bound: lobe.unit_bound().into(),
            value: Box::new(value),
        }
    }
}

/// Each about `axis`, as strong as `share` of [0, 1] says and as narrow as `exponent` of [0, 2²⁰].
pub fn other_lobes(axis: Direction, share: f32, exponent: f32) -> Vec<OtherLobe> {
    let (u, s, n) = (
        Vector::from(*axis).unit(),
        f64::from(share),
        f64::from(exponent),
    );
    let spotlight = PhongLobe::about(share, exponent, axis).unwrap();
    let of_spotlight = move |w: Vector| match w.dot(u) {
        cosine if cosine <= 0.0 => 0.0,
        cosine => s * (n + 1.0) / TAU * cosine.powf(n),
    };
    vec![OtherLobe::new("spotlight", &spotlight, of_spotlight)]
}
