//! The tiles of every subregion, and what they see.

use rayon::prelude::*;
use stochastic_light_culling::{Camera, DepthInterval, Error, Interleave, TileDepths, TileGrid};

use crate::scene::SurfaceBuffer;

/// How a tile's surfaces are parted by depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slicing {
    /// One interval around all of them.
    Whole,
    HalfZ,
    ModifiedHalfZ,
    /// So many exponential slices of the view, of which a tile has those with surfaces.
    Slices(u32),
}

/// Tiles of one size.
pub struct Tiles {
    subregions: Vec<Subregion>,
}

/// A small image of the whole view.
pub struct Subregion {
    pub grid: TileGrid,
    pub depths: TileDepths,
}

impl Subregion {
    pub fn interval(&self, [x, y]: [u32; 2], interval: u32) -> Option<DepthInterval> {
        let tile = y * self.grid.size()[0] + x;
        let first = tile as usize * self.depths.intervals() as usize;
        let [near, far] = self.depths.depths()[first + interval as usize];
        // Refused if it is missing.
        DepthInterval::new(near, far).ok()
    }
}

/// A [`Slicing`] of a view.
enum Parting {
    Own(Slicing),
    /// What all tiles share.
    Slices(Vec<DepthInterval>),
}

impl Parting {
    fn new(slicing: Slicing, surfaces: &SurfaceBuffer) -> Self {
        let Slicing::Slices(count) = slicing else {
            return Self::Own(slicing);
        };
        let depths = surfaces.surfaces.iter().map(|surface| surface.depth);
        let whole = DepthInterval::around(depths);
        Self::Slices(whole.map_or_else(Vec::new, |whole| whole.exponential_slices(count).collect()))
    }

    fn intervals(&self) -> u32 {
        match self {
            Self::Own(Slicing::Whole) => 1,
            Self::Own(_) => 2,
            Self::Slices(slices) => slices.len().max(1) as u32,
        }
    }

    fn part(&self, depths: impl Iterator<Item = f32> + Clone) -> Vec<Option<DepthInterval>> {
        match self {
            Self::Own(Slicing::HalfZ) => DepthInterval::half_z(depths)
                .map_or_else(Vec::new, |halves| halves.map(Some).to_vec()),
            Self::Own(Slicing::ModifiedHalfZ) => DepthInterval::modified_half_z(depths).to_vec(),
            Self::Own(_) => vec![DepthInterval::around(depths)],
            Self::Slices(slices) => {
                let has_surfaces = |slice: &DepthInterval| {
                    depths
                        .clone()
                        .any(|depth| slice.near() <= depth && depth <= slice.far())
                };
                slices
                    .iter()
                    .map(|slice| has_surfaces(slice).then_some(*slice))
                    .collect()
            }
        }
    }
}

/// Where a surface is looked up.
pub struct Place {
    pub subregion: usize,
    pub tile: [u32; 2],
    pub interval: u32,
}

impl Tiles {
    /// Tiles of `tile_size`² pixels of their subregion, each with its surfaces parted by `slicing`.
    pub fn new(
        surfaces: &SurfaceBuffer,
        camera: &Camera,
        interleave: &Interleave,
        tile_size: u32,
        slicing: Slicing,
    ) -> Result<Self, Error> {
        let slicing = match slicing {
            // A pixel has one depth.
            Slicing::HalfZ | Slicing::ModifiedHalfZ if tile_size == 1 => Slicing::Whole,
            _ => slicing,
        };
        let slicing = Parting::new(slicing, surfaces);
        let subregion = |subregion| {
            let grid = TileGrid::new(interleave.subregion_size(subregion), tile_size)?;
            let rectangle = |tile| camera.interleaved_tile(interleave, subregion, &grid, tile);
            let mut depths =
                TileDepths::from_rectangles(grid.size(), slicing.intervals(), rectangle)?;
            for tile in grid.tiles() {
                let pixels = grid.pixels(tile).pixels();
                let seen = pixels.map(|pixel| interleave.join_pixel(subregion, pixel));
                let seen = seen.map(|pixel| surfaces.at(pixel).depth);
                depths.set(tile, slicing.part(seen));
            }
            Ok(Subregion { grid, depths })
        };
        Ok(Self {
            subregions: (0..interleave.subregions())
                .into_par_iter()
                .map(subregion)
                .collect::<Result<_, _>>()?,
        })
    }

    pub fn subregions(&self) -> &[Subregion] {
        &self.subregions
    }

    /// The tile and the depth interval that hold the surface at `pixel` of a subregion, which is at `depth`; none
    /// for sky.
    #[inline(always)]
    pub fn place_of(&self, (subregion, pixel): (u32, [u32; 2]), depth: f32) -> Option<Place> {
        let Subregion { grid, depths } = &self.subregions[subregion as usize];
        let tile = grid.tile_of(pixel);
        Some(Place {
            subregion: subregion as usize,
            tile,
            interval: depths.interval_of(tile, depth)?,
        })
    }
}
