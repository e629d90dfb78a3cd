//! What all examples do with their command line: whatever is wrong is said in one line, with status 2. They
//! print by [`say`], not by `println!`, which panics once nobody reads.

use std::fmt::Arguments;
use std::io;
use std::io::{ErrorKind::BrokenPipe, Write};
use std::process::ExitCode;

use clap::{Parser, error::ErrorKind};

/// Does `work` with the arguments of this process, or gives the help that they ask for.
pub fn run<A: Parser>(work: impl FnOnce(A) -> Result<(), String>) -> ExitCode {
    let outcome = match A::try_parse() {
        Ok(arguments) => work(arguments),
        Err(error) => match error.kind() {
            ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
                said(error.print());
                Ok(())
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

/// Prints `line` to standard output. Gives whether anybody reads: there is nothing wrong if nobody does.
pub fn say(line: Arguments) -> bool {
    said(writeln!(io::stdout(), "{line}"))
}

/// Whether it could be printed; ends the process if it could not though somebody reads.
fn said(printed: io::Result<()>) -> bool {
    match printed {
        Ok(()) => true,
        Err(error) if error.kind() == BrokenPipe => false,
        Err(error) => {
            eprintln!("error: cannot print: {error}");
            std::process::exit(2)
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
