use super::cosine_power::Revolved;
use super::{Bound, Bounded, Ellipsoid, Sphere};
use crate::{LambertLobe, Roulette, Vpl, Xi, math};

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
    #[inline]
    fn unit_bound(&self) -> Sphere {
        let reach = unit_reach(self);
        Sphere::from_parts(
            *self.normal() * (Self::CENTER * reach),
            math::round_up(Self::RADIUS * reach, 16),
        )
    }
}

impl LambertLobe {
    /// The smallest ellipsoid around the surface l = R√cosθ, R² = ρ/π, for a light at the origin: flatter
    /// than the [sphere](Bounded::unit_bound), with 0.8896 of its volume.
    ///
    /// Its semi-axes are 0.54438R along the normal and 0.62468R across it, and it touches the surface at
    /// its tip and in the ring at cosθ = 0.422. A tile test takes longer for it than for the sphere.
    ///
    /// ```
    /// use stochastic_light_culling::{Bounded, Direction, LambertLobe};
    ///
    /// let chalk = LambertLobe::new(0.9, Direction::Y)?;
    /// let (ellipsoid, sphere) = (chalk.tight_bound(), chalk.unit_bound());
    /// let volume = ellipsoid.semi_axes().element_product() / sphere.radius().powi(3);
    /// assert!(0.88 < volume && volume < 0.89);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    pub fn tight_bound(&self) -> Ellipsoid {
        Revolved::AROUND_LAMBERT.placed_along(self.normal(), unit_reach(self))
    }
}

impl Vpl<LambertLobe> {
    /// The [tight ellipsoid](LambertLobe::tight_bound) around everything that accepts this light in a frame
    /// with `roulette` and `xi`.
    pub fn tight_bound(&self, roulette: &Roulette, xi: Xi) -> Ellipsoid {
        let scale = roulette.scale(self.flux(), xi);
        self.lobe().tight_bound().placed(self.position(), scale)
    }
}

/// R = √(ρ/π), with the roots apart, since the product with a subnormal albedo would be off by more than
/// its root is.
fn unit_reach(lobe: &LambertLobe) -> f32 {
    lobe.albedo_root() * LambertLobe::ROOT_OF_ONE_OVER_PI
}
