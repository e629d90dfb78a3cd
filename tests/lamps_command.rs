//! The example `lamps` as a command: its picture and its table, and what it refuses.

use support::command;

#[test]
fn draws_four_pictures_and_keeps_the_mean() {
    let folder = command::fresh_path("lamps", "draws");
    let few = ["--lamps", "200", "--width", "64", "--frames", "32", "--out"];
    let arguments = few
        .map(std::ffi::OsString::from)
        .into_iter()
        .chain([folder.clone().into_os_string()]);
    let output = command::run("lamps", arguments);
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success(), "{text}");
    // The mean of all light, in per cent, is the last column but two.
    let mean = |row: &str| -> f64 {
        let line = text
            .lines()
            .find(|line| line.starts_with(row))
            .expect("a row");
        let column = line.split_whitespace().rev().nth(2).expect("columns");
        column.trim_end_matches('%').parse().expect("a number")
    };
    assert!(mean("windows") < 90.0, "{text}");
    assert!((mean("roulette, 32 frames") - 100.0).abs() < 3.0, "{text}");
    let picture = std::fs::read(folder.join("lamps.png")).expect("a picture");
    assert_eq!(picture[16..24], [0, 0, 0, 128, 0, 0, 0, 72]);
}

#[test]
fn refuses_what_it_cannot_use() {
    for arguments in [
        ["--delta", "0"],
        ["--cut", "-1"],
        ["--lamps", "3"],
        ["--ev100", "nan"],
    ] {
        let folder = command::fresh_path("lamps", "refuses").into_os_string();
        let arguments = arguments.map(std::ffi::OsString::from).into_iter().chain([
            "--width".into(),
            "16".into(),
            "--out".into(),
            folder,
        ]);
        let output = command::run("lamps", arguments);
        assert_eq!(output.status.code(), Some(2));
        let error = String::from_utf8(output.stderr).expect("text");
        assert!(
            error.starts_with("error: ") && error.lines().count() == 1,
            "{error}"
        );
    }
}
