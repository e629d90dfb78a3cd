//! Lights whose lobes must be evaluated where about five are accepted, and whether a list lacks one that a pixel accepts.

use common::frame::Frame;
use common::reflect::{Division, Receiving, Scenery, White};
use common::sampling::Profiled;
use rayon::prelude::*;
use stochastic_light_culling::{
    Estimate, LightLists, RadianceEstimator, Receiver, Roulette, ShadingBatch,
};

use super::super::{F0, ROUGHNESS, Study};
use super::material::{Material, Visitor};
use super::way::Stage;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::{Gloss, Subject};

/// How many lights a pixel accepts in the mean.
const ACCEPTED: f64 = 5.0;
/// Sizes of tiles in pixels, and in how many parts they are divided in each direction.
const DIVISIONS: [[u32; 2]; 7] = [[16, 1], [16, 4], [8, 1], [8, 2], [4, 1], [4, 2], [1, 1]];

/// What is counted of receivers.
struct Counts {
    delta: f32,
    accepted: f64,
    /// Pairs of a pixel and a light.
    pairs: f64,
    /// For each of [`DIVISIONS`], the mean length of a pixel's list, and how many accepted pairs lists lack.
    lists: Vec<(f64, u64)>,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "receiver",
        "tile",
        "parts",
        "delta",
        "lights_per_pixel",
        "accepted_per_pixel",
        "pairs",
        "missing",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let whole = subject.interleave(1);
        let (gloss, vpls) = (Gloss::new(ROUGHNESS, F0), subject.effort.vpls);
        let lights = subject
            .lights(gloss, vpls, &whole, subject.seed_of(0))
            .glossy;
        let stage = Stage::new(subject, whole, lights);
        let mut series = DIVISIONS.map(|[tile, parts]| Series {
            name: if parts > 1 {
                format!("{tile}×{tile}, {parts}×{parts} parts")
            } else {
                format!("{tile}×{tile}")
            },
            look: Look {
                color: tile.ilog2() as usize,
                line: if parts > 1 { Line::Dashed } else { Line::Solid },
            },
            points: Vec::new(),
        });
        for material in Material::ALL {
            let counts = material.visit(subject, Counting { stage: &stage });
            for (i, [tile, parts]) in DIVISIONS.into_iter().enumerate() {
                let (length, missing) = counts.lists[i];
                sheet.push([
                    subject.name.into(),
                    material.name().into(),
                    tile.into(),
                    parts.into(),
                    counts.delta.into(),
                    length.into(),
                    counts.accepted.into(),
                    counts.pairs.into(),
                    (missing as f64).into(),
                ]);
                if let Some(at) = material.place() {
                    series[i].points.push(Point::new(at, length));
                }
            }
        }
        done();
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("roughness of the receiver (Lambert at 1)"),
            y: Axis::log("lights in a pixel's list"),
            series: series.into(),
        });
    }
    let effort = &subjects[0].effort;
    let [width, height] = effort.size;
    Study {
        name: "receivers_lists",
        caption: "Lights that lists by receivers leave to evaluate, for tiles with and without parts, where a pixel accepts \
                  five in the mean. Each pair of a pixel and a light is decided by brute force as well: the CSV has the \
                  number of accepted ones that a list lacks, which must be zero.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Lists by what receivers reflect".into(),
            subtitle: format!(
                "{width}×{height}, {} rays, lights α = {ROUGHNESS}; not interleaved",
                effort.vpls
            ),
            panels,
        },
    }
}

struct Counting<'a> {
    stage: &'a Stage<'a>,
}

impl Visitor for Counting<'_> {
    type Output = Counts;

    fn visit<R: Receiving + Profiled>(self, receivers: &[Option<Receiver<R>>]) -> Counts {
        let stage = self.stage;
        let delta = delta_for(stage, receivers);
        let frame = stage.frame(delta);
        let scenery = Scenery {
            frame: &frame,
            camera: &stage.subject.camera,
            lights: &stage.lights,
            receivers,
            palette: White,
            before: None,
        };
        let lists = DIVISIONS.map(|[tile, parts]| {
            let tiles = stage.tiles(tile);
            let lists = scenery.lights_to_accept(Division { tiles, parts });
            lists.expect("fewer pairs than a u32 counts").remove(0)
        });
        let pixels: Vec<usize> = (0..receivers.len())
            .filter(|i| receivers[*i].is_some())
            .collect();
        let of_pixels: Vec<(usize, Vec<(usize, u64)>)> = {
            let brute = Brute::new(&frame, stage);
            let at = |pixel: &usize| brute.compare(stage, *pixel, receivers, &lists);
            pixels.par_iter().map(at).collect()
        };
        let count = pixels.len().max(1) as f64;
        let total = |i: usize| {
            of_pixels
                .iter()
                .fold((0.0, 0), |(length, missing), (_, lists)| {
                    (length + lists[i].0 as f64, missing + lists[i].1)
                })
        };
        Counts {
            delta,
            accepted: of_pixels
                .iter()
                .map(|(accepted, _)| *accepted as f64)
                .sum::<f64>()
                / count,
            pairs: count * stage.lights.len() as f64,
            lists: (0..DIVISIONS.len())
                .map(|i| {
                    let (length, missing) = total(i);
                    (length / count, missing)
                })
                .collect(),
        }
    }
}

/// All lights at once, each decided at each pixel.
struct Brute {
    estimator: RadianceEstimator<stochastic_light_culling::AtReceiver>,
    batch: ShadingBatch<stochastic_light_culling::GgxLobe<stochastic_light_culling::Schlick>>,
    all: Vec<u32>,
}

impl Brute {
    fn new(frame: &Frame, stage: &Stage) -> Self {
        let mut batch = ShadingBatch::new();
        batch.extend(stage.lights.iter().map(|light| (&light.vpl, light.xi)));
        let estimator = RadianceEstimator::aware(&frame.roulette);
        Self {
            estimator: estimator
                .with_least_distance_squared(frame.least_distance_squared)
                .expect("a squared distance"),
            batch,
            all: (0..stage.lights.len() as u32).collect(),
        }
    }

    /// How many lights a pixel accepts; for each of `lists`, how many its own has, and how many accepted ones it lacks.
    fn compare<R: Receiving>(
        &self,
        stage: &Stage,
        pixel: usize,
        receivers: &[Option<Receiver<R>>],
        lists: &[LightLists],
    ) -> (usize, Vec<(usize, u64)>) {
        let receiver = receivers[pixel].clone().into_iter();
        let all = receiver.map(|receiver| (receiver, &*self.all));
        let mut accepted = Vec::new();
        self.estimator.fold_reflected_at_points(
            &self.batch,
            all,
            (),
            |(), _, estimate: &Estimate, _| {
                accepted.push(estimate.light);
            },
        );
        let surfaces = &stage.subject.surfaces;
        let width = surfaces.image_size[0] as usize;
        let local = [pixel % width, pixel / width].map(|n| n as u32);
        let of_lists = lists.iter().zip(DIVISIONS).map(|(lists, [tile, _])| {
            let depth = surfaces.surfaces[pixel].depth;
            let place = stage.tiles(tile).place_of((0, local), depth);
            let list = place.map_or(&[][..], |place| lists.of(place.tile, place.interval));
            let lacks = |light: &&u32| list.binary_search(light).is_err();
            (list.len(), accepted.iter().filter(lacks).count() as u64)
        });
        (accepted.len(), of_lists.collect())
    }
}

/// The δ for which some pixels accept [`ACCEPTED`] lights in the mean over ξ.
fn delta_for<R: Receiving>(stage: &Stage, receivers: &[Option<Receiver<R>>]) -> f32 {
    // For a small δ all are accepted, and reflect what they do.
    let frame = Frame {
        roulette: Roulette::new(1e-30).expect("in range"),
        ..stage.frame(1.0)
    };
    let brute = Brute::new(&frame, stage);
    let pixels = stage.compared(receivers);
    let step = pixels.len().div_ceil(1000).max(1);
    let reflected = |pixel: &usize| {
        let receiver = receivers[*pixel].clone().into_iter();
        let all = receiver.map(|receiver| (receiver, &*brute.all));
        let mut reflected = Vec::new();
        let add = |(), _, _: &Estimate, value: f32| reflected.push(f64::from(value));
        (brute.estimator).fold_reflected_at_points(&brute.batch, all, (), add);
        reflected
    };
    let pixels: Vec<Vec<f64>> = pixels.par_iter().step_by(step).map(reflected).collect();
    let accepted = |delta: f64| {
        let probability = |reflected: &f64| (reflected / delta).min(1.0);
        let sum: f64 = pixels.par_iter().flatten_iter().map(probability).sum();
        sum / pixels.len().max(1) as f64
    };
    let (mut low, mut high) = (1e-12_f64, 1e6_f64);
    for _ in 0..60 {
        let middle = (low * high).sqrt();
        if accepted(middle) > ACCEPTED {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low * high).sqrt() as f32
}
