use super::cap::CapSum;
use super::lambert::lambert_majorant;
use super::{Cap, Caps, LambertLobe, LobeFamily, Majorant, ReceiverLobe};
use crate::num::Single;

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

    #[inline(always)]
    fn to_sum(&self) -> Self::Sum {
        (self.albedo, CapSum::of(&self.normals))
    }

    #[inline(always)]
    fn add_to(&self, sum: &mut Self::Sum) {
        let (albedo, normals) = sum;
        if self.albedo <= 0.0 {
            return;
        }
        if *albedo <= 0.0 {
            *sum = self.to_sum();
            return;
        }
        *albedo = self.albedo.max(*albedo);
        normals.add(&self.normals);
    }

    fn mean((albedo, normals): &Self::Sum) -> Self {
        Self {
            albedo: *albedo,
            normals: normals.mean(),
        }
    }

    #[inline(always)]
    fn widen(&mut self, member: &Self) {
        if member.albedo > 0.0 {
            self.normals.widen(&member.normals);
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let albedo = cap.splat(self.albedo);
        lambert_majorant(albedo, &self.normals.splat(albedo), cap)
    }
}
