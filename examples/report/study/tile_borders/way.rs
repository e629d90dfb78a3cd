//! Which pixels share a decision.

use stochastic_light_culling::{Seed, Xi};

use super::TILE;

/// Which pixels share a decision, and by which ξ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// None: each decides by its own probability.
    Pixel,
    /// Those of a tile, by one ξ for each light, from its rank.
    Tile,
    /// The same, by a hashed ξ.
    Hashed,
    /// By the ranked ξ, with a grid that is moved from frame to frame.
    Jittered,
    /// By a ξ hashed from light and tile.
    HashedPerTile,
    /// By a ranked ξ, with a seed for each tile.
    RankedPerTile,
    /// The same, with a grid that is moved from frame to frame.
    JitteredPerTile,
}

impl Way {
    pub const ALL: [Self; 7] = [
        Self::Pixel,
        Self::Tile,
        Self::Hashed,
        Self::Jittered,
        Self::HashedPerTile,
        Self::RankedPerTile,
        Self::JitteredPerTile,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Pixel => "by pixel",
            Self::Tile => "by tile",
            Self::Hashed => "by tile, hashed",
            Self::Jittered => "by tile, jittered",
            Self::HashedPerTile => "by tile, hashed per tile",
            Self::RankedPerTile => "by tile, ranked per tile",
            Self::JitteredPerTile => "by tile, ranked per tile, jittered",
        }
    }

    /// By how many pixels the grid of a frame is moved.
    pub fn offset(self, seed: Seed, frame: u32) -> [u32; 2] {
        match self {
            Self::Jittered | Self::JitteredPerTile => seed
                .frame(frame)
                .hashed_point(0)
                .map(|x| (x * TILE as f32) as u32),
            _ => [0; 2],
        }
    }

    /// The ξ of a light in a tile, for the light's index, its rank within its subregion and its ranked ξ.
    pub fn xi(self, seed: Seed, frame: u32, tile: u32, [light, rank]: [u32; 2], ranked: Xi) -> Xi {
        match self {
            Self::Pixel | Self::Tile | Self::Jittered => ranked,
            Self::Hashed => seed.frame(frame).hashed_xi(light),
            Self::HashedPerTile => seed.subregion(tile).frame(frame).hashed_xi(light),
            Self::RankedPerTile | Self::JitteredPerTile => {
                seed.subregion(tile).frame(frame).xi_of_rank(rank)
            }
        }
    }
}
