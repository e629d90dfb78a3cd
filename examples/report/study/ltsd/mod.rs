//! Linearly transformed cosines in the place of GGX lobes, at lights and at receivers [Xia et al. 2023]: how
//! far they are from GGX, and what they save.

mod fit;
mod model;
mod plane;
mod scenes;

use super::Study;
use crate::subject::Subject;

/// The four studies, each with a file of its own.
pub fn make(subjects: &[Subject], done: &dyn Fn()) -> Vec<Study> {
    let effort = &subjects[0].effort;
    let mut studies = vec![fit::make(effort)];
    done();
    studies.push(plane::make(effort));
    done();
    studies.push(scenes::of_scenes(subjects));
    done();
    studies.push(scenes::of_ring(&subjects[0]));
    done();
    studies
}

/// How many steps the studies have.
pub const PARTS: usize = 4;

/// The root of the mean squared difference of two pictures, of the linear values that a screen shows: `white`
/// and more is 1.
fn rmse<'a>(pixels: impl Iterator<Item = (&'a [f32; 3], &'a [f32; 3])>, white: f32) -> f64 {
    let (mut squares, mut count) = (0.0, 0_u32);
    for (one, other) in pixels {
        for (a, b) in one.iter().zip(other) {
            let [a, b] = [a, b].map(|x| f64::from((x / white).min(1.0)));
            squares += (a - b).powi(2);
            count += 1;
        }
    }
    (squares / f64::from(count.max(1))).sqrt()
}

/// The root of the summed squared difference over that of the squares of the `exact` picture.
fn relative_l2<'a>(pixels: impl Iterator<Item = (&'a [f32; 3], &'a [f32; 3])>) -> f64 {
    let (mut squares, mut of_errors) = (0.0, 0.0);
    for (found, exact) in pixels {
        for (a, b) in found.iter().zip(exact) {
            squares += f64::from(*b).powi(2);
            of_errors += f64::from(a - b).powi(2);
        }
    }
    (of_errors / squares).sqrt()
}
