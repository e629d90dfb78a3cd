//! (h) Receivers: what it costs to leave their BRDF out of the probability, and what it is worth to put it in.

mod curve;
mod even;
mod gain;
mod ideal;
mod lists;
mod material;
mod score;
mod time;
mod way;

use super::Study;
use crate::subject::Subject;

/// The studies, each with a file of its own.
pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Vec<Study> {
    let mut studies = vec![ideal::make(subjects, done), lists::make(subjects, done)];
    studies.extend(time::make(subjects, done));
    studies
}

/// How many steps the studies have, of so many subjects.
pub fn parts(subjects: usize) -> usize {
    subjects * (2 + material::Material::ALL.len())
}
