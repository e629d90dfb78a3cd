//! Lists of lights for tiles, by what is known of their receivers and by who decides.

use rayon::prelude::*;
use stochastic_light_culling::{
    BatchBuilder, Blind, Culler, Error, GgxLobe, LightBatch, LightLists, LobeFamily,
    PixelRectangle, ProjectedEllipsoid, RadianceEstimator, ReceiverCluster, ReceiverCuller,
    Roulette, Schlick, ShadingBatch, Tight, TileProbability, TileReceivers, WeightedLists,
    glam::Vec3,
};

use super::shade::{Lights, shade};
use super::{Division, Palette, Receiving, Reflected, Scenery, Shown};
use crate::frame::{GlossyLight, Subregion, Tiles, timed};

/// What the probability of a light depends on, besides its radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Nothing: δ is arriving radiance.
    Nothing,
    /// What receivers reflect: δ is radiance at the eye.
    Receivers,
}

/// Who decides whether a light counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decided {
    /// Each pixel, by its own radiance.
    ByPixel,
    /// The tile, for all of its pixels.
    ByTile(TileProbability),
}

/// A way to draw lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roulettes {
    pub known: Known,
    pub decided: Decided,
}

/// The lights of a subregion.
struct Own {
    batch: ShadingBatch<GgxLobe<Schlick>>,
    tints: Vec<Vec3>,
}

/// Cullers of a subregion, with the lists that they fill.
struct Listing {
    bounds: Culler<ProjectedEllipsoid>,
    receivers: ReceiverCuller,
    lists: LightLists,
    weighted: WeightedLists,
}

pub(super) fn light<R: Receiving, P: Palette>(
    scenery: &Scenery<R, P>,
    roulettes: Roulettes,
    division: Division,
) -> Result<Reflected, Error> {
    let frame = scenery.frame;
    let subregions = division.tiles.subregions();
    let (own, lights_ms) = timed(|| {
        (0..frame.interleave.subregions())
            .into_par_iter()
            .map(|subregion| own_lights(scenery, subregion))
            .collect::<Vec<Own>>()
    });
    let listing = || -> Result<Listing, Error> {
        let receivers = ReceiverCuller::new(&frame.roulette);
        Ok(Listing {
            bounds: Culler::new(),
            receivers: receivers.with_least_distance_squared(frame.least_distance_squared)?,
            lists: LightLists::new(),
            weighted: WeightedLists::new(),
        })
    };
    let mut listings = (subregions.iter())
        .map(|_| listing())
        .collect::<Result<Vec<_>, _>>()?;

    let mut image = Reflected::black(scenery.receivers.len(), division.tiles);
    // Each step is taken twice: the first time makes room, and the second is like a later frame.
    let (build_ms, cull_ms) = match (roulettes.known, roulettes.decided) {
        (Known::Nothing, Decided::ByPixel) => {
            let (batches, ms) = timed(|| {
                (0..frame.interleave.subregions())
                    .into_par_iter()
                    .map(|subregion| bounds(scenery, subregion))
                    .collect::<Vec<_>>()
            });
            let mut cull = || {
                let listings = listings.par_iter_mut().zip(subregions).zip(&batches);
                listings.try_for_each(|((listing, subregion), batch)| {
                    let Listing { bounds, lists, .. } = listing;
                    bounds.cull(batch, &subregion.depths, lists).map(drop)
                })
            };
            cull()?;
            let (culled, cull_ms) = timed(cull);
            culled?;
            (ms, cull_ms)
        }
        (Known::Nothing, _) => {
            let family = |_: &R| Blind;
            list(
                scenery,
                roulettes.decided,
                division,
                &own,
                &mut listings,
                family,
                &mut image.shown,
            )?
        }
        (Known::Receivers, _) => list(
            scenery,
            roulettes.decided,
            division,
            &own,
            &mut listings,
            R::family,
            &mut image.shown,
        )?,
    };

    let tiles = division.tiles;
    image.shade_ms = shade_by(scenery, roulettes, tiles, &own, &listings, &mut image)?;
    image.build_ms = lights_ms + build_ms;
    image.cull_ms = cull_ms;
    Ok(image)
}

/// Shades `image` by the lists, and gives the milliseconds that it takes.
fn shade_by<R: Receiving, P: Palette>(
    scenery: &Scenery<R, P>,
    roulettes: Roulettes,
    tiles: &Tiles,
    own: &[Own],
    listings: &[Listing],
    image: &mut Reflected,
) -> Result<f64, Error> {
    let (roulette, least) = (
        &scenery.frame.roulette,
        scenery.frame.least_distance_squared,
    );
    let lights: Vec<Lights> = own.iter().map(|own| (&own.batch, &*own.tints)).collect();
    let list_of = |i: usize, tile, interval| listings[i].lists.of(tile, interval);
    let weighted_of = |i: usize, tile, interval| listings[i].weighted.of(tile, interval);
    let ((), ms) = match (roulettes.known, roulettes.decided) {
        (Known::Nothing, Decided::ByPixel) => {
            let estimator = RadianceEstimator::new(roulette).with_least_distance_squared(least)?;
            timed(|| shade(scenery, tiles, &lights, &estimator, list_of, image))
        }
        (Known::Receivers, Decided::ByPixel) => {
            let estimator =
                RadianceEstimator::aware(roulette).with_least_distance_squared(least)?;
            timed(|| shade(scenery, tiles, &lights, &estimator, list_of, image))
        }
        (_, Decided::ByTile(_)) => {
            let estimator = RadianceEstimator::listed().with_least_distance_squared(least)?;
            timed(|| shade(scenery, tiles, &lights, &estimator, weighted_of, image))
        }
    };
    Ok(ms)
}

/// For each subregion and each tile, the lights that a receiver may accept by what it reflects; a light has the index of
/// its turn in the subregion.
pub(super) fn lights_to_accept<R: Receiving, P: Palette>(
    scenery: &Scenery<R, P>,
    division: Division,
) -> Result<Vec<LightLists>, Error> {
    let (frame, layout) = (scenery.frame, Shown::nothing(division.tiles));
    let subregions = division.tiles.subregions().par_iter().enumerate();
    let lists = subregions.map(|(i, subregion)| {
        let own = own_lights(scenery, i as u32);
        let intervals = subregion.depths.intervals();
        let mut tiles = TileReceivers::new(&subregion.grid, division.parts, intervals)?;
        fill(
            scenery,
            (i as u32, subregion),
            &mut tiles,
            R::family,
            (&layout, None),
        );
        let mut lists = LightLists::new();
        ReceiverCuller::new(&frame.roulette)
            .with_least_distance_squared(frame.least_distance_squared)?
            .cull(&own.batch, &tiles, &mut lists)?;
        Ok(lists)
    });
    lists.collect()
}

/// The lists by the receivers of tiles, of which `family` tells what is known; the milliseconds to collect these, and to
/// cull.
fn list<R: Receiving, P: Palette, F: LobeFamily>(
    scenery: &Scenery<R, P>,
    decided: Decided,
    division: Division,
    own: &[Own],
    listings: &mut [Listing],
    family: impl Fn(&R) -> F + Sync,
    shown: &mut Shown,
) -> Result<(f64, f64), Error> {
    let subregions = division.tiles.subregions();
    let empty = |subregion: &Subregion| {
        TileReceivers::new(
            &subregion.grid,
            division.parts,
            subregion.depths.intervals(),
        )
    };
    let mut tiles = subregions
        .iter()
        .map(empty)
        .collect::<Result<Vec<_>, _>>()?;
    let ((), build_ms) = timed(|| {
        let scales = scenery.before.map(Shown::delta_scales);
        let tiles = tiles.par_iter_mut().zip(subregions).enumerate();
        let layout = &*shown;
        let counts = tiles.map(|(i, (tiles, subregion))| {
            let place = (i as u32, subregion);
            fill(scenery, place, tiles, &family, (layout, scales.as_deref()))
        });
        let counts: Vec<Vec<u32>> = counts.collect();
        for counts in counts {
            for (slot, count) in counts.into_iter().enumerate() {
                shown.add(slot, 0.0, count.into());
            }
        }
    });
    let mut cull = || {
        let listings = listings.par_iter_mut().zip(&tiles).zip(own);
        listings.try_for_each(|((listing, tiles), own)| {
            let Listing {
                receivers,
                lists,
                weighted,
                ..
            } = listing;
            match decided {
                Decided::ByPixel => receivers.cull(&own.batch, tiles, lists),
                Decided::ByTile(probability) => {
                    receivers.draw(probability, &own.batch, tiles, weighted)
                }
            }
        })
    };
    cull()?;
    let (culled, cull_ms) = timed(cull);
    culled?;
    Ok((build_ms, cull_ms))
}

/// Collects the receivers of the tiles of a subregion, with a δ for each depth interval of each tile, if there are `scales`.
/// Returns how many there are in each slot.
fn fill<R: Receiving, P: Palette, F: LobeFamily>(
    scenery: &Scenery<R, P>,
    (index, subregion): (u32, &Subregion),
    tiles: &mut TileReceivers<F>,
    family: impl Fn(&R) -> F,
    (layout, scales): (&Shown, Option<&[f32]>),
) -> Vec<u32> {
    let mut counts = vec![0; layout.slots()];
    let (frame, parts) = (scenery.frame, tiles.parts_grid());
    let parts_in_tile = subregion.grid.tile_size() / parts.tile_size();
    let width = parts.image_size()[0];
    let receiver = |local| {
        let pixel = frame.interleave.join_pixel(index, local);
        let depth = frame.surfaces.at(pixel).depth;
        let interval = subregion
            .depths
            .interval_of(subregion.grid.tile_of(local), depth)?;
        let receiver = scenery.receivers[frame.surfaces.index(pixel)].as_ref()?;
        Some((interval, receiver.position, family(&receiver.lobe)))
    };
    // Those of one row of parts at a time, since the pixels of a subregion are far apart in the image.
    let (mut receivers, mut collected) = (Vec::new(), None);
    tiles.fill(|part, interval| {
        let row = PixelRectangle {
            max: [width, parts.pixels(part).max[1]],
            ..parts.pixels([0, part[1]])
        };
        if collected.replace(part[1]) != Some(part[1]) {
            receivers.clear();
            row.pixels().for_each(
                #[inline(always)]
                |local| receivers.push(receiver(local)),
            );
        }
        let pixels = parts.pixels(part).pixels();
        let cluster = ReceiverCluster::of(pixels.filter_map(
            #[inline(always)]
            |[x, y]| {
                let (own, position, family) =
                    receivers[((y - row.min[1]) * width + x) as usize].as_ref()?;
                (*own == interval).then_some((*position, *family))
            },
        ))?;
        let slot = layout.slot(part.map(|n| n / parts_in_tile), interval);
        counts[slot] += cluster.len();
        match scales {
            Some(scales) => cluster.with_delta_scale(scales[slot]).ok(),
            None => Some(cluster),
        }
    });
    counts
}

fn own_lights<R, P>(scenery: &Scenery<R, P>, subregion: u32) -> Own {
    let own = || of_subregion(scenery, subregion);
    let mut batch = ShadingBatch::new();
    batch.extend(own().map(|light| (&light.vpl, light.xi)));
    Own {
        batch,
        tints: own().map(|light| light.tint).collect(),
    }
}

/// The bounds of the lights of a subregion, by their places in it.
fn bounds<R, P>(scenery: &Scenery<R, P>, subregion: u32) -> LightBatch<ProjectedEllipsoid> {
    let (roulette, camera): (&Roulette, _) = (&scenery.frame.roulette, scenery.camera);
    let mut batch = LightBatch::new();
    let lights = (0..).zip(of_subregion(scenery, subregion));
    let lights = lights.map(|(i, light)| (i, &light.vpl, light.xi));
    BatchBuilder::new(roulette, camera).add_by(Tight, lights, &mut batch);
    batch
}

fn of_subregion<'a, R, P>(
    scenery: &'a Scenery<R, P>,
    subregion: u32,
) -> impl Iterator<Item = &'a GlossyLight> {
    let interleave = &scenery.frame.interleave;
    let count = interleave.lights_in(subregion, scenery.lights.len() as u32);
    let indices = (0..count).map(move |local| interleave.join_light(subregion, local));
    indices.map(|i| &scenery.lights[i as usize])
}
