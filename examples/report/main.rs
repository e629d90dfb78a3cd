//! Error against run time: what each choice that the crate offers costs, and what it is worth.
//!
//! ```text
//! cargo run --release --example report -- --help
//! ```
//!
//! Each study measures one choice on each scene, and leaves a CSV file and an SVG figure of the same
//! name; `report.md` holds all figures and tables.

mod arguments;
mod axis;
mod baseline;
mod figure;
mod method;
mod page;
mod room;
mod score;
mod sheet;
mod statistics;
mod study;
mod subject;

use std::path::Path;
use std::process::ExitCode;

use common::command;
use common::folder::make_folder;
use common::picture::write_png;
use common::progress::progress;
use common::scene::{Scene, Wanted};

use arguments::Arguments;
use page::Page;
use study::Study;
use subject::{Effort, Subject};

fn main() -> ExitCode {
    command::run(|arguments: Arguments| report(&arguments))
}

/// Whatever can be refused is, before anything is measured.
fn report(arguments: &Arguments) -> Result<(), String> {
    let effort = if arguments.quick {
        Effort::QUICK
    } else {
        Effort::FULL
    };
    let names = arguments.scenes();
    let load = |name: &String| Scene::load(name, &Wanted::default());
    let scenes: Vec<Scene> = names.iter().map(load).collect::<Result<_, _>>()?;
    let subjects: Vec<Subject> = names
        .iter()
        .zip(&scenes)
        .map(|(name, scene)| Subject::new(name, scene, effort, arguments.seed))
        .collect::<Result<_, _>>()?;
    make_folder(&arguments.out)?;

    let mut page = Page::new(arguments, &effort);
    page.print_head();
    for kind in arguments.studies() {
        let bar = progress("measuring", study::parts(kind, subjects.len()));
        let studies = study::make(kind, &subjects, &|| bar.inc(1));
        bar.finish_and_clear();
        for study in &studies {
            write(study, &arguments.out)?;
            page.add(study);
        }
    }
    page.write(&arguments.out)
}

/// Writes the files of a study.
fn write(study: &Study, out: &Path) -> Result<(), String> {
    let name = study.name;
    study.sheet.write(&out.join(format!("{name}.csv")))?;
    study.figure.write(&out.join(format!("{name}.svg")))?;
    match &study.picture {
        Some(picture) => write_png(out, &format!("{name}.png"), picture),
        None => Ok(()),
    }
}
