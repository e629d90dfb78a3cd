use core::f32::consts::TAU;

use glam::Vec3;

use super::Lobe;
use crate::{Direction, Error, error, math};

/// Phong's lobe: a power of the cosine to the mirror direction [Phong 1975].
///
/// f·max(μ_o, 0) = ρ (n+1)/(2π) max(ω_o·ω_u, 0)ⁿ above the surface and zero below it, for the exponent n
/// and the mirror direction ω_u. The power stands for all of the left side, its cosine included. It
/// integrates to 2π/(n+1) over the hemisphere about ω_u, so of the light that arrives the share ρ is
/// reflected, less what the horizon cuts off: no energy is gained. Not reciprocal, as Phong's model is not.
///
/// The lobe of the virtual lights of [Dachsbacher & Stamminger 2006]. Empty, zero in every direction, if the
/// light arrives from below the surface or along it.
///
/// ```
/// use stochastic_light_culling::{Bounded, Direction, Lobe, PhongLobe, glam::Vec3};
///
/// let incoming = Direction::new(Vec3::new(-1.0, 0.0, 1.0))?;
/// let plastic = PhongLobe::new(0.5, 40.0, Direction::Z, incoming)?;
/// let peak = plastic.value(*plastic.axis());
/// assert!((peak - 0.5 * 41.0 / std::f32::consts::TAU).abs() < 1e-4);
/// assert!(plastic.value(Vec3::Z) < 1e-5 * peak);
///
/// // A slim ellipsoid from the light along the mirror direction.
/// let semi_axes = plastic.unit_bound().semi_axes();
/// assert!(semi_axes.x > 3.0 * semi_axes.y);
///
/// // A spotlight, with no surface to cut it.
/// let spot = PhongLobe::about(1.0, 10.0, Direction::X)?;
/// assert!(spot.incoming().is_none() && spot.exponent() < PhongLobe::MAX_EXPONENT);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "crate::unchecked::PhongLobe"))]
pub struct PhongLobe {
    albedo: f32,
    exponent: f32,
    normal: Direction,
    incoming: Option<Direction>,
    #[cfg_attr(feature = "serde", serde(skip))]
    axis: Direction,
    #[cfg_attr(feature = "serde", serde(skip))]
    is_lit: bool,
}

impl PhongLobe {
    /// The greatest exponent, 2²⁰: a lobe a tenth of a degree wide, of which directions in `f32` still
    /// tell the inside.
    pub const MAX_EXPONENT: f32 = 1_048_576.0;

    /// The lobe of a surface with unit `normal` that reflects the share `albedo` = ρ of the light from
    /// the unit direction `incoming` = ω_i, with `exponent` = n. Both directions point away from the
    /// surface.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if `albedo` is outside \[0, 1\], `exponent` outside
    /// \[0, [`MAX_EXPONENT`](Self::MAX_EXPONENT)\], or either is NaN.
    pub fn new(
        albedo: f32,
        exponent: f32,
        normal: Direction,
        incoming: Direction,
    ) -> Result<Self, Error> {
        Ok(Self {
            albedo: error::number_in("albedo", albedo, "in [0, 1]", 0.0..=1.0)?,
            exponent: error::number_in(
                "Phong exponent",
                exponent,
                "in [0, 2²⁰]",
                0.0..=Self::MAX_EXPONENT,
            )?,
            normal,
            incoming: Some(incoming),
            axis: incoming.mirrored(normal),
            is_lit: math::exact_dot(*normal, *incoming) > 0.0,
        })
    }

    /// The same lobe about any `axis`, without a surface that cuts it: a spotlight that sends the share
    /// `albedo` of its flux. Zero from 90° off the axis on.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn about(albedo: f32, exponent: f32, axis: Direction) -> Result<Self, Error> {
        let mirrored = Self::new(albedo, exponent, axis, axis)?;
        Ok(Self {
            incoming: None,
            // Not mirrored at itself, which is a rounding away.
            axis,
            ..mirrored
        })
    }

    /// The share of light reflected, ρ, but for what the horizon cuts off.
    pub fn albedo(&self) -> f32 {
        self.albedo
    }

    /// n, the exponent.
    pub fn exponent(&self) -> f32 {
        self.exponent
    }

    /// The surface normal; of a lobe [about](Self::about) an axis, that axis.
    pub fn normal(&self) -> Direction {
        self.normal
    }

    /// ω_i, the direction that light comes from; `None` of a lobe [about](Self::about) an axis.
    pub fn incoming(&self) -> Option<Direction> {
        self.incoming
    }

    /// ω_u, the direction in which the lobe is largest.
    pub fn axis(&self) -> Direction {
        self.axis
    }

    /// √(ρ(n+1)/(2π)), the radius of the unit isosurface along the axis; zero if the lobe is empty.
    pub(crate) fn unit_reach(&self) -> f32 {
        if self.is_lit {
            // Apart, since the product with a subnormal albedo would be off by more than its root is.
            math::sqrt(self.albedo) * math::sqrt((self.exponent + 1.0) / TAU)
        } else {
            0.0
        }
    }
}

impl Lobe for PhongLobe {
    /// The cosine is 1 − ½‖ω_o − ω_u‖² in `f64`, since a power multiplies by n what a cosine lacks; and what
    /// its rounding to `f32` takes is given back afterwards, (1 + x)ⁿ = 1 + nx + ½n²x² + …, nx < 2⁻⁵.
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        if !(self.is_lit && self.normal.dot(outgoing) > 0.0) {
            return 0.0;
        }
        let (axis, outgoing) = (self.axis.as_f64(), outgoing.to_array().map(f64::from));
        let [x, y, z] = [0, 1, 2].map(|i| outgoing[i] - axis[i]);
        let cosine = 1.0 - 0.5 * (x * x + y * y + z * z);
        let rounded = cosine as f32;
        if rounded <= 0.0 {
            return 0.0;
        }
        let lost = (cosine / f64::from(rounded) - 1.0) as f32 * self.exponent;
        let power = math::power(rounded, self.exponent) * (1.0 + lost * (1.0 + 0.5 * lost));
        self.albedo * ((self.exponent + 1.0) / TAU) * power
    }
}
