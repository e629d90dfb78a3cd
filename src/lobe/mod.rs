//! Lobes: what a surface reflects or a lamp emits. Microfacet terms, Fresnel factors, and the lobes that they make.

mod anisotropic_gaussian;
mod anisotropic_ggx;
mod anisotropic_ggx_lobe;
mod anisotropic_lobes;
mod cap;
mod cap_union;
mod caps;
mod conductor;
mod constant;
mod dielectric;
mod facets;
mod family;
mod fresnel;
mod fresnel_of_one;
mod gaussian_family;
mod gaussian_fit;
mod ggx;
mod ggx_faint;
mod ggx_family;
mod ggx_lobe;
mod ggx_lobes;
mod ggx_majorant;
mod half_angle_slices;
mod half_vectors;
mod incidence;
mod lambert;
mod lambert_family;
#[cfg(all(test, feature = "cull"))]
mod lanes_tests;
#[cfg(feature = "ltc")]
mod ltc_family;
#[cfg(feature = "ltc")]
mod ltc_from_ggx;
#[cfg(feature = "ltc")]
mod ltc_lobe;
#[cfg(feature = "ltc")]
mod ltc_lobes;
#[cfg(feature = "ltc")]
mod ltc_majorant;
#[cfg(feature = "ltc")]
mod ltc_table;
#[cfg(all(test, feature = "cull"))]
mod majorant_tests;
mod masking;
mod phong;
mod phong_family;
mod reflected_gaussian;
mod spherical_gaussian;
mod spot;
mod sum;
mod sum_family;
mod von_mises_fisher;

pub use anisotropic_gaussian::AnisotropicSphericalGaussian;
pub use anisotropic_ggx::AnisotropicGgx;
pub use anisotropic_ggx_lobe::AnisotropicGgxLobe;
pub(crate) use anisotropic_ggx_lobe::{SurfaceAxes, unit};
pub use cap::Cap;
pub(crate) use caps::Caps;
pub use conductor::Conductor;
pub use constant::ConstantLobe;
pub use dielectric::Dielectric;
pub(crate) use family::Majorant;
pub use family::{Blind, LobeFamily, ReceiverLobe};
pub use fresnel::{Fresnel, FresnelMajorant, NoFresnel, Schlick};
pub use gaussian_family::SphericalGaussianFamily;
pub(crate) use gaussian_fit::toksvig;
pub use ggx::Ggx;
pub use ggx_family::GgxFamily;
pub use ggx_lobe::GgxLobe;
pub(crate) use ggx_lobes::{GgxLobes, PlaneOfIncidence};
pub use incidence::Incidence;
pub use lambert::LambertLobe;
pub use lambert_family::LambertFamily;
#[cfg(feature = "ltc")]
pub use ltc_family::LtcFamily;
#[cfg(all(feature = "cull", feature = "ltc"))]
pub(crate) use ltc_from_ggx::GgxSurfaces;
#[cfg(feature = "ltc")]
pub use ltc_lobe::LtcLobe;
#[cfg(all(feature = "cull", feature = "ltc"))]
pub(crate) use ltc_lobes::{LTC_NUMBERS, LtcLobes};
pub use masking::{HeightCorrelated, MaskingShadowing, Separable};
pub use phong::PhongLobe;
pub use phong_family::PhongFamily;
pub use spherical_gaussian::SphericalGaussian;
pub(crate) use spherical_gaussian::solid_angle;
pub use spot::SpotLobe;
pub use sum::LobeSum;
pub use sum_family::SumFamily;

use glam::Vec3;

use crate::base::Direction;
use crate::num::{Single, Vector3};

/// The numbers of a lobe that a batch of lights stores beside position, flux and ξ.
///
/// The first [`FIRST_NUMBERS`] share a cache line of 64 bytes with these five. What a lobe has besides comes
/// in the next one.
pub type LobeNumbers<N> = [N; FIRST_NUMBERS + 16];

/// The lobe's numbers in the first cache line of a light.
pub(crate) const FIRST_NUMBERS: usize = 11;

/// `numbers`, followed by zeros.
#[inline(always)]
fn padded<const K: usize>(numbers: [f32; K]) -> LobeNumbers<f32> {
    let mut padded = [0.0; FIRST_NUMBERS + 16];
    for (padded, number) in padded.iter_mut().zip(numbers) {
        *padded = number;
    }
    padded
}

/// The light that a point reflects, as a function of the outgoing direction. The incoming direction is fixed.
///
/// The steps after this one know a lobe only by this trait and by its bound ([`Bounded`](crate::Bounded)).
pub trait Lobe {
    /// The value f(ω_i, ω_o)·max(ω_o·n, 0) in sr⁻¹ for the unit vector `outgoing` = ω_o, which points away
    /// from the surface.
    ///
    /// Finite, not negative and never NaN. Zero at and below the horizon, if the lobe has one.
    fn value(&self, outgoing: Vec3) -> f32;

    /// An upper bound of the value towards every direction of `cap`: of the exact value, which takes each direction to
    /// be a vector of exactly unit length, and of what [`value`](Self::value) computes.
    ///
    /// The narrower the cap, the closer it is to the greatest value there; for a chord of zero it is the value, but
    /// for rounding. Zero if all of the cap is below the horizon. By default it is infinite, which is true of every
    /// lobe and rejects nothing.
    ///
    /// Of a lobe of your own it should grow with the cap: of caps that hold each other the greater one should have the
    /// greater bound. Culling by [receivers](crate::ReceiverCluster) otherwise may reject a light for a block of tiles that
    /// it would keep for one of them. The lobes of this crate see to that themselves.
    fn maximum_within(&self, _cap: &Cap) -> f32 {
        f32::INFINITY
    }

    /// The normal of the surface below whose horizon the lobe is zero. `None` if the lobe has no horizon.
    fn horizon_normal(&self) -> Option<Direction> {
        None
    }

    /// Whether the lobe is known to be zero in every direction. A batch drops such lights before it computes
    /// their bounds.
    fn is_empty(&self) -> bool {
        false
    }

    /// The numbers that [`value_in_lanes`](Self::value_in_lanes) reads.
    #[doc(hidden)]
    fn numbers(&self) -> LobeNumbers<f32> {
        padded([])
    }

    /// How many of the [`numbers`](Self::numbers) are in use.
    #[doc(hidden)]
    #[must_use]
    fn numbers_in_use() -> usize
    where
        Self: Sized,
    {
        0
    }

    /// Whether [`value_in_lanes`](Self::value_in_lanes) reads more of a lobe than its numbers.
    #[doc(hidden)]
    #[must_use]
    fn has_more_than_numbers() -> bool
    where
        Self: Sized,
    {
        true
    }

    /// The normals at or below whose horizon [`value_in_lanes`](Self::value_in_lanes) is zero: where the dot
    /// product with the direction, as it rounds, is not positive. `None` if there is no such normal.
    #[doc(hidden)]
    #[must_use]
    #[inline(always)]
    fn horizon_in_lanes<N: Single>(_: &LobeNumbers<N>) -> Option<Vector3<N>>
    where
        Self: Sized,
    {
        None
    }

    /// Computes the [`value`](Self::value) of one lobe in each lane. `lobe_of` gives that of a lane.
    #[doc(hidden)]
    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        _: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N
    where
        Self: Sized + 'a,
    {
        value_per_lane(lobe_of, outgoing)
    }

    /// Whether the light of each lane is certainly too faint: whether `flux` times the value towards the end of `way`,
    /// over its squared length, is below `least`, as it rounds too. `None` if that takes as long as the value.
    #[doc(hidden)]
    #[must_use]
    #[inline(always)]
    fn is_fainter_in_lanes<N: Single>(
        _: &LobeNumbers<N>,
        _flux: N,
        _way: Vector3<N>,
        _length_squared: N,
        _least: N,
    ) -> Option<N::Mask>
    where
        Self: Sized,
    {
        None
    }

    /// Computes the [majorant](Majorant) of one lobe in each lane. `lobe_of` gives that of a lane.
    ///
    /// Where the caps say so, it must be no greater than within caps that hold them, but for rounding. By default it is
    /// [`maximum_within`](Self::maximum_within), which then must nest.
    #[doc(hidden)]
    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        _: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N>
    where
        Self: Sized + 'a,
    {
        majorant_per_lane(lobe_of, cap)
    }

    /// Computes in each lane what stands for the mean of the lobe over the SG about `axis` with `sharpness`:
    /// ∫ v g dω for ∫ g dω = 1. By default it is the value towards the axis.
    #[doc(hidden)]
    #[inline(always)]
    fn mean_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        lobe_of: impl Fn(usize) -> Option<&'a Self>,
        axis: Vector3<N>,
        _sharpness: N,
    ) -> N
    where
        Self: Sized + 'a,
    {
        Self::value_in_lanes(numbers, lobe_of, axis)
    }
}

/// [`Lobe::value_in_lanes`], lane by lane.
#[inline(always)]
fn value_per_lane<'a, N: Single, L: Lobe + 'a>(
    lobe_of: impl Fn(usize) -> Option<&'a L>,
    outgoing: Vector3<N>,
) -> N {
    N::per_lane(
        [outgoing.x, outgoing.y, outgoing.z],
        #[inline(always)]
        |i, outgoing| lobe_of(i).map_or(0.0, |lobe| lobe.value(Vec3::from_array(outgoing))),
    )
}

/// [`Lobe::majorant_in_lanes`], lane by lane.
#[inline(always)]
fn majorant_per_lane<'a, N: Single, L: Lobe + 'a>(
    lobe_of: impl Fn(usize) -> Option<&'a L>,
    cap: &Caps<N>,
) -> Majorant<N> {
    Majorant::exactly(cap.per_lane(
        #[inline(always)]
        |i, caps| lobe_of(i).map_or(f32::INFINITY, |lobe| lobe.maximum_within(&caps.cap())),
    ))
}
