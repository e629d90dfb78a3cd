//! The Fresnel factor of one lobe in each lane.

use super::Fresnel;
use super::fresnel::{falling_maximum, quasi_convex_maximum};
use crate::num::Single;

/// F of one lobe in each lane, and what helps to bound it.
pub(super) struct FresnelOfOne<N, R> {
    /// F as a function of cosθ_h
    reflectance: R,
    /// [`Fresnel::IS_GENTLE`]
    pub is_gentle: bool,
    /// [`Fresnel::critical_cosine`]
    pub critical_cosine: N,
}

/// The factor of a lobe alone.
#[inline(always)]
pub(super) fn fresnel_of_one<F: Fresnel>(fresnel: &F) -> FresnelOfOne<f32, impl Fn(f32) -> f32> {
    FresnelOfOne::new::<F>(
        #[inline(always)]
        |cosine| fresnel.reflectance(cosine),
        fresnel.critical_cosine(),
    )
}

/// The factors of lobes by their [`parameters`](Fresnel::parameters), or as [`reflectance`] takes them.
#[inline(always)]
pub(super) fn fresnel_in_lanes<N: Single, F: Fresnel>(
    parameters: [N; 2],
    fresnel_of: impl Fn(usize) -> Option<F>,
) -> FresnelOfOne<N, impl Fn(N) -> N> {
    let [any, _] = parameters;
    let critical_cosine = F::critical_cosine_of_parameters(parameters).unwrap_or_else(
        #[inline(always)]
        || any.gather(|i| fresnel_of(i).map_or(0.0, |fresnel| fresnel.critical_cosine())),
    );
    FresnelOfOne::new::<F>(
        #[inline(always)]
        move |cosine| reflectance(parameters, &fresnel_of, cosine),
        critical_cosine,
    )
}

/// F in each lane: computed in lanes if that is possible, and else by the factor that `fresnel_of` gives for a lane.
#[inline(always)]
pub(super) fn reflectance<N: Single, F: Fresnel>(
    parameters: [N; 2],
    fresnel_of: impl Fn(usize) -> Option<F>,
    cosine: N,
) -> N {
    F::reflectance_of_parameters(parameters, cosine).unwrap_or_else(
        #[inline(always)]
        || {
            N::per_lane(
                [cosine],
                #[inline(always)]
                |i, [cosine]| fresnel_of(i).map_or(0.0, |fresnel| fresnel.reflectance(cosine)),
            )
        },
    )
}

impl<N: Single, R: Fn(N) -> N> FresnelOfOne<N, R> {
    #[inline(always)]
    fn new<F: Fresnel>(reflectance: R, critical_cosine: N) -> Self {
        Self {
            reflectance,
            is_gentle: F::IS_GENTLE,
            critical_cosine,
        }
    }

    #[inline(always)]
    pub fn at(&self, cosine: N) -> N {
        (self.reflectance)(cosine)
    }

    /// An upper bound of F between two cosines.
    #[inline(always)]
    pub fn maximum(&self, cosines: [N; 2]) -> N {
        quasi_convex_maximum(
            #[inline(always)]
            |cosine| self.at(cosine),
            cosines,
        )
    }

    /// An upper bound of a gentle F, from this cosine on.
    #[inline(always)]
    pub fn falling_maximum(&self, least_cosine: N) -> N {
        falling_maximum(
            #[inline(always)]
            |cosine| self.at(cosine),
            least_cosine,
        )
    }
}
