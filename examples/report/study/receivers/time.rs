//! Error against time for receivers of all materials, by each way to light them.

use common::frame::redraw;
use common::reflect::{Receiving, Shown};
use common::sampling::Profiled;
use rayon::prelude::*;
use stochastic_light_culling::{
    RadianceEstimator, Receiver, Roulette, Seed, ShadingBatch, glam::Vec3,
};

use super::super::{F0, INTERLEAVE, ROUGHNESS, Study};
use super::curve::{Curve, Step};
use super::even;
use super::gain;
use super::material::{Material, Visitor};
use super::score::{Errors, Expected, Measures};
use super::way::{Picture, Setting, Stage, Way};
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::sheet::{Cell, Sheet};
use crate::statistics::Mean;
use crate::subject::{Gloss, Subject};

/// A curve ends with the first picture that takes longer.
const SLOWEST_MS: f64 = 300.0;
/// How long pictures of one setting may take together, if there are a few.
const ENOUGH_MS: f64 = 500.0;
/// How many pictures a way draws in advance that has δ from those before.
const PICTURES_BEFORE: u32 = 4;

/// All ways to light receivers of a material.
pub struct Measured<'a> {
    pub subject: &'a Subject<'a>,
    pub material: Material,
    pub curves: Vec<Curve>,
    /// To evaluate all lights of each pixel, which is exact.
    all_lights_ms: f64,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> [Study; 3] {
    let subjects: Vec<Subject> = subjects.iter().map(Subject::as_in_paper).collect();
    let mut all = Vec::new();
    for subject in &subjects {
        let lights = |width| {
            let interleave = subject.interleave(width);
            let gloss = Gloss::new(ROUGHNESS, F0);
            let lights =
                subject.lights(gloss, subject.effort.vpls, &interleave, subject.seed_of(0));
            Stage::new(subject, interleave, lights.glossy)
        };
        let stages = [lights(INTERLEAVE), lights(1)];
        for material in Material::ALL {
            let measuring = Measuring {
                subject,
                stages: &stages,
            };
            let (curves, all_lights_ms) = material.visit(subject, measuring);
            all.push(Measured {
                subject,
                material,
                curves,
                all_lights_ms,
            });
            done();
        }
    }
    [
        against_time(&subjects, &all),
        gain::in_equal_time(&subjects, &all),
        even::against_time(&subjects, &all),
    ]
}

/// What is measured of receivers.
struct Measuring<'a> {
    subject: &'a Subject<'a>,
    /// With interleaving, and without.
    stages: &'a [Stage<'a>; 2],
}

impl Visitor for Measuring<'_> {
    type Output = (Vec<Curve>, f64);

    fn visit<R: Receiving + Profiled>(self, receivers: &[Option<Receiver<R>>]) -> Self::Output {
        let expected = self
            .stages
            .each_ref()
            .map(|stage| expected(stage, receivers));
        let curve = |way: Way| {
            let which = usize::from(!way.is_interleaved());
            let (stage, expected) = (&self.stages[which], &expected[which]);
            let settings = way.settings(expected.mean(), self.subject.effort.is_quick);
            let mut steps: Vec<Step> = Vec::new();
            for setting in settings {
                // Nobody asks what is finer still.
                if steps.last().is_none_or(|step| step.ms < SLOWEST_MS) {
                    steps.push(self.step((stage, expected), (way, setting), receivers));
                }
            }
            Curve { way, steps }
        };
        let curves: Vec<Curve> = Way::all().into_iter().map(curve).collect();
        // The least δ lists and accepts all lights.
        let all = Setting::Delta(1e-30);
        let lights = &self.stages[0].lights;
        let times = (0..self.subject.effort.times).map(|_| {
            let stage = &self.stages[0];
            stage
                .light((Way::ALL_LIGHTS, all), receivers, lights, Seed(0), None)
                .ms
        });
        (curves, times.fold(f64::INFINITY, f64::min))
    }
}

impl Measuring<'_> {
    fn step<R: Receiving + Profiled>(
        &self,
        (stage, expected): (&Stage, &Expected),
        (way, setting): (Way, Setting),
        receivers: &[Option<Receiver<R>>],
    ) -> Step {
        let mut errors = Errors::new(expected);
        let mut times: Vec<f64> = Vec::new();
        let most = self.subject.effort.seeds.div_ceil(4).max(3);
        let is_even = way.is_even();
        let in_advance = if is_even { PICTURES_BEFORE } else { 0 };
        // Of another seed each. The first has one δ.
        let mut before: Option<Shown> = None;
        for repetition in 0..in_advance + most {
            // Of slow ways there are fewer pictures, and wider intervals.
            let is_enough = times.len() >= 4 && times.iter().sum::<f64>() > ENOUGH_MS;
            if is_enough {
                break;
            }
            let seed = Seed(self.subject.seed_of(repetition));
            let mut lights = stage.lights.clone();
            redraw(&mut lights, &stage.interleave, seed, 0);
            let Picture {
                radiance,
                ms,
                shown,
            } = stage.light((way, setting), receivers, &lights, seed, before.as_ref());
            if repetition >= in_advance {
                errors.add(&radiance);
                times.push(ms);
            }
            match (&mut before, shown) {
                (Some(before), Some(shown)) => before.add_all(&shown),
                (_, shown) => before = shown.filter(|_| is_even),
            }
        }
        Step {
            setting,
            // What else runs only adds to it.
            ms: times.into_iter().fold(f64::INFINITY, f64::min),
            measures: errors.measures(),
        }
    }
}

/// What some pixels reflect of all lights of their subregion.
fn expected<R: Receiving + Profiled>(stage: &Stage, receivers: &[Option<Receiver<R>>]) -> Expected {
    let frame = stage.frame(1.0);
    let lights = &stage.lights;
    let mut batch = ShadingBatch::new();
    batch.extend(lights.iter().map(|light| (&light.vpl, light.xi)));
    // So small that all lights are accepted.
    let roulette = Roulette::new(1e-30).expect("in range");
    let estimator = RadianceEstimator::new(&roulette)
        .with_least_distance_squared(frame.least_distance_squared)
        .expect("a squared distance");
    let of_subregion = |subregion| -> Vec<u32> {
        let count = frame.interleave.lights_in(subregion, lights.len() as u32);
        let indices = (0..count).map(|local| frame.interleave.join_light(subregion, local));
        indices.collect()
    };
    let lists: Vec<Vec<u32>> = (0..frame.interleave.subregions())
        .map(of_subregion)
        .collect();
    let pixels = stage.compared(receivers);
    let width = frame.surfaces.image_size[0];
    let radiance = |pixel: &usize| {
        let place = *pixel as u32;
        let (subregion, _) = frame.interleave.split_pixel([place % width, place / width]);
        let list = &*lists[subregion as usize];
        let receiver = receivers[*pixel].clone().into_iter();
        let add = |sum: Vec3, _, estimate: &stochastic_light_culling::Estimate, reflected: f32| {
            sum + reflected * lights[estimate.light as usize].tint
        };
        let receiver = receiver.map(|receiver| (receiver, list));
        estimator.fold_reflected_at_points(&batch, receiver, Vec3::ZERO, add)
    };
    Expected {
        radiance: pixels.par_iter().map(radiance).collect(),
        pixels,
    }
}

/// What a figure of receivers says of itself.
pub fn of_receivers(subjects: &[Subject], rest: &str) -> String {
    let effort = &subjects[0].effort;
    let [width, height] = effort.size;
    format!(
        "{width}×{height}, {} lights of α = {ROUGHNESS}; interleaved {INTERLEAVE}×{INTERLEAVE}{rest}",
        effort.lights_of_receivers
    )
}

/// A row of the table, with δ, the number of samples, milliseconds and bias.
fn row(
    measured: &Measured,
    method: String,
    [delta, samples, ms, bias]: [f64; 4],
    errors: [Mean; 3],
) -> [Cell; 16] {
    let [rmse, sigma, median] = errors.map(|error| Cell::from(error.mean));
    let [of_rmse, of_sigma, of_median] = errors.map(|error| error.interval().map(Cell::from));
    let ([a, b], [c, d], [e, f]) = (of_rmse, of_sigma, of_median);
    let [scene, receiver] = [
        measured.subject.name.into(),
        measured.material.name().into(),
    ];
    let [delta, samples, ms, bias] = [delta, samples, ms, bias].map(Cell::from);
    [
        scene,
        receiver,
        method.into(),
        delta,
        ms,
        rmse,
        sigma,
        median,
        samples,
        a,
        b,
        c,
        d,
        e,
        f,
        bias,
    ]
}

fn against_time(subjects: &[Subject], all: &[Measured]) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "receiver",
        "method",
        "delta",
        "ms",
        "relative_rmse",
        "sigma_over_mean",
        "median_relative_error",
        "samples",
        "relative_rmse_low",
        "relative_rmse_high",
        "sigma_over_mean_low",
        "sigma_over_mean_high",
        "median_relative_error_low",
        "median_relative_error_high",
        "bias_in_standard_errors",
    ]);
    let mut panels = Vec::new();
    for measured in all {
        let scene = measured.subject.name;
        let mut series = Vec::new();
        for Curve { way, steps } in &measured.curves {
            let mut points = Vec::new();
            for step in steps {
                let [delta, samples] = match step.setting {
                    Setting::Delta(delta) => [f64::from(delta), f64::NAN],
                    Setting::Samples(samples) => [f64::NAN, samples as f64],
                };
                let Measures {
                    mse,
                    sigma,
                    median,
                    bias,
                } = step.measures;
                let rmse = mse.sqrt();
                let numbers = [delta, samples, step.ms, bias];
                sheet.push(row(measured, way.name(), numbers, [rmse, sigma, median]));
                points.push(Point::new(step.ms, rmse.mean).within(rmse.interval()));
            }
            series.push(Series {
                name: way.name(),
                look: way.look(),
                points,
            });
        }
        let numbers = [f64::NAN, f64::NAN, measured.all_lights_ms, f64::NAN];
        let none = Mean::of(&[0.0]);
        sheet.push(row(measured, "all lights".into(), numbers, [none; 3]));
        if measured.material.is_drawn() {
            panels.push(Panel {
                title: format!("{scene}, {}", measured.material.name()),
                x: Axis::log("build + cull + shade (ms)"),
                y: Axis::log("RMSE over mean radiance"),
                series,
            });
        }
    }
    Study {
        name: "receivers_time",
        caption: "Down and to the left is better. The error is that of drawing lights alone: against all lights of a \
                  pixel's subregion, or of the frame where a pixel draws from all lights. So interleaved curves leave out \
                  the error of having fewer lights, which is the same for all of them. Along a curve δ falls, or the \
                  number of samples rises. Where lights are few, to evaluate all of them is quick, too: the CSV has the \
                  time. Times are the least of those of all pictures. Bars are 95 % confidence. Pictures of a \
                  setting are few, so where rare bright lights make the error, it and the bias in standard errors are rough.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Error against time, by what receivers are made of".into(),
            subtitle: of_receivers(subjects, ", but for “all lights”"),
            panels,
        },
    }
}
