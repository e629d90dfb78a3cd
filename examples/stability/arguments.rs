//! The command line.

use clap::{Parser, error::ErrorKind};

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

impl Arguments {
    /// The arguments of this process; `Ok(None)` if help was asked for, and has been given.
    pub fn read() -> Result<Option<Self>, String> {
        match Self::try_parse() {
            Ok(arguments) => Ok(Some(arguments)),
            Err(error) => match error.kind() {
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                    error.print().map_err(|error| error.to_string())?;
                    Ok(None)
                }
                _ => Err(first_paragraph(&error)),
            },
        }
    }
}

/// What went wrong, without the usage after it, on one line.
fn first_paragraph(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let paragraph = lines.split(|line| line.is_empty()).next().unwrap_or(&[]);
    paragraph.join(" ").replacen("error: ", "", 1)
}
