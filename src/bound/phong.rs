use super::cosine_power::Revolved;
use super::{Bounded, Ellipsoid};
use crate::PhongLobe;

impl Bounded for PhongLobe {
    type Bound = Ellipsoid;

    /// The smallest ellipsoid around the surface l = R cos^{n/2}γ, R² = ρ(n+1)/(2π), where γ is the angle
    /// to the mirror direction: what [Dachsbacher & Stamminger 2006] splat, made tight.
    ///
    /// For n ≥ 2 its semi-axis along the mirror direction is
    /// a = ¾((3n+2)/(3n+6))^{(n+2)/4} R, across it a√(8/(3n+2)), and it touches the light; for n = 2 it is
    /// a sphere. Broader lobes hang from the tip of theirs, which is within 10⁻⁴ of the least volume. The
    /// part of the lobe that the horizon cuts off is enclosed too.
    fn unit_bound(&self) -> Ellipsoid {
        Revolved::around_cosine_power(self.exponent()).placed_along(self.axis(), self.unit_reach())
    }
}
