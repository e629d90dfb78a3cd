use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use super::cap::CapSum;
use super::ggx::masking_root;
use super::ggx_majorant::{GgxMembers, worst_alpha_squared};
use super::{
    AnisotropicGgxLobe, Cap, Caps, Fresnel, FresnelMajorant, GgxLobe, HeightCorrelated, LobeFamily,
    Majorant, MaskingShadowing, ReceiverLobe,
};
use crate::num::{Real, Single, round_up};

/// Budget for the ratio of both roughnesses.
const STRETCH_ROUNDINGS: u16 = 1;

/// What stands for many [`GgxLobe`]s and [`AnisotropicGgxLobe`]s with the masking function `G`: caps of normals and of
/// incoming directions, the least cosine of incidence, a range of roughness, and a majorant of the Fresnel factors. Of
/// anisotropy it has the greatest ratio of both roughnesses, but no tangents.
///
/// Within a cap of directions its majorant is the product of the greatest F, D and G2/(4μ_i) of any such lobe. The
/// derivation, and the proof that it nests, are in the source.
///
/// Lobes that are [empty](crate::Lobe::is_empty) reflect nothing, so a union leaves them out.
pub struct GgxFamily<G = HeightCorrelated> {
    numbers: Numbers,
    masking_shadowing: PhantomData<fn() -> G>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Numbers {
    normals: Cap,
    incoming: Cap,
    /// The least μ, or zero if the family is empty.
    incident_cosine: f32,
    /// The least root of G1(ω_i)
    incident_root: f32,
    /// The least and the greatest α, the greater one of α_x and α_y.
    roughness: [f32; 2],
    /// The greatest ratio of that to the other one.
    stretch: f32,
    /// The least of both.
    smoothest: f32,
    fresnel: FresnelMajorant,
}

impl Numbers {
    fn is_empty(&self) -> bool {
        self.incident_cosine <= 0.0
    }

    /// Joins all but the caps of another family. In place: copies would take longer than all the rest.
    #[inline(always)]
    fn join_without_caps(&mut self, other: &Self) {
        let least = |own: &mut f32, other: f32| *own = Real::min(other, *own);
        let most = |own: &mut f32, other: f32| *own = Real::max(other, *own);
        least(&mut self.incident_cosine, other.incident_cosine);
        least(&mut self.incident_root, other.incident_root);
        least(&mut self.roughness[0], other.roughness[0]);
        most(&mut self.roughness[1], other.roughness[1]);
        most(&mut self.stretch, other.stretch);
        least(&mut self.smoothest, other.smoothest);
        most(&mut self.fresnel.base, other.fresnel.base);
        most(&mut self.fresnel.rise, other.fresnel.rise);
    }
}

/// The sum of families.
#[derive(Clone, Copy, Debug)]
pub struct NumbersSum {
    normals: CapSum,
    incoming: CapSum,
    /// All but the caps.
    numbers: Numbers,
}

impl NumbersSum {
    #[inline(always)]
    fn of(numbers: &Numbers) -> Self {
        Self {
            normals: CapSum::of(&numbers.normals),
            incoming: CapSum::of(&numbers.incoming),
            numbers: *numbers,
        }
    }
}

impl<F: Fresnel, G: MaskingShadowing> ReceiverLobe for GgxLobe<F, G> {
    type Family = GgxFamily<G>;

    #[inline(always)]
    fn family(&self) -> GgxFamily<G> {
        GgxFamily::new(Numbers {
            normals: Cap::of_axis(self.normal()),
            incoming: Cap::of_axis(self.incoming()),
            incident_cosine: self.incident_cosine(),
            incident_root: self.incident_root,
            roughness: [self.ggx().roughness(); 2],
            stretch: 1.0,
            smoothest: self.ggx().roughness(),
            fresnel: self.fresnel().majorant().or_one(),
        })
    }
}

impl<F: Fresnel, G: MaskingShadowing> ReceiverLobe for AnisotropicGgxLobe<F, G> {
    type Family = GgxFamily<G>;

    #[inline(always)]
    fn family(&self) -> GgxFamily<G> {
        let [along, across] = self.ggx().roughness();
        let (rougher, smoother) = (along.max(across), along.min(across));
        // That of the smoother roughness, with the root of this lobe for ω_i.
        let isotropic = self.at_any_azimuth().family();
        GgxFamily::new(Numbers {
            roughness: [rougher; 2],
            stretch: round_up(rougher / smoother, STRETCH_ROUNDINGS),
            ..isotropic.numbers
        })
    }
}

impl<G> GgxFamily<G> {
    fn new(numbers: Numbers) -> Self {
        Self {
            numbers,
            masking_shadowing: PhantomData,
        }
    }
}

impl<G: MaskingShadowing> LobeFamily for GgxFamily<G> {
    type Sum = NumbersSum;

    #[inline(always)]
    fn to_sum(&self) -> NumbersSum {
        NumbersSum::of(&self.numbers)
    }

    #[inline(always)]
    fn add_to(&self, sum: &mut NumbersSum) {
        let numbers = &self.numbers;
        if numbers.is_empty() {
            return;
        }
        if sum.numbers.is_empty() {
            *sum = NumbersSum::of(numbers);
            return;
        }
        sum.normals.add(&numbers.normals);
        sum.incoming.add(&numbers.incoming);
        sum.numbers.join_without_caps(numbers);
    }

    fn mean(sum: &NumbersSum) -> Self {
        Self::new(Numbers {
            normals: sum.normals.mean(),
            incoming: sum.incoming.mean(),
            ..sum.numbers
        })
    }

    #[inline(always)]
    fn widen(&mut self, member: &Self) {
        if !member.numbers.is_empty() {
            self.numbers.normals.widen(&member.numbers.normals);
            self.numbers.incoming.widen(&member.numbers.incoming);
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let numbers = &self.numbers;
        let incident_cosine = cap.splat(numbers.incident_cosine);
        let members = GgxMembers {
            normals: numbers.normals.splat(incident_cosine),
            incoming: numbers.incoming.splat(incident_cosine),
            incident_cosine,
            incident_root: cap.splat(numbers.incident_root),
        };
        members.majorant::<G>(
            #[inline(always)]
            |[least_cosine, _]| numbers.fresnel.value(least_cosine),
            #[inline(always)]
            |half_vectors| {
                let [least, most] = numbers.roughness;
                let range = [cap.splat(least * least), cap.splat(most * most)];
                let mut ndf = members.ndf(
                    half_vectors,
                    #[inline(always)]
                    |sine| {
                        let worst = worst_alpha_squared(range, sine);
                        [worst, worst * (1.0 / numbers.stretch)]
                    },
                );
                ndf.greatest = ndf.greatest * numbers.stretch;
                ndf
            },
            #[inline(always)]
            |outgoing_cosine| masking_root(cap.splat(numbers.smoothest), outgoing_cosine),
            cap,
        )
    }
}

// Derived, these would ask the same of `G`.

impl<G> Clone for GgxFamily<G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<G> Copy for GgxFamily<G> {}

impl<G> Debug for GgxFamily<G> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        self.numbers.fmt(formatter)
    }
}

impl<G> PartialEq for GgxFamily<G> {
    fn eq(&self, other: &Self) -> bool {
        self.numbers == other.numbers
    }
}
