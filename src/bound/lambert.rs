use super::{Bounded, Sphere};
use crate::{LambertLobe, math};

impl Bounded for LambertLobe {
    type Bound = Sphere;

    /// The sphere around the surface l = R√cosθ, R² = ρ/π, centred (1/3)^¾ R above the light, with
    /// radius (4/27)^¼ R [Tokuyoshi & Harada 2017, Sec. 6].
    ///
    /// A point of the surface is l² − 2(1/3)^¾ R² cos^{3/2}θ + (1/3)^{3/2} R² from that centre, squared,
    /// which is largest at cosθ = 1/√3 and there (4/27)^½ R²: the sphere is the smallest one.
    fn unit_bound(&self) -> Sphere {
        const CENTER: f32 = 0.438_691_34;
        const RADIUS: f32 = 0.620_403_2;
        // √(1/π) apart, since the product with a subnormal albedo would be off by more than its root is.
        const ROOT_OF_ONE_OVER_PI: f32 = 0.564_189_6;
        let reach = math::sqrt(self.albedo()) * ROOT_OF_ONE_OVER_PI;
        Sphere::from_parts(
            *self.normal() * (CENTER * reach),
            math::round_up(RADIUS * reach, 16),
        )
    }
}
