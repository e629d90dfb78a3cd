//! How tight the bounds are: volumes over that of the paper's spheroid, on a grid of lobes.

use std::f64::consts::{FRAC_PI_2, PI};

use stochastic_light_culling::{
    Bounded, Direction, Ellipsoid, Ggx, GgxLobe, Incidence, Paper, Schlick, Tight, glam::Vec3,
};

use crate::reference::{Brdf, Fresnel, Masking, Smallest, Surface, Vector};

pub const ROUGHNESSES: [f32; 10] = [0.001, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5];
pub const DEGREES: [f32; 11] = [
    0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 75.0, 80.0, 85.0,
];
/// F0 of Schlick's factor; F0 = 1 is no factor at all.
pub const METALS: [f32; 4] = [1.0, 0.9, 0.7, 0.5];
pub const DIELECTRICS: [f32; 5] = [0.02, 0.03, 0.04, 0.06, 0.1];

/// A lobe of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub roughness: f32,
    pub degrees: f32,
    pub f0: f32,
}

/// Volumes over that of the paper's spheroid.
#[derive(Clone, Copy, Debug)]
pub struct Volumes {
    pub tight: f64,
    /// Of the smallest ellipsoid, to half a per cent.
    pub attainable: f64,
}

/// Every place for each of `reflectances`.
pub fn grid(reflectances: &[f32]) -> Vec<Place> {
    let mut places = Vec::new();
    for &f0 in reflectances {
        for roughness in ROUGHNESSES {
            for degrees in DEGREES {
                places.push(Place {
                    roughness,
                    degrees,
                    f0,
                });
            }
        }
    }
    places
}

impl Place {
    pub fn lobe(self) -> GgxLobe<Schlick> {
        let angle = self.degrees.to_radians();
        let incoming = Vec3::new(angle.sin(), 0.0, angle.cos());
        let incidence = Incidence {
            normal: Direction::Z,
            incoming: Direction::new(incoming).expect("a unit vector"),
        };
        GgxLobe::new(
            Ggx::new(self.roughness).expect("in range"),
            Schlick::new(self.f0).expect("in range"),
            incidence,
        )
    }

    pub fn measure(self) -> Volumes {
        let lobe = self.lobe();
        let spheroid = volume(&lobe.unit_bound_by(Paper).into());
        let incoming = Vector::from(*lobe.incoming()).unit();
        Volumes {
            tight: volume(&lobe.unit_bound_by(Tight)) / spheroid,
            attainable: self.smallest(incoming) / spheroid,
        }
    }

    /// The volume of the smallest ellipsoid around the isosurface.
    ///
    /// Its points along (ω_u, ω_v, ω_w), the first times α so that they are about as far in each.
    fn smallest(self, incoming: Vector) -> f64 {
        let brdf = Brdf::Ggx {
            roughness: self.roughness,
            fresnel: Fresnel::Schlick(self.f0),
            masking: Masking::HeightCorrelated,
        };
        let surface = Surface {
            normal: Vector([0.0, 0.0, 1.0]),
            incoming,
        };
        let alpha = f64::from(self.roughness);
        let along = surface.mirror();
        let across = Vector([0.0, 1.0, 0.0]);
        let aside = across.cross(along);
        let points = half_vectors(alpha)
            .map(|half| half * (2.0 * half.dot(incoming)) - incoming)
            .map(|outgoing| outgoing * surface.value(brdf, outgoing).sqrt())
            .map(|x| [alpha * along.dot(x), aside.dot(x), across.dot(x)])
            .chain([[0.0; 3]])
            .collect();
        Smallest::around(points, 1e-3).volume() / alpha
    }
}

/// Unit vectors about z as dense as the NDF's facets: ω_h ∝ (α m₁, α m₂, m₃).
fn half_vectors(alpha: f64) -> impl Iterator<Item = Vector> {
    (0..180 * 60).map(move |i| {
        let (phi, psi) = (
            PI * (f64::from(i / 60) + 0.5) / 180.0,
            FRAC_PI_2 * f64::from(i % 60) / 60.0,
        );
        let ((up, along), (across, rest)) = (phi.sin_cos(), psi.sin_cos());
        Vector([alpha * rest * along, alpha * across, rest * up]).unit()
    })
}

/// Over that of the unit sphere.
pub fn volume(ellipsoid: &Ellipsoid) -> f64 {
    let semi_axes = ellipsoid.semi_axes().to_array();
    semi_axes.into_iter().map(f64::from).product()
}
