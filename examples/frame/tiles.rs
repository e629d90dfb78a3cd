//! The tiles of every subregion, and what they see.

use rayon::prelude::*;
use stochastic_light_culling::{Camera, DepthInterval, Error, Interleave, TileDepths, TileGrid};

use crate::scene::SurfaceBuffer;

/// Tiles of one size.
pub struct Tiles {
    interleave: Interleave,
    subregions: Vec<Subregion>,
}

/// A small image of the whole view.
pub struct Subregion {
    grid: TileGrid,
    pub depths: TileDepths,
}

/// Where a surface is looked up.
pub struct Place {
    pub subregion: usize,
    pub tile: [u32; 2],
    pub interval: u32,
}

impl Tiles {
    /// Tiles of `tile_size`² pixels of their subregion, each with its surfaces parted by depth.
    pub fn new(
        surfaces: &SurfaceBuffer,
        camera: &Camera,
        interleave: &Interleave,
        tile_size: u32,
    ) -> Result<Self, Error> {
        let subregion = |subregion| {
            let grid = TileGrid::new(interleave.subregion_size(subregion), tile_size)?;
            let mut depths = TileDepths::new(grid.size(), 2, |tile| {
                let around = interleave.join_pixels(subregion, grid.pixels(tile));
                camera.tile_rectangle(surfaces.image_size, around)
            })?;
            for tile in grid.tiles() {
                let pixels = grid.pixels(tile).pixels();
                let seen = pixels.map(|pixel| interleave.join_pixel(subregion, pixel));
                let seen = seen.map(|pixel| surfaces.at(pixel).depth);
                depths.set(tile, DepthInterval::modified_half_z(seen));
            }
            Ok(Subregion { grid, depths })
        };
        Ok(Self {
            interleave: *interleave,
            subregions: (0..interleave.subregions())
                .into_par_iter()
                .map(subregion)
                .collect::<Result<_, _>>()?,
        })
    }

    pub fn subregions(&self) -> &[Subregion] {
        &self.subregions
    }

    /// The tile and the depth interval that hold the surface at `pixel`, which is at `depth`; none for
    /// sky.
    pub fn place_of(&self, pixel: [u32; 2], depth: f32) -> Option<Place> {
        let (subregion, local) = self.interleave.split_pixel(pixel);
        let Subregion { grid, depths } = &self.subregions[subregion as usize];
        let tile = grid.tile_of(local);
        Some(Place {
            subregion: subregion as usize,
            tile,
            interval: depths.interval_of(tile, depth)?,
        })
    }
}
