use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::Lobe;

/// The same radiant intensity in every direction: an engine's ordinary point light, whose intensity
/// is its flux over 4π, culled as in [Tokuyoshi & Harada 2016].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstantLobe;

impl ConstantLobe {
    /// 1/(4π) sr⁻¹.
    pub(crate) const VALUE: f32 = 0.25 * FRAC_1_PI;
}

impl Lobe for ConstantLobe {
    #[inline]
    fn value(&self, _outgoing: Vec3) -> f32 {
        Self::VALUE
    }
}
