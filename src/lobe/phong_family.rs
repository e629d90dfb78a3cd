use super::cap_union::{CapMean, CapReach, CapSum};
use super::phong::PhongLobes;
use super::{Cap, Caps, Lobe, LobeFamily, Majorant, PhongLobe, ReceiverLobe};
use crate::base::Direction;
use crate::num::{Real, Single, Vector3, ln_1p_f64};

/// What stands for many [`PhongLobe`]s: the greatest albedo, caps of normals and mirror directions, and a range of
/// exponents.
///
/// The value ρ(n+1)/(2π) xⁿ falls with the distance of the axis, by which x is the cosine. As a function of the exponent
/// it rises up to n = −1/ln x − 1 and falls then. So the majorant is that of one lobe with the greatest albedo, the
/// least distance, and that exponent, clamped to the range. It nests: it is a maximum over a set that grows with the
/// family, and distances change by no more than those of the axes.
///
/// Empty lobes reflect nothing, so a union leaves them out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongFamily {
    /// Zero if there is no member.
    albedo: f32,
    normals: Cap,
    axes: Cap,
    exponents: [f32; 2],
}

/// With the direction to the eye as that of the light: Phong's lobe is not reciprocal, but a picture that it shades is
/// made so.
impl ReceiverLobe for PhongLobe {
    type Family = PhongFamily;

    fn family(&self) -> PhongFamily {
        PhongFamily {
            albedo: if self.is_empty() { 0.0 } else { self.albedo() },
            normals: Cap::of_axis(self.normal()),
            axes: Cap::of_axis(self.axis()),
            exponents: [self.exponent(); 2],
        }
    }
}

impl Default for PhongFamily {
    /// The family of no lobe, to whose numbers any others are joined unchanged.
    fn default() -> Self {
        Self {
            albedo: 0.0,
            normals: Cap::of_axis(Direction::Z),
            axes: Cap::of_axis(Direction::Z),
            exponents: [f32::MAX, 0.0],
        }
    }
}

impl LobeFamily for PhongFamily {
    /// All numbers but the directions, and normals and axes.
    type Sum = (Self, [CapSum; 2]);
    /// The same of their means.
    type Mean = (Self, [CapMean; 2]);
    type Reach = [CapReach; 2];

    #[inline(always)]
    fn add_to(&self, (family, [normals, axes]): &mut Self::Sum) {
        if self.albedo <= 0.0 {
            return;
        }
        let ([least, most], [own_least, own_most]) = (family.exponents, self.exponents);
        *family = Self {
            albedo: family.albedo.max(self.albedo),
            exponents: [least.min(own_least), most.max(own_most)],
            ..*family
        };
        normals.add(&self.normals);
        axes.add(&self.axes);
    }

    fn mean((family, [normals, axes]): &Self::Sum) -> Self::Mean {
        (*family, [normals.mean(), axes.mean()])
    }

    #[inline(always)]
    fn widen(&self, (_, [normals, axes]): &Self::Mean, reach: &mut Self::Reach) {
        if self.albedo > 0.0 {
            normals.widen(&self.normals, &mut reach[0]);
            axes.widen(&self.axes, &mut reach[1]);
        }
    }

    fn around((family, [normals, axes]): &Self::Mean, reach: &Self::Reach) -> Self {
        Self {
            normals: normals.cap(&reach[0]),
            axes: axes.cap(&reach[1]),
            ..*family
        }
    }

    #[inline(always)]
    fn majorant_in_lanes<N: Single>(&self, cap: &Caps<N>) -> Majorant<N> {
        let albedo = cap.splat(self.albedo);
        let lobes = PhongLobes {
            normal: Vector3::splat(albedo, (*self.normals.axis()).into()),
            axis: Vector3::splat(albedo, (*self.axes.axis()).into()),
            exponent: albedo.zero(),
            albedo,
        };
        let [least, most] = self.exponents;
        lobes.majorant_of(
            &self.normals.splat(albedo),
            &self.axes.splat(albedo),
            #[inline(always)]
            |versine| {
                let worst = N::per_lane(
                    [versine],
                    #[inline(always)]
                    |_, [versine]| (-1.0 / ln_1p_f64(-f64::from(versine)) - 1.0) as f32,
                );
                Real::min(Real::max(worst, worst.splat(least)), worst.splat(most))
            },
            cap,
        )
    }
}
