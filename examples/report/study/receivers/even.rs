//! A δ for each tile beside one for all, by the relative error of the median pixel.

use super::super::Study;
use super::curve::Curve;
use super::time::{Measured, of_receivers};
use super::way::Setting;
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::Subject;

pub fn against_time(subjects: &[Subject], all: &[Measured]) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "receiver",
        "method",
        "delta",
        "ms",
        "median_relative_error",
        "with_one_delta",
        "ratio",
    ]);
    let mut panels = Vec::new();
    for measured in all {
        let (scene, receiver) = (measured.subject.name, measured.material.name());
        let mut series = Vec::new();
        for (even, one) in pairs(measured) {
            for step in &even.steps {
                let (Setting::Delta(delta), Some(at)) = (step.setting, one.at(step.ms)) else {
                    continue;
                };
                let median = step.measures.median.mean;
                sheet.push([
                    scene.into(),
                    receiver.clone().into(),
                    even.way.name().into(),
                    delta.into(),
                    step.ms.into(),
                    median.into(),
                    at.median.into(),
                    (median / at.median).into(),
                ]);
            }
            series.extend([one, even].map(series_of));
        }
        if measured.material.is_drawn() {
            panels.push(Panel {
                title: format!("{scene}, {receiver}"),
                x: Axis::log("build + cull + shade (ms)"),
                y: Axis::log("relative error of the median pixel"),
                series,
            });
        }
    }
    Study {
        name: "receivers_even",
        caption: "A δ for each tile, in proportion to what the tile showed in the frames before, of other seeds, down to the \
                  δ of the median tile, beside one for all. Down and to the left is better; along a curve δ falls. At about 1 \
                  the median pixel has no light at all. Bars are 95 % confidence. The table has the error with one δ in the same time.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "A δ for each tile: error of the median pixel against time".into(),
            subtitle: of_receivers(subjects, ""),
            panels,
        },
    }
}

/// The curves of each way with a δ for each tile, and of the same way with one.
fn pairs<'a>(measured: &'a Measured) -> impl Iterator<Item = (&'a Curve, &'a Curve)> {
    let curves = &measured.curves;
    curves.iter().filter_map(|even| {
        let one = even.way.with_one_delta()?;
        Some((even, curves.iter().find(|curve| curve.way == one)?))
    })
}

fn series_of(curve: &Curve) -> Series {
    let point = |step: &super::curve::Step| {
        let median = step.measures.median;
        Point::new(step.ms, median.mean).within(median.interval())
    };
    Series {
        name: curve.way.name(),
        look: curve.way.look(),
        points: curve.steps.iter().map(point).collect(),
    }
}
