use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::{Cap, Caps, Lobe, LobeNumbers, Majorant};
use crate::num::{Single, Vector3, round_up};

/// A lobe with the same value 1/(4π) sr⁻¹ in every direction: the ordinary point light of engines
/// [Tokuyoshi & Harada 2016]. Its radiant intensity is its flux over 4π. [`Vpl::point`](crate::Vpl::point) takes
/// an intensity, and says what about units and colour.
///
/// ```
/// use stochastic_light_culling::{ConstantLobe, Roulette, Vpl, Xi, glam::Vec3};
///
/// let lamp = Vpl::new(Vec3::ZERO, 100.0, ConstantLobe)?;
/// let sphere = lamp.bound(&Roulette::new(0.001)?, Xi::new(0.5)?);
/// let range = (100.0 / (4.0 * std::f32::consts::PI) / (0.001 * 0.5)).sqrt();
/// assert!((sphere.radius() / range - 1.0).abs() < 1e-5);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstantLobe;

impl ConstantLobe {
    /// The value 1/(4π) in sr⁻¹.
    pub const PEAK: f32 = 0.25 * FRAC_1_PI;
}

impl Lobe for ConstantLobe {
    #[inline]
    fn value(&self, _outgoing: Vec3) -> f32 {
        Self::PEAK
    }

    #[inline]
    fn maximum_within(&self, _cap: &Cap) -> f32 {
        round_up(Self::PEAK, 2)
    }

    fn has_more_than_numbers() -> bool {
        false
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        _: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        outgoing.x.splat(Self::PEAK)
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        _: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        Majorant::exactly(cap.splat(round_up(Self::PEAK, 2)))
    }
}
