use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

use super::cap_union::{CapMean, CapReach, CapSum};
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
    normals: Cap,
    incoming: Cap,
    ranges: Ranges,
    masking_shadowing: PhantomData<fn() -> G>,
}

/// All but directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// The least μ, or zero if the family is empty.
    incident_cosine: f32,
    /// The least root of G1(ω_i)
    incident_root: f32,
    /// The least and the greatest α, the greater one of α_x and α_y.
    roughness: [f32; 2],
    /// The greatest ratio of that to the other one.
    stretch: f32,
    fresnel: FresnelMajorant,
}

impl Default for Ranges {
    /// Those of no lobe, which any other is joined to unchanged.
    fn default() -> Self {
        Self {
            incident_cosine: f32::MAX,
            incident_root: f32::MAX,
            roughness: [f32::MAX, 0.0],
            stretch: 1.0,
            fresnel: FresnelMajorant {
                base: 0.0,
                rise: 0.0,
            },
        }
    }
}

impl Ranges {
    fn is_empty(&self) -> bool {
        self.incident_cosine <= 0.0
    }

    /// Joins those of another family. In place: copies would take longer than all the rest.
    #[inline(always)]
    fn join(&mut self, other: &Self) {
        let least = |own: &mut f32, other: f32| *own = Real::min(other, *own);
        let most = |own: &mut f32, other: f32| *own = Real::max(other, *own);
        least(&mut self.incident_cosine, other.incident_cosine);
        least(&mut self.incident_root, other.incident_root);
        least(&mut self.roughness[0], other.roughness[0]);
        most(&mut self.roughness[1], other.roughness[1]);
        most(&mut self.stretch, other.stretch);
        most(&mut self.fresnel.base, other.fresnel.base);
        most(&mut self.fresnel.rise, other.fresnel.rise);
    }

    /// These ranges, or those of an empty family where no lobe was joined.
    fn closed(self) -> Self {
        if self.incident_cosine <= 1.0 {
            self
        } else {
            Self {
                incident_cosine: 0.0,
                incident_root: 1.0,
                roughness: [1.0; 2],
                ..self
            }
        }
    }

    /// A lower bound of all α_x and α_y.
    fn smoothest(&self) -> f32 {
        self.roughness[0] * (1.0 / self.stretch)
    }
}

impl<F: Fresnel, G: MaskingShadowing> ReceiverLobe for GgxLobe<F, G> {
    type Family = GgxFamily<G>;

    #[inline(always)]
    fn family(&self) -> GgxFamily<G> {
        let roughness = self.ggx().roughness();
        GgxFamily {
            normals: Cap::of_axis(self.normal()),
            incoming: Cap::of_axis(self.incoming()),
            ranges: Ranges {
                incident_cosine: self.incident_cosine(),
                incident_root: self.incident_root,
                roughness: [roughness; 2],
                stretch: 1.0,
                fresnel: FresnelMajorant::of_any(self.fresnel()),
            },
            masking_shadowing: PhantomData,
        }
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
        let ranges = Ranges {
            roughness: [rougher; 2],
            stretch: round_up(rougher / smoother, STRETCH_ROUNDINGS),
            ..isotropic.ranges
        };
        GgxFamily {
            ranges,
            ..isotropic
        }
    }
}

impl<G: MaskingShadowing> LobeFamily for GgxFamily<G> {
    /// All but directions, and normals and incoming directions.
    type Sum = (Ranges, [CapSum; 2]);
    /// The same of their means.
    type Mean = (Ranges, [CapMean; 2]);
    type Reach = [CapReach; 2];

    #[inline(always)]
    fn add_to(&self, (ranges, [normals, incoming]): &mut Self::Sum) {
        if !self.ranges.is_empty() {
            ranges.join(&self.ranges);
            normals.add(&self.normals);
            incoming.add(&self.incoming);
        }
    }

    fn mean((ranges, [normals, incoming]): &Self::Sum) -> Self::Mean {
        (ranges.closed(), [normals.mean(), incoming.mean()])
    }

    #[inline(always)]
    fn widen(&self, (_, [normals, incoming]): &Self::Mean, reach: &mut Self::Reach) {
        if !self.ranges.is_empty() {
            normals.widen(&self.normals, &mut reach[0]);
            incoming.widen(&self.incoming, &mut reach[1]);
        }
    }

    fn around((ranges, [normals, incoming]): &Self::Mean, reach: &Self::Reach) -> Self {
        Self {
            normals: normals.cap(&reach[0]),
            incoming: incoming.cap(&reach[1]),
            ranges: *ranges,
            masking_shadowing: PhantomData,
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let ranges = &self.ranges;
        let incident_cosine = cap.splat(ranges.incident_cosine);
        let members = GgxMembers {
            normals: self.normals.splat(incident_cosine),
            incoming: self.incoming.splat(incident_cosine),
            incident_cosine,
            incident_root: cap.splat(ranges.incident_root),
        };
        members.majorant::<G>(
            #[inline(always)]
            |half_vectors| {
                let [least_cosine, _] = half_vectors.half_angle_cosines();
                let typical_cosine = half_vectors.typical_half_angle_cosine();
                let fresnel = Majorant {
                    greatest: ranges.fresnel.value(least_cosine),
                    typical: ranges.fresnel.value(typical_cosine),
                };
                let [least, most] = ranges.roughness;
                let range = [cap.splat(least * least), cap.splat(most * most)];
                let sine = half_vectors.least_squared_sine_to_any(&members.normals);
                let worst = worst_alpha_squared(range, sine);
                let typical = worst * (1.0 / ranges.stretch);
                let ndf = members.ndf(half_vectors, sine, [worst, typical]);
                Majorant {
                    greatest: fresnel.greatest * (ndf.greatest * ranges.stretch),
                    typical: fresnel.typical * ndf.typical,
                }
            },
            #[inline(always)]
            |outgoing_cosine| masking_root(cap.splat(ranges.smoothest()), outgoing_cosine),
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
        let Self {
            normals,
            incoming,
            ranges,
            ..
        } = self;
        (normals, incoming, ranges).fmt(formatter)
    }
}

impl<G> PartialEq for GgxFamily<G> {
    fn eq(&self, other: &Self) -> bool {
        (self.normals, self.incoming, self.ranges) == (other.normals, other.incoming, other.ranges)
    }
}
