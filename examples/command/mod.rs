//! What all examples do with their command line: whatever is wrong is said in one line, with status 2.

use std::process::ExitCode;

use clap::{Parser, error::ErrorKind};

/// Does `work` with the arguments of this process, or gives the help that they ask for.
pub fn run<A: Parser>(work: impl FnOnce(A) -> Result<(), String>) -> ExitCode {
    let outcome = match A::try_parse() {
        Ok(arguments) => work(arguments),
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                error.print().map_err(|error| error.to_string())
            }
            _ => Err(first_paragraph(&error)),
        },
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
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
