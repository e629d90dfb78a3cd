//! Examples run as commands.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Runs the example that `cargo test` has built beside this test's own executable. With `--test`
/// cargo leaves it out, and it must be built before: `cargo build --profile test --examples`.
pub fn run<S: AsRef<OsStr>>(example: &str, arguments: impl IntoIterator<Item = S>) -> Output {
    command(example, arguments).output().expect(BUILT)
}

const BUILT: &str = "first run `cargo build --profile test --examples`, or all of `cargo test`";

fn command<S: AsRef<OsStr>>(example: &str, arguments: impl IntoIterator<Item = S>) -> Command {
    let name = format!("{example}{}", std::env::consts::EXE_SUFFIX);
    let mut command = Command::new(profile_folder().join("examples").join(name));
    command.args(arguments);
    command
}

/// What cargo has built tests and examples in.
fn profile_folder() -> PathBuf {
    let test = std::env::current_exe().expect("a test knows where it is");
    let profile = test.ancestors().nth(2).expect("tests lie in deps/");
    profile.to_path_buf()
}

/// Asserts that an example is content if nobody reads what it prints.
#[track_caller]
pub fn assert_needs_no_reader(example: &str, arguments: &[&str]) {
    let mut command = command(example, arguments);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect(BUILT);
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{error}");
    assert!(error.is_empty(), "{example} {arguments:?}: {error}");
}

/// A path for this test alone, with nothing there.
pub fn fresh_path(example: &str, test: &str) -> PathBuf {
    let path = profile_folder().join("tmp").join(example).join(test);
    if path.exists() {
        fs::remove_dir_all(&path).expect("leftovers can be removed");
    }
    path
}

pub fn fresh_folder(example: &str, test: &str) -> PathBuf {
    let folder = fresh_path(example, test);
    fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

/// The names of what is in `folder`, in their order.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder was made");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("readable").file_name();
    let mut names: Vec<String> = entries
        .map(|entry| name(entry).to_string_lossy().into())
        .collect();
    names.sort_unstable();
    names
}

/// Asserts that `output` refuses with status 2 and one line that contains `reason`.
#[track_caller]
pub fn assert_refusal(output: &Output, reason: &str) {
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
    assert!(error.starts_with("error: "), "{error}");
    assert!(error.contains(reason), "{error}");
    assert!(output.stdout.is_empty(), "{error}");
}

/// Asserts that `example` refuses `arguments` and writes nothing.
#[track_caller]
pub fn assert_refused(example: &str, test: &str, arguments: &[&str], reason: &str) {
    let out = fresh_path(example, test);
    let where_to = [OsStr::new("--out"), out.as_os_str()];
    let output = run(example, arguments.iter().map(OsStr::new).chain(where_to));
    assert_refusal(&output, reason);
    assert!(!out.exists(), "{arguments:?} wrote to {}", out.display());
}

/// Asserts that `example` does not write to a folder that is a file, or below one.
#[track_caller]
pub fn assert_leaves_files_alone(example: &str, arguments: &[&str]) {
    let folder = fresh_folder(example, "taken");
    let file = folder.join("file");
    fs::write(&file, "here first").expect("a file can be written");
    let file_name = file.to_str().expect("the path is UTF-8");
    for out in [file_name, &format!("{file_name}/below")] {
        let output = run(example, arguments.iter().chain(&["--out", out]));
        assert_refusal(&output, file_name);
    }
    assert_eq!(fs::read(&file).expect("still there"), b"here first");
}
