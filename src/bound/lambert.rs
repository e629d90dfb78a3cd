use super::cosine_power::Revolved;
use super::ellipsoid::Ellipsoids;
use super::shape::{MAX_QUADS, Quads};
use super::sphere::Spheres;
use super::{BoundStrategy, Bounded, Ellipsoid, Paper, Shape, Sphere, Tight};
use crate::lobe::LambertLobe;
use crate::num::{Single, Vector3};

/// (1/3)^¾, the distance from the light to the centre over R.
const CENTER: f32 = 0.438_691_34;
/// (4/27)^¼, the radius over R.
const RADIUS: f32 = 0.620_403_2;
/// √(1/π)
const ROOT_OF_ONE_OVER_PI: f32 = 0.564_189_6;

/// Pays for the rounding of the sphere's radius and centre.
const RADIUS_ROUNDINGS: u16 = 16;

/// √ρ and n
#[inline(always)]
fn to_quads(lobe: &LambertLobe) -> Quads<f32> {
    let n = lobe.normal();
    let mut quads = [[0.0; 4]; MAX_QUADS];
    quads[0] = [lobe.albedo_root(), n.x, n.y, n.z];
    quads
}

/// R = √(ρ/π), and n. The roots are apart, since the product with a subnormal albedo would be off by more
/// than its root is.
#[inline(always)]
fn reach_and_normal<N: Single>(quads: &Quads<N>) -> (N, Vector3<N>) {
    let [albedo_root, x, y, z] = quads[0];
    (albedo_root * ROOT_OF_ONE_OVER_PI, Vector3::new(x, y, z))
}

/// The sphere around the surface l = R√cosθ, R² = ρ/π, centred (1/3)^¾ R above the light, with
/// radius (4/27)^¼ R [Tokuyoshi & Harada 2017, Sec. 6].
///
/// A point of the surface is l² − 2(1/3)^¾ R² cos^{3/2}θ + (1/3)^{3/2} R² from that centre, squared,
/// which is largest at cosθ = 1/√3 and there (4/27)^½ R²: the sphere is the smallest one.
impl BoundStrategy<LambertLobe> for Paper {
    type Shape = Sphere;

    // Without asking whether the lobe is empty: its sphere is then as well.
    #[inline]
    fn unit_bound(&self, lobe: &LambertLobe) -> Sphere {
        let (quads, none) = BoundStrategy::<LambertLobe>::to_quads(self, lobe);
        let lanes = BoundStrategy::<LambertLobe>::unit_bounds(self, &quads, &[none]);
        Sphere::from_lanes(lanes)
    }

    type PerLight = ();

    const QUADS: usize = 1;

    #[inline(always)]
    fn to_quads(&self, lobe: &LambertLobe) -> (Quads<f32>, ()) {
        (to_quads(lobe), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Spheres<N> {
        let (reach, normal) = reach_and_normal(quads);
        Spheres {
            center: normal * (reach * CENTER),
            radius: (reach * RADIUS).round_up(RADIUS_ROUNDINGS),
        }
    }
}

/// The smallest ellipsoid around the surface l = R√cosθ, R² = ρ/π: flatter than the sphere, with 0.8896 of
/// its volume.
///
/// Its semi-axes are 0.54438R along the normal and 0.62468R across it, and it touches the surface at
/// its tip and in the ring at cosθ = 0.422. A tile test takes longer for it than for the sphere.
impl BoundStrategy<LambertLobe> for Tight {
    type Shape = Ellipsoid;

    type PerLight = ();

    const QUADS: usize = 1;

    #[inline(always)]
    fn to_quads(&self, lobe: &LambertLobe) -> (Quads<f32>, ()) {
        (to_quads(lobe), ())
    }

    #[inline(always)]
    fn unit_bounds<N: Single>(&self, quads: &Quads<N>, _: &[()]) -> Ellipsoids<N> {
        let (reach, normal) = reach_and_normal(quads);
        Revolved::around_lambert(reach).along(normal, reach)
    }
}

impl Bounded for LambertLobe {
    type Shape = Sphere;
    type Strategy = Paper;

    #[inline]
    fn unit_bound(&self) -> Sphere {
        self.unit_bound_by(Paper)
    }
}
