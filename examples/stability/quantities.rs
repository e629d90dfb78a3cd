//! The formulas' values by the crate, by the direct port, and in double-double.

use stochastic_light_culling::{
    Conductor, Dielectric, Ggx, GgxLobe, Incidence, NoFresnel, Schlick, glam::Vec3,
};
use support::adversary::{Bound, Light};
use support::direct_port;
use support::reference::{
    Brdf, Fresnel,
    exact::{Exact, reflectance},
};
use twofloat::TwoFloat as Real;
use twofloat::consts::PI;

/// D, G1, F, F_max and r.
pub type Quantities<T> = [T; 5];

pub const SYMBOLS: Quantities<&str> = ["D", "G1", "F", "F_max", "r"];

/// Values below this are left out: they, or their factors, are subnormal in `f32`.
const LEAST: f64 = 1e-30;

/// The relative errors of the crate and of the direct port, for light that leaves towards `outgoing`;
/// 0 where there is nothing to compare, and infinite for NaN.
pub fn errors(
    light: &Light,
    port: Option<&direct_port::Light>,
    bound: &Bound,
    outgoing: Vec3,
) -> [Quantities<f64>; 2] {
    let Brdf::Ggx {
        roughness, fresnel, ..
    } = light.brdf
    else {
        return [[0.0; 5]; 2];
    };
    let half_vector = *light.incoming + outgoing;
    let half_angle_cosine = (0.5 * half_vector.length()).min(1.0);
    let mu = light.incoming.dot(*light.normal);
    let exact = [
        exact_ndf(roughness, half_vector, *light.normal),
        exact_masking(roughness, mu),
        reflectance(fresnel, Real::from(f64::from(half_angle_cosine))),
        exact_max_fresnel(light, fresnel),
        exact_radius(light).unwrap_or(Real::from(0.0)),
    ];
    let ggx = Ggx::new(roughness).expect("in the domain");
    let [f, f_max] = fresnel_factors(light, ggx, fresnel, half_angle_cosine);
    let r = match bound {
        Bound::Ggx { spheroid, .. } => spheroid.radius(),
        _ => f32::NAN,
    };
    let ours = [
        ggx.ndf_at(half_vector, *light.normal),
        ggx.masking(mu),
        f,
        f_max,
        r,
    ];
    let ported = port.map(|port| {
        [
            direct_port::ndf(
                port.alpha,
                direct_port::half_cosine(half_vector, port.normal),
            ),
            direct_port::masking(port.alpha, mu),
            port.fresnel.reflectance(half_angle_cosine),
            port.fresnel.maximum(mu),
            port.radius(),
        ]
    });
    [
        relative_errors(ours, exact),
        ported.map_or([0.0; 5], |ported| relative_errors(ported, exact)),
    ]
}

fn relative_errors(computed: Quantities<f32>, exact: Quantities<Real>) -> Quantities<f64> {
    std::array::from_fn(|i| {
        if exact[i].hi() < LEAST {
            return 0.0;
        }
        let error = ((Real::from(f64::from(computed[i])) - exact[i]) / exact[i])
            .hi()
            .abs();
        if error.is_nan() { f64::INFINITY } else { error }
    })
}

/// D of the half vector and the normal, both as rounded to `f32`; 0 at and below the horizon.
fn exact_ndf(roughness: f32, half_vector: Vec3, normal: Vec3) -> Real {
    if half_vector.dot(normal) <= 0.0 {
        return Real::from(0.0);
    }
    let (h, n) = (Exact::from(half_vector).unit(), Exact::from(normal).unit());
    let (cosine, across) = (h.dot(n), h.cross(n));
    let alpha_squared = squared(roughness);
    let spread = alpha_squared * cosine * cosine + across.dot(across);
    alpha_squared / (PI * spread * spread)
}

fn squared(x: f32) -> Real {
    Real::new_mul(x.into(), x.into())
}

/// μ + √(kμ² + α²)
fn masking_sum(roughness: f32, mu: Real) -> Real {
    let alpha_squared = squared(roughness);
    mu + ((Real::from(1.0) - alpha_squared) * mu * mu + alpha_squared).sqrt()
}

fn exact_masking(roughness: f32, mu: f32) -> Real {
    let mu = Real::from(f64::from(mu));
    mu * 2.0 / masking_sum(roughness, mu)
}

/// μ and √(1 − μ²) of the exact directions.
fn incident(light: &Light) -> (Real, Real) {
    let n = Exact::from(*light.normal).unit();
    let w = Exact::from(*light.incoming).unit();
    let cross = n.cross(w);
    (n.dot(w), cross.dot(cross).sqrt())
}

fn exact_max_fresnel(light: &Light, fresnel: Fresnel) -> Real {
    let (mu, sine) = incident(light);
    let smallest_cosine = mu / ((sine + 1.0) * 2.0).sqrt();
    let head_on = reflectance(fresnel, Real::from(1.0));
    reflectance(fresnel, smallest_cosine).max(head_on)
}

/// r = √(Φ F_max G1/(4πδξμ)) of a GGX light that is lit from above.
pub fn exact_radius(light: &Light) -> Option<Real> {
    let Brdf::Ggx {
        roughness, fresnel, ..
    } = light.brdf
    else {
        return None;
    };
    let (mu, _) = incident(light);
    let divisor = Real::new_mul(light.delta.into(), light.xi.into()) * PI * 2.0;
    let reflected = exact_max_fresnel(light, fresnel) * f64::from(light.flux);
    let squared = reflected / (divisor * masking_sum(roughness, mu));
    (mu.hi() > 0.0).then(|| squared.sqrt())
}

/// The crate's F and F_max.
fn fresnel_factors(light: &Light, ggx: Ggx, fresnel: Fresnel, cosine: f32) -> [f32; 2] {
    fn of<F: stochastic_light_culling::Fresnel>(
        light: &Light,
        ggx: Ggx,
        fresnel: F,
        cosine: f32,
    ) -> [f32; 2] {
        let Light {
            normal, incoming, ..
        } = *light;
        let lobe = GgxLobe::new(ggx, fresnel, Incidence { normal, incoming });
        [fresnel.reflectance(cosine), lobe.max_fresnel()]
    }
    const DOMAIN: &str = "in the domain";
    match fresnel {
        Fresnel::None => of(light, ggx, NoFresnel, cosine),
        Fresnel::Schlick(f0) => of(light, ggx, Schlick::new(f0).expect(DOMAIN), cosine),
        Fresnel::Dielectric(eta) => of(light, ggx, Dielectric::new(eta).expect(DOMAIN), cosine),
        Fresnel::Conductor(eta, kappa) => {
            let conductor = Conductor::new(eta, kappa).expect(DOMAIN);
            of(light, ggx, conductor, cosine)
        }
    }
}
