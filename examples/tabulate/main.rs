//! Makes the table of the tight bound, and proves that its ellipsoids enclose. Makes the tables of clusters and of
//! linearly transformed cosines too, and that of the inequalities behind the bound of the latter.
//!
//! ```text
//! cargo run --release --example tabulate                 # writes src/bound/table.bin
//! cargo run --release --example tabulate -- --prove      # proves those of the tight bound and of clusters, in minutes
//! cargo run --release --example tabulate -- --cluster    # writes src/bound/cluster.bin
//! cargo run --release --example tabulate -- --ltc        # writes src/lobe/ltc.bin
//! cargo run --release --example tabulate -- --ltc-bound  # writes src/bound/ltc_rows.bin, for the table of --ltc
//! ```

mod cluster;
mod fit;
mod ltc;
mod ltc_rows;
mod make;

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use common::command::{self, say};
use common::progress;
use rayon::prelude::*;
use support::certificate::{self, Cell, ClusterCell};

/// The table of smallest ellipsoids behind the tight bound.
#[derive(Parser)]
#[allow(clippy::struct_excessive_bools, reason = "flags of a command line")]
struct Arguments {
    /// Prove the table that is there, instead of making it.
    #[arg(long)]
    prove: bool,
    /// Make the table of ellipsoids around clusters.
    #[arg(long, conflicts_with = "prove")]
    cluster: bool,
    /// Make the table of linearly transformed cosines.
    #[arg(long, conflicts_with_all = ["prove", "cluster"])]
    ltc: bool,
    /// Make the table of inequalities behind the bound of linearly transformed cosines.
    #[arg(long, conflicts_with_all = ["prove", "cluster", "ltc"])]
    ltc_bound: bool,
    /// Boxes after which a cell is given up.
    #[arg(long, default_value_t = 10_000_000)]
    boxes: usize,
}

fn main() -> ExitCode {
    command::run(|arguments: Arguments| {
        if arguments.prove {
            prove(&arguments)
        } else if arguments.cluster {
            write("src/bound/cluster.bin", &cluster::table())
        } else if arguments.ltc_bound {
            write("src/bound/ltc_rows.bin", &ltc_rows::table())
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
    let of_clusters: Vec<_> = ClusterCell::all()
        .into_par_iter()
        .map(|cell| cell.prove(arguments.boxes))
        .collect();
    let count = count + of_clusters.len();
    let boxes = of_clusters.iter().flatten().sum::<usize>()
        + results
            .iter()
            .filter_map(|r| r.as_ref().ok())
            .sum::<usize>();
    for doubt in of_clusters.iter().filter_map(|r| r.as_ref().err()) {
        eprintln!("in doubt at √w, √t and height {doubt:?}");
    }
    let doubts = results.iter().filter(|r| r.is_err()).count()
        + of_clusters.iter().filter(|r| r.is_err()).count();
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
