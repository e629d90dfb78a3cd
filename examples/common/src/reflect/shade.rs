//! Shading of receivers by lists.

use rayon::prelude::*;
use stochastic_light_culling::{
    Decision, GgxLobe, PointBlock, RadianceEstimator, ReceiverBlock, Schlick, ShadingBatch,
    glam::Vec3,
};

use super::palette::{Palette, Sums};
use super::{Receiving, Reflected, Scenery, Shown};
use crate::frame::{Subregion, Tiles};

/// The lights of a subregion, and their tints.
pub type Lights<'a> = (&'a ShadingBatch<GgxLobe<Schlick>>, &'a [Vec3]);

/// A pixel of the image, and what it shows.
struct Pixel {
    place: usize,
    /// Of its tile and depth interval, in [`Shown`].
    slot: usize,
    radiance: Vec3,
    evaluated: u32,
    contributing: u32,
}

/// Lights the pixels of `image` by the lists that `list_of` gives for a subregion, a tile and a depth interval.
///
/// If tiles have as many pixels as a block, a light is evaluated at sixteen of them at once; else several pixels with
/// their lists at once.
pub fn shade<'l, R: Receiving, P: Palette, D: Decision + Sync>(
    scenery: &Scenery<R, P>,
    tiles: &Tiles,
    lights: &[Lights],
    estimator: &RadianceEstimator<D>,
    list_of: impl Fn(usize, [u32; 2], u32) -> D::List<'l> + Sync,
    image: &mut Reflected,
) where
    D::List<'l>: HasLength,
{
    let subregions = tiles.subregions();
    let rows: Vec<(usize, u32)> = (0..subregions.len())
        .flat_map(|i| (0..subregions[i].grid.size()[1]).map(move |y| (i, y)))
        .collect();
    let shown = &image.shown;
    let row = |&(i, y): &(usize, u32)| {
        let row = Row {
            scenery,
            subregion: (i, &subregions[i]),
            y,
            lights: lights[i],
            shown,
        };
        let list_of = |tile, interval| list_of(i, tile, interval);
        let tile_size = subregions[i].grid.tile_size() as usize;
        if tile_size * tile_size >= PointBlock::LEN {
            row.by_block(estimator, list_of)
        } else {
            row.by_pixel(estimator, list_of)
        }
    };
    let rows: Vec<Vec<Pixel>> = rows.par_iter().map(row).collect();
    for pixel in rows.into_iter().flatten() {
        image.radiance[pixel.place] = pixel.radiance;
        let radiance = pixel.radiance.element_sum() / 3.0;
        image.shown.add(pixel.slot, radiance.into(), 0.0);
        image.evaluated[pixel.place] = pixel.evaluated;
        image.contributing[pixel.place] = pixel.contributing;
    }
}

/// A list that knows how many lights it has.
pub trait HasLength {
    fn length(&self) -> usize;
}

impl HasLength for &[u32] {
    fn length(&self) -> usize {
        self.len()
    }
}

impl HasLength for stochastic_light_culling::WeightedList<'_> {
    fn length(&self) -> usize {
        self.lights.len()
    }
}

/// A row of tiles.
struct Row<'a, R, P> {
    scenery: &'a Scenery<'a, R, P>,
    subregion: (usize, &'a Subregion),
    y: u32,
    lights: Lights<'a>,
    shown: &'a Shown,
}

impl<R: Receiving, P: Palette> Row<'_, R, P> {
    /// The places in the image of the pixels of a tile that see a surface in a depth interval.
    fn pixels(&self, tile: [u32; 2], interval: u32, places: &mut Vec<usize>) {
        let frame = self.scenery.frame;
        let (index, Subregion { grid, depths }) = self.subregion;
        places.clear();
        for pixel in grid.pixels(tile).pixels() {
            let pixel = frame.interleave.join_pixel(index as u32, pixel);
            let place = frame.surfaces.index(pixel);
            let is_seen = self.scenery.receivers[place].is_some();
            if is_seen && depths.interval_of(tile, frame.surfaces.at(pixel).depth) == Some(interval)
            {
                places.push(place);
            }
        }
    }

    fn tiles_and_intervals(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let (_, Subregion { grid, depths }) = self.subregion;
        let (y, intervals) = (self.y, depths.intervals());
        (0..grid.size()[0]).flat_map(move |x| (0..intervals).map(move |i| ([x, y], i)))
    }

    fn by_block<'l, D: Decision>(
        &self,
        estimator: &RadianceEstimator<D>,
        list_of: impl Fn([u32; 2], u32) -> D::List<'l>,
    ) -> Vec<Pixel>
    where
        D::List<'l>: HasLength,
    {
        let (batch, tints) = self.lights;
        let (mut shaded, mut places) = (Vec::new(), Vec::new());
        for (tile, interval) in self.tiles_and_intervals() {
            let list = list_of(tile, interval);
            if list.length() == 0 {
                continue;
            }
            self.pixels(tile, interval, &mut places);
            let slot = self.shown.slot(tile, interval);
            for places in places.chunks(PointBlock::LEN) {
                let receivers = places
                    .iter()
                    .filter_map(|i| self.scenery.receivers[*i].clone());
                let Some(block) = ReceiverBlock::take(&mut receivers.into_iter()) else {
                    continue;
                };
                let mut sums: Sums = [[0.0; PointBlock::LEN]; 3];
                let mut contributing = [0; PointBlock::LEN];
                estimator.reflected_at_block(
                    batch,
                    list,
                    &block,
                    #[inline(always)]
                    |estimates, reflected| {
                        let tint = tints[estimates.light as usize];
                        let palette = &self.scenery.palette;
                        palette.add(places, estimates, reflected, tint, &mut sums);
                        for (i, contributing) in contributing.iter_mut().enumerate() {
                            *contributing += estimates.accepted >> i & 1;
                        }
                    },
                );
                shaded.extend(places.iter().enumerate().map(|(i, place)| Pixel {
                    place: *place,
                    slot,
                    radiance: sums.map(|sums| sums[i]).into(),
                    evaluated: list.length() as u32,
                    contributing: contributing[i],
                }));
            }
        }
        shaded
    }

    fn by_pixel<'l, D: Decision>(
        &self,
        estimator: &RadianceEstimator<D>,
        list_of: impl Fn([u32; 2], u32) -> D::List<'l>,
    ) -> Vec<Pixel>
    where
        D::List<'l>: HasLength,
    {
        let (batch, tints) = self.lights;
        let (mut shaded, mut lists, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for (tile, interval) in self.tiles_and_intervals() {
            let list = list_of(tile, interval);
            if list.length() == 0 {
                continue;
            }
            self.pixels(tile, interval, &mut places);
            let slot = self.shown.slot(tile, interval);
            for place in &places {
                lists.push(list);
                shaded.push(Pixel {
                    place: *place,
                    slot,
                    radiance: Vec3::ZERO,
                    evaluated: list.length() as u32,
                    contributing: 0,
                });
            }
        }
        let pixels: Vec<usize> = shaded.iter().map(|pixel| pixel.place).collect();
        let receivers = pixels.iter().zip(&lists).filter_map(|(place, list)| {
            let receiver = self.scenery.receivers[*place].clone()?;
            Some((receiver, *list))
        });
        // The state stays in registers over the lights of a pixel.
        let start = (0, Vec3::ZERO, 0);
        let add = |(mut last, mut sum, mut count): (usize, Vec3, u32),
                   turn: usize,
                   estimate: &stochastic_light_culling::Estimate,
                   reflected: f32| {
            if turn != last {
                (shaded[last].radiance, shaded[last].contributing) = (sum, count);
                (last, sum, count) = (turn, Vec3::ZERO, 0);
            }
            let tint = tints[estimate.light as usize];
            let palette = &self.scenery.palette;
            sum += palette.colored(pixels[turn], estimate, reflected, tint);
            (last, sum, count + 1)
        };
        let (last, sum, count) = estimator.fold_reflected_at_points(batch, receivers, start, add);
        if let Some(pixel) = shaded.get_mut(last) {
            (pixel.radiance, pixel.contributing) = (sum, count);
        }
        shaded
    }
}
