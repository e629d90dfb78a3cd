use core::f32::consts::PI;

use glam::Vec3;

use crate::base::{Error, finite, number_in};
use crate::lobe::{ConstantLobe, Lobe, SpotLobe};
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

impl Vpl<ConstantLobe> {
    /// Creates a point light of `intensity` = I at `position`: the same intensity in every direction. Its flux is
    /// 4πI.
    ///
    /// In W/sr or in candela, the unit of glTF. With I in candela the flux is in lumens, the unit of Bevy and
    /// Filament; who has lumens calls [`new`](Self::new). L = I/l² is then the illuminance in lux of a surface that
    /// faces the light, and so is δ. For coloured light I is the luminance of the colour times its intensity, and
    /// a channel of the estimate is that of the light times the channel over that luminance.
    ///
    /// The radiance of a light that is a ball is I/l² too, from its surface on. Within its radius take l to be
    /// that radius, as engines do (`RadianceEstimator::with_least_distance_squared`, feature `cull`). Bounds stay
    /// valid, since that only dims the light.
    ///
    /// ```
    /// use stochastic_light_culling::{Roulette, Vpl, Xi, glam::Vec3};
    ///
    /// // An orange lamp of 80 cd, whose colour has the luminance 0.56.
    /// let (colour, luminance) = (Vec3::new(1.0, 0.5, 0.1), 0.56);
    /// let lamp = Vpl::point(Vec3::new(0.0, 2.0, 0.0), 80.0 * luminance)?;
    /// let (direction, squared) = lamp.direction_to(Vec3::ZERO);
    /// let (roulette, xi) = (Roulette::new(0.5)?, Xi::new(0.5)?); // δ = 0.5 lx
    /// let estimate = roulette.estimate(lamp.radiant_intensity(direction), squared, xi);
    /// let illuminance = colour / luminance * estimate;
    /// assert!((illuminance - colour * 20.0).length() < 1e-4);
    /// # Ok::<(), stochastic_light_culling::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new). The flux must be finite too.
    pub fn point(position: Vec3, intensity: f32) -> Result<Self, Error> {
        Self::new(position, flux(intensity)?, ConstantLobe)
    }
}

impl Vpl<SpotLobe> {
    /// Creates a spot light whose intensity within its inner cone is `intensity` = I. Its flux is 4πI, that of a
    /// point light of the same intensity, of which the cones let the share
    /// [`emitted_share`](SpotLobe::emitted_share) through.
    ///
    /// Units and colour are those of [`Vpl::point`]. Lumens of Bevy, which do not depend on the cones, are the
    /// flux itself. Lumens that are emitted in all are the flux times the share.
    ///
    /// # Errors
    ///
    /// As [`Vpl::point`].
    pub fn spot(position: Vec3, intensity: f32, lobe: SpotLobe) -> Result<Self, Error> {
        Self::new(position, flux(intensity)?, lobe)
    }
}

/// The flux 4πI of a light with the same `intensity` = I in every direction.
fn flux(intensity: f32) -> Result<f32, Error> {
    let most = f32::MAX / (4.0 * PI);
    let valid = "not negative, and finite times 4π";
    number_in("intensity", intensity, valid, 0.0..=most).map(|intensity| 4.0 * PI * intensity)
}

/// The smallest length that a vector is divided by, 2⁻⁶³. Squares of smaller ones lose digits.
const LEAST_LENGTH: f32 = 1.084_202_2e-19;

/// The vector of unit length along `way`; see [`Vpl::direction_to`].
#[inline(always)]
pub(crate) fn unit<N: Single>(way: Vector3<N>, length_squared: N) -> Vector3<N> {
    let length = Real::max(length_squared.sqrt(), way.x.splat(LEAST_LENGTH));
    way * length.recip()
}
