//! What all kernels of a frame share.

use bytemuck::{Pod, Zeroable};

use super::GpuCamera;
use super::kernel::LIGHTS_OF_WORKGROUP;
use crate::base::{Error, number_in};
use crate::light::{Roulette, Seed};
use crate::view::{Camera, Interleave, TileGrid};

/// What all kernels of a frame share, for a uniform buffer: `SlcFrame`, 128 bytes.
///
/// The kernels split the image into subregions ([`Interleave`]), and each of these into tiles of 16×16 of its pixels. Light
/// i lights the subregion that [`Interleave::split_light`] says, with [`Interleave::weight`] times its flux.
///
/// ```
/// use stochastic_light_culling::{
///     Camera, GpuBuffer, GpuFrame, GpuKernel, Interleave, Roulette, Seed, glam::Vec3,
/// };
///
/// let camera = Camera::look_at(Vec3::splat(6.0), Vec3::ZERO, Vec3::Y, 1.0, 16.0 / 9.0, 0.1..100.0)?;
/// let interleave = Interleave::new([1920, 1080], 8)?;
/// let frame = GpuFrame::new(&camera, &interleave, &Roulette::new(0.001)?, 65536)?.seeded(Seed(1), 7);
/// assert_eq!(frame.workgroups(GpuKernel::Tiles), [15, 9, 64]);
/// assert_eq!(frame.bytes(GpuBuffer::Lights), 64 * 65536);
/// // The edges of 15 columns and 9 rows of tiles, of 8 pixels beside each other.
/// assert_eq!(frame.edges(&camera, &interleave).count(), 8 * (15 + 9));
/// let bytes: &[u8] = bytemuck::bytes_of(&frame);
/// assert_eq!(bytes.len(), 128);
/// # Ok::<(), stochastic_light_culling::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GpuFrame {
    /// The camera; offset 0.
    pub camera: GpuCamera,
    /// The width and height of the image in pixels; offset 80.
    pub image_size: [u32; 2],
    /// Columns and rows of tiles in the largest subregion, which all subregions have; offset 88.
    pub tiles: [u32; 2],
    /// Width w of the interleaving; offset 96.
    pub interleave: u32,
    /// The number of lights; offset 100.
    pub lights: u32,
    /// The number of depth intervals of a tile; offset 104.
    pub intervals: u32,
    /// For how many indices the buffer of lists has room; offset 108.
    pub room: u32,
    /// δ; offset 112.
    pub delta: f32,
    /// Lower clamp of squared distances to lights; offset 116.
    pub least_distance_squared: f32,
    /// The seed; offset 120.
    pub seed: u32,
    /// The index of the frame; offset 124.
    pub frame: u32,
}

/// The side of a tile in pixels of its subregion.
const TILE_SIZE: u32 = 16;
/// The most workgroups along an axis.
const MOST_WORKGROUPS: u32 = 65535;
/// The most depth intervals of a tile.
const MOST_INTERVALS: u32 = 32;
/// The least squared distance to a light, where the caller sets none. A quotient by it is finite.
const LEAST_DISTANCE_SQUARED: f32 = 1e-20;

impl GpuFrame {
    /// Creates the record of a frame with so many `lights`. Zero lights are valid, and light nothing.
    ///
    /// Tiles have two depth intervals, and lists room for 64 lights in each, on average. Both can be
    /// [changed](Self::with_lists).
    ///
    /// # Errors
    ///
    /// [`Error::Count`] for more than 4,194,240 lights, and [`Error::Size`] if the interleaving is wider than 255, or the
    /// image has more than 2³² tiles or more than 65,535 of them in a row: a GPU does not run so many workgroups.
    pub fn new(
        camera: &Camera,
        interleave: &Interleave,
        roulette: &Roulette,
        lights: u32,
    ) -> Result<Self, Error> {
        if lights > MOST_WORKGROUPS * LIGHTS_OF_WORKGROUP {
            return Err(Error::Count {
                quantity: "lights",
                value: lights as usize,
                valid: "at most 4,194,240",
            });
        }
        let width = interleave.width();
        if interleave.subregions() > MOST_WORKGROUPS {
            return Err(Error::Size {
                quantity: "interleaving width",
                value: [width; 2],
                valid: "at most 255×255 on a GPU",
            });
        }
        let tiles = TileGrid::new(interleave.subregion_size(0), TILE_SIZE)?.size();
        let frame = Self {
            camera: GpuCamera::from(camera),
            image_size: interleave.image_size(),
            tiles,
            interleave: width,
            lights,
            intervals: 1,
            room: 0,
            delta: roulette.delta(),
            least_distance_squared: LEAST_DISTANCE_SQUARED,
            seed: 0,
            frame: 0,
        };
        let room = frame.lists().saturating_mul(128).min(u64::from(u32::MAX)) as u32;
        let fits = tiles.iter().all(|n| *n <= MOST_WORKGROUPS);
        match frame.with_lists(2, room) {
            Ok(frame) if fits => Ok(frame),
            _ => Err(Error::Size {
                quantity: "image size",
                value: interleave.image_size(),
                valid: "at most 65535×65535 tiles of 16×16 pixels, and 2³² intervals in all",
            }),
        }
    }

    /// Returns this record with the random numbers of a frame: ξ of a light is
    /// [`xi_of_rank`](crate::FrameSeed::xi_of_rank) of its index within its subregion, with the seed of
    /// [that](Seed::subregion).
    ///
    /// Lights that are sorted by [`rank_along_curve`](crate::rank_along_curve) have the least noise.
    #[must_use]
    pub fn seeded(self, Seed(seed): Seed, frame: u32) -> Self {
        Self {
            seed,
            frame,
            ..self
        }
    }

    /// Returns this record with a lower clamp of squared distances to lights, such as the squared size of the patch of
    /// surface that a light stands for.
    ///
    /// # Errors
    ///
    /// [`Error::Number`] if it is less than 10⁻²⁰, greater than 10³⁰ or NaN.
    pub fn with_least_distance_squared(self, squared: f32) -> Result<Self, Error> {
        let (quantity, valid) = ("least squared distance", "in [10⁻²⁰, 10³⁰]");
        let range = LEAST_DISTANCE_SQUARED..=1e30;
        let least_distance_squared = number_in(quantity, squared, valid, range)?;
        Ok(Self {
            least_distance_squared,
            ..self
        })
    }

    /// Returns this record with so many depth `intervals` in each tile, and `room` for so many indices in all lists
    /// together.
    ///
    /// Lists for which there is no room lose no light: their pixels are shaded by all lights, which is slow. So read
    /// [`GpuBuffer::Needed`](crate::GpuBuffer::Needed) now and then, and make room.
    ///
    /// # Errors
    ///
    /// [`Error::Count`] if `intervals` is zero or more than 32, or there are 2³² intervals or more.
    pub fn with_lists(self, intervals: u32, room: u32) -> Result<Self, Error> {
        let frame = Self {
            intervals,
            room,
            ..self
        };
        let is_valid = (1..=MOST_INTERVALS).contains(&intervals);
        if !is_valid || u32::try_from(frame.lists()).is_err() {
            return Err(Error::Count {
                quantity: "depth intervals of a tile",
                value: intervals as usize,
                valid: "from 1 to 32, and fewer than 2³² in all tiles",
            });
        }
        Ok(frame)
    }

    /// The number of lists: depth intervals of all tiles of all subregions.
    ///
    /// That of interval k of n in tile (x, y) of subregion s, with w columns and h rows of tiles, is number
    /// ((s h + y) w + x) n + k.
    #[must_use]
    pub fn lists(&self) -> u64 {
        let [columns, rows] = self.tiles.map(u64::from);
        let subregions = u64::from(self.interleave) * u64::from(self.interleave);
        // Below 2⁴⁸ tiles, so that this does not overflow.
        (columns * rows)
            .saturating_mul(subregions)
            .saturating_mul(u64::from(self.intervals))
    }

    /// The edges of tiles, for [`GpuBuffer::Edges`](crate::GpuBuffer::Edges): \[least, greatest\] x/z of each column of
    /// tiles, for each of the w subregions beside each other; then y/z of each row, for each of the w below each other.
    ///
    /// Those of [`Camera::interleaved_tile`], bit for bit. `camera` and `interleave` must be those of this record.
    pub fn edges(
        &self,
        camera: &Camera,
        interleave: &Interleave,
    ) -> impl Iterator<Item = [f32; 2]> + Clone {
        let ([columns, rows], width) = (self.tiles, self.interleave);
        let (camera, interleave) = (*camera, *interleave);
        let tile = move |subregion, tile| {
            // A subregion has at least one pixel, and so its grid is valid.
            let grid = TileGrid::new(interleave.subregion_size(subregion), TILE_SIZE).ok();
            grid.map(|grid| camera.interleaved_tile(&interleave, subregion, &grid, tile))
        };
        let across = (0..width * columns).filter_map(move |i| {
            let tile = tile(i / columns, [i % columns, 0])?;
            Some([tile.min().x, tile.max().x])
        });
        let down = (0..width * rows).filter_map(move |i| {
            let tile = tile(i / rows * width, [0, i % rows])?;
            Some([tile.min().y, tile.max().y])
        });
        across.chain(down)
    }
}
