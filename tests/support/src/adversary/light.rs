//! Lights from the whole domain, and how far they reach.

use std::f64::consts::{FRAC_PI_2, TAU};

use fastrand::Rng;
use stochastic_light_culling::{
    AnisotropicGgx, AnisotropicGgxLobe, Bounded, Conductor, ConstantLobe, Dielectric, Direction,
    Focal, Ggx, GgxLobe, Incidence, LambertLobe, MaskingShadowing, NoFresnel, Paper, PhongLobe,
    Roulette, Schlick, SphericalGaussian, SpotLobe, Tight, Triaxial, Vpl, Xi, glam::Vec3,
};
use twofloat::TwoFloat as Real;

use super::draw::{cone_angles, exponent, fresnel, masking, matrix, sharpness, two_roughnesses};
use super::{Bound, Reach, chance, direction, log_uniform, unit_vector, up_to_one};
use crate::reference::exact::{Exact, value};
use crate::reference::{Brdf, Fresnel, GivenFresnel, MaskedAlone, Masking, Vector, ltc_rows};

/// A light in one frame.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    pub brdf: Brdf,
    pub normal: Direction,
    pub incoming: Direction,
    pub position: Vec3,
    pub flux: f32,
    pub delta: f32,
    pub xi: f32,
}

impl Light {
    /// Any light of the domain: α from 1e-6, μ from 1e-7, ranges from 1e-12 to 1e12, ξ from 2⁻³², up
    /// to 1e6 ranges from the origin.
    pub fn draw(rng: &mut Rng) -> Self {
        let range = log_uniform(rng, 1e-12, 1e12);
        let distance = range * log_uniform(rng, 1e-3, 1e6);
        let mu = up_to_one(rng, 1e-7);
        let brdf = match rng.u8(0..18) {
            0 => Brdf::Lambert {
                albedo: up_to_one(rng, 1e-6) as f32,
            },
            1 => Brdf::Constant,
            9 | 10 => Brdf::SphericalGaussian {
                amplitude: log_uniform(rng, 1e-6, 1e6) as f32,
                sharpness: sharpness(rng),
            },
            2 | 3 => Brdf::Phong {
                albedo: up_to_one(rng, 1e-6) as f32,
                exponent: exponent(rng),
            },
            16 => Brdf::ltc(up_to_one(rng, 1e-6) as f32, rng.f32(), None),
            17 => Brdf::ltc(1.0, up_to_one(rng, 1e-6) as f32, Some(matrix(rng))),
            4..6 => Brdf::spot(cone_angles(rng)),
            6..9 => Brdf::Anisotropic {
                roughness: two_roughnesses(rng),
                tangent: direction(unit_vector(rng)),
                fresnel: fresnel(rng),
                masking: masking(rng),
            },
            _ => Brdf::Ggx {
                roughness: up_to_one(rng, 1e-6) as f32,
                fresnel: fresnel(rng),
                masking: masking(rng),
            },
        };
        Self::with(rng, brdf, mu, range, distance)
    }

    /// A light that reaches as far as `range` at the peak of its lobe, `distance` from the origin.
    pub fn with(rng: &mut Rng, brdf: Brdf, mu: f64, range: f64, distance: f64) -> Self {
        let normal = unit_vector(rng);
        let tangent = normal.orthogonal();
        let tangent = tangent.turned(normal.cross(tangent), rng.f64() * TAU);
        let incoming = tangent * (1.0 - mu * mu).sqrt() + normal * mu;
        let normal = direction(normal);
        // Normal incidence is so to the last bit.
        let incoming = if mu == 1.0 {
            normal
        } else {
            direction(incoming)
        };
        let brdf = brdf.laid_on(Vector::from(*normal));
        let mut light = Self {
            brdf: brdf.lit_by(normal, incoming),
            normal,
            incoming,
            position: (unit_vector(rng) * distance).to_f32(),
            flux: 1.0,
            delta: log_uniform(rng, 1e-6, 1e3) as f32,
            xi: up_to_one(rng, 2.0_f64.powi(-32)) as f32,
        };
        let unit_reach = light.reach(light.peak().unit()).hi().max(1e-15);
        light.flux = (range / unit_reach).powi(2).clamp(1e-37, 1e37) as f32;
        light
    }

    fn unit_normal(&self) -> Exact {
        Exact::from(*self.normal).unit()
    }

    fn unit_incoming(&self) -> Exact {
        Exact::from(*self.incoming).unit()
    }

    /// About where the lobe is largest.
    pub fn peak(&self) -> Exact {
        let (n, w) = (self.unit_normal(), self.unit_incoming());
        match self.brdf {
            Brdf::Lambert { .. }
            | Brdf::Constant
            | Brdf::Spot { .. }
            | Brdf::SphericalGaussian { .. } => n,
            // Where the first two components of M⁻¹ω vanish.
            Brdf::Ltc { lobe, .. } => {
                let [first, third] = ltc_rows(&lobe).map(|row| Exact(row.0.map(Real::from)));
                first.cross(third.cross(first))
            }
            _ => n * (n.dot(w) * 2.0) - w,
        }
    }

    /// A direction that M maps any direction to.
    fn transformed(&self, rng: &mut Rng) -> Exact {
        let Brdf::Ltc { lobe, .. } = self.brdf else {
            return self.peak().unit();
        };
        let exact = |row: Vector| Exact(row.0.map(Real::from));
        let [first, third] = ltc_rows(&lobe).map(exact);
        let second = third.cross(first);
        // The columns of M times the determinant.
        let columns = [second.cross(third), third.cross(first), first.cross(second)];
        let way = exact(unit_vector(rng));
        let [x, y, z] = way.0;
        let z = if z < Real::from(0.0) { -z } else { z };
        (columns[0] * x + columns[1] * y + columns[2] * z).unit()
    }

    fn about_peak(&self, rng: &mut Rng) -> Exact {
        let width = match self.brdf {
            Brdf::Ggx { roughness, .. } | Brdf::Ltc { roughness, .. } => f64::from(roughness),
            Brdf::Anisotropic { roughness, .. } => f64::from(roughness[rng.usize(0..2)]),
            Brdf::Phong { exponent, .. } => (1.0 / (2.0 + 2.0 * f64::from(exponent))).sqrt(),
            Brdf::SphericalGaussian { sharpness, .. } => {
                (1.0 / (2.0 + 2.0 * f64::from(sharpness))).sqrt()
            }
            _ => 1.0,
        };
        let peak = self.peak().unit();
        let middle = Vector(peak.0.map(|x| x.hi()));
        let across = match Vector::from(*self.normal).cross(Vector::from(*self.incoming)) {
            cross if cross.length() > 1e-7 => cross.unit(),
            _ => middle.orthogonal(),
        };
        let along = across.cross(middle);
        let side = match rng.u8(0..4) {
            0 => across,
            1 => along + across * (10.0 * (rng.f64() - 0.5)),
            _ => along,
        };
        let side = Exact(side.unit().0.map(Real::from));
        // The direction at the angle 2 atan t from the peak: ((1 − t²) peak + 2t side)/(1 + t²).
        let tangent = width * (rng.f64() * FRAC_PI_2).tan();
        let t = Real::from(if rng.bool() { tangent } else { -tangent });
        (peak * (Real::from(1.0) - t * t) + side * (t * 2.0)).unit()
    }

    /// Anywhere in the outer cone of a spot light, often next to the edge of either.
    fn in_cones(&self, rng: &mut Rng) -> Exact {
        let Brdf::Spot { angles, .. } = self.brdf else {
            return self.peak().unit();
        };
        let [inner, outer] = angles.map(f64::from);
        let off = log_uniform(rng, 1e-12, 0.1);
        let angle = match rng.u8(0..8) {
            0 => outer * (1.0 - off),
            1 => inner * (1.0 - off),
            2 => inner * (1.0 + off),
            3 => inner + (outer - inner) * off,
            4 => inner,
            5 => inner * rng.f64(),
            _ => inner + (outer - inner) * rng.f64(),
        };
        let normal = Vector::from(*self.normal);
        let side = normal.orthogonal();
        let side = side.turned(normal.cross(side).unit(), rng.f64() * TAU);
        let side = Exact(side.0.map(Real::from));
        let t = Real::from((0.5 * angle).tan());
        let peak = self.peak();
        (peak * (Real::from(1.0) - t * t) + side * (t * 2.0)).unit()
    }

    /// Where a facet mirrors the light that is any of those that the roughness spreads evenly, often
    /// one that leans along the tangent or the bitangent only.
    fn mirrored_by_facet(&self, rng: &mut Rng) -> Exact {
        let Brdf::Anisotropic {
            roughness, tangent, ..
        } = self.brdf
        else {
            return self.peak().unit();
        };
        let (n, w) = (self.unit_normal(), self.unit_incoming());
        let across = n.cross(Exact::from(*tangent)).unit();
        let along = across.cross(n);
        let lean = |rng: &mut Rng, alpha: f32| {
            let share = if chance(rng, 0.2) { 0.0 } else { rng.f64() };
            f64::from(alpha) * (share * FRAC_PI_2).tan() * if rng.bool() { 1.0 } else { -1.0 }
        };
        let [x, y] = roughness.map(|alpha| Real::from(lean(rng, alpha)));
        let facet = (n + along * x + across * y).unit();
        facet * (facet.dot(w) * 2.0) - w
    }

    /// The crate's bound of this light.
    pub fn bound(&self) -> Bound {
        match self.brdf {
            Brdf::Constant => Bound::Sphere(self.bound_of(ConstantLobe)),
            Brdf::Spot { angles, .. } => {
                let [inner, outer] = angles;
                let lobe = SpotLobe::new(inner, outer, self.normal).expect("in the domain");
                Bound::Spot(self.bound_of(lobe))
            }
            Brdf::Ltc { lobe, .. } => Bound::Ltc(self.bound_of(lobe)),
            Brdf::Lambert { albedo } => {
                let lobe = LambertLobe::new(albedo, self.normal).expect("in the domain");
                let light = Vpl::new(self.position, self.flux, lobe).expect("in the domain");
                let (roulette, xi) = self.roulette();
                Bound::Lambert {
                    sphere: light.bound(&roulette, xi),
                    tight: light.bound_by(Tight, &roulette, xi),
                }
            }
            Brdf::SphericalGaussian {
                amplitude,
                sharpness,
            } => {
                let lobe = SphericalGaussian::new(self.normal, sharpness, amplitude)
                    .expect("in the domain");
                let light = Vpl::new(self.position, self.flux, lobe).expect("in the domain");
                let (roulette, xi) = self.roulette();
                Bound::SphericalGaussian {
                    focal: light.bound_by(Focal, &roulette, xi),
                    tight: light.bound(&roulette, xi),
                }
            }
            Brdf::Phong { albedo, exponent } => {
                let lobe = PhongLobe::new(
                    albedo,
                    exponent,
                    Incidence {
                        normal: self.normal,
                        incoming: self.incoming,
                    },
                )
                .expect("in the domain");
                Bound::Phong(self.bound_of(lobe))
            }
            Brdf::Anisotropic {
                roughness,
                tangent,
                fresnel,
                masking,
            } => {
                let [along, across] = roughness;
                let ggx = AnisotropicGgx::new(along, across).expect("in the domain");
                let fresnel = GivenFresnel::try_from(fresnel).expect("in the domain");
                let lobe = AnisotropicGgxLobe::new(
                    ggx,
                    fresnel,
                    Incidence {
                        normal: self.normal,
                        incoming: self.incoming,
                    },
                    tangent,
                )
                .expect("laid on the surface");
                Bound::Anisotropic(match masking {
                    Masking::HeightCorrelated => self.bound_of(lobe),
                    Masking::Separable => self.bound_of(lobe.separable()),
                    Masking::MaskedAlone => self.bound_of(lobe.with_masking::<MaskedAlone>()),
                })
            }
            Brdf::Ggx {
                roughness,
                fresnel,
                masking,
            } => {
                let ggx = Ggx::new(roughness).expect("in the domain");
                self.ggx_bound(ggx, fresnel, masking)
                    .expect("in the domain")
            }
        }
    }

    fn ggx_bound(
        &self,
        ggx: Ggx,
        fresnel: Fresnel,
        masking: Masking,
    ) -> Result<Bound, stochastic_light_culling::Error> {
        Ok(match fresnel {
            Fresnel::None => self.ggx_bound_of(ggx, NoFresnel, masking),
            Fresnel::Schlick(f0) => self.ggx_bound_of(ggx, Schlick::new(f0)?, masking),
            Fresnel::Dielectric(eta) => self.ggx_bound_of(ggx, Dielectric::new(eta)?, masking),
            Fresnel::Conductor(eta, kappa) => {
                self.ggx_bound_of(ggx, Conductor::new(eta, kappa)?, masking)
            }
        })
    }

    fn ggx_bound_of<F>(&self, ggx: Ggx, fresnel: F, masking: Masking) -> Bound
    where
        F: stochastic_light_culling::Fresnel,
    {
        let lobe = GgxLobe::new(
            ggx,
            fresnel,
            Incidence {
                normal: self.normal,
                incoming: self.incoming,
            },
        );
        match masking {
            Masking::HeightCorrelated => self.both_bounds_of(lobe),
            Masking::Separable => self.both_bounds_of(lobe.separable()),
            Masking::MaskedAlone => self.both_bounds_of(lobe.with_masking::<MaskedAlone>()),
        }
    }

    fn both_bounds_of<F, G>(&self, lobe: GgxLobe<F, G>) -> Bound
    where
        F: stochastic_light_culling::Fresnel,
        G: MaskingShadowing,
    {
        let (roulette, xi) = self.roulette();
        let light = Vpl::new(self.position, self.flux, lobe).expect("in the domain");
        Bound::Ggx {
            spheroid: light.bound_by(Paper, &roulette, xi),
            triaxial: light.bound_by(Triaxial, &roulette, xi),
            tight: light.bound_by(Tight, &roulette, xi),
        }
    }

    fn bound_of<L: Bounded>(&self, lobe: L) -> L::Shape {
        let (roulette, xi) = self.roulette();
        let light = Vpl::new(self.position, self.flux, lobe).expect("in the domain");
        light.bound(&roulette, xi)
    }

    fn roulette(&self) -> (Roulette, Xi) {
        let roulette = Roulette::new(self.delta).expect("in the domain");
        (roulette, Xi::new(self.xi).expect("in the domain"))
    }
}

impl Reach for Light {
    fn position(&self) -> Vec3 {
        self.position
    }

    /// A direction in which a bound is likely to fail: about the peak, in the plane of incidence and
    /// across it, at all angles that the lobe's width makes interesting; at grazing; anywhere.
    fn outgoing(&self, rng: &mut Rng) -> Exact {
        let exact = |v: Vector| Exact(v.0.map(Real::from));
        let normal = Vector::from(*self.normal);
        match rng.u8(0..10) {
            0 => self.peak().unit(),
            1 => exact(unit_vector(rng)).unit(),
            3.. if matches!(self.brdf, Brdf::Spot { .. }) => self.in_cones(rng),
            3..6 if matches!(self.brdf, Brdf::Anisotropic { .. }) => self.mirrored_by_facet(rng),
            2 => {
                let tangent = normal.cross(unit_vector(rng));
                exact(tangent + normal * log_uniform(rng, 1e-8, 1.0)).unit()
            }
            3..6 if matches!(self.brdf, Brdf::Ltc { .. }) => self.transformed(rng),
            _ => self.about_peak(rng),
        }
    }

    /// l_max = √(Φ f μ_o/(δξ)).
    fn reach(&self, outgoing: Exact) -> Real {
        let value = value(
            self.brdf,
            self.unit_normal(),
            self.unit_incoming(),
            outgoing,
        );
        let divisor = Real::new_mul(self.delta.into(), self.xi.into());
        (Real::from(f64::from(self.flux)) / divisor * value).sqrt()
    }
}
