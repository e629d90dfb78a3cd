//! (e) Lights that a list holds in vain, against nanoseconds, for each test, tile size and slicing.

use std::time::Instant;

use rayon::prelude::*;
use stochastic_light_culling::{Culler, HalfSpace, LightBatch, LightLists, Stretch, TileTest};

use super::{DELTA, F0, INTERLEAVE, ROUGHNESS, Study, of_frames};
use crate::baseline::cluster;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::frame::{Frame, GlossyLight, Path, Slicing, Subregion, Tiles};
use crate::method::Stage;
use crate::sheet::Sheet;
use crate::statistics::median;
use crate::subject::{Gloss, Subject};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Test {
    Box,
    BoxAndHalfSpace,
    Exact,
    ExactAndHalfSpace,
    /// Of a polyhedron of 20 triangles.
    Raster,
}

impl Test {
    fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::BoxAndHalfSpace => "box, half-space",
            Self::Exact => "exact",
            Self::ExactAndHalfSpace => "exact, half-space",
            Self::Raster => "raster, 20 triangles",
        }
    }

    fn is_exact(self) -> bool {
        matches!(self, Self::Exact | Self::ExactAndHalfSpace)
    }

    fn has_half_space(self) -> bool {
        matches!(self, Self::BoxAndHalfSpace | Self::ExactAndHalfSpace)
    }
}

/// What is tested, and against what.
#[derive(Clone, Copy, Debug)]
struct Setting {
    is_tight: bool,
    test: Test,
    tile: u32,
    slicing: Slicing,
    /// In the figure's legend.
    family: &'static str,
}

fn settings() -> Vec<Setting> {
    let papers = Setting {
        is_tight: false,
        test: Test::Box,
        tile: 16,
        slicing: Slicing::ModifiedHalfZ,
        family: "spheroid: the tests",
    };
    let tight = Setting {
        is_tight: true,
        family: "tight: the tests",
        ..papers
    };
    let tests = [
        Test::Box,
        Test::BoxAndHalfSpace,
        Test::Exact,
        Test::ExactAndHalfSpace,
    ];
    let slicings = [Slicing::Whole, Slicing::HalfZ, Slicing::ModifiedHalfZ]
        .into_iter()
        .chain([1, 2, 4, 8, 16, 32].map(Slicing::Slices));
    let mut settings = Vec::new();
    for base in [papers, tight] {
        settings.extend(tests.map(|test| Setting { test, ..base }));
    }
    let family = "tight, box: tile width";
    settings.extend([32, 16, 8, 4, 2, 1].map(|tile| Setting {
        tile,
        family,
        ..tight
    }));
    let family = "tight, box: depth intervals";
    settings.extend(slicings.map(|slicing| Setting {
        slicing,
        family,
        ..tight
    }));
    let slicing = Slicing::Slices(cluster::SLICES);
    let (test, family) = (Test::Raster, "raster clusters");
    settings.push(Setting {
        test,
        slicing,
        family,
        ..tight
    });
    settings
}

fn name_of(slicing: Slicing) -> String {
    match slicing {
        Slicing::Whole => "one".into(),
        Slicing::HalfZ => "HalfZ".into(),
        Slicing::ModifiedHalfZ => "Modified HalfZ".into(),
        Slicing::Slices(count) => format!("{count} slices"),
    }
}

/// The lights of each depth interval of each tile of a subregion.
type Lists<'a> = Box<dyn Fn([u32; 2], u32) -> &'a [u32] + Sync + 'a>;

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "bound",
        "test",
        "tile",
        "depth_intervals",
        "ns_per_pair",
        "lists_per_light",
        "false_discovery_rate",
        "lights_per_pixel",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let stage = Stage::new(subject, Gloss::new(ROUGHNESS, F0), INTERLEAVE);
        let lights = stage.lights(0);
        let frame = stage.frame(DELTA);
        let mut series: Vec<Series> = Vec::new();
        for setting in settings() {
            let Outcome {
                ns,
                listed,
                needed,
                at_pixels,
            } = measure(&stage, &frame, &lights, setting);
            let in_vain = 1.0 - needed as f64 / listed.max(1) as f64;
            let surfaces = subject
                .surfaces
                .surfaces
                .iter()
                .filter(|surface| !surface.is_sky());
            sheet.push([
                subject.name.into(),
                if setting.is_tight {
                    "tight"
                } else {
                    "spheroid"
                }
                .into(),
                setting.test.name().into(),
                setting.tile.into(),
                name_of(setting.slicing).into(),
                ns.into(),
                (listed as f64 / lights.len() as f64).into(),
                in_vain.into(),
                (at_pixels as f64 / surfaces.count().max(1) as f64).into(),
            ]);
            let label = match setting.family {
                "tight, box: tile width" => setting.tile.to_string(),
                "tight, box: depth intervals" => name_of(setting.slicing).replace(" slices", ""),
                _ => setting.test.name().into(),
            };
            let point = Point::new(ns, 100.0 * in_vain).labelled(label);
            match series.last_mut() {
                Some(series) if series.name == setting.family => series.points.push(point),
                _ => series.push(Series {
                    name: setting.family.into(),
                    look: Look {
                        color: series.len(),
                        line: Line::None,
                    },
                    points: vec![point],
                }),
            }
        }
        done();
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("ns per light, tile and depth interval"),
            y: Axis::linear("of the lights in a list, in vain (%)"),
            series,
        });
    }
    Study {
        name: "tests",
        caption: "A light is in a list in vain if no pixel of the tile's depth interval accepts it. Down and \
                  to the left is better; pairs that blocks of tiles decide together share the time.",
        sheet,
        figure: Figure {
            title: "Lights listed in vain, against the time of a test".into(),
            subtitle: of_frames(
                subjects,
                &format!(
                    "δ = {DELTA}, glossy lights alone, interleaved {INTERLEAVE}×{INTERLEAVE}, one core"
                ),
            ),
            panels,
        },
    }
}

struct Outcome {
    /// For each light and depth interval.
    ns: f64,
    /// Lights in all lists, and those of them that some pixel accepts.
    listed: usize,
    needed: usize,
    /// Lights in the lists of all pixels.
    at_pixels: usize,
}

fn measure(stage: &Stage, frame: &Frame, lights: &[GlossyLight], setting: Setting) -> Outcome {
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
            Stretch::new(&light.vpl.tight_bound(roulette, xi), camera)
        } else {
            Stretch::new(&light.vpl.bound(roulette, xi).into(), camera)
        }
    };
    let batches: Vec<LightBatch<Stretch>> = (0..stage.interleave.subregions())
        .map(|subregion| {
            let count = stage.interleave.lights_in(subregion, lights.len() as u32);
            let numbers = (0..count).map(|local| stage.interleave.join_light(subregion, local));
            let mut batch = LightBatch::new();
            batch.extend(
                numbers.filter_map(|number| Some((number, bound(&lights[number as usize])?))),
            );
            batch
        })
        .collect();
    let mut culler = Culler::new();
    if setting.test.is_exact() {
        culler = culler.with_exact_test();
    }
    let half_spaces: Vec<HalfSpace> = lights
        .iter()
        .map(|light| HalfSpace::new(light.vpl.position(), light.normal, camera))
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
    (number, subregion): (u32, &Subregion),
    lists: &LightLists,
    half_spaces: &[HalfSpace],
) -> Vec<Vec<u32>> {
    let mut kept = Vec::new();
    for tile in subregion.grid.tiles() {
        let pixels = stage
            .interleave
            .join_pixels(number, subregion.grid.pixels(tile));
        let rectangle = stage
            .subject
            .camera
            .tile_rectangle(stage.subject.effort.size, pixels);
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

fn outcome(
    frame: &Frame,
    tiles: &Tiles,
    lights: &[GlossyLight],
    lists: &[Lists],
    ns: f64,
) -> Outcome {
    let totals: Vec<[usize; 4]> = tiles
        .subregions()
        .par_iter()
        .zip(lists)
        .enumerate()
        .map(|(i, (subregion, lists))| {
            let i = i as u32;
            let of_subregion = frame.interleave.lights_in(i, lights.len() as u32) as usize;
            totals(frame, (i, subregion), lights, lists, of_subregion)
        })
        .collect();
    let [pairs, listed, needed, at_pixels]: [usize; 4] =
        std::array::from_fn(|i| totals.iter().map(|totals| totals[i]).sum());
    Outcome {
        ns: ns / pairs.max(1) as f64,
        listed,
        needed,
        at_pixels,
    }
}

/// Pairs of a light and a depth interval with surfaces, those listed, those needed, and the sum over all
/// pixels of the lights in their lists.
fn totals(
    frame: &Frame,
    (number, subregion): (u32, &Subregion),
    lights: &[GlossyLight],
    lists: &Lists,
    of_subregion: usize,
) -> [usize; 4] {
    let mut totals = [0; 4];
    for tile in subregion.grid.tiles() {
        let mut surfaces = vec![Vec::new(); subregion.depths.intervals() as usize];
        for pixel in subregion.grid.pixels(tile).pixels() {
            let surface = frame
                .surfaces
                .at(frame.interleave.join_pixel(number, pixel));
            if let Some(interval) = subregion.depths.interval_of(tile, surface.depth) {
                surfaces[interval as usize].push(surface);
            }
        }
        for (surfaces, interval) in surfaces.iter().zip(0..) {
            if surfaces.is_empty() {
                continue;
            }
            let list = lists(tile, interval);
            let accepts = |light: &GlossyLight| {
                surfaces.iter().any(|surface| {
                    let path = Path::new(light, surface, frame.least_distance_squared);
                    frame
                        .roulette
                        .estimate(path.intensity, path.distance_squared, light.xi)
                        > 0.0
                })
            };
            let needed = list
                .iter()
                .filter(|light| accepts(&lights[**light as usize]))
                .count();
            totals[0] += of_subregion;
            totals[1] += list.len();
            totals[2] += needed;
            totals[3] += list.len() * surfaces.len();
        }
    }
    totals
}
