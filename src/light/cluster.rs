use core::iter::Sum;
use core::ops::{Add, AddAssign, Mul};

use glam::Vec3;

use super::Vsgl;
use crate::base::{Error, finite, number_in};
use crate::lobe::{SphericalGaussian, solid_angle, toksvig};
use crate::num::{Vector3, sqrt_f64};

/// Spread, as a share of the distance from the origin, squared, below which the difference of moments is
/// mostly rounding: 2⁻⁴⁶.
const LEAST_SPREAD_SQUARED: f64 = 1.421_085_471_520_200_4e-14;

/// The sums that a cluster of lights is known by, and the smooth light that stands for it
/// [Tokuyoshi 2016, Sec. 3].
///
/// They are the sums of flux and of mean direction, for diffuse and for glossy reflection apart, and of
/// position and squared position, weighted by the flux of both. Clusters merge by adding their sums, in any
/// order, and a share of a cluster is a multiple of them. So a pyramid of sums has the clusters of all its
/// levels. The sums are in double precision, since sharpness and spread are differences that cancel: the first
/// for sharp lobes, the second far from the origin.
///
/// ```
/// use stochastic_light_culling::{ClusterSums, Direction, Ggx, Incidence, SphericalGaussian, glam::Vec3};
///
/// let floor = Incidence { normal: Direction::Y, incoming: Direction::new(Vec3::new(-1.0, 1.0, 0.0))? };
/// let dull = SphericalGaussian::diffuse(0.5, floor.normal)?;
/// let glossy = SphericalGaussian::specular(Ggx::new(0.2)?, 0.3, floor)?;
/// // Two lights of 2 W, 0.6 m apart.
/// let light = |x| ClusterSums::of_light(Vec3::new(x, 0.0, 0.0), 2.0, &dull, &glossy);
/// let cluster = light(-0.3)? + light(0.3)?;
///
/// let both = cluster.glossy();
/// assert!((both.lobe().integral() - 4.0 * 0.3).abs() < 1e-5);
/// assert!((both.lobe().sharpness() / glossy.sharpness() - 1.0).abs() < 1e-5);
/// assert!((both.spread() - 0.3).abs() < 1e-6 && both.position().length() < 1e-6);
/// assert_eq!(cluster.diffuse().position(), both.position());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClusterSums {
    diffuse: LobeSums,
    glossy: LobeSums,
    position: Vector3<f64>,
    position_squared: f64,
}

/// The sums of one kind of reflection: of the flux, and of the flux times the mean direction.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LobeSums {
    flux: f64,
    direction: Vector3<f64>,
}

const ZERO: Vector3<f64> = Vector3 {
    x: 0.0,
    y: 0.0,
    z: 0.0,
};

impl LobeSums {
    const EMPTY: Self = Self {
        flux: 0.0,
        direction: ZERO,
    };

    fn of(flux: f64, lobe: &SphericalGaussian) -> Self {
        let flux = flux * f64::from(lobe.amplitude()) * solid_angle(f64::from(lobe.sharpness()));
        Self {
            flux,
            direction: lobe.mean() * flux,
        }
    }

    fn scaled(self, factor: f64) -> Self {
        Self {
            flux: self.flux * factor,
            direction: self.direction * factor,
        }
    }

    /// The SG by Toksvig's rule [Tokuyoshi 2016, Sec. 3.1].
    fn lobe(&self) -> SphericalGaussian {
        // The quotient is the same; without division by a flux that may be subnormal.
        let rest = self.flux - self.direction.length();
        let (axis, sharpness) = toksvig(self.direction, rest);
        let amplitude = self.flux / solid_angle(f64::from(sharpness));
        SphericalGaussian::of_parts(axis, sharpness, amplitude.min(f32::MAX.into()) as f32)
    }
}

impl Add for LobeSums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            flux: self.flux + other.flux,
            direction: self.direction + other.direction,
        }
    }
}

impl ClusterSums {
    /// The sums of no lights.
    pub const EMPTY: Self = Self {
        diffuse: LobeSums::EMPTY,
        glossy: LobeSums::EMPTY,
        position: ZERO,
        position_squared: 0.0,
    };

    /// The sums of one light at `position`, where the flux `flux` = Φ in W arrives, and is reflected by the
    /// lobes `diffuse` and `glossy`. Their integrals are the reflectances R_d and R_s.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `position` is not finite, [`Error::Number`] if `flux` is negative, infinite or NaN.
    pub fn of_light(
        position: Vec3,
        flux: f32,
        diffuse: &SphericalGaussian,
        glossy: &SphericalGaussian,
    ) -> Result<Self, Error> {
        let position = Vector3::from(finite("light position", position)?).widen();
        let flux = number_in("flux Φ", flux, "in [0, ∞)", 0.0..=f32::MAX)?;
        let [diffuse, glossy] = [diffuse, glossy].map(|lobe| LobeSums::of(flux.into(), lobe));
        let weight = diffuse.flux + glossy.flux;
        Ok(Self {
            diffuse,
            glossy,
            position: position * weight,
            position_squared: position.length_squared() * weight,
        })
    }

    /// The sums of the share `factor` of each light, or of `factor` times as many. It counts as zero if it is
    /// negative or NaN, and as 10³⁰ if it is larger.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        // Zero for NaN.
        let factor = if factor > 0.0 {
            f64::from(factor.min(1e30))
        } else {
            0.0
        };
        Self {
            diffuse: self.diffuse.scaled(factor),
            glossy: self.glossy.scaled(factor),
            position: self.position * factor,
            position_squared: self.position_squared * factor,
        }
    }

    /// The flux in W that all lights reflect: Σ Φ(R_d + R_s).
    #[must_use]
    pub fn flux(&self) -> f64 {
        self.diffuse.flux + self.glossy.flux
    }

    /// The smooth light that stands for the diffuse reflection of the cluster. See [`glossy`](Self::glossy).
    #[must_use]
    pub fn diffuse(&self) -> Vsgl {
        self.light_of(&self.diffuse)
    }

    /// The smooth light that stands for the glossy reflection of the cluster [Tokuyoshi 2016, Secs. 3.1–3.2].
    ///
    /// Its flux is the sum of the lights'. Its lobe is an SG by Toksvig's rule, from the mean of their mean
    /// directions: constant if that is zero, as for two lights with opposite lobes. Its position is the mean,
    /// and its spread the root of the mean squared distance from there, both weighted by diffuse and glossy
    /// flux together, so that the two lights of a cluster share one visibility. Lights in a plane with the
    /// variance s² along each axis have the spread √2 s.
    ///
    /// A cluster without flux is a light at the origin that reaches nothing. The spread of a single light is
    /// zero; any spread is that is below 1.2·10⁻⁷ of the distance from the origin, as little as `f32` positions
    /// resolve there. An amplitude above the largest `f32` is that.
    #[must_use]
    pub fn glossy(&self) -> Vsgl {
        self.light_of(&self.glossy)
    }

    fn light_of(&self, sums: &LobeSums) -> Vsgl {
        let weight = self.flux();
        let has_flux = weight > 0.0;
        if !has_flux {
            return Vsgl::of_cluster(Vec3::ZERO, 0.0, sums.lobe());
        }
        let mean = self.position / weight;
        let mean_squared = mean.length_squared();
        let variance = self.position_squared / weight - mean_squared;
        let spread = if variance > LEAST_SPREAD_SQUARED * mean_squared {
            sqrt_f64(variance)
        } else {
            0.0
        };
        let position = Vec3::from(Vector3::narrow(mean));
        Vsgl::of_cluster(position, spread as f32, sums.lobe())
    }
}

impl Default for ClusterSums {
    /// The sums of no lights.
    fn default() -> Self {
        Self::EMPTY
    }
}

/// Merges two clusters.
impl Add for ClusterSums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            diffuse: self.diffuse + other.diffuse,
            glossy: self.glossy + other.glossy,
            position: self.position + other.position,
            position_squared: self.position_squared + other.position_squared,
        }
    }
}

impl AddAssign for ClusterSums {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// A share of a cluster, as [`scaled`](ClusterSums::scaled).
impl Mul<f32> for ClusterSums {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f32) -> Self {
        self.scaled(factor)
    }
}

/// Merges all clusters.
impl Sum for ClusterSums {
    fn sum<I: Iterator<Item = Self>>(clusters: I) -> Self {
        clusters.fold(Self::EMPTY, |sum, cluster| sum + cluster)
    }
}
