//! Directions of a cap, in `f64`.

use std::f64::consts::TAU;

use stochastic_light_culling::Cap;

use crate::reference::Vector;

/// The direction of `cap` that is nearest to `direction`.
pub fn nearest(cap: &Cap, direction: Vector) -> Vector {
    let axis = Vector::from(*cap.axis()).unit();
    let chord = f64::from(cap.chord());
    if (direction - axis).length() <= chord {
        return direction;
    }
    let sideways = direction - axis * axis.dot(direction);
    if sideways.length() < 1e-12 {
        return axis;
    }
    // Where the two are close, what is left sideways is not quite at right angles.
    at_chord(axis, sideways.unit(), chord).unit()
}

/// Directions evenly over `cap`, and along its edge.
pub fn spiral(cap: &Cap) -> impl Iterator<Item = Vector> {
    let axis = Vector::from(*cap.axis()).unit();
    let chord = f64::from(cap.chord());
    let side = axis.orthogonal();
    (0..48).flat_map(move |step| {
        let azimuth = TAU * f64::from(step) * 0.618_034;
        let side = side.turned(axis.cross(side), azimuth);
        let share = (f64::from(step) / 47.0).sqrt();
        [chord * share, chord].map(|chord| at_chord(axis, side, chord))
    })
}

/// The direction at the distance `chord` from `axis`, towards `side`, a unit vector at right angles.
fn at_chord(axis: Vector, side: Vector, chord: f64) -> Vector {
    axis.turned(side, 2.0 * (0.5 * chord).min(1.0).asin())
}
