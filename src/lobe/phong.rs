use core::f32::consts::TAU;

use glam::Vec3;

use super::{Cap, Caps, Incidence, Lobe, LobeNumbers, Majorant, padded};
use crate::base::{Direction, Error, number_in};
use crate::num::{self, Real, Single, Vector3, exact_dot};

/// Budget for the value of a maximum within a cap.
const MAXIMUM_ROUNDINGS: u16 = 64;

/// Phong's lobe: a power of the cosine to the mirror direction [Phong 1975].
///
/// Its value is f·max(μ_o, 0) = ρ (n+1)/(2π) max(ω_o·ω_u, 0)ⁿ above the surface and zero below it, with the
/// exponent n and the mirror direction ω_u. The power replaces the whole left side, cosine included. It
/// integrates to 2π/(n+1) over the hemisphere around ω_u. So the share ρ of the incoming light is reflected,
/// less what the horizon cuts off, and no energy is gained. Like Phong's model, the lobe is not reciprocal.
///
/// [Dachsbacher & Stamminger 2006] use it for virtual lights. It is empty, that is, zero in every direction,
/// if the light arrives from below the surface or at grazing incidence.
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, Incidence, Lobe, PhongLobe, glam::Vec3};
///
/// let incoming = Direction::new(Vec3::new(-1.0, 0.0, 1.0))?;
/// let incidence = Incidence { normal: Direction::Z, incoming };
/// let plastic = PhongLobe::new(0.5, 40.0, incidence)?;
/// let peak = plastic.value(*plastic.axis());
/// assert!((peak - 0.5 * 41.0 / std::f32::consts::TAU).abs() < 1e-4);
/// assert!(plastic.value(Vec3::Z) < 1e-5 * peak);
///
/// // Its bound is a slim ellipsoid along the mirror direction.
/// let semi_axes = plastic.unit_bound().semi_axes();
/// assert!(semi_axes.x > 3.0 * semi_axes.y);
///
/// // A spotlight has no surface that cuts its lobe.
/// let spot = PhongLobe::about(1.0, 10.0, Direction::X)?;
/// assert!(spot.incoming().is_none() && spot.exponent() < PhongLobe::MAX_EXPONENT);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongLobe {
    albedo: f32,
    exponent: f32,
    normal: Direction,
    incoming: Option<Direction>,
    axis: Direction,
    is_lit: bool,
}

impl PhongLobe {
    /// The largest exponent, 2²⁰. Its lobe is a tenth of a degree wide, which `f32` directions still resolve.
    pub const MAX_EXPONENT: f32 = 1_048_576.0;

    /// Creates the lobe with `exponent` = n of a surface that reflects the share `albedo` = ρ of the light
    /// that arrives with `incidence`.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `albedo` is outside \[0, 1\], `exponent` outside
    /// \[0, [`MAX_EXPONENT`](Self::MAX_EXPONENT)\], or either is NaN.
    pub fn new(albedo: f32, exponent: f32, incidence: Incidence) -> Result<Self, Error> {
        let Incidence { normal, incoming } = incidence;
        Ok(Self {
            albedo: number_in("albedo", albedo, "in [0, 1]", 0.0..=1.0)?,
            exponent: number_in(
                "Phong exponent",
                exponent,
                "in [0, 2²⁰]",
                0.0..=Self::MAX_EXPONENT,
            )?,
            normal,
            incoming: Some(incoming),
            axis: incoming.mirrored(normal),
            is_lit: exact_dot(Vector3::from(normal), incoming.into()) > 0.0,
        })
    }

    /// Creates the same lobe around any `axis`, without a surface that cuts it: a spotlight that emits the
    /// share `albedo` of its flux. It is zero from 90° off the axis on.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn about(albedo: f32, exponent: f32, axis: Direction) -> Result<Self, Error> {
        let mirrored = Self::new(albedo, exponent, Incidence::head_on(axis))?;
        Ok(Self {
            incoming: None,
            // Unchanged: mirrored at itself it would be rounded.
            axis,
            ..mirrored
        })
    }

    /// The albedo ρ in \[0, 1\]: the share of the light that is reflected, were nothing cut off by the
    /// horizon.
    #[must_use]
    pub fn albedo(&self) -> f32 {
        self.albedo
    }

    /// The exponent n.
    #[must_use]
    pub fn exponent(&self) -> f32 {
        self.exponent
    }

    /// The surface normal, or the axis of a lobe made by [`about`](Self::about).
    #[must_use]
    pub fn normal(&self) -> Direction {
        self.normal
    }

    /// The direction ω_i that light comes from. `None` for a lobe made by [`about`](Self::about).
    #[must_use]
    pub fn incoming(&self) -> Option<Direction> {
        self.incoming
    }

    /// The axis ω_u: the mirror direction, in which the lobe is largest.
    #[must_use]
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// The radius √(ρ(n+1)/(2π)) of the unit isosurface along the axis. Zero if the lobe is empty.
    pub(crate) fn unit_reach(&self) -> f32 {
        if self.is_lit {
            // Two roots, since the product with a subnormal albedo would lose digits.
            num::sqrt(self.albedo) * num::sqrt((self.exponent + 1.0) / TAU)
        } else {
            0.0
        }
    }
}

impl Lobe for PhongLobe {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        self.lanes().value(outgoing.into())
    }

    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        self.lanes().majorant(&cap.lanes()).greatest
    }

    fn horizon_normal(&self) -> Option<Direction> {
        self.incoming.map(|_| self.normal)
    }

    fn is_empty(&self) -> bool {
        !self.is_lit || self.albedo <= 0.0
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        let PhongLobes {
            normal: n,
            axis: u,
            exponent,
            albedo,
        } = self.lanes();
        padded([n.x, n.y, n.z, u.x, u.y, u.z, exponent, albedo])
    }

    fn numbers_in_use() -> usize {
        8
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
        PhongLobes::from_numbers(numbers).value(outgoing)
    }

    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        PhongLobes::from_numbers(numbers).majorant(cap)
    }
}

/// A [`PhongLobe`] in each lane.
#[derive(Clone, Copy)]
pub(crate) struct PhongLobes<N> {
    pub normal: Vector3<N>,
    /// ω_u
    pub axis: Vector3<N>,
    pub exponent: N,
    /// ρ, or zero for an empty lobe
    pub albedo: N,
}

impl PhongLobe {
    #[inline(always)]
    fn lanes(&self) -> PhongLobes<f32> {
        PhongLobes {
            normal: self.normal.into(),
            axis: self.axis.into(),
            exponent: self.exponent,
            albedo: if self.is_lit { self.albedo } else { 0.0 },
        }
    }
}

impl<N: Single> PhongLobes<N> {
    #[inline(always)]
    fn from_numbers(numbers: &LobeNumbers<N>) -> Self {
        let [n_x, n_y, n_z, u_x, u_y, u_z, exponent, albedo, ..] = *numbers;
        Self {
            normal: Vector3::new(n_x, n_y, n_z),
            axis: Vector3::new(u_x, u_y, u_z),
            exponent,
            albedo,
        }
    }

    /// The majorant within a cap.
    #[inline(always)]
    fn majorant(&self, cap: &Caps<N>) -> Majorant<N> {
        let [normals, axes] = [self.normal, self.axis].map(
            #[inline(always)]
            |axis| Caps::around(axis),
        );
        self.majorant_of(
            &normals,
            &axes,
            #[inline(always)]
            |_| self.exponent,
            cap,
        )
    }

    /// The majorant of lobes with other normals and axes. `exponent` gives that for which the lobe is greatest at a
    /// distance from the axis, of which it takes half the square.
    ///
    /// The typical value is that between the axes, of the lobe that is wider by the spread of the directions. A power
    /// of the cosine is nearly an SG of the sharpness n, whose variance is 1/n for each of two axes; that of a disc of
    /// the radius c is c²/4.
    #[inline(always)]
    pub(super) fn majorant_of(
        &self,
        normals: &Caps<N>,
        axes: &Caps<N>,
        exponent: impl FnOnce(N) -> N,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let above = cap.greatest_cosine(normals).is_positive();
        let [least, middle] = cap.distances(axes).map(
            #[inline(always)]
            |distance| distance.widen() * distance.widen(),
        );
        let two = least.splat(2.0);
        let is_lit = self.albedo.is_positive() & above & !two.le(least);
        let zero = self.albedo.zero();
        if N::is_known_false(is_lit) {
            return Majorant::exactly(zero);
        }
        let exponent = exponent(N::narrow(least * 0.5));
        let spread = cap.spread(axes);
        let wider = exponent / (exponent * spread * spread * 0.25 + 1.0);
        let greatest = Self { exponent, ..*self }.value_at(least, above);
        let typical = Self {
            exponent: wider,
            ..*self
        }
        .value_at(middle, above);
        // Both may underflow.
        let smallest = zero.splat(f32::MIN_POSITIVE);
        let greatest = Real::max(greatest.round_up(MAXIMUM_ROUNDINGS), smallest);
        let typical = Real::max(typical, smallest).min(greatest);
        let [greatest, typical] = N::select_all(is_lit, [greatest, typical], [zero; 2]);
        Majorant { greatest, typical }
    }

    /// f·max(μ_o, 0) towards `outgoing`.
    ///
    /// The cosine is 1 − ½‖ω_o − ω_u‖² in `f64`, since the power multiplies its relative error by n. The
    /// power is taken of the cosine rounded to `f32`. The relative rounding error x of that cosine is then
    /// made up for by the factor (1 + x)ⁿ = 1 + nx + ½n²x² + …, nx < 2⁻⁵.
    #[inline(always)]
    pub fn value(&self, outgoing: Vector3<N>) -> N {
        let apart = outgoing.widen() - self.axis.widen();
        self.value_at(
            apart.length_squared(),
            self.normal.dot(outgoing).is_positive(),
        )
    }

    /// The value where the distance from the axis has the square `distance_squared`, and zero where it is not
    /// `above` the surface.
    #[inline(always)]
    fn value_at(&self, distance_squared: N::Double, above: N::Mask) -> N {
        let zero = self.albedo.zero();
        let half_squared = distance_squared * 0.5;
        let cosine = half_squared.splat(1.0) - half_squared;
        let rounded = N::narrow(cosine);
        let is_lit = self.albedo.is_positive() & above & rounded.is_positive();
        if N::is_known_false(is_lit) {
            return zero;
        }
        let share = cosine / rounded.widen();
        let lost = N::narrow(share - 1.0) * self.exponent;
        let power = N::per_lane(
            [rounded, self.exponent],
            #[inline(always)]
            |_, [cosine, exponent]| num::power(cosine, exponent),
        );
        let power = power * (lost * (lost * 0.5 + 1.0) + 1.0);
        let value = self.albedo * ((self.exponent + 1.0) / zero.splat(TAU)) * power;
        N::select(is_lit, value, zero)
    }
}
