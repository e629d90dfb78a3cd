use glam::Vec3;

use crate::base::{Error, finite, number_in};
use crate::lobe::Lobe;

/// A virtual point light: a lit surface point that lights others [Keller 1997].
///
/// `L` is what it reflects; an ordinary point light is one with a [`ConstantLobe`](crate::ConstantLobe).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vpl<L> {
    position: Vec3,
    flux: f32,
    lobe: L,
}

impl<L: Lobe> Vpl<L> {
    /// A light at `position`, where a photon of `flux` Φ (W) arrived and is reflected by `lobe`.
    ///
    /// For coloured light Φ is any non-negative weighting of the channels, such as luminance: the
    /// estimator stays unbiased in each channel as long as no channel is lit where Φ is zero.
    /// Zero flux is a light that reaches nothing.
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

    /// Where the light is.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Φ, in W.
    pub fn flux(&self) -> f32 {
        self.flux
    }

    /// What the light reflects.
    pub fn lobe(&self) -> &L {
        &self.lobe
    }

    /// I(ω_o) = Φ f max(ω_o·n, 0) in W/sr, towards the unit direction `outgoing`
    /// [Tokuyoshi & Harada 2017, Eq. 4].
    #[inline]
    pub fn radiant_intensity(&self, outgoing: Vec3) -> f32 {
        self.flux * self.lobe.value(outgoing)
    }
}
