//! (j) Smooth lights in the place of points: error against time and against the number of lights, and what a moving
//! light does to a picture.

mod flicker;
mod method;
mod picture;
mod truth;

use super::{F0, Study};
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::{Effort, Gloss, Subject};
use method::{Kind, Setting, Stage};
use truth::Truth;

/// The roughnesses of a full report.
pub const ROUGHNESSES: [f32; 5] = [0.4, 0.2, 0.1, 0.05, 0.02];

pub fn roughnesses(effort: &Effort) -> &'static [f32] {
    if effort.is_quick {
        &ROUGHNESSES[2..3]
    } else {
        &ROUGHNESSES
    }
}

/// What one setting comes to.
struct Row<'a> {
    scene: &'a str,
    roughness: f32,
    setting: Setting,
    lights: usize,
    ms: f64,
    cluster_ms: f64,
    rmse: f64,
    bias: f64,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut rows = Vec::new();
    let mut flickers = Vec::new();
    for subject in subjects {
        for roughness in roughnesses(&subject.effort) {
            let stage = Stage::new(subject, Gloss::new(*roughness, F0));
            let truth = Truth::new(&stage);
            let settings = Setting::all(&subject.effort);
            rows.extend(settings.into_iter().map(|setting| {
                let measured = measure(&stage, &truth, setting);
                Row {
                    scene: subject.name,
                    roughness: *roughness,
                    ..measured
                }
            }));
            flickers.extend(flicker::measure(&stage));
            done();
        }
    }
    let first = &subjects[0];
    let [width, height] = first.effort.size;
    Study {
        name: "vsgl",
        caption: "Glossy lights alone, without interleaving or denoising, against the mean of many more points, whose \
                  own noise is taken off. Time is to make clusters, bound, cull and shade; both kinds of light have \
                  their rays for nothing. Points are culled by the tight bound in lists of pixels. In the table: the \
                  least error of points in the same time, and how a picture changes from frame to frame as the light \
                  moves by a thousandth of its distance: in all, and beyond what a steady motion changes (the second \
                  difference over √6), both over the mean radiance. The picture has a row for each roughness, and in \
                  it points, smooth lights, the same culled, and those of k-means.",
        sheet: sheet(&rows),
        summary: Some(summary(&rows, &flickers)),
        picture: Some(picture::make(first)),
        figure: Figure {
            title: "Smooth lights in the place of points: error against time".into(),
            subtitle: format!("{width}×{height}, F0 = {F0}, glossy lights alone"),
            panels: panels(subjects, &rows),
        },
    }
}

/// The error over frames with other lights, and the least time.
fn measure<'a>(stage: &Stage, truth: &Truth, setting: Setting) -> Row<'a> {
    // Those of all lights take long, and differ little.
    let frames = match setting.delta {
        _ if stage.subject.effort.is_quick => 1,
        Some(_) => 4,
        None => 1,
    };
    let lit: Vec<_> = (0..frames)
        .map(|frame| stage.light(setting, frame))
        .collect();
    let least = |time: fn(&method::Lit) -> f64| lit.iter().map(time).fold(f64::INFINITY, f64::min);
    let errors: Vec<_> = lit.iter().map(|lit| truth.error(&lit.irradiance)).collect();
    let mean =
        |of: fn(&truth::Deviation) -> f64| errors.iter().map(of).sum::<f64>() / f64::from(frames);
    Row {
        scene: "",
        roughness: 0.0,
        setting,
        lights: lit[0].lights,
        ms: least(|lit| lit.ms),
        cluster_ms: least(|lit| lit.cluster_ms),
        rmse: mean(|error| error.relative_mse).max(0.0).sqrt(),
        bias: mean(|error| error.relative_bias),
    }
}

fn sheet(rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(&["scene", "alpha", "method", "lights", "ms", "relative_rmse"]);
    for row in rows {
        sheet.push([
            row.scene.into(),
            row.roughness.into(),
            row.setting.kind.name().into(),
            (row.lights as f64).into(),
            row.ms.into(),
            row.rmse.into(),
        ]);
    }
    sheet
}

fn summary(rows: &[Row], flickers: &[flicker::Flicker]) -> Sheet {
    let mut sheet = Sheet::new(&[
        "scene",
        "alpha",
        "method",
        "lights",
        "delta",
        "cluster_ms",
        "ms",
        "relative_rmse",
        "of_points_then",
        "bias",
        "change",
        "flicker",
    ]);
    for row in rows {
        let of_points = rows.iter().filter(|other| {
            (other.scene, other.roughness, other.setting.kind)
                == (row.scene, row.roughness, Kind::Vpl)
                && other.ms <= row.ms
        });
        let then = of_points
            .map(|other| other.rmse)
            .fold(f64::INFINITY, f64::min);
        let flicker = flickers.iter().find(|flicker| {
            (flicker.scene, flicker.roughness, flicker.setting)
                == (row.scene, row.roughness, row.setting)
        });
        sheet.push([
            row.scene.into(),
            row.roughness.into(),
            row.setting.kind.name().into(),
            (row.lights as f64).into(),
            row.setting.delta.map_or(f64::NAN.into(), Into::into),
            row.cluster_ms.into(),
            row.ms.into(),
            row.rmse.into(),
            then.into(),
            row.bias.into(),
            flicker.map_or(f64::NAN, |flicker| flicker.change).into(),
            flicker.map_or(f64::NAN, |flicker| flicker.unsteady).into(),
        ]);
    }
    sheet
}

/// A panel for each scene and roughness, with a series for each method.
fn panels(subjects: &[Subject], rows: &[Row]) -> Vec<Panel> {
    let panel = |subject: &Subject, roughness: f32| {
        let series = Kind::ALL.map(|kind| {
            let of_kind = rows.iter().filter(|row| {
                (row.scene, row.roughness, row.setting.kind) == (subject.name, roughness, kind)
            });
            Series {
                name: kind.name().into(),
                look: kind.look(),
                points: of_kind
                    .map(|row| Point::new(row.ms, row.rmse).labelled(row.lights.to_string()))
                    .collect(),
            }
        });
        Panel {
            title: format!("{}, α = {roughness}", subject.name),
            x: Axis::log("cluster + bound + cull + shade (ms)"),
            y: Axis::log("RMSE over mean radiance"),
            series: series.into(),
        }
    };
    let of_subject = |subject: &Subject| -> Vec<Panel> {
        let roughnesses = roughnesses(&subject.effort).iter();
        roughnesses
            .map(|roughness| panel(subject, *roughness))
            .collect()
    };
    subjects.iter().flat_map(of_subject).collect()
}
