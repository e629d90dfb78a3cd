//! (l) One decision for all pixels of a tile: what is seen of the tiles' borders, and what removes them.
//!
//! Lights are drawn in several ways (`way`, `draw`), and the errors of pixels are compared with those of their
//! neighbours (`errors`, `tables`).

mod draw;
mod errors;
mod tables;
mod way;

use common::frame::{cross_bilateral, redraw};
use stochastic_light_culling::{Seed, glam::Vec3};

use self::draw::{delta_of_lists, light, tiles};
use self::errors::Errors;
use self::tables::{panels, sheet, sheet_of, summary};
use self::way::Way;
use super::{F0, INTERLEAVE, ROUGHNESS, Study};
use crate::baseline::fewer;
use crate::figure::Figure;
use crate::method::Stage;
use crate::subject::{Gloss, Subject};

/// Pixels of a subregion.
const TILE: u32 = 16;
const WIDTHS: [u32; 2] = [1, INTERLEAVE];
const FRAMES: [u32; 2] = [1, 16];
/// Lights in the list of a pixel, in the mean: δ is such that there are so many.
const LISTED: f64 = 24.0;

/// Pictures of one way.
pub struct Row<'a> {
    pub scene: &'a str,
    pub width: u32,
    pub is_denoised: bool,
    pub frames: u32,
    pub way: Way,
    pub lights_per_pixel: f64,
    pub errors: Errors,
}

pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Study {
    let small: Vec<Subject> = subjects.iter().map(Subject::half_as_large).collect();
    let (mut rows, mut picture) = (Vec::new(), None);
    for subject in &small {
        let mut columns = Vec::new();
        for width in WIDTHS {
            let stage = Stage::new(subject, Gloss::new(ROUGHNESS, F0), width);
            for way in Way::ALL {
                let (of_way, images) = measure(&stage, way);
                rows.extend(of_way);
                columns.push((way, images));
            }
        }
        picture.get_or_insert_with(|| sheet_of(subject, columns));
        done();
    }
    let panels = small.iter().flat_map(|subject| panels(subject, &rows));
    let [width, height] = small[0].effort.size;
    Study {
        name: "tile_borders",
        caption: "Lights drawn for tiles of 16×16 pixels, without knowing receivers, with the δ that gives a pixel a \
                  list of 24 lights; of these lists each pixel accepts by its own probability, or takes all. The figure has the correlation \
                  of the errors of two pixels of one frame, by their distance: a tile shows as one that stays high \
                  up to 16 pixels, or up to 64 with interleaving. In the table, border contrast is the mean squared \
                  step of the error across a border of tiles over that within, 1 where no border shows. The picture \
                  has a row for each way, in the order of the table: one frame, the magnitude of its error and the \
                  mean of 16 frames; then one frame of 4×4 subregions, denoised.",
        sheet: sheet(&rows),
        summary: Some(summary(&rows)),
        picture,
        figure: Figure {
            title: "Lights drawn for tiles: how far errors go together".into(),
            subtitle: format!(
                "{width}×{height}, {} rays, α = {ROUGHNESS}, F0 = {F0}, lists of {LISTED} lights, glossy lights alone",
                small[0].effort.vpls
            ),
            panels: panels.collect(),
        },
    }
}

/// Measures frames, and means of frames, without and with denoising. Returns some of the pictures too.
fn measure<'a>(stage: &Stage<'a>, way: Way) -> (Vec<Row<'a>>, Vec<Vec<Vec3>>) {
    let subject = stage.subject;
    // The least δ that there may be.
    let frame = stage.frame(1e-6);
    let mut lights = stage.lights(0);
    let frame = stage.frame(delta_of_lists(
        &tiles(&frame, &lights, [0; 2]),
        frame.roulette.delta(),
    ));
    let all = fewer::light(&frame, &lights, 1, 0);
    let [denoised] = cross_bilateral(&subject.surfaces, [&all], || ());
    let truths = [all, denoised];
    let mut errors = [(); 2].map(|()| FRAMES.map(|_| Errors::default()));
    let (mut images, mut listed) = (Vec::new(), 0.0);
    let unmoved = tiles(&frame, &lights, [0; 2]);
    let seeds = if subject.effort.is_quick { 2 } else { 4 };
    for seed in 0..seeds {
        let seed = Seed(subject.seed_of(seed));
        let mut sum = vec![Vec3::ZERO; truths[0].len()];
        for number in 0..FRAMES[1] {
            redraw(&mut lights, &stage.interleave, seed, number);
            let offset = way.offset(seed, number);
            let (image, count) = if offset == [0; 2] {
                light(way, &frame, &lights, &unmoved, (seed, number))
            } else {
                let moved = tiles(&frame, &lights, offset);
                light(way, &frame, &lights, &moved, (seed, number))
            };
            listed += count / f64::from(seeds * FRAMES[1]);
            for (sum, image) in sum.iter_mut().zip(image) {
                *sum += image;
            }
            let Some(i) = FRAMES.iter().position(|frames| *frames == number + 1) else {
                continue;
            };
            let mean: Vec<Vec3> = sum.iter().map(|sum| sum / FRAMES[i] as f32).collect();
            let [denoised] = cross_bilateral(&subject.surfaces, [&mean], || ());
            // A mean has borders of its own where no grid moves.
            let offset = if i == 0 { offset } else { [0; 2] };
            errors[0][i].add(&frame, &mean, &truths[0], offset);
            errors[1][i].add(&frame, &denoised, &truths[1], offset);
            if images.len() < 4 {
                images.extend([mean, denoised]);
            }
        }
    }
    let mut rows = Vec::new();
    for (is_denoised, errors) in [false, true].into_iter().zip(errors) {
        for (frames, errors) in FRAMES.into_iter().zip(errors) {
            rows.push(Row {
                scene: subject.name,
                width: stage.interleave.width(),
                is_denoised,
                frames,
                way,
                lights_per_pixel: listed,
                errors,
            });
        }
    }
    images.push(truths[0].clone());
    (rows, images)
}
