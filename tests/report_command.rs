//! The example `report` as a command: what it refuses, and what it leaves behind.

use std::collections::{HashMap, HashSet};
use std::fs;

use support::command::{self, assert_refused, fresh_folder, fresh_path, run};

#[test]
fn refuses_what_it_does_not_know() {
    for (argument, reason) in [
        ("--study=colour", "'colour'"),
        ("--scene=no/such.obj", "no/such.obj"),
        ("--seed=-1", "-1"),
        ("--seeds=3", "--seeds"),
        ("extra", "'extra'"),
    ] {
        assert_refused("report", "unknown", &["--quick", argument], reason);
    }
}

#[test]
fn refuses_scenes_without_glossy_lights_or_geometry() {
    let folder = fresh_folder("report", "scenes");
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl chalk\nf 1 3 2\n";
    let chalk = "newmtl chalk\nKd 0.5 0.5 0.5\n";
    for (name, text, reason) in [
        ("empty.obj", "", "no triangles"),
        ("chalk.obj", triangle, "no glossy lights"),
    ] {
        let path = folder.join(name);
        fs::write(folder.join("chalk.mtl"), chalk).expect("a file can be written");
        fs::write(&path, format!("mtllib chalk.mtl\n{text}")).expect("a file can be written");
        let path = path.to_str().expect("the path is UTF-8");
        assert_refused("report", "no_scene", &["--quick", "--scene", path], reason);
    }
}

#[test]
fn refuses_a_folder_that_is_a_file() {
    command::assert_leaves_files_alone("report", &["--quick", "--scene", "ring"]);
}

/// The columns of a CSV file by name.
type Columns = HashMap<String, Vec<String>>;

/// All that a quick run leaves.
fn quick_run(test: &str, more: &[&str]) -> HashMap<String, Columns> {
    let out = fresh_path("report", test);
    let folder = out.to_str().expect("the path is UTF-8");
    let arguments = ["--quick", "--out", folder];
    let output = run("report", arguments.iter().chain(more));
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{error}");

    let names = command::names_in(&out);
    assert!(names.contains(&"report.md".into()), "{names:?}");
    let page = fs::read_to_string(out.join("report.md")).expect("the page is text");
    names
        .iter()
        .filter_map(|name| name.strip_suffix(".csv"))
        .map(|name| {
            let svg = fs::read_to_string(out.join(format!("{name}.svg"))).expect("a figure");
            assert!(
                svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
                "{name}"
            );
            // As wide as a page, with ticks such as 10⁻⁵, not 1e-5.
            assert!(svg.contains(r#"width="800""#), "{name}");
            let is_power = |line: &&str| line.contains('e') && line.trim().parse::<f64>().is_ok();
            assert_eq!(svg.lines().find(is_power), None, "{name}");
            assert!(page.contains(&format!("({name}.svg)")), "{name}");
            let mut reader =
                csv::Reader::from_path(out.join(format!("{name}.csv"))).expect("a file");
            let header = reader.headers().expect("a header").clone();
            let rows: Vec<csv::StringRecord> =
                reader.records().collect::<Result<_, _>>().expect("a table");
            assert!(!rows.is_empty(), "{name}");
            let column = |(i, column): (usize, &str)| {
                (
                    column.to_owned(),
                    rows.iter().map(|row| row[i].to_owned()).collect(),
                )
            };
            (
                name.to_owned(),
                header.iter().enumerate().map(column).collect(),
            )
        })
        .collect()
}

fn numbers(columns: &Columns, name: &str) -> Vec<f64> {
    let cells = columns
        .get(name)
        .unwrap_or_else(|| panic!("no column {name}"));
    cells
        .iter()
        .map(|cell| cell.parse().unwrap_or(f64::NAN))
        .collect()
}

#[test]
fn makes_every_study_of_the_ring() {
    check_every_study("ring");
}

#[test]
fn makes_every_study_of_the_box() {
    check_every_study("cornell");
}

fn check_every_study(scene: &str) {
    let studies = quick_run(scene, &["--scene", scene]);
    let mut names: Vec<&str> = studies.keys().map(|name| &**name).collect();
    names.sort_unstable();
    assert_eq!(
        names,
        [
            "delta_sweep",
            "equal_time",
            "functions",
            "interleaving",
            "ltsd_fit",
            "ltsd_plane",
            "ltsd_ring",
            "ltsd_scenes",
            "receivers",
            "receivers_equal_time",
            "receivers_even",
            "receivers_lists",
            "receivers_time",
            "spread",
            "tests",
            "tightness",
            "tile_borders",
            "vpl_count",
            "vsgl"
        ]
    );

    let sweep = &studies["delta_sweep"];
    let [delta, ms, error, bias] =
        ["delta", "ms", "relative_rmse", "relative_bias"].map(|name| numbers(sweep, name));
    assert!(ms.iter().all(|ms| *ms > 0.0));
    for (method, i) in sweep["method"].iter().zip(0..) {
        // The picture does not depend on what encloses the lights.
        let same = (0..delta.len()).filter(|j| delta[*j] == delta[i]);
        for j in same.filter(|_| !method.contains("clamped")) {
            let is_clamped = sweep["method"][j].contains("clamped");
            assert!(
                is_clamped || error[j] == error[i],
                "{method} and {}",
                sweep["method"][j]
            );
        }
        // Lights that end are missing.
        if method.contains("clamped") && delta[i] > 0.005 {
            assert!(bias[i] < -0.02, "{method}: {} at δ = {}", bias[i], delta[i]);
        }
    }
    let of = |columns: &Columns, name: &str| numbers(columns, name);
    let tightness = &studies["tightness"];
    for (tight, attainable) in of(tightness, "tight")
        .iter()
        .zip(of(tightness, "attainable"))
    {
        assert!(*tight >= 0.99 * attainable, "{tight} under {attainable}");
    }
    let tests = &studies["tests"];
    assert!(
        of(tests, "false_discovery_rate")
            .iter()
            .all(|rate| (0.0..1.0).contains(rate))
    );
    let receivers = &studies["receivers"];
    let [blind, knowing] = ["relative_deviation", "relative_deviation_knowing_receiver"]
        .map(|name| of(receivers, name));
    assert!(
        blind
            .iter()
            .zip(&knowing)
            .all(|(blind, knowing)| blind > knowing)
    );
    check_receivers(&studies["receivers_time"], &studies["receivers_equal_time"]);
    let missing = of(&studies["receivers_lists"], "missing");
    assert!(missing.iter().all(|missing| *missing == 0.0));
    check_smooth_lights(&studies["vsgl"]);
    let fit = &studies["ltsd_fit"];
    let [f0, error, energy] = ["f0", "relative_l2", "energy"].map(|name| of(fit, name));
    for ((f0, error), energy) in f0.iter().zip(error).zip(energy) {
        // The promise is for F = 1. A quick run has few nodes.
        let most = if *f0 == 1.0 { 0.01 } else { 0.02 };
        assert!(
            error < 1.0 && (energy - 1.0).abs() < most,
            "{error} {energy}"
        );
        assert!([1.0, 0.04].contains(f0));
    }
    for name in ["ltsd_scenes", "ltsd_ring"] {
        let study = &studies[name];
        let rmse = of(study, "rmse");
        for (i, model) in study["model"].iter().enumerate() {
            assert_eq!(model, ["ggx", "ltc"][i % 2]);
            assert_eq!(rmse[i] > 0.0, model == "ltc");
            assert!(rmse[i] < 0.05, "{name}: {}", rmse[i]);
        }
    }
    let functions = &studies["functions"];
    for (name, error) in functions["function"]
        .iter()
        .zip(of(functions, "max_relative_error"))
    {
        let is_number = !["tests", "bounds"].contains(&&*functions["kind"][0]);
        assert!(!is_number || error < 0.5, "{name}: {error}");
    }
}

fn check_receivers(time: &Columns, equal_time: &Columns) {
    let methods: HashSet<&str> = time["method"].iter().map(|s| &**s).collect();
    assert_eq!(methods.len(), 13, "{methods:?}");
    let receivers: HashSet<&str> = time["receiver"].iter().map(|s| &**s).collect();
    assert_eq!(receivers.len(), 7, "{receivers:?}");
    let [ms, rmse, sigma] =
        ["ms", "relative_rmse", "sigma_over_mean"].map(|name| numbers(time, name));
    assert!(ms.iter().all(|ms| *ms > 0.0));
    for (method, rmse) in time["method"].iter().zip(rmse) {
        // All lights alone leave no error.
        assert_eq!(rmse > 0.0, method != "all lights", "{method}");
    }
    // The finest setting of a curve leaves less than the coarsest.
    let rows: Vec<usize> = (0..sigma.len()).collect();
    let curves = rows.chunk_by(|a, b| time["method"][*a] == time["method"][*b]);
    for curve in curves.filter(|curve| curve.len() > 1) {
        let [coarsest, finest] = [curve[0], curve[curve.len() - 1]];
        let (method, receiver) = (&time["method"][finest], &time["receiver"][finest]);
        assert!(sigma[finest] < sigma[coarsest], "{method}, {receiver}");
    }
    let gains = numbers(equal_time, "variance_gain");
    for (method, gain) in equal_time["method"].iter().zip(gains) {
        assert!(gain > 0.0, "{method}");
        assert_eq!(gain == 1.0, method == "blind exact", "{method}");
    }
}

fn check_smooth_lights(study: &Columns) {
    let methods: HashSet<&str> = study["method"].iter().map(|s| &**s).collect();
    let all = ["vpl", "vsgl", "vsgl_culled", "kmeans"];
    assert_eq!(methods, HashSet::from(all));
    for name in ["alpha", "lights", "ms"] {
        assert!(
            numbers(study, name).iter().all(|number| *number > 0.0),
            "{name}"
        );
    }
    let rmse = numbers(study, "relative_rmse");
    assert!(rmse.iter().all(|rmse| *rmse >= 0.0));
}

#[test]
fn makes_the_study_asked_for_of_both_scenes() {
    let studies = quick_run("one", &["--study", "receivers"]);
    let mut names: Vec<&String> = studies.keys().collect();
    names.sort_unstable();
    let parts = ["equal_time", "even", "lists", "time"].map(|part| format!("receivers_{part}"));
    assert_eq!(names[0], "receivers");
    assert!(names[1..].iter().copied().eq(&parts), "{names:?}");
    let scenes: HashSet<&str> = studies["receivers"]["scene"].iter().map(|s| &**s).collect();
    assert_eq!(scenes, HashSet::from(["ring", "cornell"]));
}
