//! Points that a light reaches, exactly, and the thinnest tiles around them: drawn from the whole
//! domain, most often from its edges.

mod cluster;
mod draw;
mod light;
mod tile;

pub use cluster::ClusterLight;
pub use draw::{cone_angles, exponent, fresnel, sharpness};
pub use light::Light;
pub use tile::{Drawn, Tile};

use fastrand::Rng;
use stochastic_light_culling::{
    Direction, Ellipsoid, Projection, Sphere, Spheroid, TileTest, glam::Vec3,
};
use twofloat::TwoFloat;

use crate::reference::Vector;
use crate::reference::exact::Exact;

/// A light in one frame, as far as tiles are drawn around it.
pub trait Reach {
    fn position(&self) -> Vec3;

    /// A direction in which a bound is likely to fail.
    fn outgoing(&self, rng: &mut Rng) -> Exact;

    /// The distance up to which it is accepted in a unit direction.
    fn reach(&self, outgoing: Exact) -> TwoFloat;
}

/// What the crate encloses a light's range by.
#[derive(Clone, Copy, Debug)]
pub enum Bound {
    Ggx {
        spheroid: Spheroid,
        triaxial: Ellipsoid,
        tight: Ellipsoid,
    },
    Anisotropic(Ellipsoid),
    Phong(Ellipsoid),
    SphericalGaussian {
        focal: Spheroid,
        tight: Ellipsoid,
    },
    Ltc(Ellipsoid),
    Lambert {
        sphere: Sphere,
        tight: Ellipsoid,
    },
    Sphere(Sphere),
    Spot(Ellipsoid),
}

impl Bound {
    /// The names of the bounds by which the light is not found to touch `tile`.
    pub fn that_lose<P: Projection>(&self, tile: &Tile<P>) -> Vec<&'static str> {
        self.that_fail(tile, |test| test.touches(&tile.rectangle, &tile.depths))
    }

    /// Those by which it is not found by the exact test.
    pub fn that_lose_exactly<P: Projection>(&self, tile: &Tile<P>) -> Vec<&'static str> {
        self.that_fail(tile, |test| {
            test.touches_exactly(&tile.rectangle, &tile.depths)
        })
    }

    fn that_fail<P: Projection>(
        &self,
        tile: &Tile<P>,
        touches: impl Fn(&dyn TileTest) -> bool,
    ) -> Vec<&'static str> {
        let sphere = |sphere: Sphere| {
            sphere
                .project(&tile.camera)
                .is_some_and(|test| touches(&test))
        };
        let ellipsoid = |ellipsoid: Ellipsoid| {
            ellipsoid
                .project(&tile.camera)
                .is_some_and(|test| touches(&test))
        };
        let found = match *self {
            Self::Sphere(bound) => vec![("sphere", sphere(bound))],
            Self::Anisotropic(bound) => vec![("anisotropic ellipsoid", ellipsoid(bound))],
            Self::Spot(bound) => vec![("ellipsoid of a spot light", ellipsoid(bound))],
            Self::Ltc(bound) => vec![("ellipsoid of a transformed cosine", ellipsoid(bound))],
            Self::Phong(bound) => vec![("ellipsoid of Phong's lobe", ellipsoid(bound))],
            Self::SphericalGaussian { focal, tight } => vec![
                ("focal spheroid", ellipsoid(focal.into())),
                ("ellipsoid of an SG", ellipsoid(tight)),
                ("sphere around an SG", sphere(focal.enclosing_sphere())),
                ("sphere at an SG", sphere(focal.sphere_at_focus())),
            ],
            Self::Lambert {
                sphere: bound,
                tight,
            } => vec![
                ("sphere", sphere(bound)),
                ("ellipsoid of Lambert's lobe", ellipsoid(tight)),
            ],
            Self::Ggx {
                spheroid,
                triaxial,
                tight,
            } => vec![
                ("triaxial ellipsoid", ellipsoid(triaxial)),
                ("spheroid", ellipsoid(spheroid.into())),
                ("tight ellipsoid", ellipsoid(tight)),
                ("enclosing sphere", sphere(spheroid.enclosing_sphere())),
                ("sphere at the light", sphere(spheroid.sphere_at_focus())),
            ],
        };
        let lost = found.into_iter().filter(|(_, touched)| !touched);
        lost.map(|(name, _)| name).collect()
    }
}

pub fn chance(rng: &mut Rng, share: f64) -> bool {
    rng.f64() < share
}

pub fn log_uniform(rng: &mut Rng, low: f64, high: f64) -> f64 {
    (low.ln() + rng.f64() * (high / low).ln()).exp()
}

/// Numbers in [low, 1], mostly over decades from both ends.
pub fn up_to_one(rng: &mut Rng, low: f64) -> f64 {
    match rng.u8(0..10) {
        0 => 1.0,
        1 => low,
        2 => low + (1.0 - low) * rng.f64(),
        3 | 4 => (1.0 - log_uniform(rng, 1e-8, 0.5)).max(low),
        _ => log_uniform(rng, low, 1.0),
    }
}

pub fn unit_vector(rng: &mut Rng) -> Vector {
    if chance(rng, 0.1) {
        let mut axis = [0.0; 3];
        axis[rng.usize(0..3)] = if rng.bool() { 1.0 } else { -1.0 };
        return Vector(axis);
    }
    loop {
        let v = Vector(std::array::from_fn(|_| 2.0 * rng.f64() - 1.0));
        if (0.01..1.0).contains(&v.length()) {
            return v.unit();
        }
    }
}

pub fn direction(v: Vector) -> Direction {
    Direction::new(v.to_f32()).expect("unit vectors have a direction")
}
