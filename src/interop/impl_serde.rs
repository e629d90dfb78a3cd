//! Serialization of each type, and the constructor that checks what is deserialized.
//!
//! Types whose fields are public derive both traits where they are defined.

use glam::{Mat3, Vec3};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use crate::base::{Direction, Error};
use crate::light::{DistanceWindow, EvenNoise, Roulette, Vpl, Xi};
use crate::lobe::{
    AnisotropicGgx, AnisotropicGgxLobe, Conductor, Dielectric, Fresnel, Ggx, GgxLobe, Incidence,
    LambertLobe, Lobe, PhongLobe, Schlick, SphericalGaussian, SpotLobe,
};
use crate::view::{
    Camera, CameraParts, DepthInterval, Interleave, Orthographic, Perspective, TileGrid,
    TileRectangle,
};

type OrthographicCamera = Camera<Orthographic>;

/// Implements both traits: for each type the fields that are saved, and the constructor that reads them.
macro_rules! saved {
    ($(
        |$this:ident| $name:ident { $($field:ident: $kind:ty = $value:expr),* } => $constructed:expr;
    )*) => {$(
        const _: () = {
            #[derive(Serialize, Deserialize)]
            struct Saved {
                $($field: $kind,)*
            }

            impl Serialize for $name {
                fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    let $this = self;
                    Saved { $($field: $value,)* }.serialize(serializer)
                }
            }

            impl<'de> Deserialize<'de> for $name {
                fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    let Saved { $($field),* } = Saved::deserialize(deserializer)?;
                    checked($constructed)
                }
            }
        };
    )*};
}

/// Turns the error of a constructor into one of the deserializer, with the same message.
fn checked<T, E: de::Error>(constructed: Result<T, Error>) -> Result<T, E> {
    constructed.map_err(E::custom)
}

saved! {
    |ggx| AnisotropicGgx { roughness: [f32; 2] = ggx.roughness() } =>
        AnisotropicGgx::new(roughness[0], roughness[1]);
    |metal| Conductor { index: f32 = metal.index(), extinction: f32 = metal.extinction() } =>
        Conductor::new(index, extinction);
    |depths| DepthInterval { near: f32 = depths.near(), far: f32 = depths.far() } =>
        DepthInterval::new(near, far);
    |interface| Dielectric { relative_index: f32 = interface.relative_index() } =>
        Dielectric::new(relative_index);
    |ggx| Ggx { roughness: f32 = ggx.roughness() } => Ggx::new(roughness);
    |interleave| Interleave {
        image_size: [u32; 2] = interleave.image_size(),
        width: u32 = interleave.width()
    } => Interleave::new(image_size, width);
    |lobe| LambertLobe { albedo: f32 = lobe.albedo(), normal: Direction = lobe.normal() } =>
        LambertLobe::new(albedo, normal);
    |lobe| PhongLobe {
        albedo: f32 = lobe.albedo(),
        exponent: f32 = lobe.exponent(),
        normal: Direction = lobe.normal(),
        incoming: Option<Direction> = lobe.incoming()
    } => match incoming {
        Some(incoming) => PhongLobe::new(albedo, exponent, Incidence { normal, incoming }),
        None => PhongLobe::about(albedo, exponent, normal),
    };
    |lobe| SpotLobe {
        inner_angle: f32 = lobe.inner_angle(),
        outer_angle: f32 = lobe.outer_angle(),
        axis: Direction = lobe.axis()
    } => SpotLobe::new(inner_angle, outer_angle, axis);
    |window| DistanceWindow { radius: f32 = window.radius() } => DistanceWindow::new(radius);
    |even| EvenNoise { typical: f32 = even.typical(), range: [f32; 2] = even.range() } =>
        EvenNoise::new(typical).and_then(|even| even.with_range(range[0], range[1]));
    |roulette| Roulette { delta: f32 = roulette.delta() } => Roulette::new(delta);
    |schlick| Schlick { f0: f32 = schlick.f0() } => Schlick::new(f0);
    |lobe| SphericalGaussian {
        axis: Direction = lobe.axis(),
        sharpness: f32 = lobe.sharpness(),
        amplitude: f32 = lobe.amplitude()
    } => SphericalGaussian::new(axis, sharpness, amplitude);
    |grid| TileGrid { image_size: [u32; 2] = grid.image_size(), tile_size: u32 = grid.tile_size() } =>
        TileGrid::new(image_size, tile_size);
    |tile| TileRectangle { min: [f32; 2] = tile.min().into(), max: [f32; 2] = tile.max().into() } =>
        TileRectangle::new(min.into(), max.into());
    // A camera does not keep the arguments of its constructor, so its fields are saved. The columns of the
    // rotation are the images of the world's axes.
    |camera| Camera {
        rotation: [[f32; 3]; 3] = camera.parts().rotation.to_cols_array_2d(),
        translation: [f32; 3] = camera.parts().translation.into(),
        slope_scale: [f32; 2] = camera.parts().scale.into(),
        slope_offset: [f32; 2] = camera.parts().offset.into(),
        depth_numerator: f32 = camera.parts().projection.depths()[0],
        depth_offset: f32 = camera.parts().projection.depths()[1]
    } => Camera::from_parts(CameraParts {
        rotation: Mat3::from_cols_array_2d(&rotation),
        translation: translation.into(),
        scale: slope_scale.into(),
        offset: slope_offset.into(),
        projection: Perspective::with_depths([depth_numerator, depth_offset]),
    });
    |camera| OrthographicCamera {
        rotation: [[f32; 3]; 3] = camera.parts().rotation.to_cols_array_2d(),
        translation: [f32; 3] = camera.parts().translation.into(),
        scale: [f32; 2] = camera.parts().scale.into(),
        offset: [f32; 2] = camera.parts().offset.into(),
        depth_per_ndc: f32 = camera.parts().projection.depth_per_ndc()
    } => Camera::from_parts(CameraParts {
        rotation: Mat3::from_cols_array_2d(&rotation),
        translation: translation.into(),
        scale: scale.into(),
        offset: offset.into(),
        projection: Orthographic::with_depth_per_ndc(depth_per_ndc),
    });
}

/// Saved as a single number.
impl Serialize for Xi {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.get().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Xi {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        checked(Self::new(f32::deserialize(deserializer)?))
    }
}

/// Saved as three numbers. A vector of any length is read.
impl Serialize for Direction {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_array().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let vector = <[f32; 3]>::deserialize(deserializer)?;
        checked(Self::of_unit_or_any_length(vector.into()))
    }
}

/// The fields of a lobe. The form of masking and shadowing is not saved: it is that of the type that is read.
#[derive(Serialize, Deserialize)]
#[serde(rename = "GgxLobe")]
struct SavedGgxLobe<F> {
    ggx: Ggx,
    fresnel: F,
    normal: Direction,
    incoming: Direction,
}

impl<F: Fresnel + Serialize, G> Serialize for GgxLobe<F, G> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let saved = SavedGgxLobe {
            ggx: self.ggx(),
            fresnel: *self.fresnel(),
            normal: self.normal(),
            incoming: self.incoming(),
        };
        saved.serialize(serializer)
    }
}

impl<'de, F: Fresnel + Deserialize<'de>, G> Deserialize<'de> for GgxLobe<F, G> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let SavedGgxLobe {
            ggx,
            fresnel,
            normal,
            incoming,
        } = SavedGgxLobe::deserialize(deserializer)?;
        Ok(GgxLobe::new(ggx, fresnel, Incidence { normal, incoming }).with_masking())
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "AnisotropicGgxLobe")]
struct SavedAnisotropicGgxLobe<F> {
    ggx: AnisotropicGgx,
    fresnel: F,
    normal: Direction,
    tangent: Direction,
    incoming: Direction,
}

impl<F: Fresnel + Serialize, G> Serialize for AnisotropicGgxLobe<F, G> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let saved = SavedAnisotropicGgxLobe {
            ggx: self.ggx(),
            fresnel: *self.fresnel(),
            normal: self.normal(),
            tangent: self.tangent(),
            incoming: self.incoming(),
        };
        saved.serialize(serializer)
    }
}

impl<'de, F: Fresnel + Deserialize<'de>, G> Deserialize<'de> for AnisotropicGgxLobe<F, G> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let SavedAnisotropicGgxLobe {
            ggx,
            fresnel,
            normal,
            tangent,
            incoming,
        } = SavedAnisotropicGgxLobe::deserialize(deserializer)?;
        let incidence = Incidence { normal, incoming };
        let lobe = AnisotropicGgxLobe::new(ggx, fresnel, incidence, tangent);
        checked(lobe.map(AnisotropicGgxLobe::with_masking))
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "Vpl")]
struct SavedVpl<P, L> {
    position: P,
    flux: f32,
    lobe: L,
}

impl<L: Lobe + Serialize> Serialize for Vpl<L> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let saved = SavedVpl {
            position: self.position().to_array(),
            flux: self.flux(),
            lobe: self.lobe(),
        };
        saved.serialize(serializer)
    }
}

impl<'de, L: Lobe + Deserialize<'de>> Deserialize<'de> for Vpl<L> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let SavedVpl::<[f32; 3], L> {
            position,
            flux,
            lobe,
        } = SavedVpl::deserialize(deserializer)?;
        checked(Self::new(Vec3::from(position), flux, lobe))
    }
}
