//! The table of the tight bound is proved to enclose: some of its cells here, all of them by
//!
//! ```text
//! cargo run --release --example tabulate -- --prove
//! ```

mod certificate;

use certificate::{Cell, prove};
use rayon::prelude::*;

/// Cells from metals at normal incidence to dielectrics at grazing, smooth to rough.
#[test]
fn ellipsoids_of_some_cells_enclose() {
    let cells = [[0, 2, 5], [2, 12, 3], [4, 5, 1], [7, 18, 4]];
    let doubts: Vec<_> = cells
        .into_par_iter()
        .filter_map(|cell| prove(&Cell::at(cell), 5_000_000).err())
        .collect();
    assert!(doubts.is_empty(), "{doubts:?}");
}

/// What does not enclose is not proved to.
#[test]
fn shrunken_ellipsoids_are_not_proved() {
    let mut cell = Cell::at([4, 5, 3]);
    for knot in &mut cell.knots {
        for number in &mut knot[2..] {
            *number *= 0.95;
        }
    }
    assert!(prove(&cell, 100_000).is_err());
}
