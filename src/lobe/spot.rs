use core::f32::consts::PI;

use glam::Vec3;

use super::{Cap, Caps, ConstantLobe, Lobe, LobeNumbers, Majorant, padded};
use crate::base::{Direction, Error, number_in};
use crate::num::{Real, Single, Vector3, round_down, tan};

/// Budget for the value and the versine of a maximum within a cap.
const MAXIMUM_ROUNDINGS: u16 = 16;
/// The typical value within a cap over the greatest, at least: where the middle is in the dark, some of the cap is lit.
const LEAST_TYPICAL_SHARE: f32 = 0.01;

/// The lobe of an engine's spot light: constant within an inner cone, and fading to zero at an outer cone.
///
/// Its value is 1/(4π) · clamp((cosγ − cosγ_o)/(cosγ_i − cosγ_o), 0, 1)² in sr⁻¹, with the angle γ to the
/// axis and the half angles γ_i and γ_o of the cones. This is the transition of Bevy, Filament and the glTF
/// extension KHR_lights_punctual. The cones may have any angle up to 180°, at which the lobe has no edge.
///
/// The lobe is that of a [`ConstantLobe`] behind a stop. So a spot light of intensity I in candela has the
/// flux 4πI, as a point light has ([`Vpl::spot`](crate::Vpl::spot)), and a narrower cone does not brighten
/// its middle. It emits the share [`emitted_share`](Self::emitted_share) of that flux.
///
/// Engines keep cosγ_i − cosγ_o above about 10⁻³, which dims a cone of less than 2.6°. This lobe does not:
/// its edge may be hard, γ_i = γ_o.
///
/// ```
/// use stochastic_light_culling::{Direction, Lobe, Roulette, SpotLobe, Vpl, Xi, glam::Vec3};
///
/// let (inner, outer) = (30_f32.to_radians(), 45_f32.to_radians());
/// let lobe = SpotLobe::new(inner, outer, -Direction::Y)?;
/// let lamp = Vpl::spot(Vec3::new(0.0, 3.0, 0.0), 800.0, lobe)?; // 800 cd
/// assert!((lamp.radiant_intensity(-Vec3::Y) - 800.0).abs() < 1e-3);
/// let slanted = Vec3::new(35_f32.to_radians().tan(), -1.0, 0.0).normalize();
/// assert!(lamp.radiant_intensity(slanted) < 500.0);
/// assert_eq!(lamp.radiant_intensity(Vec3::X), 0.0);
///
/// // Its range in a frame: an ellipsoid that begins at the lamp.
/// let bound = lamp.bound(&Roulette::new(1.0)?, Xi::new(0.5)?);
/// let range = (800.0_f32 / 0.5).sqrt();
/// assert!(bound.semi_axes().max_element() < 0.7 * range);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLobe {
    axis: Direction,
    angles: [f32; 2],
    /// 1 − cosγ_i ≤ 1 − cosγ_o
    versines: [f32; 2],
}

impl SpotLobe {
    /// The value within the inner cone, 1/(4π) sr⁻¹: the largest.
    pub const PEAK: f32 = ConstantLobe::PEAK;

    /// Creates the lobe around `axis` with the half angles `inner_angle` = γ_i and `outer_angle` = γ_o in
    /// radians.
    ///
    /// An outer angle of 0 makes an [empty](Lobe::is_empty) lobe, and so does one below 10⁻²². Equal angles
    /// make a hard edge; both π make a point light.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `outer_angle` is outside \[0, π\], `inner_angle` is outside \[0, γ_o\], or either
    /// is NaN.
    pub fn new(inner_angle: f32, outer_angle: f32, axis: Direction) -> Result<Self, Error> {
        let outer = number_in("outer cone angle", outer_angle, "in [0, π]", 0.0..=PI)?;
        let valid = "between 0 and the outer cone angle";
        let inner = number_in("inner cone angle", inner_angle, valid, 0.0..=outer)?;
        let outer_versine = versine(outer);
        Ok(Self {
            axis,
            angles: [inner, outer],
            versines: [versine(inner).min(outer_versine), outer_versine],
        })
    }

    /// Returns the lobe with another `axis`.
    #[must_use]
    pub fn with_axis(self, axis: Direction) -> Self {
        Self { axis, ..self }
    }

    /// Returns the lobe with the inner cone as wide as the outer one, which is nowhere less than this lobe.
    ///
    /// Its range is a sector of a ball. So its bound, scaled to a distance, holds all of the outer cone up to
    /// that distance: a bound of a spot light with a [`DistanceWindow`](crate::DistanceWindow) that can be kept.
    #[must_use]
    pub fn hard_edged(self) -> Self {
        Self {
            angles: [self.angles[1]; 2],
            versines: [self.versines[1]; 2],
            ..self
        }
    }

    /// The axis, in which the lobe is largest.
    #[must_use]
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// The half angle γ_i of the inner cone, in radians.
    #[must_use]
    pub fn inner_angle(&self) -> f32 {
        self.angles[0]
    }

    /// The half angle γ_o of the outer cone, in radians.
    #[must_use]
    pub fn outer_angle(&self) -> f32 {
        self.angles[1]
    }

    /// 1 − cosγ_i and 1 − cosγ_o as the lobe has them, in \[0, 2\]. All of its values follow from these
    /// numbers, which are accurate for narrow cones too.
    #[must_use]
    pub fn versines(&self) -> [f32; 2] {
        self.versines
    }

    /// The share of the flux that is emitted, the integral of the lobe: (2(1 − cosγ_i) + 1 − cosγ_o)/6.
    ///
    /// In \[0, 1\]. A light that is to emit Φ lumens in all has the flux Φ over this share.
    #[must_use]
    pub fn emitted_share(&self) -> f32 {
        let [inner, outer] = self.versines;
        (2.0 * inner + outer) / 6.0
    }

    /// 1/(cosγ_i − cosγ_o), clamped where the edge is hard.
    #[inline(always)]
    fn slope(&self) -> f32 {
        let [inner, outer] = self.versines;
        (1.0 / (outer - inner)).min(f32::MAX)
    }
}

/// 1 − cos `angle` for an angle in \[0, π\]: 2t²/(1 + t²) with the tangent t of its half.
fn versine(angle: f32) -> f32 {
    let tangent = tan(0.5 * angle);
    let squared = tangent * tangent;
    2.0 * squared / (1.0 + squared)
}

impl Lobe for SpotLobe {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        spot(
            self.axis.into(),
            self.versines[1],
            self.slope(),
            outgoing.into(),
        )
    }

    #[inline]
    fn maximum_within(&self, cap: &Cap) -> f32 {
        let numbers = self.numbers();
        Self::majorant_in_lanes(&numbers, |_| Some(self), &cap.lanes()).greatest
    }

    fn is_empty(&self) -> bool {
        self.versines[1] <= 0.0
    }

    #[inline]
    fn numbers(&self) -> LobeNumbers<f32> {
        let axis = self.axis;
        padded([axis.x, axis.y, axis.z, self.versines[1], self.slope()])
    }

    fn numbers_in_use() -> usize {
        5
    }

    fn has_more_than_numbers() -> bool {
        false
    }

    #[inline(always)]
    fn value_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        outgoing: Vector3<N>,
    ) -> N {
        let [x, y, z, outer, slope, ..] = *numbers;
        spot(Vector3::new(x, y, z), outer, slope, outgoing)
    }

    /// The typical value is that halfway between the middle and the nearest direction, and not much less than the
    /// greatest.
    #[inline(always)]
    fn majorant_in_lanes<'a, N: Single>(
        numbers: &LobeNumbers<N>,
        _: impl Fn(usize) -> Option<&'a Self>,
        cap: &Caps<N>,
    ) -> Majorant<N> {
        let [x, y, z, outer, slope, ..] = *numbers;
        let [least, middle] = cap.distances(&Caps::around(Vector3::new(x, y, z)));
        let halfway = (least + middle) * 0.5;
        let versine = least * least * 0.5 * round_down(1.0, MAXIMUM_ROUNDINGS);
        let greatest = spot_of_versine(outer, slope, versine).round_up(MAXIMUM_ROUNDINGS);
        let typical = spot_of_versine(outer, slope, halfway * halfway * 0.5);
        // Zero beyond the edge.
        let typical = Real::max(typical, greatest * LEAST_TYPICAL_SHARE);
        Majorant {
            greatest,
            typical: typical.min(greatest),
        }
    }
}

/// The value of [`SpotLobe`] for `outer` = 1 − cosγ_o and `slope` = 1/(cosγ_i − cosγ_o).
///
/// 1 − cosγ is ½‖ω_o − u‖², which loses no digits near the axis u.
#[inline(always)]
fn spot<N: Single>(axis: Vector3<N>, outer: N, slope: N, outgoing: Vector3<N>) -> N {
    spot_of_versine(outer, slope, (outgoing - axis).length_squared() * 0.5)
}

/// The value where 1 − cosγ is `versine`.
#[inline(always)]
fn spot_of_versine<N: Single>(outer: N, slope: N, versine: N) -> N {
    let share = (outer - versine) * slope;
    let share = Real::min(Real::max(share, outer.zero()), outer.splat(1.0));
    share * share * SpotLobe::PEAK
}
