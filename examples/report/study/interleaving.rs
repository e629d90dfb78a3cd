//! (g) Error and milliseconds against the width of interleaving, with and without denoising.

use common::frame::{BoundKind, cross_bilateral, timed};

use super::{DELTA, F0, ROUGHNESS, Study, of_frames};
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::method::{Method, Stage};
use crate::score::Score;
use crate::sheet::Sheet;
use crate::statistics::median;
use crate::subject::{Gloss, Subject};

pub const METHOD: Method = Method::Culled {
    bound: BoundKind::Tight,
    refined: true,
};

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let mut sheet = Sheet::new(&[
        "scene",
        "width",
        "denoised",
        "ms",
        "relative_rmse",
        "relative_rmse_low",
        "relative_rmse_high",
    ]);
    let mut panels = Vec::new();
    for subject in subjects {
        let mut series =
            [("not denoised", Line::Solid), ("denoised", Line::Dashed)].map(|(name, line)| {
                Series {
                    name: name.into(),
                    look: Look { color: 0, line },
                    points: Vec::new(),
                }
            });
        let truth = subject.truth(Gloss::new(ROUGHNESS, F0));
        for width in [1, 2, 4, 8, 16] {
            let stage = Stage::new(subject, Gloss::new(ROUGHNESS, F0), width);
            let mut scores = [(); 2].map(|()| Score::new(subject, &truth));
            let mut times = [(); 2].map(|()| Vec::new());
            // Denoising takes longer than all the rest.
            for repetition in 0..subject.effort.seeds.div_ceil(4) {
                let lit = stage.light(METHOD, DELTA, &stage.lights(repetition));
                let ([smooth], ms) =
                    timed(|| cross_bilateral(&subject.surfaces, [&lit.irradiance], || ()));
                for (i, image) in [&lit.irradiance, &smooth].into_iter().enumerate() {
                    scores[i].add(image);
                }
                times[0].push(lit.ms);
                times[1].push(lit.ms + ms);
            }
            for (i, denoised) in ["no", "yes"].into_iter().enumerate() {
                let (ms, rmse) = (median(&times[i]), scores[i].relative_rmse());
                let [low, high] = rmse.interval();
                sheet.push([
                    subject.name.into(),
                    width.into(),
                    denoised.into(),
                    ms.into(),
                    rmse.mean.into(),
                    low.into(),
                    high.into(),
                ]);
                let point = Point::new(ms, rmse.mean).within([low, high]);
                series[i]
                    .points
                    .push(point.labelled(format!("{width}×{width}")));
            }
        }
        done();
        panels.push(Panel {
            title: subject.name.into(),
            x: Axis::log("milliseconds"),
            y: Axis::log("RMSE over mean radiance"),
            series: series.into(),
        });
    }
    Study {
        name: "interleaving",
        caption: "With a width of w each pixel is lit by 1/w² of the lights, each w² times as bright: less \
                  work and more noise, which the denoiser takes away as long as its window holds all of \
                  the w×w pixels.",
        sheet,
        summary: None,
        picture: None,
        figure: Figure {
            title: "Interleaving, with and without denoising".into(),
            subtitle: of_frames(
                subjects,
                &format!("δ = {DELTA}, glossy lights alone, the tight bound, refined"),
            ),
            panels,
        },
    }
}
