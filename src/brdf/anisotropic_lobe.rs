use glam::Vec3;

use super::{AnisotropicGgx, Fresnel, GgxLobe, HeightCorrelated, Lobe, MaskingShadowing};
use super::{NoFresnel, Separable};
use crate::wide::{self, Vector};
use crate::{Direction, Error, math};

/// The lobe of an [`AnisotropicGgx`] microsurface for light from one direction [Heitz 2014].
///
/// f·max(μ_o, 0) = F(ω_i·ω_h) G2(ω_i, ω_o) D(ω_h)/(4μ), with the [`Fresnel`] factor `F` and the
/// [`MaskingShadowing`] function `G`. Empty, zero in every direction, if the light arrives from below
/// the surface or along it.
///
/// ```
/// use stochastic_light_culling::{
///     AnisotropicGgx, AnisotropicGgxLobe, Bounded, Direction, Lobe, Schlick, glam::Vec3,
/// };
///
/// let (normal, tangent) = (Direction::Z, Direction::X);
/// let incoming = Direction::new(Vec3::new(-1.0, 0.0, 1.0))?;
/// let brushed = AnisotropicGgx::new(0.05, 0.3)?;
/// let lobe = AnisotropicGgxLobe::new(brushed, Schlick::new(0.9)?, normal, tangent, incoming)?;
///
/// // The highlight is wide across the tangent, along which the surface is smooth.
/// let towards = |x, y| Direction::new(Vec3::new(x, y, 1.0)).map(Vec3::from);
/// assert!(lobe.value(towards(1.0, 0.3)?) > lobe.value(towards(1.3, 0.0)?));
///
/// assert_eq!((lobe.ggx(), lobe.tangent()), (brushed, tangent));
/// // No more than this leaves it of what arrives at facets that are lit.
/// assert!(lobe.max_reflected() <= 1.0 && lobe.incident_cosine() > 0.7);
/// assert!(lobe.separable().value(towards(1.0, 0.3)?) <= lobe.value(towards(1.0, 0.3)?));
///
/// let semi_axes = lobe.unit_bound().semi_axes();
/// assert!(semi_axes.max_element() > 3.0 * semi_axes.min_element());
/// // A tangent is needed to say which way is which.
/// assert!(AnisotropicGgxLobe::new(brushed, Schlick::new(0.9)?, normal, normal, incoming).is_err());
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        into = "crate::unchecked::AnisotropicGgxLobe<F>",
        try_from = "crate::unchecked::AnisotropicGgxLobe<F>",
        bound(
            serialize = "F: Fresnel + serde::Serialize, G: Copy",
            deserialize = "F: Fresnel + serde::Deserialize<'de>"
        )
    )
)]
pub struct AnisotropicGgxLobe<F = NoFresnel, G = HeightCorrelated> {
    ggx: AnisotropicGgx,
    /// As given.
    tangent: Direction,
    /// The tangent at right angles to n, and the bitangent.
    tangent_axes: [Vec3; 2],
    /// All that the azimuth of ω_o does not matter to: an isotropic lobe, of the lesser roughness, since
    /// that has the largest G2 of any azimuth, but with this lobe's own root for ω_i.
    at_any_azimuth: GgxLobe<F, G>,
}

impl<F: Fresnel> AnisotropicGgxLobe<F> {
    /// The lobe, with height-correlated masking and shadowing, of a surface with unit `normal` = n for
    /// light from the unit direction `incoming` = ω_i, both pointing away from the surface.
    ///
    /// The surface has the roughness α_x along the part of `tangent` that is at right angles to n, of
    /// either sign.
    ///
    /// # Errors
    ///
    /// [`Error::Vector`] if `tangent` is parallel to `normal`, or within 10⁻⁶ radians of that, where it
    /// has no other part than rounding.
    pub fn new(
        ggx: AnisotropicGgx,
        fresnel: F,
        normal: Direction,
        tangent: Direction,
        incoming: Direction,
    ) -> Result<Self, Error> {
        let Some(axes) = surface_axes(normal, tangent) else {
            return Err(Error::Vector {
                quantity: "tangent",
                value: *tangent,
                valid: "not parallel to the normal",
            });
        };
        let isotropic = GgxLobe::new(ggx.smoother(), fresnel, normal, incoming);
        let at_any_azimuth = if ggx.is_isotropic() {
            isotropic
        } else {
            let incoming = wide::unit(incoming);
            let incoming = axes.map(|axis| wide::dot(axis, incoming));
            isotropic.with_incident_root(ggx.masking_root_of_wide(incoming))
        };
        let [along, across, _] = axes.map(|axis| Vec3::from_array(axis.map(|x| x as f32)));
        Ok(Self {
            ggx,
            tangent,
            tangent_axes: [along, across],
            at_any_azimuth,
        })
    }

    /// The same lobe with [`Separable`] masking and shadowing.
    pub fn separable(self) -> AnisotropicGgxLobe<F, Separable> {
        self.with_masking()
    }
}

impl<F: Fresnel, G> AnisotropicGgxLobe<F, G> {
    /// The same lobe with masking and shadowing of another form.
    pub(crate) fn with_masking<H>(self) -> AnisotropicGgxLobe<F, H> {
        let Self {
            ggx,
            tangent,
            tangent_axes,
            at_any_azimuth,
        } = self;
        AnisotropicGgxLobe {
            ggx,
            tangent,
            tangent_axes,
            at_any_azimuth: at_any_azimuth.with_masking(),
        }
    }

    /// The microsurface.
    pub fn ggx(&self) -> AnisotropicGgx {
        self.ggx
    }

    /// n, the surface normal.
    pub fn normal(&self) -> Direction {
        self.at_any_azimuth.normal()
    }

    /// The tangent, as it was given: not at right angles to n if it was not.
    pub fn tangent(&self) -> Direction {
        self.tangent
    }

    /// ω_i, the direction that light comes from.
    pub fn incoming(&self) -> Direction {
        self.at_any_azimuth.incoming()
    }

    /// μ = ω_i·n in \[0, 1\]; 0 means that the lobe is empty.
    pub fn incident_cosine(&self) -> f32 {
        self.at_any_azimuth.incident_cosine()
    }

    /// ω_u = 2μn − ω_i, the direction of mirror reflection.
    pub fn mirror_direction(&self) -> Direction {
        self.at_any_azimuth.mirror_direction()
    }

    /// The unit vectors along the tangent, at right angles to n, the bitangent n × tangent, and n.
    pub(crate) fn surface_axes(&self) -> [Vector; 3] {
        // What the constructor has accepted has axes.
        surface_axes(self.normal(), self.tangent).unwrap_or_default()
    }

    /// An isotropic lobe with the same normal, ω_i, F and G1(ω_i), whose G2 is nowhere below this one's;
    /// the same lobe altogether if α_x = α_y.
    pub(crate) fn at_any_azimuth(&self) -> &GgxLobe<F, G> {
        &self.at_any_azimuth
    }

    fn to_surface_frame(&self, v: Vec3) -> Vec3 {
        let [along, across] = self.tangent_axes;
        Vec3::new(along.dot(v), across.dot(v), self.normal().dot(v))
    }
}

/// The frame (tangent, bitangent, n), if the tangent is not parallel to n.
fn surface_axes(normal: Direction, tangent: Direction) -> Option<[Vector; 3]> {
    let across = math::cross(*normal, *tangent);
    let length = math::length(across);
    if length < 1e-6 {
        return None;
    }
    let (across, normal) = (across.map(|x| x / length), wide::unit(normal));
    Some([wide::cross(across, normal), across, normal])
}

impl<F: Fresnel, G: MaskingShadowing> AnisotropicGgxLobe<F, G> {
    /// An upper bound of F·G2/G1(ω_i) over all directions above the surface, as
    /// [`GgxLobe::max_reflected`].
    pub fn max_reflected(&self) -> f32 {
        self.at_any_azimuth.max_reflected()
    }
}

impl<F: Fresnel, G: MaskingShadowing> Lobe for AnisotropicGgxLobe<F, G> {
    #[inline]
    fn value(&self, outgoing: Vec3) -> f32 {
        self.at_any_azimuth.value_with(
            outgoing,
            |half_vector| self.ggx.ndf(self.to_surface_frame(half_vector)),
            |_| self.ggx.masking_root(self.to_surface_frame(outgoing)),
        )
    }
}
