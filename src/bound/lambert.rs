use super::{Bounded, Sphere};
use crate::{LambertLobe, math};

impl LambertLobe {
    /// (1/3)^¾, the way from the light to the centre over R.
    pub(crate) const CENTER: f32 = 0.438_691_34;
    /// (4/27)^¼, the radius over R.
    pub(crate) const RADIUS: f32 = 0.620_403_2;
    /// Apart from √ρ, since the product with a subnormal albedo would be off by more than its root is.
    pub(crate) const ROOT_OF_ONE_OVER_PI: f32 = 0.564_189_6;
}

impl Bounded for LambertLobe {
    type Bound = Sphere;

    /// The sphere around the surface l = R√cosθ, R² = ρ/π, centred (1/3)^¾ R above the light, with
    /// radius (4/27)^¼ R [Tokuyoshi & Harada 2017, Sec. 6].
    ///
    /// A point of the surface is l² − 2(1/3)^¾ R² cos^{3/2}θ + (1/3)^{3/2} R² from that centre, squared,
    /// which is largest at cosθ = 1/√3 and there (4/27)^½ R²: the sphere is the smallest one.
    fn unit_bound(&self) -> Sphere {
        let reach = math::sqrt(self.albedo()) * Self::ROOT_OF_ONE_OVER_PI;
        Sphere::from_parts(
            *self.normal() * (Self::CENTER * reach),
            math::round_up(Self::RADIUS * reach, 16),
        )
    }
}
