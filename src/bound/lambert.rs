use super::ellipsoid::Ellipsoids;
use super::revolved::Revolved;
use super::shape::{Quads, padded};
use super::sphere::Spheres;
use super::{BoundStrategy, Bounded, Ellipsoid, Paper, Shape, Sphere, Tight};
use crate::lobe::LambertLobe;
use crate::num::{Single, Vector3};

/// The distance from the light to the centre of the sphere, over R: (1/3)^¾.
const CENTER: f32 = 0.438_691_34;
/// The radius of the sphere over R: (4/27)^¼.
const RADIUS: f32 = 0.620_403_2;
/// √(1/π)
const ROOT_OF_ONE_OVER_PI: f32 = 0.564_189_6;

/// Pays for the rounding of the sphere's radius and centre.
const RADIUS_ROUNDINGS: u16 = 16;

/// The quads of a lobe: √ρ and n.
#[inline(always)]
fn to_quads(lobe: &LambertLobe) -> Quads<f32> {
    let n = lobe.normal();
    padded([[lobe.albedo_root(), n.x, n.y, n.z]])
}

/// R = √(ρ/π), and n. R is a product of two roots, since the product with a subnormal albedo would lose
/// digits.
#[inline(always)]
fn reach_and_normal<N: Single>(quads: &Quads<N>) -> (N, Vector3<N>) {
    let [albedo_root, x, y, z] = quads[0];
    (albedo_root * ROOT_OF_ONE_OVER_PI, Vector3::new(x, y, z))
}

/// Bounds the surface l = R√cosθ, R² = ρ/π, by the smallest sphere. Its centre is (1/3)^¾ R above the light,
/// and its radius is (4/27)^¼ R [Tokuyoshi & Harada 2017, Sec. 6].
///
/// The squared distance of a point of the surface from that centre is
/// l² − 2(1/3)^¾ R² cos^{3/2}θ + (1/3)^{3/2} R². It is largest at cosθ = 1/√3, where it is (4/27)^½ R². There
/// the surface touches the sphere in a great circle, so no sphere is smaller.
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
            center: Some(normal * (reach * CENTER)),
            radius: (reach * RADIUS).round_up(RADIUS_ROUNDINGS),
        }
    }
}

/// Bounds the surface l = R√cosθ, R² = ρ/π, by the smallest ellipsoid. It is flatter than the sphere, and has
/// 0.8896 of its volume.
///
/// Its semi-axes are 0.54438R along the normal and 0.62468R across it. It touches the surface at the tip and
/// in the ring at cosθ = 0.422. Its tile test takes longer than that of the sphere.
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
