//! The tiles of every subregion, and what they see.

use stochastic_light_culling::{Camera, DepthInterval, Error, Interleave, TileGrid, TileRectangle};

use crate::scene::SurfaceBuffer;

/// A tile of one subregion.
pub struct Tile {
    pub subregion: u32,
    /// Its pixels in the image.
    pub pixels: Vec<[u32; 2]>,
    pub rectangle: TileRectangle,
    /// What its surfaces lie in, the nearer ones first.
    pub depths: [Option<DepthInterval>; 2],
}

impl Tile {
    /// All tiles, of `tile_size`² pixels of their subregion, that see more than sky.
    pub fn all(
        surfaces: &SurfaceBuffer,
        camera: &Camera,
        interleave: &Interleave,
        tile_size: u32,
    ) -> Result<Vec<Self>, Error> {
        let mut tiles = Vec::new();
        for subregion in 0..interleave.subregions() {
            let grid = TileGrid::new(interleave.subregion_size(subregion), tile_size)?;
            for tile in grid.tiles() {
                let local = grid.pixels(tile);
                let pixels: Vec<_> = local
                    .pixels()
                    .map(|pixel| interleave.join_pixel(subregion, pixel))
                    .collect();
                let seen = pixels.iter().map(|pixel| surfaces.at(*pixel).depth);
                let depths = DepthInterval::modified_half_z(seen);
                let around = interleave.join_pixels(subregion, local);
                if depths.iter().any(Option::is_some) {
                    tiles.push(Self {
                        subregion,
                        pixels,
                        rectangle: camera.tile_rectangle(surfaces.image_size, around),
                        depths,
                    });
                }
            }
        }
        Ok(tiles)
    }

    /// Which of the two intervals `depth`, of one of the tile's surfaces, lies in.
    pub fn interval_of(&self, depth: f32) -> usize {
        let in_nearer = self.depths[0].is_some_and(|nearer| depth <= nearer.far());
        usize::from(!in_nearer)
    }
}
