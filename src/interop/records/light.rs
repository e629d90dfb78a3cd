//! Lights in the memory layout of shaders.

use bytemuck::{Pod, Zeroable};

use crate::light::Vpl;
use crate::lobe::{ConstantLobe, Fresnel, GgxLobe, LambertLobe};

/// A light for shaders: `SlcLight`, 64 bytes.
///
/// Which lobe it has, and which Fresnel factor, the shader says by the functions that it calls. What a lobe does not have
/// is zero.
///
/// ```
/// use stochastic_light_culling::{Direction, Ggx, GgxLobe, GpuLight, Incidence, Schlick, Vpl, glam::Vec3};
///
/// let lobe = GgxLobe::new(Ggx::new(0.2)?, Schlick::new(0.9)?, Incidence::head_on(Direction::Y));
/// let lights = [Vpl::new(Vec3::X, 3.0, lobe)?];
/// let records = lights.each_ref().map(GpuLight::from);
/// assert_eq!((records[0].position, records[0].flux), ([1.0, 0.0, 0.0], 3.0));
/// assert_eq!((records[0].cosine, records[0].roughness, records[0].fresnel), (1.0, 0.2, [0.9, 0.0]));
/// let bytes: &[u8] = bytemuck::cast_slice(&records);
/// assert_eq!(bytes.len(), 64);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuLight {
    /// The position in world space; offset 0.
    pub position: [f32; 3],
    /// Φ in W; offset 12.
    pub flux: f32,
    /// n, of unit length; offset 16.
    pub normal: [f32; 3],
    /// μ = ω_i·n of a GGX lobe, zero if it is lit from behind; offset 28.
    pub cosine: f32,
    /// ω_i of a GGX lobe, of unit length; offset 32.
    pub incoming: [f32; 3],
    /// α of a GGX lobe; offset 44.
    pub roughness: f32,
    /// Parameters of the Fresnel factor: F0, or η, or η and κ. The first is ρ of Lambert's lobe. Offset 48.
    pub fresnel: [f32; 2],
    /// Base and rise of an upper bound of the Fresnel factor in Schlick's form ([`Fresnel::majorant`]); offset 56.
    pub majorant: [f32; 2],
}

/// The record of a light with a lobe that no number but its flux tells.
fn plain<L: crate::lobe::Lobe>(light: &Vpl<L>) -> GpuLight {
    GpuLight {
        position: light.position().to_array(),
        flux: light.flux(),
        ..GpuLight::zeroed()
    }
}

impl<F: Fresnel> From<&Vpl<GgxLobe<F>>> for GpuLight {
    fn from(light: &Vpl<GgxLobe<F>>) -> Self {
        let lobe = light.lobe();
        let majorant = lobe.fresnel().majorant();
        Self {
            normal: lobe.normal().to_array(),
            cosine: lobe.incident_cosine(),
            incoming: lobe.incoming().to_array(),
            roughness: lobe.ggx().roughness(),
            fresnel: lobe.fresnel().parameters(),
            majorant: [majorant.base, majorant.rise],
            ..plain(light)
        }
    }
}

impl From<&Vpl<LambertLobe>> for GpuLight {
    fn from(light: &Vpl<LambertLobe>) -> Self {
        Self {
            normal: light.lobe().normal().to_array(),
            fresnel: [light.lobe().albedo(), 0.0],
            ..plain(light)
        }
    }
}

impl From<&Vpl<ConstantLobe>> for GpuLight {
    fn from(light: &Vpl<ConstantLobe>) -> Self {
        plain(light)
    }
}
