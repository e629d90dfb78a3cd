//! The studies: each measures one choice and draws one figure.

mod delta_sweep;
mod equal_time;
mod functions;
mod interleaving;
mod ltsd;
mod receivers;
mod spread;
mod tests;
mod tightness;
mod tile_borders;
mod vpl_count;
mod vsgl;

use image::RgbImage;

use crate::arguments::StudyKind;
use crate::figure::Figure;
use crate::sheet::Sheet;
use crate::subject::Subject;

/// What a study leaves behind.
pub struct Study {
    /// Of the files, without what follows the dot.
    pub name: &'static str,
    /// What the figure shows and how it is read, in a sentence or two.
    pub caption: &'static str,
    pub sheet: Sheet,
    /// What people read of it, if it is long.
    pub summary: Option<Sheet>,
    /// Frames to look at.
    pub picture: Option<RgbImage>,
    pub figure: Figure,
}

/// Makes a study of `subjects`, or several that belong together; calls `done` after each of their [`parts`].
pub fn make(kind: StudyKind, subjects: &[Subject], done: &dyn Fn()) -> Vec<Study> {
    let study = match kind {
        StudyKind::DeltaSweep => delta_sweep::make(subjects, done),
        StudyKind::EqualTime => equal_time::make(subjects, done),
        StudyKind::Functions => functions::make(&subjects[0].effort, done),
        StudyKind::Tightness => tightness::make(&subjects[0].effort, done),
        StudyKind::Tests => tests::make(subjects, done),
        StudyKind::VplCount => vpl_count::make(subjects, done),
        StudyKind::Interleaving => interleaving::make(subjects, done),
        StudyKind::Spread => spread::make(subjects, done),
        StudyKind::TileBorders => tile_borders::make(subjects, done),
        StudyKind::Vsgl => vsgl::make(subjects, done),
        StudyKind::Receivers => return receivers::make(subjects, done),
        StudyKind::Ltsd => return ltsd::make(subjects, done),
    };
    vec![study]
}

/// How many steps a study of so many subjects has.
pub fn parts(kind: StudyKind, subjects: usize) -> usize {
    match kind {
        StudyKind::Functions | StudyKind::Tightness => 1,
        StudyKind::Ltsd => ltsd::PARTS,
        StudyKind::Receivers => receivers::parts(subjects),
        StudyKind::EqualTime => subjects * equal_time::ROUGHNESSES.len(),
        StudyKind::Spread => subjects * spread::ROUGHNESSES.len(),
        StudyKind::Vsgl => subjects * vsgl::ROUGHNESSES.len(),
        _ => subjects,
    }
}

/// The setting that is varied one way at a time: as the example `render` has it.
const ROUGHNESS: f32 = 0.1;
const F0: f32 = 0.9;
pub const DELTA: f32 = 0.001;
const INTERLEAVE: u32 = 4;

/// What a figure of frames says of itself.
fn of_frames(subjects: &[Subject], rest: &str) -> String {
    let rays = format!("{} rays; {rest}", subjects[0].effort.vpls);
    of_any_rays(subjects, &rays)
}

/// Where there is more than one number of rays.
fn of_any_rays(subjects: &[Subject], rest: &str) -> String {
    let [width, height] = subjects[0].effort.size;
    format!("{width}×{height}, α = {ROUGHNESS}, F0 = {F0}, {rest}")
}
