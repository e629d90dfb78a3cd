//! Makes the table of the tight bound, and proves that its ellipsoids enclose. Makes the table of linearly
//! transformed cosines too, and prints its errors.
//!
//! ```text
//! cargo run --release --example tabulate                 # writes src/bound/table.bin
//! cargo run --release --example tabulate -- --prove      # proves the one that is there, in minutes
//! cargo run --release --example tabulate -- --ltc        # writes src/lobe/ltc.bin
//! cargo run --release --example tabulate -- --ltc-errors # prints the errors of the one that is there, as CSV
//! ```

mod fit;
mod ltc;
mod ltc_errors;
mod make;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use common::command::{self, say};
use common::progress;
use rayon::prelude::*;
use support::certificate::{self, Cell};

/// The table of smallest ellipsoids behind the tight bound.
#[derive(Parser)]
struct Arguments {
    /// Prove the table that is there, instead of making it.
    #[arg(long)]
    prove: bool,
    /// Make the table of linearly transformed cosines.
    #[arg(long, conflicts_with = "prove")]
    ltc: bool,
    /// Print how far the linearly transformed cosines are from GGX.
    #[arg(long, conflicts_with_all = ["prove", "ltc"])]
    ltc_errors: bool,
    /// Boxes after which a cell is given up.
    #[arg(long, default_value_t = 10_000_000)]
    boxes: usize,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        if arguments.prove {
            prove(&arguments)
        } else if arguments.ltc_errors {
            ltc_errors::print();
            Ok(())
        } else if arguments.ltc {
            write("src/lobe/ltc.bin", &ltc::table())
        } else {
            let bytes: Vec<u8> = make::table().iter().flat_map(|x| x.to_le_bytes()).collect();
            write("src/bound/table.bin", &bytes)
        }
    })
}

fn write(path: &str, bytes: &[u8]) -> Result<(), String> {
    let path = format!("{}/{path}", env!("CARGO_MANIFEST_DIR"));
    std::fs::write(&path, bytes).map_err(|error| format!("{path}: {error}"))
}

fn prove(arguments: &Arguments) -> Result<(), String> {
    let cells = Cell::all();
    let (count, start) = (cells.len(), Instant::now());
    let bar = progress::progress("cells", count);
    let results: Vec<_> = cells
        .into_par_iter()
        .map(|cell| {
            let result = certificate::prove(&cell, arguments.boxes);
            bar.inc(1);
            if let Err(doubt) = result {
                bar.suspend(|| eprintln!("in doubt: {doubt:?}"));
            }
            result
        })
        .collect();
    bar.finish_and_clear();
    let boxes: usize = results.iter().filter_map(|r| r.as_ref().ok()).sum();
    let doubts = results.iter().filter(|r| r.is_err()).count();
    let seconds = start.elapsed().as_secs();
    say(format_args!(
        "{count} cells, {doubts} in doubt, {boxes} boxes, {seconds} s"
    ));
    if doubts == 0 {
        Ok(())
    } else {
        Err(format!("{doubts} cells are in doubt"))
    }
}
