use glam::Vec3;

use crate::base::{Error, finite, number_in};
use crate::lobe::Lobe;
use crate::num::{Real, Single, Vector3};

/// A virtual point light: a lit surface point that lights others [Keller 1997].
///
/// The lobe `L` is what the point reflects. An ordinary point light has a
/// [`ConstantLobe`](crate::ConstantLobe).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vpl<L> {
    position: Vec3,
    flux: f32,
    lobe: L,
}

impl<L: Lobe> Vpl<L> {
    /// Creates a light at `position`, where the flux `flux` = Φ in W arrives and is reflected by `lobe`.
    ///
    /// For coloured light Φ is any non-negative weighting of the channels, such as luminance. The estimator
    /// is unbiased in each channel as long as no channel is lit where Φ is zero. A light with Φ = 0 reaches
    /// nothing.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `position` is not finite, [`Error::Number`] if `flux` is negative,
    /// infinite or NaN.
    pub fn new(position: Vec3, flux: f32, lobe: L) -> Result<Self, Error> {
        Ok(Self {
            position: finite("light position", position)?,
            flux: number_in("flux Φ", flux, "in [0, ∞)", 0.0..=f32::MAX)?,
            lobe,
        })
    }

    /// The position of the light, in world space.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// The flux Φ in W.
    pub fn flux(&self) -> f32 {
        self.flux
    }

    /// The lobe.
    pub fn lobe(&self) -> &L {
        &self.lobe
    }

    /// The direction ω_o from the light to `point` and the squared distance l², in that order.
    ///
    /// The direction has unit length to 10⁻⁶ at distances from 2⁻⁶³ to 2⁶⁴. At smaller ones it is shortened in
    /// proportion, to zero where the two coincide. At larger ones, where l² overflows, it is zero, and NaN if
    /// the difference of the points overflows too.
    ///
    /// ```
    /// use stochastic_light_culling::{ConstantLobe, Roulette, Vpl, Xi, glam::Vec3};
    ///
    /// let light = Vpl::new(Vec3::ZERO, 1.0, ConstantLobe)?;
    /// let (direction, distance_squared) = light.direction_to(Vec3::new(0.0, 0.0, 4.0));
    /// assert_eq!((direction, distance_squared), (Vec3::Z, 16.0));
    ///
    /// let intensity = light.radiant_intensity(direction);
    /// let radiance = Roulette::new(0.001)?.estimate(intensity, distance_squared, Xi::new(0.5)?);
    /// assert_eq!(radiance, intensity / 16.0);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    #[inline]
    pub fn direction_to(&self, point: Vec3) -> (Vec3, f32) {
        let way = Vector3::from(point) - self.position.into();
        let distance_squared = way.length_squared();
        (unit(way, distance_squared).into(), distance_squared)
    }

    /// The radiant intensity I(ω_o) = Φ f max(ω_o·n, 0) in W/sr towards the unit vector `outgoing` = ω_o
    /// [Tokuyoshi & Harada 2017, Eq. 4].
    ///
    /// Not negative; zero below the horizon of the lobe.
    #[inline]
    pub fn radiant_intensity(&self, outgoing: Vec3) -> f32 {
        self.flux * self.lobe.value(outgoing)
    }
}

/// The smallest length that a vector is divided by, 2⁻⁶³. Squares of smaller ones lose digits.
const LEAST_LENGTH: f32 = 1.084_202_2e-19;

/// The vector of unit length along `way`; see [`Vpl::direction_to`].
#[inline(always)]
pub(crate) fn unit<N: Single>(way: Vector3<N>, length_squared: N) -> Vector3<N> {
    let length = Real::max(length_squared.sqrt(), way.x.splat(LEAST_LENGTH));
    way * length.recip()
}
