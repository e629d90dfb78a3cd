use glam::Vec3;

use super::shape::{Quads, padded};
use super::sphere::Spheres;
use super::{BoundStrategy, Bounded, Paper, Sphere};
use crate::lobe::ConstantLobe;
use crate::num::{Single, round_up, sqrt};

/// Pays for the rounding of √(1/4π).
const RADIUS_ROUNDINGS: u16 = 2;

/// Bounds the lobe by its isosurface, the sphere of radius √(1/4π) around the light
/// [Tokuyoshi & Harada 2016].
impl BoundStrategy<ConstantLobe> for Paper {
    type Shape = Sphere;

    fn unit_bound(&self, _: &ConstantLobe) -> Sphere {
        let radius = round_up(sqrt(ConstantLobe::PEAK), RADIUS_ROUNDINGS);
        Sphere::from_parts(Vec3::ZERO, radius)
    }

    type PerLight = ();

    const QUADS: usize = 0;

    #[inline(always)]
    fn to_quads(&self, _: &ConstantLobe) -> (Quads<f32>, ()) {
        (padded([]), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Spheres<N> {
        Spheres {
            center: None,
            radius: quads[0][0].splat(self.unit_bound(&ConstantLobe).radius()),
        }
    }
}

impl Bounded for ConstantLobe {
    type Shape = Sphere;
    type Strategy = Paper;

    fn unit_bound(&self) -> Sphere {
        self.unit_bound_by(Paper)
    }
}
