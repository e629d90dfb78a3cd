//! Tests that values of lobes in lanes have the same bits as those of each lobe alone.

use core::array::from_fn;

use fearless_simd::{Simd, SimdBase};
use glam::Vec3;

use super::anisotropic_lobes::anisotropic_value;
use super::facets::Facets;
use super::lambert::lambert;
use super::phong::PhongLobes;
use super::spherical_gaussian::SphericalGaussians;
use super::{
    AnisotropicGgx, AnisotropicGgxLobe, Conductor, Dielectric, Fresnel, Ggx, GgxLobe, GgxLobes,
    HeightCorrelated, Incidence, LambertLobe, Lobe, MaskingShadowing, NoFresnel, PhongLobe,
    Schlick, Separable, SphericalGaussian,
};
use crate::base::Direction;
use crate::num::{
    F32Lanes, LaneTest, MAX_LANES, Matrix3, Single, Vector3, at_every_level, to_array,
};

/// A linear congruential generator, which is good enough to pick inputs.
pub struct Random(pub u32);

impl Random {
    /// A number in [0, 1).
    pub fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / 16_777_216.0
    }

    pub fn direction(&mut self) -> Direction {
        let vector = from_fn(|_| 2.0 * self.number() - 1.0);
        Direction::new(Vec3::from_array(vector)).unwrap_or(Direction::X)
    }

    /// Sometimes along the normal, or from below.
    pub fn incidence(&mut self) -> Incidence {
        let normal = self.direction();
        if self.number() < 0.1 {
            return Incidence::head_on(normal);
        }
        let incoming = *normal + 1.2 * *self.direction();
        let incoming = Direction::new(incoming).unwrap_or(normal);
        Incidence { normal, incoming }
    }

    pub fn roughness(&mut self) -> f32 {
        let share = self.number();
        (share * share * share).max(1e-4)
    }
}

/// No facet shadows another.
#[derive(Clone, Copy)]
pub struct MaskedAlone;

impl MaskingShadowing for MaskedAlone {
    fn over_four_incident_cosines(cosine: f32, root: f32, _: f32, _: f32) -> f32 {
        0.5 / (cosine + root)
    }
}

/// A Fresnel factor that has no form in lanes.
#[derive(Clone, Copy)]
pub struct Squared(pub f32);

impl Fresnel for Squared {
    fn reflectance(&self, half_angle_cosine: f32) -> f32 {
        let rest = 1.0 - half_angle_cosine;
        self.0 + (1.0 - self.0) * rest * rest
    }

    // Where F is not steep, and for most factors not a cosine.
    fn critical_cosine(&self) -> f32 {
        [f32::NAN, -1.0, 0.5, 1.5, f32::INFINITY][(self.0 * 5.0) as usize]
    }
}

/// What `number` returns for the lights from `start` on, in lanes.
pub fn gathered<S: Simd>(simd: S, start: usize, number: impl Fn(usize) -> f32) -> F32Lanes<S> {
    F32Lanes::new(simd, 0.0).gather(|i| number(start + i))
}

pub fn gathered_vector<S: Simd>(
    simd: S,
    start: usize,
    vector: impl Fn(usize) -> Vec3,
) -> Vector3<F32Lanes<S>> {
    Vector3::new(
        gathered(simd, start, |i| vector(i).x),
        gathered(simd, start, |i| vector(i).y),
        gathered(simd, start, |i| vector(i).z),
    )
}

/// Lobes, directions, and a function that computes the values in lanes.
struct Values<L, V>([L; MAX_LANES], [Vec3; MAX_LANES], V);

/// Computes the values of the lobes from `start` on, in lanes.
trait InLanes<L> {
    fn values<S: Simd>(
        &self,
        simd: S,
        lobes: &[L; MAX_LANES],
        start: usize,
        outgoing: Vector3<F32Lanes<S>>,
    ) -> F32Lanes<S>;
}

impl<L: Lobe, V: InLanes<L>> LaneTest for Values<L, V> {
    fn run<S: Simd>(&self, simd: S) {
        let Self(lobes, outgoing, in_lanes) = self;
        for start in (0..MAX_LANES).step_by(S::f32s::LEN) {
            let directions = gathered_vector(simd, start, |i| outgoing[i]);
            let found = to_array(in_lanes.values(simd, lobes, start, directions));
            for (i, found) in (start..).zip(&found[..S::f32s::LEN]) {
                let expected = lobes[i].value(outgoing[i]);
                assert_eq!(found.to_bits(), expected.to_bits(), "{found} {expected}");
            }
        }
    }
}

fn check<L: Lobe>(in_lanes: impl InLanes<L> + Copy, lobe: impl Fn(&mut Random) -> L) {
    let mut random = Random(1);
    for _ in 0..200 {
        let lobes = from_fn(|_| lobe(&mut random));
        let outgoing = from_fn(|_| *random.direction());
        at_every_level(&Values(lobes, outgoing, in_lanes));
    }
}

#[derive(Clone, Copy)]
struct OfGgx;

fn ggx_lobes<S: Simd, F: Fresnel, G>(
    simd: S,
    lobe: impl Fn(usize) -> GgxLobe<F, G>,
    start: usize,
) -> GgxLobes<F32Lanes<S>> {
    let number =
        |number: fn(GgxLobes<f32>) -> f32| gathered(simd, start, |i| number(lobe(i).lanes()));
    GgxLobes {
        normal: gathered_vector(simd, start, |i| *lobe(i).normal()),
        incoming: gathered_vector(simd, start, |i| *lobe(i).incoming()),
        incident_cosine: number(|lobe| lobe.incident_cosine),
        incident_root: number(|lobe| lobe.incident_root),
        roughness: number(|lobe| lobe.roughness),
    }
}

impl<F: Fresnel, G: MaskingShadowing> InLanes<GgxLobe<F, G>> for OfGgx {
    fn values<S: Simd>(
        &self,
        simd: S,
        lobes: &[GgxLobe<F, G>; MAX_LANES],
        start: usize,
        outgoing: Vector3<F32Lanes<S>>,
    ) -> F32Lanes<S> {
        let fresnels: [F; MAX_LANES] = lobes.map(|lobe| *lobe.fresnel());
        ggx_lobes(simd, |i| lobes[i], start).value::<G>(
            |cosine| F::reflectance_in_lanes(&fresnels[start..], cosine),
            outgoing,
        )
    }
}

fn check_ggx<F: Fresnel>(fresnel: impl Fn(f32) -> F + Copy) {
    let lobe = |random: &mut Random| {
        let ggx = Ggx::new(random.roughness()).expect("in range");
        GgxLobe::new(ggx, fresnel(random.number()), random.incidence())
    };
    check(OfGgx, lobe);
    check(OfGgx, |random| lobe(random).with_masking::<Separable>());
    check(OfGgx, |random| lobe(random).with_masking::<MaskedAlone>());
}

#[test]
fn ggx_lobes_have_the_same_values() {
    check_ggx(|_| NoFresnel);
    check_ggx(|share| Schlick::new(share).expect("in range"));
    check_ggx(|share| Dielectric::new(0.4 + 2.0 * share).expect("in range"));
    check_ggx(|share| Conductor::new(0.1 + share, 4.0 * share).expect("in range"));
    check_ggx(Squared);
}

#[derive(Clone, Copy)]
struct OfAnisotropicGgx;

impl<F: Fresnel> InLanes<AnisotropicGgxLobe<F>> for OfAnisotropicGgx {
    fn values<S: Simd>(
        &self,
        simd: S,
        lobes: &[AnisotropicGgxLobe<F>; MAX_LANES],
        start: usize,
        outgoing: Vector3<F32Lanes<S>>,
    ) -> F32Lanes<S> {
        let fresnels: [F; MAX_LANES] = lobes.map(|lobe| *lobe.fresnel());
        let axis = |axis: fn(Matrix3<f32>) -> Vector3<f32>| {
            gathered_vector(simd, start, |i| {
                axis(lobes[i].facets().to_surface_frame).into()
            })
        };
        anisotropic_value::<_, HeightCorrelated>(
            &ggx_lobes(simd, |i| *lobes[i].at_any_azimuth(), start),
            &Facets {
                roughness: [
                    gathered(simd, start, |i| lobes[i].ggx().roughness()[0]),
                    gathered(simd, start, |i| lobes[i].ggx().roughness()[1]),
                ],
                to_surface_frame: Matrix3::new(axis(|m| m.x), axis(|m| m.y), axis(|m| m.z)),
            },
            |cosine| F::reflectance_in_lanes(&fresnels[start..], cosine),
            outgoing,
        )
    }
}

#[test]
fn anisotropic_lobes_have_the_same_values() {
    check(OfAnisotropicGgx, |random| {
        let ggx = AnisotropicGgx::new(random.roughness(), random.roughness()).expect("in range");
        let fresnel = Schlick::new(random.number()).expect("in range");
        let incidence = random.incidence();
        let tangent = Direction::new(incidence.normal.any_orthonormal_vector()).expect("unit");
        AnisotropicGgxLobe::new(ggx, fresnel, incidence, tangent).expect("at right angles")
    });
}

#[derive(Clone, Copy)]
struct OfPhong;

impl InLanes<PhongLobe> for OfPhong {
    fn values<S: Simd>(
        &self,
        simd: S,
        lobes: &[PhongLobe; MAX_LANES],
        start: usize,
        outgoing: Vector3<F32Lanes<S>>,
    ) -> F32Lanes<S> {
        let lanes = PhongLobes {
            normal: gathered_vector(simd, start, |i| *lobes[i].normal()),
            axis: gathered_vector(simd, start, |i| *lobes[i].axis()),
            exponent: gathered(simd, start, |i| lobes[i].exponent()),
            albedo: gathered(simd, start, |i| {
                if lobes[i].is_empty() {
                    0.0
                } else {
                    lobes[i].albedo()
                }
            }),
        };
        lanes.value(outgoing)
    }
}

#[test]
fn phong_lobes_have_the_same_values() {
    check(OfPhong, |random| {
        let exponent = 100.0 * random.number();
        PhongLobe::new(random.number(), exponent, random.incidence()).expect("in range")
    });
}

#[derive(Clone, Copy)]
struct OfGaussian;

impl InLanes<SphericalGaussian> for OfGaussian {
    fn values<S: Simd>(
        &self,
        simd: S,
        lobes: &[SphericalGaussian; MAX_LANES],
        start: usize,
        outgoing: Vector3<F32Lanes<S>>,
    ) -> F32Lanes<S> {
        let lanes = SphericalGaussians {
            axis: gathered_vector(simd, start, |i| *lobes[i].axis()),
            sharpness: gathered(simd, start, |i| lobes[i].sharpness()),
            amplitude: gathered(simd, start, |i| lobes[i].amplitude()),
        };
        lanes.value(outgoing)
    }
}

#[test]
fn spherical_gaussians_have_the_same_values() {
    check(OfGaussian, |random| {
        let sharpness = 60.0 * random.number();
        SphericalGaussian::new(random.direction(), sharpness, random.number()).expect("in range")
    });
}

#[derive(Clone, Copy)]
struct OfLambert;

impl InLanes<LambertLobe> for OfLambert {
    fn values<S: Simd>(
        &self,
        simd: S,
        lobes: &[LambertLobe; MAX_LANES],
        start: usize,
        outgoing: Vector3<F32Lanes<S>>,
    ) -> F32Lanes<S> {
        let normal = gathered_vector(simd, start, |i| *lobes[i].normal());
        lambert(
            gathered(simd, start, |i| lobes[i].albedo()),
            normal,
            outgoing,
        )
    }
}

#[test]
fn lambert_lobes_have_the_same_values() {
    check(OfLambert, |random| {
        LambertLobe::new(random.number(), random.direction()).expect("in range")
    });
}
