//! (e) Lights that a list holds and no pixel accepts, against nanoseconds, for each test, tile size and slicing.

mod count;
mod measure;

use common::frame::Slicing;

use super::{DELTA, F0, INTERLEAVE, ROUGHNESS, Study, of_frames};
use crate::baseline::cluster;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::method::Stage;
use crate::sheet::Sheet;
use crate::subject::{Gloss, Subject};
use count::Outcome;
use measure::measure;

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
        family: "spheroid, each test",
    };
    let tight = Setting {
        is_tight: true,
        family: "tight, each test",
        ..papers
    };
    let tests = [
        Test::Box,
        Test::BoxAndHalfSpace,
        Test::Exact,
        Test::ExactAndHalfSpace,
    ];
    let mut settings = Vec::new();
    for base in [papers, tight] {
        settings.extend(tests.map(|test| Setting { test, ..base }));
    }
    let family = "tight, each tile width";
    settings.extend([32, 16, 8, 4, 2, 1].map(|tile| Setting {
        tile,
        family,
        ..tight
    }));
    let around_surfaces = [Slicing::Whole, Slicing::HalfZ, Slicing::ModifiedHalfZ];
    let slices = [1, 2, 4, 8, 16, 32].map(Slicing::Slices);
    for (family, slicings) in [
        (AROUND_SURFACES, &around_surfaces[..]),
        (SLICES, &slices[..]),
    ] {
        settings.extend(slicings.iter().map(|slicing| Setting {
            slicing: *slicing,
            family,
            ..tight
        }));
    }
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

const AROUND_SURFACES: &str = "tight, around surfaces";
const SLICES: &str = "tight, slices of depth";

fn name_of(slicing: Slicing) -> String {
    match slicing {
        Slicing::Whole => "one".into(),
        Slicing::HalfZ => "HalfZ".into(),
        Slicing::ModifiedHalfZ => "Modified HalfZ".into(),
        Slicing::Slices(count) => format!("{count} slices"),
    }
}

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
            let unneeded = 1.0 - needed as f64 / listed.max(1) as f64;
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
                unneeded.into(),
                (at_pixels as f64 / surfaces.count().max(1) as f64).into(),
            ]);
            let label = match setting.family {
                "tight, each tile width" => setting.tile.to_string(),
                AROUND_SURFACES | SLICES => name_of(setting.slicing).replace(" slices", ""),
                _ => setting.test.name().into(),
            };
            let point = Point::new(ns, 100.0 * unneeded).labelled(label);
            match series.last_mut() {
                Some(series) if series.name == setting.family => series.points.push(point),
                _ => series.push(Series {
                    name: setting.family.into(),
                    look: Look {
                        color: series.len(),
                        line: Line::Solid,
                    },
                    points: vec![point],
                }),
            }
        }
        done();
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("ns per light, tile and depth interval"),
            y: Axis::linear("false positives in a list (%)"),
            series,
        });
    }
    Study {
        name: "tests",
        caption: "A light in a list is a false positive if no pixel of the tile's depth interval accepts it. Down and \
                  to the left is better; pairs that blocks of tiles decide together share the time.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "False positives in lists, against the time of a test".into(),
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
