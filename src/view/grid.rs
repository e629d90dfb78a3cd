use crate::base::Error;

/// A rectangle of pixels, from `min` (inclusive) to `max` (exclusive). Pixel (0, 0) is at the top left.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PixelRectangle {
    /// The pixel at the top left.
    pub min: [u32; 2],
    /// One past the pixel at the bottom right, in x and in y.
    pub max: [u32; 2],
}

impl PixelRectangle {
    /// Iterates over the pixels, row by row. None if `max` is not greater than `min` in both components.
    pub fn pixels(self) -> impl Iterator<Item = [u32; 2]> + Clone {
        let [x, y] = [0, 1].map(|i| self.min[i]..self.max[i]);
        y.flat_map(move |y| x.clone().map(move |x| [x, y]))
    }
}

/// An image split into square tiles. The tiles at the right and at the bottom may be cut off.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct TileGrid {
    image_size: [u32; 2],
    tile_size: u32,
}

impl TileGrid {
    /// Creates the grid of an image of `image_size` = \[width, height\] pixels, with tiles of `tile_size`²
    /// pixels.
    ///
    /// # Errors
    ///
    /// [`Error::Size`] if a side of the image or `tile_size` is zero.
    pub fn new(image_size: [u32; 2], tile_size: u32) -> Result<Self, Error> {
        let positive = |quantity, value: [u32; 2]| {
            let valid = "at least 1×1";
            if value.contains(&0) {
                Err(Error::Size {
                    quantity,
                    value,
                    valid,
                })
            } else {
                Ok(value)
            }
        };
        Ok(Self {
            image_size: positive("image size", image_size)?,
            tile_size: positive("tile size", [tile_size; 2])?[0],
        })
    }

    /// The width and height of the image in pixels.
    #[must_use]
    pub fn image_size(&self) -> [u32; 2] {
        self.image_size
    }

    /// The side of a tile in pixels.
    #[must_use]
    pub fn tile_size(&self) -> u32 {
        self.tile_size
    }

    /// The number of tiles, \[columns, rows\].
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.image_size.map(|n| n.div_ceil(self.tile_size))
    }

    /// Iterates over the tiles as \[column, row\], row by row.
    pub fn tiles(&self) -> impl Iterator<Item = [u32; 2]> + Clone {
        let max = self.size();
        PixelRectangle { min: [0; 2], max }.pixels()
    }

    /// The pixels of `tile`. None for a tile outside the grid.
    #[inline]
    #[must_use]
    pub fn pixels(&self, tile: [u32; 2]) -> PixelRectangle {
        let edge =
            |first: u32, i: usize| first.saturating_mul(self.tile_size).min(self.image_size[i]);
        PixelRectangle {
            min: [0, 1].map(|i| edge(tile[i], i)),
            max: [0, 1].map(|i| edge(tile[i].saturating_add(1), i)),
        }
    }

    /// The tile that holds `pixel`. Outside the grid for a pixel outside the image.
    #[inline]
    #[must_use]
    pub fn tile_of(&self, pixel: [u32; 2]) -> [u32; 2] {
        pixel.map(|n| n / self.tile_size)
    }
}
