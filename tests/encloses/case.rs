//! A lit surface with a material, the bounds of its lobe, and the directions to look in.

use std::f64::consts::TAU;

use proptest::prelude::*;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Bounded, Conductor, ConstantLobe, Dielectric, Direction,
    Ellipsoid, Focal, Ggx, GgxLobe, Incidence, LambertLobe, MaskingShadowing, NoFresnel, Paper,
    PhongLobe, Roulette, Schlick, SphericalGaussian, Spheroid, SpotLobe, Tight, Triaxial, Vpl, Xi,
    glam::Vec3,
};
use support::generators::{self, Lit};
use support::reference::{
    Brdf, Fresnel, GivenFresnel, MaskedAlone, Masking, Shape, Vector, ltc_rows,
};

/// What the crate says of a GGX light.
pub struct GgxBounds {
    pub spheroid: Spheroid,
    pub triaxial: Ellipsoid,
    pub tight: Ellipsoid,
    pub max_fresnel: f64,
}

/// A light and what the crate makes of it.
#[derive(Debug)]
pub struct Case {
    pub brdf: Brdf,
    pub lit: Lit,
    pub position: Vec3,
    pub roulette: (f32, f32, f32),
}

impl Case {
    /// The radius of the isosurface, √(Φ f μ_o/(δξ)).
    pub fn radius(&self, outgoing: Vector) -> f64 {
        let (flux, delta, xi) = self.roulette;
        let scale = f64::from(flux) / (f64::from(delta) * f64::from(xi));
        (scale * self.lit.surface.value(self.brdf, outgoing)).sqrt()
    }

    pub fn bound<L: Bounded>(&self, lobe: L) -> L::Shape {
        let (flux, delta, xi) = self.roulette;
        Vpl::new(self.position, flux, lobe)
            .unwrap()
            .bound(&Roulette::new(delta).unwrap(), Xi::new(xi).unwrap())
    }

    pub fn spheroid(&self, roughness: f32, fresnel: Fresnel, masking: Masking) -> Spheroid {
        self.ggx_bounds(roughness, fresnel, masking).spheroid
    }

    pub fn ggx_bounds(&self, roughness: f32, fresnel: Fresnel, masking: Masking) -> GgxBounds {
        let ggx = Ggx::new(roughness).unwrap();
        match fresnel {
            Fresnel::None => self.ggx_bounds_of(ggx, NoFresnel, masking),
            Fresnel::Schlick(f0) => self.ggx_bounds_of(ggx, Schlick::new(f0).unwrap(), masking),
            Fresnel::Dielectric(eta) => {
                self.ggx_bounds_of(ggx, Dielectric::new(eta).unwrap(), masking)
            }
            Fresnel::Conductor(eta, kappa) => {
                self.ggx_bounds_of(ggx, Conductor::new(eta, kappa).unwrap(), masking)
            }
        }
    }

    pub fn ggx_bounds_of<F>(&self, ggx: Ggx, fresnel: F, masking: Masking) -> GgxBounds
    where
        F: stochastic_light_culling::Fresnel,
    {
        let lobe = GgxLobe::new(
            ggx,
            fresnel,
            Incidence {
                normal: self.lit.normal,
                incoming: self.lit.incoming,
            },
        );
        match masking {
            Masking::HeightCorrelated => self.bounds_of_lobe(lobe),
            Masking::Separable => self.bounds_of_lobe(lobe.separable()),
            Masking::MaskedAlone => self.bounds_of_lobe(lobe.with_masking::<MaskedAlone>()),
        }
    }

    pub fn anisotropic_bound(
        &self,
        roughness: [f32; 2],
        tangent: Direction,
        fresnel: Fresnel,
        masking: Masking,
    ) -> Ellipsoid {
        let [along, across] = roughness;
        let ggx = AnisotropicGgx::new(along, across).unwrap();
        let fresnel = GivenFresnel::try_from(fresnel).unwrap();
        let (normal, incoming) = (self.lit.normal, self.lit.incoming);
        let lobe =
            AnisotropicGgxLobe::new(ggx, fresnel, Incidence { normal, incoming }, tangent).unwrap();
        match masking {
            Masking::HeightCorrelated => self.bound(lobe),
            Masking::Separable => self.bound(lobe.separable()),
            Masking::MaskedAlone => self.bound(lobe.with_masking::<MaskedAlone>()),
        }
    }

    pub fn bounds_of_lobe<F, G>(&self, lobe: GgxLobe<F, G>) -> GgxBounds
    where
        F: stochastic_light_culling::Fresnel,
        G: MaskingShadowing,
    {
        let (flux, delta, xi) = self.roulette;
        let light = Vpl::new(self.position, flux, lobe).unwrap();
        let (roulette, xi) = (Roulette::new(delta).unwrap(), Xi::new(xi).unwrap());
        GgxBounds {
            spheroid: light.bound_by(Paper, &roulette, xi),
            triaxial: light.bound_by(Triaxial, &roulette, xi),
            tight: light.bound_by(Tight, &roulette, xi),
            max_fresnel: lobe.max_fresnel().into(),
        }
    }

    /// All bounds that the crate has for this light.
    pub fn bounds(&self) -> Vec<(&'static str, Shape)> {
        match self.brdf {
            Brdf::Ggx {
                roughness,
                fresnel,
                masking,
            } => {
                let GgxBounds {
                    spheroid,
                    triaxial,
                    tight,
                    ..
                } = self.ggx_bounds(roughness, fresnel, masking);
                vec![
                    ("spheroid", spheroid.into()),
                    (
                        "ellipsoid of the spheroid",
                        Ellipsoid::from(spheroid).into(),
                    ),
                    ("triaxial ellipsoid", triaxial.into()),
                    ("tight ellipsoid", tight.into()),
                    ("sphere at the light", spheroid.sphere_at_focus().into()),
                    (
                        "sphere around the spheroid",
                        spheroid.enclosing_sphere().into(),
                    ),
                ]
            }
            Brdf::Anisotropic {
                roughness,
                tangent,
                fresnel,
                masking,
            } => {
                let bound = self.anisotropic_bound(roughness, tangent, fresnel, masking);
                vec![("ellipsoid of the anisotropic lobe", bound.into())]
            }
            Brdf::Lambert { albedo } => {
                let (flux, delta, xi) = self.roulette;
                let lobe = LambertLobe::new(albedo, self.lit.normal).unwrap();
                let light = Vpl::new(self.position, flux, lobe).unwrap();
                let tight =
                    light.bound_by(Tight, &Roulette::new(delta).unwrap(), Xi::new(xi).unwrap());
                vec![
                    ("sphere of Lambert's lobe", self.bound(lobe).into()),
                    ("ellipsoid of Lambert's lobe", tight.into()),
                ]
            }
            Brdf::Phong { albedo, exponent } => {
                let lobe = PhongLobe::new(
                    albedo,
                    exponent,
                    Incidence {
                        normal: self.lit.normal,
                        incoming: self.lit.incoming,
                    },
                )
                .unwrap();
                vec![("ellipsoid of Phong's lobe", self.bound(lobe).into())]
            }
            Brdf::Spot { angles, .. } => {
                let [inner, outer] = angles;
                let lobe = SpotLobe::new(inner, outer, self.lit.normal).unwrap();
                let [tight, hard] = [lobe, lobe.hard_edged()].map(|lobe| self.bound(lobe).into());
                vec![
                    ("ellipsoid of a spot light", tight),
                    ("ellipsoid of its outer cone", hard),
                ]
            }
            Brdf::SphericalGaussian {
                amplitude,
                sharpness,
            } => {
                let lobe = SphericalGaussian::new(self.lit.normal, sharpness, amplitude).unwrap();
                let (flux, delta, xi) = self.roulette;
                let light = Vpl::new(self.position, flux, lobe).unwrap();
                let focal =
                    light.bound_by(Focal, &Roulette::new(delta).unwrap(), Xi::new(xi).unwrap());
                vec![
                    ("ellipsoid of an SG", self.bound(lobe).into()),
                    ("spheroid of an SG", focal.into()),
                    (
                        "ellipsoid of the spheroid of an SG",
                        Ellipsoid::from(focal).into(),
                    ),
                    ("sphere at an SG", focal.sphere_at_focus().into()),
                    ("sphere around an SG", focal.enclosing_sphere().into()),
                ]
            }
            Brdf::Ltc { lobe, .. } => {
                vec![("ellipsoid of a transformed cosine", self.bound(lobe).into())]
            }
            Brdf::Constant => vec![("sphere of a point light", self.bound(ConstantLobe).into())],
        }
    }

    /// Directions in which a bound is most likely to fail.
    pub fn directions(&self, random: &[Vector]) -> Vec<Vector> {
        let surface = self.lit.surface;
        let mirror = match self.brdf {
            Brdf::SphericalGaussian { .. } => surface.normal,
            _ => surface.mirror().unit(),
        };
        let across = match surface.normal.cross(surface.incoming) {
            cross if cross.length() > 1e-12 => cross.unit(),
            _ => mirror.orthogonal(),
        };
        let in_plane = across.cross(mirror);
        let width = match self.brdf {
            Brdf::Ggx { roughness, .. } | Brdf::Ltc { roughness, .. } => f64::from(roughness),
            Brdf::Anisotropic { roughness, .. } => f64::from(roughness[0].min(roughness[1])),
            Brdf::Phong { exponent, .. } => (1.0 / (2.0 + 2.0 * f64::from(exponent))).sqrt(),
            Brdf::SphericalGaussian { sharpness, .. } => {
                (1.0 / (2.0 + 2.0 * f64::from(sharpness))).sqrt()
            }
            _ => 1.0,
        };
        let mut directions = vec![mirror, surface.normal, surface.incoming, -surface.incoming];
        if let Brdf::Anisotropic {
            roughness, tangent, ..
        } = self.brdf
        {
            directions.extend(surface.mirrored_by_facets(roughness, tangent));
        }
        if let Brdf::Spot { angles, .. } = self.brdf {
            let [inner, outer] = angles.map(f64::from);
            let side = surface.normal.orthogonal();
            for step in 0..=64 {
                let share = f64::from(step) / 64.0;
                for angle in [inner * share, inner + (outer - inner) * share] {
                    let azimuth = 2.399_963 * f64::from(step);
                    let side = side.turned(surface.normal.cross(side), azimuth);
                    directions.push(surface.normal.turned(side, angle));
                }
            }
        }
        if let Brdf::Ltc { lobe, .. } = self.brdf {
            // What M maps evenly spread directions to.
            let [first, third] = ltc_rows(&lobe);
            let second = third.cross(first);
            let columns = [second.cross(third), second, first.cross(second)];
            directions.extend((0..300).map(|i| {
                let height = (f64::from(i) + 0.5) / 300.0;
                let (radius, azimuth) = ((1.0 - height * height).sqrt(), 2.399_963 * f64::from(i));
                let [x, y] = [azimuth.cos(), azimuth.sin()].map(|x| radius * x);
                (columns[0] * x + columns[1] * y + columns[2] * height).unit()
            }));
        }
        for step in 0..48 {
            // Even in the half angle's tangent over α, so that narrow lobes are covered too.
            let t = std::f64::consts::PI * (f64::from(step) + 0.5) / 48.0;
            let angle = 2.0 * (width * (0.5 * t).tan()).atan();
            for side in [in_plane, -in_plane, across, -across] {
                directions.push(mirror.turned(side, angle));
            }
            let slanted = (in_plane + across * (f64::from(step) - 24.0)).unit();
            directions.push(mirror.turned(slanted, angle));
            // Just above the horizon, all around.
            let azimuth = TAU * f64::from(step) / 48.0;
            let tangent = surface.normal.orthogonal();
            let tangent = tangent.turned(surface.normal.cross(tangent), azimuth);
            directions.push(tangent.turned(surface.normal, 10_f64.powi(-(step % 7))));
        }
        directions.extend_from_slice(random);
        directions
    }
}

pub fn case() -> impl Strategy<Value = Case> {
    (
        generators::brdf(),
        generators::lit(),
        generators::position(),
        generators::roulette(),
    )
        .prop_map(|(brdf, lit, position, roulette)| Case {
            brdf: brdf
                .laid_on(lit.surface.normal)
                .lit_by(lit.normal, lit.incoming),
            lit,
            position,
            roulette,
        })
}
