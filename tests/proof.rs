//! The interval proof of the tight bound's table proves what is so, and refuses what is not.
//!
//! One cell here; any number of them, by the minute, with
//!
//! ```text
//! cargo run --release --example tabulate -- --prove
//! ```

mod certificate;

use certificate::{Cell, prove};

/// A rough, grazing cell, across which the horizon cuts the lobe.
#[test]
fn ellipsoids_of_a_cell_enclose() {
    let proved = prove(&Cell::at([7, 18, 4]), 1_000_000);
    assert!(proved.is_ok(), "{proved:?}");
}

#[test]
fn shrunken_ellipsoids_are_not_proved() {
    let mut cell = Cell::at([7, 18, 4]);
    for knot in &mut cell.knots {
        for number in &mut knot[2..] {
            *number *= 0.95;
        }
    }
    assert!(prove(&cell, 60_000).is_err());
}
