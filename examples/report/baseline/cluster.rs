//! Clustered shading with lights found by conservative rasterisation: the polyhedron around a light's
//! range is drawn into tiles, and into those of 32 slices of depth that it reaches there
//! [Örtegren & Persson 2016].

use common::frame::{Frame, GlossyLight, Shaded, Subregion, Tiles, shade};
use rayon::prelude::*;
use stochastic_light_culling::{Camera, DepthInterval, Proxy, Tight};

use super::{Polyhedron, Raster, Span};

/// How many slices of depth all tiles share.
pub const SLICES: u32 = 32;

/// The lights of each slice of each tile, row by row.
pub struct Clusters {
    columns: usize,
    slices: usize,
    lists: Vec<Vec<u32>>,
}

impl Clusters {
    pub fn of(&self, [x, y]: [u32; 2], slice: u32) -> &[u32] {
        let tile = y as usize * self.columns + x as usize;
        &self.lists[tile * self.slices + slice as usize]
    }
}

/// The frame with the lights of each pixel's cluster.
pub fn light(frame: &Frame, camera: &Camera, tiles: &Tiles, lights: &[GlossyLight]) -> Shaded {
    let clusters = clusters(frame, camera, tiles, lights);
    let list_of = |pixel, depth| {
        let place = tiles.place_of(pixel, depth)?;
        Some(clusters[place.subregion].of(place.tile, place.interval))
    };
    shade(frame, true, lights, list_of, || ())
}

/// The clusters of each subregion, whose `tiles` must be cut into [`SLICES`].
pub fn clusters(
    frame: &Frame,
    camera: &Camera,
    tiles: &Tiles,
    lights: &[GlossyLight],
) -> Vec<Clusters> {
    let depths = frame.surfaces.surfaces.iter().map(|surface| surface.depth);
    let slices: Vec<DepthInterval> = DepthInterval::around(depths)
        .map_or_else(Vec::new, |whole| whole.exponential_slices(SLICES).collect());
    let of_subregion = |(subregion, tiles): (usize, &Subregion)| {
        clusters_of(frame, camera, (subregion as u32, tiles), &slices, lights)
    };
    tiles
        .subregions()
        .par_iter()
        .enumerate()
        .map(|(i, tiles)| of_subregion((i, tiles)))
        .collect()
}

fn clusters_of(
    frame: &Frame,
    camera: &Camera,
    (subregion, tiles): (u32, &Subregion),
    slices: &[DepthInterval],
    lights: &[GlossyLight],
) -> Clusters {
    let interleave = &frame.interleave;
    let [columns, rows] = tiles.grid.size();
    let rectangle = |tile| camera.interleaved_tile(interleave, subregion, &tiles.grid, tile);
    let spans = |axis: usize, tile: [u32; 2]| -> Span {
        let rectangle = rectangle(tile);
        [rectangle.min()[axis], rectangle.max()[axis]]
    };
    let mut raster = Raster::new(
        (0..columns).map(|x| spans(0, [x, 0])).collect(),
        (0..rows).map(|y| spans(1, [0, y])).collect(),
    );
    let mut lists = vec![Vec::new(); (columns * rows) as usize * slices.len()];
    for local in 0..interleave.lights_in(subregion, lights.len() as u32) {
        let index = interleave.join_light(subregion, local);
        let light = &lights[index as usize];
        let ellipsoid = light.vpl.bound_by(Tight, &frame.roulette, light.xi);
        let Some(polyhedron) = Polyhedron::around(&ellipsoid, Proxy::Icosahedron, camera) else {
            continue;
        };
        raster.draw(&polyhedron, |x, y, [near, far]| {
            let tile = &mut lists[(y * columns as usize + x) * slices.len()..][..slices.len()];
            let first = slices.partition_point(|slice| slice.far() < near);
            let end = slices.partition_point(|slice| slice.near() <= far);
            for list in &mut tile[first.min(end)..end] {
                list.push(index);
            }
        });
    }
    Clusters {
        columns: columns as usize,
        slices: slices.len(),
        lists,
    }
}
