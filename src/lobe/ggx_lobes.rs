//! The formulas of [`GgxLobe`](super::GgxLobe), for one lobe in each lane.

use super::facets::Facets;
use super::fresnel::LEAST_REFLECTED;
use super::fresnel_of_one::FresnelOfOne;
use super::ggx::{masking_root, ndf_at};
use super::ggx_majorant::GgxMembers;
use super::{Caps, Fresnel, LobeNumbers, Majorant, MaskingShadowing};
use crate::base::mirrored;
use crate::num::{Quad, Real, Single, UNIT_ROUNDOFF, Vector3};

/// Pays for the rounding of the half angle's cosine at the end of a segment, in units of u.
const END_COSINE_ROUNDINGS: f32 = 16.0;
/// Pays for the rounding of F·G2/G1(μ).
const MAX_REFLECTED_ROUNDINGS: u16 = 96;

/// A [`GgxLobe`] in each lane, without its Fresnel factor and its masking function.
#[derive(Clone, Copy)]
pub(crate) struct GgxLobes<N> {
    pub normal: Vector3<N>,
    pub incoming: Vector3<N>,
    /// μ
    pub incident_cosine: N,
    /// The root √(kμ² + α²) of G1(μ)
    pub incident_root: N,
    /// α
    pub roughness: N,
}

/// The plane of incidence.
#[derive(Clone, Copy)]
pub(crate) struct PlaneOfIncidence<N> {
    /// ω_u
    pub mirror: Vector3<N>,
    /// ω_w, perpendicular to the plane
    pub across: Vector3<N>,
    /// √(1 − μ²)
    pub sine: N,
}

impl<N: Single> GgxLobes<N> {
    #[inline(always)]
    pub fn from_quads(quads: [Quad<N>; 3]) -> Self {
        let [
            [n_x, n_y, n_z, cosine],
            [w_x, w_y, w_z, root],
            [roughness, ..],
        ] = quads;
        Self {
            normal: Vector3::new(n_x, n_y, n_z),
            incoming: Vector3::new(w_x, w_y, w_z),
            incident_cosine: cosine,
            incident_root: root,
            roughness,
        }
    }

    /// The lobes, and the parameters of their Fresnel factors.
    #[inline(always)]
    pub fn from_numbers(numbers: &LobeNumbers<N>) -> (Self, [N; 2]) {
        let [
            n_x,
            n_y,
            n_z,
            cosine,
            w_x,
            w_y,
            w_z,
            root,
            roughness,
            first,
            second,
            ..,
        ] = *numbers;
        let lobes = Self {
            normal: Vector3::new(n_x, n_y, n_z),
            incoming: Vector3::new(w_x, w_y, w_z),
            incident_cosine: cosine,
            incident_root: root,
            roughness,
        };
        (lobes, [first, second])
    }

    /// ω_u
    #[inline(always)]
    pub fn mirror_direction(&self) -> Vector3<N> {
        mirrored(self.incoming, self.normal)
    }

    /// √(1 − μ²) ≥ 0
    #[inline(always)]
    pub fn incident_sine(&self) -> N {
        let cross = self.normal.widen().cross(self.incoming.widen());
        N::narrow(cross.length())
    }

    #[inline(always)]
    pub fn plane_of_incidence(&self) -> PlaneOfIncidence<N> {
        let mirror = self.mirror_direction();
        // Equals ω_u × n, without the rounding of ω_u.
        let cross = self.normal.widen().cross(self.incoming.widen());
        let length = cross.length();
        let is_oblique = length.is_positive();
        // Finite, since the smallest positive length is 2⁻²⁹⁸.
        let across = Vector3::narrow(cross * (length.splat(1.0) / length));
        let across = if N::is_known_false(!is_oblique) {
            across
        } else {
            Vector3::select(is_oblique, across, mirror.any_orthonormal_pair().1)
        };
        PlaneOfIncidence {
            mirror,
            across,
            sine: N::narrow(length),
        }
    }

    /// G1(μ)/(4μ) = 1/(2(μ + √(kμ² + α²))), which stays finite at grazing incidence.
    #[inline(always)]
    pub fn masking_over_four_cosines(&self) -> N {
        self.incident_cosine.splat(0.5) / (self.incident_cosine + self.incident_root)
    }

    /// F_max; see [`GgxLobe::max_fresnel`].
    #[inline(always)]
    pub fn max_fresnel<F: Fresnel>(&self, fresnels: &[F]) -> N {
        self.max_fresnel_at(self.incident_sine(), fresnels)
    }

    /// F_max for √(1 − μ²) = `incident_sine`.
    #[inline(always)]
    pub fn max_fresnel_at<F: Fresnel>(&self, incident_sine: N, fresnels: &[F]) -> N {
        let smallest_cosine = self.incident_cosine / ((incident_sine + 1.0) * 2.0).sqrt();
        F::maximum_in_lanes(fresnels, smallest_cosine)
    }

    /// An upper bound of F·G2/G1(μ); see [`GgxLobe::max_reflected`].
    #[inline(always)]
    pub fn max_reflected<F: Fresnel, G: MaskingShadowing>(&self, fresnels: &[F]) -> N {
        /// cosθ_o at the start of a segment, and cos ½θ_o and sin ½θ_o at its end. The ends are 0°, 40°, 55°,
        /// 65°, 72°, 78°, 83°, 87° and 90°.
        const SEGMENTS: [[f32; 3]; 8] = [
            [1.0, 0.939_692_6, 0.342_020_15],
            [0.766_044_5, 0.887_010_8, 0.461_748_63],
            [0.573_576_4, 0.843_391_4, 0.537_299_6],
            [0.422_618_27, 0.809_017, 0.587_785_24],
            [0.309_017, 0.777_146, 0.629_320_4],
            [0.207_911_7, 0.748_955_7, 0.662_620_07],
            [0.121_869_34, 0.725_374_4, 0.688_354_6],
            [0.052_335_96, 0.707_106_77, 0.707_106_77],
        ];
        let sine = self.incident_sine();
        let most = self.max_fresnel_at(sine, fresnels);
        let (zero, one) = (most.zero(), most.splat(1.0));
        let head_on = F::reflectance_in_lanes(fresnels, one);
        let rises = !most.le(head_on);
        if N::is_known_false(rises) {
            return most;
        }
        let half_cosine = ((self.incident_cosine + 1.0) * 0.5).sqrt();
        let half_sine = sine * 0.5 / half_cosine;
        let unmasked = one / self.masking_over_four_cosines();
        let mut joint = zero;
        for [start, end_half_cosine, end_half_sine] in SEGMENTS {
            let cosine = half_cosine * end_half_cosine - half_sine * end_half_sine;
            let cosine = (cosine - END_COSINE_ROUNDINGS * UNIT_ROUNDOFF).max(zero);
            let start = most.splat(start);
            let masking = G::over_four_incident_cosines_in_lanes(
                self.incident_cosine,
                self.incident_root,
                start,
                masking_root(self.roughness, start),
            );
            let reflected = F::reflectance_in_lanes(fresnels, cosine).max(head_on);
            joint = (reflected * (masking * unmasked)).max(joint);
        }
        // The second operand is taken where a caller's Fresnel factor makes `most` NaN.
        let least = most.min(most.splat(LEAST_REFLECTED));
        let joint = most.min(joint.round_up(MAX_REFLECTED_ROUNDINGS).max(least));
        N::select(rises, joint, most)
    }

    /// f·max(μ_o, 0) towards `outgoing`, where `reflectance` is F as a function of cosθ_h.
    #[inline(always)]
    pub fn value<G: MaskingShadowing>(
        &self,
        reflectance: impl FnOnce(N) -> N,
        outgoing: Vector3<N>,
    ) -> N {
        self.value_with::<G>(
            reflectance,
            outgoing,
            #[inline(always)]
            |half_vector| ndf_at(self.roughness, half_vector, self.normal),
            #[inline(always)]
            |outgoing_cosine| masking_root(self.roughness, outgoing_cosine),
        )
    }

    /// The majorant within a cap.
    #[inline(always)]
    pub(super) fn majorant<G: MaskingShadowing>(
        &self,
        fresnel: &FresnelOfOne<N, impl Fn(N) -> N>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let members = GgxMembers::one(self);
        let alpha_squared = self.roughness * self.roughness;
        members.majorant_of_one::<G>(
            fresnel,
            #[inline(always)]
            || Facets::isotropic(self.roughness, self.normal),
            #[inline(always)]
            |half_vectors| {
                let sine = half_vectors.least_squared_sine(self.normal);
                members.ndf(half_vectors, sine, [alpha_squared; 2])
            },
            #[inline(always)]
            |outgoing_cosine| masking_root(self.roughness, outgoing_cosine),
            cap,
        )
    }

    /// The value with another NDF, a function of the half vector, and another root, a function of μ_o.
    #[inline(always)]
    pub(super) fn value_with<G: MaskingShadowing>(
        &self,
        reflectance: impl FnOnce(N) -> N,
        outgoing: Vector3<N>,
        ndf: impl FnOnce(Vector3<N>) -> N,
        masking_root: impl FnOnce(N) -> N,
    ) -> N {
        let outgoing_cosine = self.normal.dot(outgoing);
        let zero = outgoing_cosine.zero();
        let is_lit = outgoing_cosine.is_positive() & self.incident_cosine.is_positive();
        if N::is_known_false(is_lit) {
            return zero;
        }
        let half_vector = self.incoming + outgoing;
        // ω_i·ω_h = ½‖ω_i + ω_o‖.
        let half_angle_cosine = (half_vector.length() * 0.5).min(zero.splat(1.0));
        let value = reflectance(half_angle_cosine)
            * ndf(half_vector)
            * G::over_four_incident_cosines_in_lanes(
                self.incident_cosine,
                self.incident_root,
                outgoing_cosine,
                masking_root(outgoing_cosine),
            );
        N::select(is_lit, value, zero)
    }
}
