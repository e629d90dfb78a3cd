use glam::Vec3;

use super::{Bounded, Sphere};
use crate::{ConstantLobe, math};

impl Bounded for ConstantLobe {
    type Bound = Sphere;

    /// The isosurface itself, the sphere of radius √(1/4π) around the light
    /// [Tokuyoshi & Harada 2016].
    fn unit_bound(&self) -> Sphere {
        Sphere::from_parts(Vec3::ZERO, math::round_up(math::sqrt(Self::VALUE), 2))
    }
}
