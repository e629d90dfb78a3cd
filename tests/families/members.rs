//! Lobes of one kind and near each other, with the model of each.

use std::f64::consts::TAU;

use fastrand::Rng;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Direction, Ggx, GgxLobe, Incidence, LambertLobe, Lobe,
    LobeSum, LtcLobe, PhongLobe, SphericalGaussian, SpotLobe,
};
use support::adversary::{
    chance, cone_angles, direction, exponent, fresnel, log_uniform, sharpness, unit_vector,
    up_to_one,
};
use support::generators::Lit;
use support::reference::{Brdf, Fresnel, GivenFresnel, Masking, Surface, Vector};

/// A lobe, and the sum of models that it is.
#[derive(Debug)]
pub struct Member<L> {
    pub lobe: L,
    pub surface: Surface,
    parts: Vec<(f32, Brdf)>,
    /// How far its facets are turned, at most.
    roughness: f32,
}

impl<L> Member<L> {
    fn new(lobe: L, lit: &Lit, brdf: Brdf) -> Self {
        let roughness = match brdf {
            Brdf::Ggx { roughness, .. } | Brdf::Ltc { roughness, .. } => roughness,
            Brdf::Anisotropic { roughness, .. } => roughness[0].max(roughness[1]),
            _ => 1.0,
        };
        Self {
            lobe,
            surface: lit.surface,
            parts: vec![(1.0, brdf.lit_by(lit.normal, lit.incoming))],
            roughness,
        }
    }

    pub fn value(&self, outgoing: Vector) -> f64 {
        let value =
            |(weight, brdf): &(f32, Brdf)| f64::from(*weight) * self.surface.value(*brdf, outgoing);
        self.parts.iter().map(value).sum()
    }

    /// Directions in which a bound is likely to fail.
    pub fn likely_directions(&self, rng: &mut Rng) -> [Vector; 4] {
        let Surface { normal, incoming } = self.surface;
        let turned = log_uniform(rng, 1e-3, 3.0) * f64::from(self.roughness);
        let facet = (normal + around(rng, normal) * turned).unit();
        [
            self.surface.mirror().unit(),
            normal,
            facet * (2.0 * facet.dot(incoming)) - incoming,
            unit_vector(rng),
        ]
    }
}

/// A unit vector at right angles to `axis`.
fn around(rng: &mut Rng, axis: Vector) -> Vector {
    let side = axis.orthogonal();
    side.turned(axis.cross(side), rng.f64() * TAU)
}

/// One to four surface points near each other. Some may be lit from below.
pub fn surfaces(rng: &mut Rng) -> Vec<Lit> {
    let normal = unit_vector(rng);
    let cosine = up_to_one(rng, 1e-4);
    let incoming = normal.turned(around(rng, normal), cosine.acos());
    let spreads = [(); 2].map(|()| match rng.u8(0..4) {
        0 => 0.0,
        _ => log_uniform(rng, 1e-7, 1.0),
    });
    let near = |rng: &mut Rng, axis: Vector, spread: f64| {
        let offset = unit_vector(rng) * (spread * rng.f64());
        (axis + offset).unit()
    };
    (0..rng.usize(1..5))
        .map(|_| {
            let normal = near(rng, normal, spreads[0]);
            Lit::new(normal, near(rng, incoming, spreads[1]))
        })
        .collect()
}

/// A number for each of some lobes: all the same, nearly so, or any in [low, 1].
fn shares(rng: &mut Rng, low: f64) -> impl Fn(&mut Rng) -> f32 + use<> {
    let (most, spread) = (up_to_one(rng, low), rng.u8(0..3));
    move |rng| {
        let share = match spread {
            0 => most,
            1 => most * (1.0 - 0.3 * rng.f64()),
            _ => up_to_one(rng, low),
        };
        share.max(low) as f32
    }
}

/// An albedo or a weight for each of some lobes: as [`shares`], and sometimes zero.
fn albedos(rng: &mut Rng) -> impl Fn(&mut Rng) -> f32 + use<> {
    let share = shares(rng, 1e-6);
    move |rng| if chance(rng, 0.2) { 0.0 } else { share(rng) }
}

/// A Fresnel factor for each of some lobes: all the same, or any.
fn fresnels(rng: &mut Rng) -> impl Fn(&mut Rng) -> Fresnel + use<> {
    let (one, is_one) = (fresnel(rng), rng.bool());
    move |rng| if is_one { one } else { fresnel(rng) }
}

fn incidence(lit: &Lit) -> Incidence {
    Incidence {
        normal: lit.normal,
        incoming: lit.incoming,
    }
}

fn given(fresnel: Fresnel) -> GivenFresnel {
    GivenFresnel::try_from(fresnel).expect("in range")
}

fn members<L>(rng: &mut Rng, make: impl Fn(&mut Rng, &Lit) -> Member<L>) -> Vec<Member<L>> {
    surfaces(rng).iter().map(|lit| make(rng, lit)).collect()
}

pub fn ggx<G>(rng: &mut Rng, masking: Masking) -> Vec<Member<GgxLobe<GivenFresnel, G>>> {
    let (alpha, fresnel) = (shares(rng, 1e-4), fresnels(rng));
    members(rng, |rng, lit| {
        ggx_of((alpha(rng), fresnel(rng), masking), lit)
    })
}

/// The lobe of this roughness, Fresnel factor and masking.
pub fn ggx_of<G>(
    (roughness, fresnel, masking): (f32, Fresnel, Masking),
    lit: &Lit,
) -> Member<GgxLobe<GivenFresnel, G>> {
    let ggx = Ggx::new(roughness).expect("in range");
    let lobe = GgxLobe::new(ggx, given(fresnel), incidence(lit)).with_masking();
    let brdf = Brdf::Ggx {
        roughness,
        fresnel,
        masking,
    };
    Member::new(lobe, lit, brdf)
}

pub fn anisotropic<G>(
    rng: &mut Rng,
    masking: Masking,
) -> Vec<Member<AnisotropicGgxLobe<GivenFresnel, G>>> {
    let alphas = [shares(rng, 1e-4), shares(rng, 1e-4)];
    let (fresnel, tangent) = (fresnels(rng), direction(unit_vector(rng)));
    members(rng, |rng, lit| {
        let roughness = [alphas[0](rng), alphas[1](rng)];
        anisotropic_of((roughness, tangent, fresnel(rng), masking), lit)
    })
}

/// The lobe of this roughness, tangent, Fresnel factor and masking.
pub fn anisotropic_of<G>(
    (roughness, tangent, fresnel, masking): ([f32; 2], Direction, Fresnel, Masking),
    lit: &Lit,
) -> Member<AnisotropicGgxLobe<GivenFresnel, G>> {
    let brdf = Brdf::Anisotropic {
        roughness,
        tangent,
        fresnel,
        masking,
    };
    let brdf = brdf.laid_on(lit.surface.normal);
    let Brdf::Anisotropic { tangent, .. } = brdf else {
        unreachable!("it is laid another way, but no other lobe")
    };
    let ggx = AnisotropicGgx::new(roughness[0], roughness[1]).expect("in range");
    let lobe = AnisotropicGgxLobe::new(ggx, given(fresnel), incidence(lit), tangent);
    Member::new(lobe.expect("a frame").with_masking(), lit, brdf)
}

pub fn lambert(rng: &mut Rng) -> Vec<Member<LambertLobe>> {
    let albedo = albedos(rng);
    members(rng, |rng, lit| lambert_of(albedo(rng), lit))
}

pub fn lambert_of(albedo: f32, lit: &Lit) -> Member<LambertLobe> {
    let lobe = LambertLobe::new(albedo, lit.normal).expect("in range");
    Member::new(lobe, lit, Brdf::Lambert { albedo })
}

pub fn phong(rng: &mut Rng) -> Vec<Member<PhongLobe>> {
    let albedo = albedos(rng);
    members(rng, |rng, lit| phong_of([albedo(rng), exponent(rng)], lit))
}

pub fn phong_of([albedo, exponent]: [f32; 2], lit: &Lit) -> Member<PhongLobe> {
    let lobe = PhongLobe::new(albedo, exponent, incidence(lit)).expect("in range");
    Member::new(lobe, lit, Brdf::Phong { albedo, exponent })
}

pub fn gaussian(rng: &mut Rng) -> Vec<Member<SphericalGaussian>> {
    let scale = log_uniform(rng, 1e-3, 1e3) as f32;
    members(rng, |rng, lit| {
        let sharpness = sharpness(rng);
        let amplitude = match rng.u8(0..3) {
            0 => 0.0,
            1 => scale,
            _ => scale * (sharpness + 1.0),
        };
        gaussian_of([sharpness, amplitude], lit)
    })
}

pub fn gaussian_of([sharpness, amplitude]: [f32; 2], lit: &Lit) -> Member<SphericalGaussian> {
    let brdf = Brdf::SphericalGaussian {
        amplitude,
        sharpness,
    };
    let lobe = SphericalGaussian::new(lit.normal, sharpness, amplitude).expect("in range");
    Member::new(lobe, lit, brdf)
}

pub fn transformed_cosine(rng: &mut Rng) -> Vec<Member<LtcLobe>> {
    let (alpha, share) = (shares(rng, 1e-4), albedos(rng));
    members(rng, |rng, lit| {
        transformed_cosine_of([alpha(rng), share(rng)], lit)
    })
}

pub fn transformed_cosine_of([alpha, share]: [f32; 2], lit: &Lit) -> Member<LtcLobe> {
    let brdf = Brdf::ltc(alpha, share, None).lit_by(lit.normal, lit.incoming);
    let Brdf::Ltc { lobe, .. } = brdf else {
        unreachable!("it is lit another way, but no other lobe")
    };
    Member::new(lobe, lit, brdf)
}

/// Diffuse surfaces under a dielectric, or as a caller weights them.
pub fn varnished(rng: &mut Rng) -> Vec<Member<LobeSum<LambertLobe, GgxLobe<GivenFresnel>>>> {
    let (alpha, fresnel) = (shares(rng, 1e-4), fresnels(rng));
    let (albedo, weights) = (albedos(rng), [albedos(rng), albedos(rng)]);
    members(rng, |rng, lit| {
        let varnish = (alpha(rng), fresnel(rng), Masking::HeightCorrelated);
        let varnish = ggx_of(varnish, lit);
        let paint = lambert_of(albedo(rng), lit);
        weighted([weights[0](rng), weights[1](rng)], paint, varnish)
    })
}

/// The weighted sum of two lobes of one surface.
pub fn weighted<A: Lobe, B: Lobe>(
    weights: [f32; 2],
    first: Member<A>,
    second: Member<B>,
) -> Member<LobeSum<A, B>> {
    let scaled = |weight: f32, parts: Vec<(f32, Brdf)>| {
        let scale = move |(own, brdf)| (weight * own, brdf);
        parts.into_iter().map(scale)
    };
    let [of_first, of_second] = weights;
    Member {
        lobe: LobeSum::weighted(weights, first.lobe, second.lobe).expect("in range"),
        surface: first.surface,
        parts: scaled(of_first, first.parts)
            .chain(scaled(of_second, second.parts))
            .collect(),
        roughness: first.roughness.min(second.roughness),
    }
}

/// What has no family: a spot light.
pub fn spot(rng: &mut Rng, lit: &Lit) -> Member<SpotLobe> {
    let angles = cone_angles(rng);
    let lobe = SpotLobe::new(angles[0], angles[1], lit.normal).expect("in range");
    Member::new(lobe, lit, Brdf::spot(angles))
}
