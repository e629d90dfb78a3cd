//! (a) Error against milliseconds as δ goes from coarse to fine.

use common::frame::{BoundKind, GlossyLight, timed};

use super::{DELTA, F0, INTERLEAVE, ROUGHNESS, Study, of_frames};
use crate::baseline::fewer;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::method::{Method, Stage};
use crate::score::Score;
use crate::sheet::Sheet;
use crate::statistics::{Mean, median};
use crate::subject::{Gloss, Subject, Truth};

const NO_CULLING: &str = "no culling, fewer lights";
const NO_CULLING_LOOK: Look = Look {
    color: 6,
    line: Line::Solid,
};

/// A method at one setting.
struct Row {
    method: String,
    look: Look,
    /// NaN without roulette.
    delta: f64,
    /// One in so many lights is used.
    share: u32,
    ms: f64,
    rmse: Mean,
    bias: Mean,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "method",
        "delta",
        "one_light_in",
        "ms",
        "relative_rmse",
        "relative_rmse_low",
        "relative_rmse_high",
        "relative_bias",
        "bias_standard_error",
        "bias_in_standard_errors",
    ]);
    let mut summary = Sheet::new(&[
        "scene",
        "method",
        "ms",
        "relative_rmse",
        "bias_percent",
        "bias_in_standard_errors",
    ]);
    let mut panels = Vec::new();
    let mut biases = Vec::new();
    for subject in subjects {
        let rows = sweep(subject);
        done();
        for row in &rows {
            let [low, high] = row.rmse.interval();
            sheet.push([
                subject.name.into(),
                row.method.clone().into(),
                row.delta.into(),
                row.share.into(),
                row.ms.into(),
                row.rmse.mean.into(),
                low.into(),
                high.into(),
                row.bias.mean.into(),
                row.bias.standard_error.into(),
                row.bias.sigmas().into(),
            ]);
            let is_usual = (row.delta / f64::from(DELTA) - 1.0).abs() < 1e-3;
            if is_usual || (row.delta.is_nan() && row.share == 1) {
                summary.push([
                    subject.name.into(),
                    row.method.clone().into(),
                    row.ms.into(),
                    row.rmse.mean.into(),
                    (100.0 * row.bias.mean).into(),
                    row.bias.sigmas().into(),
                ]);
            }
        }
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("bound + cull + shade (ms)"),
            y: Axis::log("RMSE over mean radiance"),
            series: series(&rows, |row| {
                Point::new(row.ms, row.rmse.mean).within(row.rmse.interval())
            }),
        });
        biases.push(bias_panel(subject.name, &rows));
    }
    panels.extend(biases);
    Study {
        name: "delta_sweep",
        caption: "Down and to the left is better; the table is for δ = 0.001. Along a curve δ falls from 0.1 to 10⁻⁶; for light \
                  without culling the number of lights rises instead. Bars are 95 % confidence. Below, \
                  the mean of all pixels: what is unbiased stays at zero whatever δ is.",
        sheet,
        summary: Some(summary),
        picture: None,
        figure: Figure {
            title: "Error against time, as δ falls".into(),
            subtitle: of_frames(
                subjects,
                &format!("glossy lights alone, interleaved {INTERLEAVE}×{INTERLEAVE}"),
            ),
            panels,
        },
    }
}

fn bias_panel(name: &str, rows: &[Row]) -> Panel {
    let shown = |row: &&Row| {
        let tight = Method::Culled {
            bound: BoundKind::Tight,
            refined: true,
        };
        [tight.name(), Method::Clamped.name()].contains(&row.method)
    };
    let mut series = series_of(rows.iter().filter(shown), |row| {
        let percent = row.bias.over(0.01);
        Point::new(row.delta, percent.mean).within(percent.interval())
    });
    if let Some(unbiased) = series.first_mut() {
        "all culling, unbiased".clone_into(&mut unbiased.name);
        unbiased.look = Look {
            color: NO_CULLING_LOOK.color,
            line: Line::Dashed,
        };
    }
    Panel {
        title: format!("{name}: bias"),
        x: Axis::log("δ (W/(m²·sr))"),
        y: Axis::linear("bias of the mean radiance (%)"),
        series,
    }
}

fn series(rows: &[Row], point: impl Fn(&Row) -> Point) -> Vec<Series> {
    series_of(rows.iter(), point)
}

/// One series for each method, in the order in which they come.
fn series_of<'a>(
    rows: impl Iterator<Item = &'a Row>,
    point: impl Fn(&Row) -> Point,
) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    for row in rows {
        if all.last().is_none_or(|series| series.name != row.method) {
            all.push(Series {
                name: row.method.clone(),
                look: row.look,
                points: Vec::new(),
            });
        }
        all.last_mut()
            .expect("there is one")
            .points
            .push(point(row));
    }
    all
}

fn deltas(is_quick: bool) -> Vec<f32> {
    let steps = if is_quick { 1 } else { 2 };
    (0..=5 * steps)
        .map(|i| 10_f32.powf(-1.0 - i as f32 / steps as f32))
        .collect()
}

fn sweep(subject: &Subject) -> Vec<Row> {
    let gloss = Gloss::new(ROUGHNESS, F0);
    let stage = Stage::new(subject, gloss, INTERLEAVE);
    let frames = stage.frames();
    let truth = subject.truth_of(&stage.frame(1.0), &frames[0]);
    let deltas = deltas(subject.effort.is_quick);

    // Whatever encloses the ranges, the picture is the same; where it is, its error is taken once.
    let quickest = Method::Culled {
        bound: BoundKind::Tight,
        refined: true,
    };
    let scored = |method: Method, delta: f32| {
        let mut score = Score::new(subject, &truth);
        for lights in &frames {
            score.add(&stage.light(method, delta, lights).irradiance);
        }
        (score.relative_rmse(), score.relative_bias())
    };
    let picture = |method: Method, delta: f32| stage.light(method, delta, &frames[0]).irradiance;
    let unbiased: Vec<_> = deltas
        .iter()
        .map(|&delta| (delta, picture(quickest, delta), scored(quickest, delta)))
        .collect();
    let mut rows = Vec::new();
    let row = |method: Method, delta: f32, (rmse, bias)| Row {
        method: method.name(),
        look: method.look(),
        delta: delta.into(),
        share: 1,
        ms: stage.milliseconds(method, delta, subject.effort.times),
        rmse,
        bias,
    };
    for method in Method::culling() {
        for (delta, same, errors) in &unbiased {
            let is_same = picture(method, *delta) == *same;
            rows.push(row(
                method,
                *delta,
                if is_same {
                    *errors
                } else {
                    scored(method, *delta)
                },
            ));
        }
    }
    for &delta in &deltas {
        rows.push(row(Method::Clamped, delta, scored(Method::Clamped, delta)));
    }
    rows.extend(without_culling(&stage, &frames[0], &truth));
    rows
}

/// All of fewer and fewer lights.
fn without_culling(stage: &Stage, lights: &[GlossyLight], truth: &Truth) -> Vec<Row> {
    let frame = stage.frame(1.0);
    let of_share = |share: u32| {
        let mut score = Score::new(stage.subject, truth);
        let mut times = Vec::new();
        for seed in 0..stage.subject.effort.seeds {
            let (irradiance, ms) = timed(|| fewer::light(&frame, lights, share, seed));
            score.add(&irradiance);
            times.push(ms);
        }
        Row {
            method: NO_CULLING.into(),
            look: NO_CULLING_LOOK,
            delta: f64::NAN,
            share,
            ms: median(&times),
            rmse: score.relative_rmse(),
            bias: score.relative_bias(),
        }
    };
    (0..9).map(|log| of_share(1 << log)).collect()
}
