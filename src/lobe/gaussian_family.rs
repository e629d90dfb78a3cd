use super::cap_union::{CapMean, CapReach, CapSum};
use super::spherical_gaussian::SphericalGaussians;
use super::{Cap, Caps, LobeFamily, Majorant, ReceiverLobe, SphericalGaussian};
use crate::base::Direction;
use crate::num::{Real, Single, Vector3, exponential, round_up};

/// Budget for the share c/(λ + 1).
const SHARE_ROUNDINGS: u16 = 2;
/// Budget for the value by the greatest share.
const VALUE_ROUNDINGS: u16 = 8;

/// What stands for many [`SphericalGaussian`]s: a cap of axes, a range of sharpnesses λ, the greatest amplitude c, and
/// the greatest c/(λ + 1).
///
/// The sharper of two SGs that reflect alike has the greater amplitude. So there are two bounds at the least distance d
/// of an axis, and the majorant is the lesser: the greatest amplitude with the least sharpness, and the greatest share
/// times (λ + 1) exp(−½λd²), which is greatest at λ = 2/d² − 1, clamped to the range. Both nest, as maxima over sets that
/// grow with the family, of functions that fall with d.
///
/// Empty lobes reflect nothing, so a union leaves them out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalGaussianFamily {
    axes: Cap,
    sharpness: [f32; 2],
    amplitude: f32,
    /// The greatest c/(λ + 1)
    share: f32,
}

impl ReceiverLobe for SphericalGaussian {
    type Family = SphericalGaussianFamily;

    fn family(&self) -> SphericalGaussianFamily {
        let (sharpness, amplitude) = (self.sharpness(), self.amplitude());
        SphericalGaussianFamily {
            axes: Cap::of_axis(self.axis()),
            sharpness: [sharpness; 2],
            amplitude,
            share: round_up(amplitude / (sharpness + 1.0), SHARE_ROUNDINGS).max(f32::MIN_POSITIVE),
        }
    }
}

impl Default for SphericalGaussianFamily {
    /// The family of no lobe, to whose numbers any others are joined unchanged.
    fn default() -> Self {
        Self {
            axes: Cap::of_axis(Direction::Z),
            sharpness: [f32::MAX, 0.0],
            amplitude: 0.0,
            share: 0.0,
        }
    }
}

impl LobeFamily for SphericalGaussianFamily {
    /// All numbers but the axes, and those.
    type Sum = (Self, CapSum);
    /// The same of their mean.
    type Mean = (Self, CapMean);
    type Reach = CapReach;

    #[inline(always)]
    fn add_to(&self, (family, axes): &mut Self::Sum) {
        if self.amplitude <= 0.0 {
            return;
        }
        let ([least, most], [own_least, own_most]) = (family.sharpness, self.sharpness);
        *family = Self {
            sharpness: [least.min(own_least), most.max(own_most)],
            amplitude: family.amplitude.max(self.amplitude),
            share: family.share.max(self.share),
            ..*family
        };
        axes.add(&self.axes);
    }

    fn mean((family, axes): &Self::Sum) -> Self::Mean {
        (*family, axes.mean())
    }

    #[inline(always)]
    fn widen(&self, (_, axes): &Self::Mean, reach: &mut CapReach) {
        if self.amplitude > 0.0 {
            axes.widen(&self.axes, reach);
        }
    }

    fn around((family, axes): &Self::Mean, reach: &CapReach) -> Self {
        Self {
            axes: axes.cap(reach),
            ..*family
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let [least, most] = self.sharpness;
        let amplitude = cap.splat(self.amplitude);
        let widest = SphericalGaussians {
            axis: Vector3::splat(amplitude, (*self.axes.axis()).into()),
            sharpness: cap.splat(least),
            amplitude,
        };
        let axes = self.axes.splat(amplitude);
        let by_amplitude = widest.majorant(&axes, cap);
        let [distance, _] = cap.distances(&axes);
        let worst = amplitude.splat(2.0) / (distance * distance) - 1.0;
        let worst = Real::min(Real::max(worst, worst.splat(least)), worst.splat(most));
        let squared = distance.widen() * distance.widen();
        let power = exponential(-(worst.widen() * 0.5 * squared));
        let by_share = N::narrow((worst.widen() + 1.0) * f64::from(self.share) * power);
        // It may underflow.
        let by_share = Real::max(
            by_share.round_up(VALUE_ROUNDINGS),
            worst.splat(f32::MIN_POSITIVE),
        );
        let greatest = by_share.min(by_amplitude.greatest);
        Majorant {
            greatest,
            typical: by_amplitude.typical.min(greatest),
        }
    }
}
