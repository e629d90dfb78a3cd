//! The example `render` as a command: what it refuses, and what it leaves behind.

mod files;
mod refusals;
mod runs;

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Output;

use serde_json::Value;
use support::command;

fn render<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Output {
    command::run("render", arguments)
}

fn fresh_path(test: &str) -> PathBuf {
    command::fresh_path("render", test)
}

fn fresh_folder(test: &str) -> PathBuf {
    command::fresh_folder("render", test)
}

#[track_caller]
fn assert_refused(test: &str, arguments: &[&str], reason: &str) {
    command::assert_refused("render", test, arguments, reason);
}

fn number(row: &Value, name: &str) -> f64 {
    row[name]
        .as_f64()
        .unwrap_or_else(|| panic!("{name} in {row}"))
}

/// The JSON and the names of the pictures of a small run.
fn small_run(test: &str, more: &[&str]) -> (Value, Vec<String>) {
    let out = fresh_path(test);
    let arguments = ["--size", "64x48", "--vpls", "256", "--json", "--out"];
    let arguments = arguments.iter().map(OsStr::new).chain([out.as_os_str()]);
    let output = render(arguments.chain(more.iter().map(OsStr::new)));
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{error}");
    let pictures = command::names_in(&out);
    for picture in &pictures {
        image::open(out.join(picture)).unwrap_or_else(|error| panic!("{picture}: {error}"));
    }
    let json = serde_json::from_slice(&output.stdout);
    (json.expect("standard output is one JSON object"), pictures)
}
