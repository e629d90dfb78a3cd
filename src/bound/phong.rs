use super::ellipsoid::Ellipsoids;
use super::revolved::Revolved;
use super::shape::{Quads, padded};
use super::{BoundStrategy, Bounded, Ellipsoid, Tight};
use crate::lobe::PhongLobe;
use crate::num::{Single, Vector3};

/// Bounds the lobe by the smallest ellipsoid around the surface l = R cos^{n/2}γ, R² = ρ(n+1)/(2π), where γ
/// is the angle to the mirror direction. [Dachsbacher & Stamminger 2006] splat ellipsoids around such lobes.
///
/// For n ≥ 2 the semi-axes are a = ¾((3n+2)/(3n+6))^{(n+2)/4} R along the mirror direction and a√(8/(3n+2))
/// across it, and the ellipsoid touches the light; for n = 2 it is a sphere. For n < 2 the ellipsoid touches
/// the tip of the lobe, and its volume is within 10⁻⁴ of the smallest. The part of the lobe that the horizon
/// cuts off is enclosed too.
impl BoundStrategy<PhongLobe> for Tight {
    type Shape = Ellipsoid;

    type PerLight = ();

    const QUADS: usize = 2;

    #[inline(always)]
    fn to_quads(&self, lobe: &PhongLobe) -> (Quads<f32>, ()) {
        let axis = lobe.axis();
        let axis_and_exponent = [axis.x, axis.y, axis.z, lobe.exponent()];
        let reach = [lobe.unit_reach(), 0.0, 0.0, 0.0];
        (padded([axis_and_exponent, reach]), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Ellipsoids<N> {
        let [[x, y, z, exponent], [reach, ..], ..] = *quads;
        Revolved::around_cosine_power(exponent).along(Vector3::new(x, y, z), reach)
    }
}

impl Bounded for PhongLobe {
    type Shape = Ellipsoid;
    type Strategy = Tight;

    fn unit_bound(&self) -> Ellipsoid {
        self.unit_bound_by(Tight)
    }
}
