//! Fresnel factors from Snell's law and complex amplitudes.

#[derive(Clone, Copy, Debug)]
pub enum Fresnel {
    None,
    Schlick(f32),
    Dielectric(f32),
    Conductor(f32, f32),
}

impl Fresnel {
    /// F at the angle θ_h whose cosine is given.
    pub fn at(self, cosine: f64) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Schlick(f0) => {
                let f0 = f64::from(f0);
                f0 + (1.0 - f0) * (1.0 - cosine).powi(5)
            }
            Self::Dielectric(eta) => unpolarised(cosine, f64::from(eta), 0.0),
            Self::Conductor(eta, kappa) => unpolarised(cosine, f64::from(eta), f64::from(kappa)),
        }
    }

    /// The largest F over half vectors of outgoing directions above the surface, by search: the half
    /// angle runs from 0 to θ_i/2 + π/4.
    pub fn max_above_surface(self, incident_cosine: f64) -> f64 {
        let widest = 0.5 * incident_cosine.min(1.0).acos() + std::f64::consts::FRAC_PI_4;
        (0..=2000)
            .map(|i| self.at((widest * f64::from(i) / 2000.0).cos()))
            .fold(0.0, f64::max)
    }
}

/// (|r_s|² + |r_p|²)/2 with the amplitudes of Born & Wolf.
fn unpolarised(cosine: f64, eta: f64, kappa: f64) -> f64 {
    let squared = complex_mul((eta, kappa), (eta, kappa));
    let sine_squared = 1.0 - cosine * cosine;
    let w = complex_sqrt((squared.0 - sine_squared, squared.1));
    let (c, e) = ((cosine, 0.0), complex_mul(squared, (cosine, 0.0)));
    0.5 * (ratio_squared(c, w) + ratio_squared(e, w))
}

/// |(a − b)/(a + b)|²
fn ratio_squared(a: (f64, f64), b: (f64, f64)) -> f64 {
    let modulus_squared = |x: f64, y: f64| x * x + y * y;
    modulus_squared(a.0 - b.0, a.1 - b.1) / modulus_squared(a.0 + b.0, a.1 + b.1)
}

fn complex_mul(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn complex_sqrt((x, y): (f64, f64)) -> (f64, f64) {
    let (modulus, angle) = (x.hypot(y).sqrt(), 0.5 * y.atan2(x));
    (modulus * angle.cos(), modulus * angle.sin())
}
