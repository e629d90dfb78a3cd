//! (c) Error and nanoseconds of each function.

mod bench;
mod brdf;
mod case;
mod culling;

use bench::{Bench, off};
use case::Case;

use super::Study;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::sheet::Sheet;
use crate::subject::Effort;

/// F0 of the metal that bounds are for.
const METAL: f32 = 0.9;

pub fn make(effort: &Effort, done: &dyn Fn()) -> Study {
    let count = if effort.is_quick { 1000 } else { 20_000 };
    let mut bench = Bench::new(count, effort.is_quick);
    brdf::microfacets(&mut bench);
    brdf::fresnel(&mut bench);
    brdf::lobes(&mut bench);
    culling::bounds(&mut bench);
    culling::tests(&mut bench);
    done();

    let mut sheet = Sheet::new(&["kind", "function", "ns", "max_relative_error"]);
    let mut series: Vec<Series> = Vec::new();
    for row in &bench.rows {
        sheet.push([
            row.kind.into(),
            row.name.into(),
            row.ns.into(),
            row.error.into(),
        ]);
        // A logarithm must be had of what is exact, too.
        let point = Point::new(row.ns, row.error.max(1e-8)).labelled(row.name);
        match series.last_mut() {
            Some(series) if series.name == row.kind => series.points.push(point),
            _ => series.push(Series {
                name: row.kind.into(),
                look: Look {
                    color: series.len(),
                    line: Line::None,
                },
                points: vec![point],
            }),
        }
    }
    Study {
        name: "functions",
        caption: "Each function over random lights and directions, α from 0.01 to 1, a degree above the horizon or more. The error of a bound \
                  is that of its size, and of a stretch how far points of the ellipsoid land from the \
                  unit sphere, to which it adds a margin on purpose; the error of a test is the share of \
                  tiles that it keeps though an exact one in f64 would not. None is lost.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Functions: error against time".into(),
            subtitle: format!("{count} random cases, one core, one at a time"),
            panels: vec![Panel {
                title: "least error at the bottom, least time to the left".into(),
                x: Axis::log("ns"),
                y: Axis::log("largest relative error against f64"),
                series,
            }],
        },
    }
}
