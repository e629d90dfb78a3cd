//! What serde reads: the numbers of each type that can be saved, which its constructor then checks.

use serde::{Deserialize, Serialize};

use crate::Error;

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
