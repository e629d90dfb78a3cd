//! (f) Error and milliseconds against the number of lights.

use common::frame::BoundKind;

use super::{DELTA, F0, INTERLEAVE, ROUGHNESS, Study, of_any_rays};
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::method::{Method, Stage};
use crate::score::Score;
use crate::sheet::Sheet;
use crate::statistics::median;
use crate::subject::{Gloss, Subject};

const METHODS: [Method; 4] = [
    Method::Culled {
        bound: BoundKind::Enclosing,
        refined: false,
    },
    Method::Culled {
        bound: BoundKind::Spheroid,
        refined: false,
    },
    Method::Culled {
        bound: BoundKind::Tight,
        refined: false,
    },
    Method::Culled {
        bound: BoundKind::Tight,
        refined: true,
    },
];

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "rays",
        "glossy_lights",
        "method",
        "ms",
        "relative_rmse",
        "relative_rmse_low",
        "relative_rmse_high",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let gloss = Gloss::new(ROUGHNESS, F0);
        let stage = Stage::new(subject, gloss, INTERLEAVE);
        let truth = subject.truth(gloss);
        let mut series = METHODS.map(|method| Series {
            name: method.name(),
            look: method.look(),
            points: Vec::new(),
        });
        let logs = if subject.effort.is_quick {
            10..=13
        } else {
            12..=20
        };
        for rays in logs.map(|log| 1_u32 << log) {
            // A frame of many lights is slow, and less a matter of chance.
            let seeds = (subject.effort.seeds * 16384 / rays).clamp(2, subject.effort.seeds);
            let mut score = Score::new(subject, &truth);
            for repetition in 0..seeds {
                let lights = stage.lights_of(rays, repetition);
                score.add(&stage.light(METHODS[3], DELTA, &lights).irradiance);
            }
            let lights = stage.lights_of(rays, 0);
            let times = METHODS.map(|method| {
                let once = |_| stage.light(method, DELTA, &lights).ms;
                median(&(0..subject.effort.times).map(once).collect::<Vec<f64>>())
            });
            let rmse = score.relative_rmse();
            let [low, high] = rmse.interval();
            for ((method, ms), series) in METHODS.iter().zip(times).zip(&mut series) {
                series.points.push(Point::new(f64::from(rays), ms));
                sheet.push([
                    subject.name.into(),
                    rays.into(),
                    (lights.len() as f64).into(),
                    method.name().into(),
                    ms.into(),
                    rmse.mean.into(),
                    low.into(),
                    high.into(),
                ]);
            }
        }
        done();
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("rays from the light"),
            y: Axis::log("bound + cull + shade (ms)"),
            series: series.into(),
        });
    }
    Study {
        name: "vpl_count",
        caption: "Lights become dimmer as they become more, so that with the same δ a pixel evaluates about \
                  as many: what grows is the work of culling.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Time against the number of lights".into(),
            subtitle: of_any_rays(
                subjects,
                &format!("δ = {DELTA}, glossy lights alone, interleaved {INTERLEAVE}×{INTERLEAVE}"),
            ),
            panels,
        },
    }
}
