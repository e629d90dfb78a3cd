use core::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::{Cap, Caps, Lobe, LobeNumbers, Majorant, padded};
use crate::base::{Direction, Error, number_in};
use crate::num::{Real, Single, Vector3, sqrt};

/// Budget for the products of a maximum within a cap.
const MAXIMUM_ROUNDINGS: u16 = 4;

/// Lambert's lobe: the same radiance in every direction, f = ρ/π.
///
/// Its value is ρ/π max(ω_o·n, 0) in sr⁻¹, zero at and below the horizon.
///
/// ```
/// use stochastic_light_culling::{Direction, LambertLobe, Lobe, glam::Vec3};
///
/// let chalk = LambertLobe::new(0.9, Direction::Z)?;
/// assert!((chalk.value(Vec3::Z) - 0.9 / std::f32::consts::PI).abs() < 1e-6);
/// assert_eq!(chalk.value(-Vec3::Z), 0.0);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LambertLobe {
    albedo: f32,
    /// √ρ, the first step of every bound.
    albedo_root: f32,
    normal: Direction,
}

impl LambertLobe {
    /// Creates the lobe of a surface with `normal` that reflects the share `albedo` = ρ of the light. It is
    /// zero everywhere for ρ = 0.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `albedo` is outside \[0, 1\] or NaN.
    pub fn new(albedo: f32, normal: Direction) -> Result<Self, Error> {
        number_in("albedo", albedo, "in [0, 1]", 0.0..=1.0).map(|albedo| Self {
            albedo,
            albedo_root: sqrt(albedo),
            normal,
        })
    }

    /// The albedo ρ in \[0, 1\], the share of the light that is reflected.
    #[must_use]
    pub fn albedo(&self) -> f32 {
        self.albedo
    }

    /// √ρ
    pub(crate) fn albedo_root(&self) -> f32 {
        self.albedo_root
    }

    /// The surface normal n.
    #[must_use]
    pub fn normal(&self) -> Direction {
        self.normal
    }
}

impl Lobe for LambertLobe {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        lambert(self.albedo, self.normal.into(), outgoing.into())
    }

    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        let normals = Caps::around(self.normal.into());
        lambert_majorant(self.albedo, &normals, &cap.lanes()).greatest
    }

    fn is_empty(&self) -> bool {
        self.albedo <= 0.0
    }

    fn horizon_normal(&self) -> Option<Direction> {
        Some(self.normal)
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        let n = self.normal;
        padded([n.x, n.y, n.z, self.albedo])
    }

    fn numbers_in_use() -> usize {
        4
    }

    fn has_more_than_numbers() -> bool {
        false
    }

    #[inline(always)]
    fn horizon_in_lanes<N: Single>(numbers: &LobeNumbers<N>) -> Option<Vector3<N>> {
        let [x, y, z, ..] = *numbers;
        Some(Vector3::new(x, y, z))
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        let [x, y, z, albedo, ..] = *numbers;
        lambert(albedo, Vector3::new(x, y, z), outgoing)
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let [x, y, z, albedo, ..] = *numbers;
        lambert_majorant(albedo, &Caps::around(Vector3::new(x, y, z)), cap)
    }
}

/// The majorant within a cap of [`LambertLobe`]s with these normals.
#[inline(always)]
pub(super) fn lambert_majorant<N: Single>(
    albedo: N,
    normals: &Caps<N>,
    cap: &Caps<N>,
) -> Majorant<N> {
    let cosine = cap.cosine(normals);
    let (radiance, zero) = (albedo * FRAC_1_PI, albedo.zero());
    let greatest = radiance * Real::max(cosine.greatest, zero);
    let greatest = greatest.round_up(MAXIMUM_ROUNDINGS);
    // It may underflow.
    let typical = Real::max(radiance * cosine.typical, zero.splat(f32::MIN_POSITIVE));
    Majorant {
        greatest,
        typical: typical.min(greatest),
    }
}

/// The value ρ/π max(ω_o·n, 0) of [`LambertLobe`].
#[inline(always)]
pub(crate) fn lambert<N: Single>(albedo: N, normal: Vector3<N>, outgoing: Vector3<N>) -> N {
    albedo * FRAC_1_PI * normal.dot(outgoing).max(albedo.zero())
}
