//! Error against run time: what each choice that the crate offers costs, and what it is worth.
//!
//! ```text
//! cargo run --release --example report -- --help
//! ```
//!
//! Each study measures one choice on each scene, and leaves a CSV file and an SVG figure of the same
//! name; `report.md` holds all figures and tables.

#[path = "report/arguments.rs"]
mod arguments;
#[path = "report/axis.rs"]
mod axis;
#[path = "report/baseline/mod.rs"]
mod baseline;
mod command;
#[path = "report/figure.rs"]
mod figure;
#[path = "output/folder.rs"]
mod folder;
mod frame;
#[path = "report/method.rs"]
mod method;
#[path = "report/page.rs"]
mod page;
#[path = "output/progress.rs"]
mod progress;
#[path = "../tests/reference/mod.rs"]
mod reference;
#[path = "report/room.rs"]
mod room;
mod scene;
#[path = "report/score.rs"]
mod score;
#[path = "report/sheet.rs"]
mod sheet;
#[path = "report/statistics.rs"]
mod statistics;
#[path = "report/study/mod.rs"]
mod study;
#[path = "report/subject.rs"]
mod subject;
#[path = "../tests/tightness/mod.rs"]
mod tightness;

use std::process::ExitCode;

use arguments::Arguments;
use folder::make_folder;
use page::Page;
use progress::progress;
use scene::Scene;
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
    let load = |name: &String| Scene::load(name, &[]);
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
        let study = study::make(kind, &subjects, &|| bar.inc(1));
        bar.finish_and_clear();
        study
            .sheet
            .write(&arguments.out.join(format!("{}.csv", study.name)))?;
        study
            .figure
            .write(&arguments.out.join(format!("{}.svg", study.name)))?;
        page.add(&study);
    }
    page.write(&arguments.out)
}
