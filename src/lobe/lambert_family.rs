use super::cap_union::{CapMean, CapReach, CapSum};
use super::lambert::lambert_majorant;
use super::{Cap, Caps, LambertLobe, LobeFamily, Majorant, ReceiverLobe};
use crate::num::{Real, Single};

/// What stands for many [`LambertLobe`]s: the greatest albedo, and a cap of normals.
///
/// The majorant is that of one lobe, with the chord of the normals added to that of the directions. It nests, since
/// ω·n changes by no more than the distances of ω and of n.
///
/// Black surfaces reflect nothing, so a union leaves them out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LambertFamily {
    albedo: f32,
    normals: Cap,
}

impl ReceiverLobe for LambertLobe {
    type Family = LambertFamily;

    #[inline(always)]
    fn family(&self) -> LambertFamily {
        LambertFamily {
            albedo: self.albedo(),
            normals: Cap::of_axis(self.normal()),
        }
    }
}

impl LobeFamily for LambertFamily {
    /// The greatest albedo, and the normals.
    type Sum = (f32, CapSum);
    /// The same of the normals' mean.
    type Mean = (f32, CapMean);
    type Reach = CapReach;

    #[inline(always)]
    fn add_to(&self, (albedo, normals): &mut Self::Sum) {
        if self.albedo > 0.0 {
            *albedo = Real::max(self.albedo, *albedo);
            normals.add(&self.normals);
        }
    }

    fn mean((albedo, normals): &Self::Sum) -> Self::Mean {
        (*albedo, normals.mean())
    }

    #[inline(always)]
    fn widen(&self, (_, normals): &Self::Mean, reach: &mut CapReach) {
        if self.albedo > 0.0 {
            normals.widen(&self.normals, reach);
        }
    }

    fn around((albedo, normals): &Self::Mean, reach: &CapReach) -> Self {
        Self {
            albedo: *albedo,
            normals: normals.cap(reach),
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let albedo = cap.splat(self.albedo);
        lambert_majorant(albedo, &self.normals.splat(albedo), cap)
    }
}
