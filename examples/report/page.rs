//! All studies on one page: on standard output, and as Markdown beside the figures.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

use common::command::say;

use crate::arguments::Arguments;
use crate::study::Study;
use crate::subject::Effort;

pub struct Page {
    head: String,
    studies: String,
}

impl Page {
    /// What was measured, when, and on what.
    pub fn new(arguments: &Arguments, effort: &Effort) -> Self {
        let date = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        let date = date.split('T').next().unwrap_or_default().to_owned();
        let [width, height] = effort.size;
        let head = format!(
            "{} {} on {date}: {}, {} threads, {}; scenes {}; {width}×{height}, {} rays, {} seeds from {}{}",
            env!("CARGO_PKG_NAME"),
            env!("CARGO_PKG_VERSION"),
            processor(),
            rayon::current_num_threads(),
            compiler(),
            arguments.scenes().join(" and "),
            effort.vpls,
            effort.seeds,
            arguments.seed,
            if effort.is_quick {
                "; a quick look, not to be quoted"
            } else {
                ""
            },
        );
        Self {
            head,
            studies: String::new(),
        }
    }

    pub fn print_head(&self) {
        say(format_args!("{}", self.head));
    }

    /// Prints the study's table, and adds its figure too.
    pub fn add(&mut self, study: &Study) {
        let Study {
            name,
            caption,
            sheet,
            summary,
            picture,
            figure,
        } = study;
        let table = summary.as_ref().unwrap_or(sheet).markdown();
        say(format_args!("\n{}: {name}\n\n{table}", figure.title));
        let title = &figure.title;
        let picture = match picture {
            Some(_) => format!("![{title}: frames]({name}.png)\n\n"),
            None => String::new(),
        };
        let _ = write!(
            self.studies,
            "\n## {title}\n\n![{title}]({name}.svg)\n\n{picture}{caption}\n\n{table}\n\n[{name}.csv]({name}.csv)\n"
        );
    }

    /// Writes `report.md`, all of it or nothing.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let (path, unfinished) = (folder.join("report.md"), folder.join("report.md.part"));
        let text = format!(
            "# Error against run time\n\nMade by `cargo run --release --example report`.\n\n{}.\n{}",
            self.head, self.studies
        );
        std::fs::write(&unfinished, text)
            .and_then(|()| std::fs::rename(&unfinished, &path))
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        say(format_args!(
            "\nfigures, tables and all: {}",
            path.display()
        ));
        Ok(())
    }
}

/// The processor's name, where the system tells it.
fn processor() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or_else(
        || std::env::consts::ARCH.into(),
        |(_, name)| name.trim().into(),
    )
}

fn compiler() -> String {
    let version = Command::new("rustc").arg("--version").output();
    version
        .ok()
        .and_then(|output| String::from_utf8(output.stdout).ok())
        .map_or_else(
            || "rustc unknown".into(),
            |version| version.split(" (").next().unwrap_or_default().trim().into(),
        )
}
