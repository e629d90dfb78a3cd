//! (i) Error of the mean of 1 to 64 frames, by how the ξ of lights and frames go together.

use common::frame::{GlossyLight, cross_bilateral, ordered, redraw};
use common::picture::{Exposure, tone_mapped};
use image::{RgbImage, imageops};
use stochastic_light_culling::{Interleave, Seed, Vpl, glam::Vec3};

use super::interleaving::METHOD;
use super::{DELTA, F0, INTERLEAVE, ROUGHNESS, Study};
use crate::baseline::fewer;
use crate::figure::{Axis, Figure, Line, Look, Panel, Point, Series};
use crate::method::Stage;
use crate::score::Score;
use crate::sheet::Sheet;
use crate::statistics::Mean;
use crate::subject::{Gloss, Subject};

pub const ROUGHNESSES: [f32; 3] = [0.4, 0.1, 0.05];
const WIDTHS: [u32; 2] = [1, 4];
const FRAMES: [u32; 4] = [1, 4, 16, 64];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Spread {
    /// Hashed from light and frame.
    Hashed,
    /// Hashed from light, and moved by the golden ratio from frame to frame.
    Golden,
    /// From the rank of the light, with one seed for all subregions.
    Ranked,
    /// From the rank of the light, with a seed for each subregion.
    PerSubregion,
    /// The same, with ranks by the positions of the lights instead of the centers of their bounds.
    ByPosition,
}

impl Spread {
    const ALL: [Self; 5] = [
        Self::Hashed,
        Self::Golden,
        Self::Ranked,
        Self::PerSubregion,
        Self::ByPosition,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Hashed => "hashed",
            Self::Golden => "golden",
            Self::Ranked => "ranked",
            Self::PerSubregion => "ranked per subregion",
            Self::ByPosition => "ranked by position",
        }
    }

    /// Sorts lights, which come sorted by the centers of their bounds.
    fn sort(self, lights: Vec<GlossyLight>) -> Vec<GlossyLight> {
        match self {
            Self::ByPosition => ordered(lights, Vpl::position).expect("few lights"),
            _ => lights,
        }
    }

    /// Gives each light its ξ for a frame.
    fn draw(self, lights: &mut [GlossyLight], interleave: &Interleave, seed: Seed, frame: u32) {
        let frame_seed = seed.frame(frame);
        for (i, light) in (0..).zip(&mut *lights) {
            light.xi = match self {
                Self::Hashed => frame_seed.hashed_xi(i),
                Self::Golden => frame_seed.xi(i),
                _ => frame_seed.xi_of_rank(interleave.split_light(i).1),
            };
        }
        if matches!(self, Self::PerSubregion | Self::ByPosition) {
            redraw(lights, interleave, seed, frame);
        }
    }
}

/// Errors of one way to draw ξ.
struct Row<'a> {
    subject: &'a Subject<'a>,
    roughness: f32,
    width: u32,
    is_denoised: bool,
    spread: Spread,
    /// After each of [`FRAMES`], relative to the mean radiance.
    rmse: Vec<Mean>,
    bias: Vec<Mean>,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let small: Vec<Subject> = subjects.iter().map(Subject::half_as_large).collect();
    let mut rows = Vec::new();
    for subject in &small {
        for roughness in ROUGHNESSES {
            for width in WIDTHS {
                let stage = Stage::new(subject, Gloss::new(roughness, F0), width);
                for spread in Spread::ALL {
                    // Without interleaving there is one subregion.
                    if width > 1 || spread != Spread::Ranked {
                        rows.extend(measure(&stage, spread));
                    }
                }
            }
            done();
        }
    }
    let panels = small.iter().flat_map(|subject| panels(subject, &rows));
    let [width, height] = small[0].effort.size;
    Study {
        name: "spread",
        caption: "Lights stay, and ξ differ from frame to frame. The picture has a frame, its error and the mean of \
                  16 frames, of 4×4 subregions: with hashed ξ, with the golden ratio in time, and with ranks. The \
                  error is that of roulette alone, against all lights of a pixel's subregion; denoised, against \
                  their denoised picture. The table has the variance of hashed ξ over that of each way, in the \
                  geometric mean of scenes and roughnesses, and for the worst of them in brackets.",
        sheet: sheet(&rows),
        summary: Some(summary(&rows)),
        picture: Some(picture(&small[0])),
        figure: Figure {
            title: "Spread ξ: error against the number of frames".into(),
            subtitle: format!(
                "{width}×{height}, {} rays, α = {ROUGHNESS}, F0 = {F0}, δ = {DELTA}, glossy lights alone",
                small[0].effort.vpls
            ),
            panels: panels.collect(),
        },
    }
}

/// The errors of means of frames, without and with denoising.
fn measure<'a>(stage: &Stage<'a>, spread: Spread) -> [Row<'a>; 2] {
    let subject = stage.subject;
    // [denoised][frames][set of lights]
    let mut squared = [(); 2].map(|()| FRAMES.map(|_| Vec::new()));
    let mut biases = squared.clone();
    let effort = subject.effort;
    // Sets of lights, and seeds of ξ for each set.
    let [sets, seeds] = if effort.is_quick { [1, 2] } else { [2, 8] };
    for set in 0..sets {
        let mut lights = spread.sort(stage.lights(set));
        let frame = stage.frame(DELTA);
        let all = fewer::light(&frame, &lights, 1, 0);
        let [denoised] = cross_bilateral(&subject.surfaces, [&all], || ());
        let truths = [all, denoised].map(|image| subject.truth_in(&frame, &image));
        let mut scores = truths
            .each_ref()
            .map(|truth| FRAMES.map(|_| Score::new(subject, truth)));
        for seed in 0..seeds {
            let seed = Seed(subject.seed_of(1000 * set + seed));
            add_frames(stage, spread, &mut lights, seed, &mut scores);
        }
        for (i, scores) in scores.iter().enumerate() {
            for (j, score) in scores.iter().enumerate() {
                squared[i][j].push(score.relative_mse());
                biases[i][j].push(score.relative_bias());
            }
        }
    }
    [0, 1].map(|i| Row {
        subject,
        roughness: stage.gloss.ggx.roughness(),
        width: stage.interleave.width(),
        is_denoised: i == 1,
        spread,
        rmse: squared[i]
            .iter()
            .map(|sets| Mean::of_means(sets).sqrt())
            .collect(),
        bias: biases[i].iter().map(|sets| Mean::of_means(sets)).collect(),
    })
}

/// Adds means of frames to `scores`, those without and those with denoising.
fn add_frames(
    stage: &Stage,
    spread: Spread,
    lights: &mut [GlossyLight],
    seed: Seed,
    scores: &mut [[Score; FRAMES.len()]; 2],
) {
    let surfaces = &stage.subject.surfaces;
    let mut sum = vec![Vec3::ZERO; surfaces.surfaces.len()];
    let mut frame = 0;
    for (i, frames) in FRAMES.into_iter().enumerate() {
        while frame < frames {
            spread.draw(lights, &stage.interleave, seed, frame);
            let lit = stage.light(METHOD, DELTA, lights).irradiance;
            for (sum, lit) in sum.iter_mut().zip(lit) {
                *sum += lit;
            }
            frame += 1;
        }
        let mean: Vec<Vec3> = sum.iter().map(|sum| sum / frames as f32).collect();
        let [denoised] = cross_bilateral(surfaces, [&mean], || ());
        scores[0][i].add(&mean);
        scores[1][i].add(&denoised);
    }
}

/// Frames of three ways, a row each: one frame, the magnitude of its error, and the mean of sixteen frames.
fn picture(subject: &Subject) -> RgbImage {
    let stage = Stage::new(subject, Gloss::new(ROUGHNESS, F0), INTERLEAVE);
    let [width, height] = subject.effort.size;
    let ways = [Spread::Hashed, Spread::Golden, Spread::PerSubregion];
    let mut picture = RgbImage::new(3 * width, ways.len() as u32 * height);
    let mut exposure = None;
    for (row, spread) in (0..).zip(ways) {
        let mut lights = spread.sort(stage.lights(0));
        let truth = fewer::light(&stage.frame(DELTA), &lights, 1, 0);
        let exposure = *exposure.get_or_insert_with(|| Exposure::of(&subject.radiance(&truth)));
        let frames = (0..16).map(|frame| {
            spread.draw(&mut lights, &stage.interleave, Seed(subject.seed), frame);
            stage.light(METHOD, DELTA, &lights).irradiance
        });
        let frames: Vec<Vec<Vec3>> = frames.collect();
        let pixels = 0..truth.len();
        let error = pixels.clone().map(|i| (frames[0][i] - truth[i]).abs());
        let mean = pixels.map(|i| frames.iter().map(|frame| frame[i]).sum::<Vec3>() / 16.0);
        let images = [frames[0].clone(), error.collect(), mean.collect()];
        for (column, image) in (0..).zip(images) {
            let image = tone_mapped([width, height], &subject.radiance(&image), exposure);
            let place = [column * width, row * height].map(i64::from);
            imageops::replace(&mut picture, &image, place[0], place[1]);
        }
    }
    picture
}

fn sheet(rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(&[
        "scene",
        "alpha",
        "interleave",
        "denoised",
        "method",
        "frames",
        "relative_rmse",
        "bias_in_standard_errors",
    ]);
    for row in rows {
        for (frames, (rmse, bias)) in FRAMES.into_iter().zip(row.rmse.iter().zip(&row.bias)) {
            sheet.push([
                row.subject.name.into(),
                row.roughness.into(),
                row.width.into(),
                yes_or_no(row.is_denoised).into(),
                row.spread.name().into(),
                frames.into(),
                rmse.mean.into(),
                bias.sigmas().into(),
            ]);
        }
    }
    sheet
}

fn yes_or_no(is_so: bool) -> &'static str {
    if is_so { "yes" } else { "no" }
}

fn panels(subject: &Subject, rows: &[Row]) -> Vec<Panel> {
    let shown = [(1, false), (4, false), (4, true)];
    let panel = |(width, is_denoised)| {
        let of_panel = rows.iter().filter(|row| {
            (row.subject.name, row.roughness) == (subject.name, ROUGHNESS)
                && (row.width, row.is_denoised) == (width, is_denoised)
        });
        let series = of_panel.map(|row| Series {
            name: row.spread.name().into(),
            look: Look {
                color: row.spread as usize,
                line: Line::Solid,
            },
            points: FRAMES
                .into_iter()
                .zip(&row.rmse)
                .map(|(frames, rmse)| {
                    Point::new(f64::from(frames), rmse.mean).within(rmse.interval())
                })
                .collect(),
        });
        let denoised = if is_denoised { ", denoised" } else { "" };
        Panel {
            title: format!("{}, {width}×{width}{denoised}", subject.name),
            x: Axis::log("frames"),
            y: Axis::log("RMSE over mean radiance"),
            series: series.collect(),
        }
    };
    shown.into_iter().map(panel).collect()
}

/// How many times less variance each way has than hashed ξ.
fn summary(rows: &[Row]) -> Sheet {
    let mut sheet = Sheet::new(&[
        "interleave",
        "denoised",
        "method",
        "1 frame",
        "4 frames",
        "16 frames",
        "64 frames",
    ]);
    for width in WIDTHS {
        for is_denoised in [false, true] {
            for spread in Spread::ALL {
                let of = |spread: Spread| {
                    rows.iter().filter(move |row| {
                        (row.width, row.is_denoised, row.spread) == (width, is_denoised, spread)
                    })
                };
                if of(spread).next().is_none() {
                    continue;
                }
                let gain = |i: usize| {
                    let gains = of(Spread::Hashed)
                        .zip(of(spread))
                        .map(|(hashed, row)| 2.0 * (hashed.rmse[i].mean / row.rmse[i].mean).ln());
                    let gains: Vec<f64> = gains.collect();
                    let mean = gains.iter().sum::<f64>() / gains.len() as f64;
                    let least = gains.iter().copied().fold(f64::INFINITY, f64::min);
                    format!("{:.2} ({:.2})", mean.exp(), least.exp())
                };
                sheet.push([
                    width.into(),
                    yes_or_no(is_denoised).into(),
                    spread.name().into(),
                    gain(0).into(),
                    gain(1).into(),
                    gain(2).into(),
                    gain(3).into(),
                ]);
            }
        }
    }
    sheet
}
