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

    fn family(&self) -> LambertFamily {
        LambertFamily {
            albedo: self.albedo(),
            normals: Cap::of_axis(self.normal()),
        }
    }
}

impl LobeFamily for LambertFamily {
    fn union(mut families: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        let lit = families.clone().filter(|family| family.albedo > 0.0);
        let Some(normals) = Cap::union(lit.clone().map(|family| family.normals)) else {
            return families.next();
        };
        let albedo = lit.fold(0.0, |most: f32, family| most.max(family.albedo));
        Some(Self { albedo, normals })
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let albedo = cap.splat(self.albedo);
        lambert_majorant(albedo, &self.normals.splat(albedo), cap)
    }
}
