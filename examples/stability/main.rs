//! Stiff and extreme cases, as a table: lights lost, volume added and accuracy, of the crate and of a
//! direct port of the papers' formulas to `f32`.
//!
//! ```text
//! cargo run --release --example stability -- --help
//! ```

mod arguments;
mod cell;
mod port;
mod quantities;
mod report;
mod tally;
mod thin_tiles;

use std::process::ExitCode;

use common::command::{self, say};
use common::progress;
use rayon::prelude::*;

use arguments::Arguments;
use cell::Cell;
use tally::Tally;

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        run(&arguments);
        Ok(())
    })
}

fn run(arguments: &Arguments) {
    let cells = Cell::all();
    let bar = progress::progress("cases", cells.len());
    let count = cells.len() as u64;
    let tallies: Vec<(Cell, Tally)> = cells
        .into_par_iter()
        .enumerate()
        .map(|(i, cell)| {
            let i = i as u64;
            let cases = arguments.cases / count + u64::from(i < arguments.cases % count);
            let tally = cell.measure(i, cases);
            bar.inc(1);
            (cell, tally)
        })
        .collect();
    bar.finish_and_clear();
    let thin = thin_tiles::measure(arguments.cases);

    let text = report::text(&tallies, &thin);
    if arguments.json {
        eprintln!("{text}");
        say(format_args!("{}", report::json(&tallies)));
    } else {
        say(format_args!("{text}"));
    }
}
