use super::phong::PhongLobes;
use super::{Cap, Caps, Lobe, LobeFamily, Majorant, PhongLobe, ReceiverLobe};
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

impl LobeFamily for PhongFamily {
    fn union(mut families: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        let lit = families.clone().filter(|family| family.albedo > 0.0);
        let Some(normals) = Cap::union(lit.clone().map(|family| family.normals)) else {
            return families.next();
        };
        let axes = Cap::union(lit.clone().map(|family| family.axes))?;
        let rest = lit.reduce(|a, b| Self {
            albedo: a.albedo.max(b.albedo),
            exponents: [
                a.exponents[0].min(b.exponents[0]),
                a.exponents[1].max(b.exponents[1]),
            ],
            ..a
        })?;
        Some(Self {
            normals,
            axes,
            ..rest
        })
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
