//! Majorants of GGX lobes within a cap of directions: of one lobe, or of all members of a family.
//!
//! # The bound
//!
//! The members have normals within a chord c_n of n, incoming directions within c_i of i, cosines of at least μ,
//! roots of G1 of at least Λ, roughnesses in \[α₀, α₁\], and Fresnel factors of at most F̂(cosθ_h). One lobe is
//! the family whose chords are zero. Let w be the axis of the cap, c_w its chord, h = i + w and c = c_i + c_w. Then, for
//! any member and any direction of the cap,
//!
//! - the half vector is within c of h, so its length is at most L = min(‖h‖ + c, 2), and cosθ_h half of that; the least
//!   cosθ_h is that of a sum of angles (`half_vectors`);
//! - the sine of its angle to the member's normal is at least s = max(0, s₀ − c_n), where s₀ is the least sine of the
//!   angles between n and the elliptic cone of the unit half vectors (`half_vectors`), since the cross product with a
//!   unit vector changes by no more than the other vector does;
//! - μ_o is at most m = min(1, n·w + c_w + c_n), and there is nothing to bound if m ≤ 0.
//!
//! D falls with s. As a function of a = α² it is a/(π (a(1 − s²) + s²)²), which rises up to a = s²/(1 − s²) and
//! falls then. So its greatest value is at s, with that a clamped to \[α₀², α₁²\].
//!
//! An anisotropic D is 1/(π α_xα_y (x²/α_x² + y²/α_y² + c²)²) for the half vector (x, y, c) in the surface's frame. Let
//! α be the greater of α_x and α_y, and κ their ratio. With x² + y² = s², it is at most κ times the isotropic D of
//! roughness α, which needs no frame: a family has the greatest κ. One lobe takes the frame of its own.
//!
//! G2/(4μ_i) is bounded by its value for μ, Λ, m, and the root of m for α₀, since it falls with μ_i and with both
//! roots, and grows with μ_o ([`MaskingShadowing`]), and since the root √(μ² + α²(1 − μ²)) grows with α. On an
//! anisotropic surface the root is at least that for the lesser of α_x and α_y, which is at least α₀/κ for a family.
//!
//! The product of the three bounds is the majorant. As the chords close it becomes the lobe itself. Where F is infinitely
//! steep, F·D of one lobe has a bound of its own that is sharper, unless the majorant must nest (`half_angle_slices`).
//!
//! # It nests
//!
//! Let n′, i′, w′ and their chords be those of a greater pair: c′_n ≥ ‖n′ − n‖ + c_n, and so on. Then
//! ‖h′ − h‖ ≤ c′ − c. Hence L′ ≥ L, and the least cosθ_h is no greater. The cone of the greater pair holds that of the
//! lesser, so s₀′ ≤ s₀ + ‖n′ − n‖, and s′ ≤ s. In the same way m′ ≥ m, and a chord that is clamped to 2 makes s′ zero and
//! m′ one. D̂ is a maximum over a set that grows with the family, of a function that falls with s; F̂ and the bound of G2
//! are monotonic in all of their numbers. So the majorant of the greater pair is at least that of the lesser.
//!
//! # The typical value
//!
//! It takes the sine, the cosines and the Fresnel factor of the middle, and the NDF that is filtered as for a
//! Gaussian spread of half vectors: α̂² + ½(c/‖h‖ + c_n)², with the α̂ of the bound, or α_xα_y.

use super::facets::Facets;
use super::fresnel_of_one::FresnelOfOne;
use super::ggx::ndf_of_squared_sine;
use super::half_vectors::HalfVectors;
use super::{Caps, GgxLobes, Majorant, MaskingShadowing};
use crate::num::{Real, Single};

/// Pays for the rounding of the majorant, besides those of one lobe's F and of the cap.
const MAXIMUM_WITHIN_ROUNDINGS: u16 = 128;

/// One GGX lobe, or the members of a family, in each lane: without Fresnel factor and roughness.
#[derive(Clone, Copy)]
pub(super) struct GgxMembers<N> {
    pub normals: Caps<N>,
    pub incoming: Caps<N>,
    /// The least μ. Not positive if there is no member.
    pub incident_cosine: N,
    /// The least root of G1(ω_i)
    pub incident_root: N,
}

impl<N: Single> GgxMembers<N> {
    #[inline(always)]
    pub fn one(lobe: &GgxLobes<N>) -> Self {
        Self {
            normals: Caps::around(lobe.normal),
            incoming: Caps::around(lobe.incoming),
            incident_cosine: lobe.incident_cosine,
            incident_root: lobe.incident_root,
        }
    }

    /// The majorant within a cap. `reflected` gives that of F·D, and `masking_root` the least root of G1(ω_o) for the
    /// greatest μ_o.
    #[inline(always)]
    pub fn majorant<G: MaskingShadowing>(
        &self,
        reflected: impl FnOnce(&HalfVectors<N>) -> Majorant<N>,
        masking_root: impl Fn(N) -> N,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let outgoing_cosine = cap.cosine(&self.normals);
        let zero = self.incident_cosine.zero();
        let is_lit = outgoing_cosine.greatest.is_positive() & self.incident_cosine.is_positive();
        if N::is_known_false(is_lit) {
            return Majorant::exactly(zero);
        }
        let half_vectors = cap.half_vectors(&self.incoming);
        let reflected = reflected(&half_vectors);
        let greatest = reflected.greatest
            * self.masking::<G>(
                outgoing_cosine.greatest,
                masking_root(outgoing_cosine.greatest),
            );
        let typical = reflected.typical
            * self.masking::<G>(
                outgoing_cosine.typical,
                masking_root(outgoing_cosine.typical),
            );
        // Both may underflow.
        let least = zero.splat(f32::MIN_POSITIVE);
        let greatest = Real::max(greatest.round_up(MAXIMUM_WITHIN_ROUNDINGS), least);
        let typical = Real::max(typical, least).min(greatest);
        let [greatest, typical] = N::select_all(is_lit, [greatest, typical], [zero; 2]);
        Majorant { greatest, typical }
    }

    /// The majorant of one lobe within a cap. `ndf` gives that of D, and `facets` what F·D is bounded by where F is steep.
    #[inline(always)]
    pub fn majorant_of_one<G: MaskingShadowing>(
        &self,
        fresnel: &FresnelOfOne<N, impl Fn(N) -> N>,
        facets: impl FnOnce() -> Facets<N>,
        ndf: impl FnOnce(&HalfVectors<N>) -> Majorant<N>,
        masking_root: impl Fn(N) -> N,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        self.majorant::<G>(
            #[inline(always)]
            |half_vectors| {
                let greatest = if fresnel.is_gentle {
                    let [least_cosine, _] = half_vectors.half_angle_cosines();
                    fresnel.falling_maximum(least_cosine)
                } else {
                    fresnel.maximum(half_vectors.sharp_half_angle_cosines())
                };
                let typical = fresnel.at(half_vectors.typical_half_angle_cosine());
                let ndf = ndf(half_vectors);
                let greatest = greatest * ndf.greatest;
                let greatest = if fresnel.is_gentle || cap.must_nest {
                    greatest
                } else {
                    half_vectors.greatest_reflected(fresnel, facets, ndf.greatest, greatest)
                };
                Majorant {
                    greatest,
                    typical: typical * ndf.typical,
                }
            },
            masking_root,
            cap,
        )
    }

    /// G2/(4μ_i) for a μ_o and its root.
    #[inline(always)]
    fn masking<G: MaskingShadowing>(&self, cosine: N, root: N) -> N {
        G::over_four_incident_cosines_in_lanes(
            self.incident_cosine,
            self.incident_root,
            cosine,
            root,
        )
    }

    /// The majorant of an isotropic D for the least squared sine s², with the α² that makes D greatest there, and a
    /// typical one.
    #[inline(always)]
    pub fn ndf(
        &self,
        half_vectors: &HalfVectors<N>,
        squared_sine: N,
        [worst, typical]: [N; 2],
    ) -> Majorant<N> {
        let typical_squared_sine = half_vectors.typical_squared_sine(self.normals.axis);
        let filtered = self.filtered(typical, half_vectors);
        Majorant {
            greatest: ndf_of_squared_sine(worst, squared_sine),
            typical: ndf_of_squared_sine(filtered, typical_squared_sine),
        }
    }

    /// α² widened by the spread of half vectors and normals, at most 1.
    #[inline(always)]
    pub fn filtered(&self, alpha_squared: N, half_vectors: &HalfVectors<N>) -> N {
        let spread = half_vectors.spread(&self.normals);
        (spread * spread * 0.5 + alpha_squared).min(spread.splat(1.0))
    }
}

/// The a in \[α₀², α₁²\] for which D is greatest, for a squared sine in \[0, 1\].
#[inline(always)]
pub(super) fn worst_alpha_squared<N: Single>(range: [N; 2], squared_sine: N) -> N {
    let [least, most] = range;
    let ratio = squared_sine / squared_sine.one_minus();
    Real::min(Real::max(ratio, least), most)
}
