use glam::Vec3;

use crate::base::{Error, finite, number_in};
use crate::lobe::Lobe;

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

    /// The radiant intensity I(ω_o) = Φ f max(ω_o·n, 0) in W/sr towards the unit vector `outgoing` = ω_o
    /// [Tokuyoshi & Harada 2017, Eq. 4].
    ///
    /// Not negative; zero below the horizon of the lobe.
    #[inline]
    pub fn radiant_intensity(&self, outgoing: Vec3) -> f32 {
        self.flux * self.lobe.value(outgoing)
    }
}
