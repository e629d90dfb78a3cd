//! (b) The error of each method in the time of the paper's.

use common::frame::{BoundKind, GlossyLight};

use super::{DELTA, F0, INTERLEAVE, Study};
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::method::{Method, PAPERS, Stage};
use crate::score::Score;
use crate::sheet::Sheet;
use crate::statistics::Mean;
use crate::subject::{Gloss, Subject, Truth};

pub const ROUGHNESSES: [f32; 3] = [0.2, 0.1, 0.05];

struct Row {
    method: Method,
    delta: f32,
    ms: f64,
    rmse: Mean,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "alpha",
        "method",
        "delta",
        "ms",
        "relative_rmse",
        "relative_rmse_low",
        "relative_rmse_high",
        "over_papers",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let mut series: Vec<Series> = Vec::new();
        for roughness in ROUGHNESSES {
            let rows = compare(subject, Gloss::new(roughness, F0));
            done();
            let papers = rows.iter().find(|row| row.method == PAPERS);
            let papers = papers.map_or(f64::NAN, |row| row.rmse.mean);
            for row in rows {
                let [low, high] = row.rmse.interval();
                let name = row.method.name();
                sheet.push([
                    subject.name.into(),
                    roughness.into(),
                    name.clone().into(),
                    row.delta.into(),
                    row.ms.into(),
                    row.rmse.mean.into(),
                    low.into(),
                    high.into(),
                    (row.rmse.mean / papers).into(),
                ]);
                let point = Point::new(roughness.into(), row.rmse.mean).within([low, high]);
                match series.iter_mut().find(|series| series.name == name) {
                    Some(series) => series.points.push(point),
                    None => {
                        series.push(Series {
                            name,
                            look: row.method.look(),
                            points: vec![point],
                        });
                    }
                }
            }
        }
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("roughness α"),
            y: Axis::log("RMSE over mean radiance"),
            series,
        });
    }
    let effort = &subjects[0].effort;
    let [width, height] = effort.size;
    Study {
        name: "equal_time",
        caption: "Each method has the δ with which it takes as long as the paper's (the spheroid, tiles of \
                  16×16 pixels, the box test) with δ = 0.001. Lower is better; bars are 95 % confidence.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Error in equal time".into(),
            subtitle: format!(
                "{width}×{height}, {} rays, F0 = {F0}; glossy lights alone, interleaved \
                 {INTERLEAVE}×{INTERLEAVE}, {} seeds",
                effort.vpls, effort.seeds
            ),
            panels,
        },
    }
}

fn compare(subject: &Subject, gloss: Gloss) -> Vec<Row> {
    let stage = Stage::new(subject, gloss, INTERLEAVE);
    let frames = stage.frames();
    let truth = subject.truth_of(&stage.frame(1.0), &frames[0]);
    let times = subject.effort.times;
    let time = stage.milliseconds(PAPERS, DELTA, times);
    let row = |method: Method| {
        let delta = if method == PAPERS {
            DELTA
        } else {
            delta_for(&stage, method, time)
        };
        Row {
            method,
            delta,
            ms: stage.milliseconds(method, delta, times),
            rmse: error(&stage, &frames, &truth, delta),
        }
    };
    Method::culling().into_iter().map(row).collect()
}

/// The δ with which `method` takes `time` in ms, by bisection; within what the sweep covers.
fn delta_for(stage: &Stage, method: Method, time: f64) -> f32 {
    let (mut low, mut high) = (1e-7_f32, 10.0_f32);
    let (steps, times) = if stage.subject.effort.is_quick {
        (5, 1)
    } else {
        (10, 3)
    };
    for _ in 0..steps {
        let middle = (low * high).sqrt();
        if stage.milliseconds(method, middle, times) > time {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low * high).sqrt()
}

/// The error that a δ comes to, whatever encloses the ranges.
fn error(stage: &Stage, frames: &[Vec<GlossyLight>], truth: &Truth, delta: f32) -> Mean {
    let quickest = Method::Culled {
        bound: BoundKind::Tight,
        refined: true,
    };
    let mut score = Score::new(stage.subject, truth);
    for lights in frames {
        score.add(&stage.light(quickest, delta, lights).irradiance);
    }
    score.relative_rmse()
}
