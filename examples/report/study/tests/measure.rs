//! The lists that a setting comes to, and the time they take.

use std::time::Instant;

use common::frame::{Frame, GlossyLight, Subregion};
use stochastic_light_culling::{
    Culler, LightBatch, LightLists, Paper, ProjectedEllipsoid, ProjectedHalfSpace, Tight,
};

use super::count::{Lists, Outcome, outcome};
use super::{Setting, Test};
use crate::baseline::cluster;
use crate::method::Stage;
use crate::statistics::median;

pub fn measure(stage: &Stage, frame: &Frame, lights: &[GlossyLight], setting: Setting) -> Outcome {
    let camera = &stage.subject.camera;
    let tiles = stage
        .subject
        .tiles(&stage.interleave, setting.tile, setting.slicing);
    if setting.test == Test::Raster {
        let (clusters, ns) =
            nanoseconds(stage, || cluster::clusters(frame, camera, &tiles, lights));
        let lists: Vec<Lists> = clusters
            .iter()
            .map(|clusters| Box::new(|tile, slice| clusters.of(tile, slice)) as Lists)
            .collect();
        return outcome(frame, &tiles, lights, &lists, ns);
    }
    let bound = |light: &GlossyLight| {
        let (roulette, xi) = (&frame.roulette, light.xi);
        if setting.is_tight {
            light.vpl.bound_by(Tight, roulette, xi).project(camera)
        } else {
            light.vpl.bound_by(Paper, roulette, xi).project(camera)
        }
    };
    let batches: Vec<LightBatch<ProjectedEllipsoid>> = (0..stage.interleave.subregions())
        .map(|subregion| {
            let count = stage.interleave.lights_in(subregion, lights.len() as u32);
            let indices = (0..count).map(|local| stage.interleave.join_light(subregion, local));
            let mut batch = LightBatch::new();
            batch.extend(indices.filter_map(|i| Some((i, bound(&lights[i as usize])?))));
            batch
        })
        .collect();
    let mut culler = Culler::new();
    if setting.test.is_exact() {
        culler = culler.with_exact_test();
    }
    let half_spaces: Vec<ProjectedHalfSpace> = lights
        .iter()
        .map(|light| light.vpl.half_space().expect("metal has a horizon"))
        .map(|half_space| half_space.project(camera))
        .collect();
    let ((culled, kept), ns) = nanoseconds(stage, || {
        let mut culled = Vec::new();
        let mut kept = Vec::new();
        for (batch, (subregion, i)) in batches.iter().zip(tiles.subregions().iter().zip(0..)) {
            let mut lists = LightLists::new();
            culler
                .cull(batch, &subregion.depths, &mut lists)
                .expect("fewer pairs than a u32 counts");
            if setting.test.has_half_space() {
                kept.push(before_surfaces(stage, (i, subregion), &lists, &half_spaces));
            }
            culled.push(lists);
        }
        (culled, kept)
    });
    let lists: Vec<Lists> = if setting.test.has_half_space() {
        let intervals = |i: usize| tiles.subregions()[i].depths.intervals();
        kept.iter()
            .enumerate()
            .map(|(i, kept): (usize, &Vec<Vec<u32>>)| {
                let (columns, count) = (tiles.subregions()[i].grid.size()[0], intervals(i));
                Box::new(move |[x, y]: [u32; 2], interval: u32| {
                    &*kept[((y * columns + x) * count + interval) as usize]
                }) as Lists
            })
            .collect()
    } else {
        culled
            .iter()
            .map(|lists| Box::new(|tile, interval| lists.of(tile, interval)) as Lists)
            .collect()
    };
    outcome(frame, &tiles, lights, &lists, ns)
}

/// The lists without lights that have their backs to a whole tile.
fn before_surfaces(
    stage: &Stage,
    (i, subregion): (u32, &Subregion),
    lists: &LightLists,
    half_spaces: &[ProjectedHalfSpace],
) -> Vec<Vec<u32>> {
    let mut kept = Vec::new();
    for tile in subregion.grid.tiles() {
        let camera = &stage.subject.camera;
        let rectangle = camera.interleaved_tile(&stage.interleave, i, &subregion.grid, tile);
        for interval in 0..subregion.depths.intervals() {
            let Some(depths) = subregion.interval(tile, interval) else {
                kept.push(Vec::new());
                continue;
            };
            let list = lists.of(tile, interval).iter().copied();
            kept.push(
                list.filter(|light| half_spaces[*light as usize].touches(&rectangle, &depths))
                    .collect(),
            );
        }
    }
    kept
}

/// What `cull` gives, and the nanoseconds of a single core that it takes.
fn nanoseconds<T: Send>(stage: &Stage, mut cull: impl FnMut() -> T + Send) -> (T, f64) {
    let alone = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread can be had");
    alone.install(|| {
        let mut result = cull();
        let times: Vec<f64> = (0..stage.subject.effort.times)
            .map(|_| {
                let start = Instant::now();
                result = cull();
                1e9 * start.elapsed().as_secs_f64()
            })
            .collect();
        (result, median(&times))
    })
}
