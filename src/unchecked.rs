//! What serde reads: the numbers of each type that can be saved, which its constructor then checks.

use glam::{Mat3, Vec3};
use serde::{Deserialize, Serialize};

use crate::camera::Parts;
use crate::{Error, Fresnel, Lobe};

/// For each type, what it is saved as and the constructor that it is read through.
macro_rules! unchecked {
    ($($name:ident { $($field:ident: $kind:ty),* } => $constructed:expr;)*) => {$(
        #[derive(Deserialize)]
        pub(crate) struct $name {
            $($field: $kind,)*
        }

        impl TryFrom<$name> for crate::$name {
            type Error = Error;

            fn try_from($name { $($field),* }: $name) -> Result<Self, Error> {
                $constructed
            }
        }
    )*};
}

unchecked! {
    AnisotropicGgx { roughness: [f32; 2] } => Self::new(roughness[0], roughness[1]);
    Conductor { index: f32, extinction: f32 } => Self::new(index, extinction);
    DepthInterval { near: f32, far: f32 } => Self::new(near, far);
    Dielectric { relative_index: f32 } => Self::new(relative_index);
    Ggx { roughness: f32 } => Self::new(roughness);
    Interleave { image_size: [u32; 2], width: u32 } => Self::new(image_size, width);
    LambertLobe { albedo: f32, normal: crate::Direction } => Self::new(albedo, normal);
    PhongLobe {
        albedo: f32,
        exponent: f32,
        normal: crate::Direction,
        incoming: Option<crate::Direction>
    } => match incoming {
        Some(incoming) => Self::new(albedo, exponent, normal, incoming),
        None => Self::about(albedo, exponent, normal),
    };
    Roulette { delta: f32 } => Self::new(delta);
    Schlick { f0: f32 } => Self::new(f0);
    TileGrid { image_size: [u32; 2], tile_size: u32 } => Self::new(image_size, tile_size);
}

/// A number on its own.
#[derive(Deserialize)]
pub(crate) struct Xi(f32);

impl TryFrom<Xi> for crate::Xi {
    type Error = Error;

    fn try_from(Xi(xi): Xi) -> Result<Self, Error> {
        Self::new(xi)
    }
}

/// Three numbers, of any length when read.
#[derive(Deserialize, Serialize)]
pub(crate) struct Direction([f32; 3]);

impl From<crate::Direction> for Direction {
    fn from(direction: crate::Direction) -> Self {
        Self(direction.to_array())
    }
}

impl TryFrom<Direction> for crate::Direction {
    type Error = Error;

    fn try_from(Direction(vector): Direction) -> Result<Self, Error> {
        Self::of_unit_or_any_length(vector.into())
    }
}

/// Of what form masking and shadowing are, the type says that is read.
#[derive(Deserialize)]
pub(crate) struct GgxLobe<F> {
    ggx: crate::Ggx,
    fresnel: F,
    normal: crate::Direction,
    incoming: crate::Direction,
}

impl<F: Fresnel, G> From<GgxLobe<F>> for crate::GgxLobe<F, G> {
    fn from(lobe: GgxLobe<F>) -> Self {
        crate::GgxLobe::new(lobe.ggx, lobe.fresnel, lobe.normal, lobe.incoming).with_masking()
    }
}

#[derive(Deserialize, Serialize)]
pub(crate) struct AnisotropicGgxLobe<F> {
    ggx: crate::AnisotropicGgx,
    fresnel: F,
    normal: crate::Direction,
    tangent: crate::Direction,
    incoming: crate::Direction,
}

impl<F: Fresnel, G> From<crate::AnisotropicGgxLobe<F, G>> for AnisotropicGgxLobe<F> {
    fn from(lobe: crate::AnisotropicGgxLobe<F, G>) -> Self {
        Self {
            ggx: lobe.ggx(),
            fresnel: *lobe.at_any_azimuth().fresnel(),
            normal: lobe.normal(),
            tangent: lobe.tangent(),
            incoming: lobe.incoming(),
        }
    }
}

impl<F: Fresnel, G> TryFrom<AnisotropicGgxLobe<F>> for crate::AnisotropicGgxLobe<F, G> {
    type Error = Error;

    fn try_from(lobe: AnisotropicGgxLobe<F>) -> Result<Self, Error> {
        let AnisotropicGgxLobe {
            ggx,
            fresnel,
            normal,
            tangent,
            incoming,
        } = lobe;
        crate::AnisotropicGgxLobe::new(ggx, fresnel, normal, tangent, incoming)
            .map(crate::AnisotropicGgxLobe::with_masking)
    }
}

#[derive(Deserialize, Serialize)]
pub(crate) struct Vpl<L> {
    position: [f32; 3],
    flux: f32,
    lobe: L,
}

impl<L: Lobe + Clone> From<crate::Vpl<L>> for Vpl<L> {
    fn from(light: crate::Vpl<L>) -> Self {
        Self {
            position: light.position().to_array(),
            flux: light.flux(),
            lobe: light.lobe().clone(),
        }
    }
}

impl<L: Lobe> TryFrom<Vpl<L>> for crate::Vpl<L> {
    type Error = Error;

    fn try_from(light: Vpl<L>) -> Result<Self, Error> {
        Self::new(light.position.into(), light.flux, light.lobe)
    }
}

#[derive(Deserialize, Serialize)]
pub(crate) struct TileRectangle {
    min: [f32; 2],
    max: [f32; 2],
}

impl From<crate::TileRectangle> for TileRectangle {
    fn from(rectangle: crate::TileRectangle) -> Self {
        Self {
            min: rectangle.min().to_array(),
            max: rectangle.max().to_array(),
        }
    }
}

impl TryFrom<TileRectangle> for crate::TileRectangle {
    type Error = Error;

    fn try_from(TileRectangle { min, max }: TileRectangle) -> Result<Self, Error> {
        Self::new(min.into(), max.into())
    }
}

/// Not the arguments of a constructor, which a camera does not keep, but what they come to.
#[derive(Deserialize, Serialize)]
pub(crate) struct Camera {
    /// The images of the world's axes.
    rotation: [[f32; 3]; 3],
    translation: [f32; 3],
    slope_scale: [f32; 2],
    slope_offset: [f32; 2],
    depth_numerator: f32,
    depth_offset: f32,
}

impl From<crate::Camera> for Camera {
    fn from(camera: crate::Camera) -> Self {
        let parts = camera.parts();
        Self {
            rotation: parts.rotation.to_cols_array_2d(),
            translation: parts.translation.to_array(),
            slope_scale: parts.slope_scale.to_array(),
            slope_offset: parts.slope_offset.to_array(),
            depth_numerator: parts.depth_numerator,
            depth_offset: parts.depth_offset,
        }
    }
}

impl TryFrom<Camera> for crate::Camera {
    type Error = Error;

    fn try_from(camera: Camera) -> Result<Self, Error> {
        Self::of_parts(Parts {
            rotation: Mat3::from_cols_array_2d(&camera.rotation),
            translation: Vec3::from_array(camera.translation),
            slope_scale: camera.slope_scale.into(),
            slope_offset: camera.slope_offset.into(),
            depth_numerator: camera.depth_numerator,
            depth_offset: camera.depth_offset,
        })
    }
}
