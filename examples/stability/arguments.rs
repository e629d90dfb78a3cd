//! The command line.

use clap::Parser;

/// Tests stiff and extreme lights against tiles that they reach, and measures the accuracy of each
/// formula, beside a direct port of the papers' formulas.
#[derive(Debug, Parser)]
#[command(name = "stability", version)]
pub struct Arguments {
    /// How many pairs of a light and a tile that it reaches
    #[arg(long, default_value_t = 1_000_000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    pub cases: u64,

    /// Print one JSON object to standard output, and the tables to standard error
    #[arg(long)]
    pub json: bool,
}
