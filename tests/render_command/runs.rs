//! What small runs of `render` measure and draw.

use std::fs;

use serde_json::Value;

use crate::files::{glb, gltf};
use crate::{fresh_folder, number, small_run};

#[test]
fn draws_smooth_lights() {
    for clustering in ["fis", "kmeans"] {
        let smooth = ["--lights", "vsgl", "--clustering", clustering];
        let fewer = [&smooth[..], &["--clusters", "40", "--interleave", "2"]].concat();
        for (arguments, count) in [(&smooth[..], 1024), (&fewer, 40)] {
            let (json, pictures) = small_run(clustering, arguments);
            assert_eq!(json["lights"], "vsgl");
            assert_eq!(json["clusters"], count);
            assert_eq!(json["clustering"], clustering);
            let methods = json["methods"].as_array().expect("a list of methods");
            let kinds = methods.iter().map(|row| (&row["bound"], &row["refined"]));
            let [no, yes] = [false, true].map(Value::from);
            let tight = Value::from("tight");
            assert!(kinds.eq([(&tight, &no), (&tight, &yes)]));
            for row in methods.iter().chain([&json["diffuse"]]) {
                assert!(number(row, "contributing_per_pixel") > 0.0);
                assert!(number(row, "contributing_per_pixel") <= number(row, "lights_per_pixel"));
                assert!(number(row, "rmse") > 0.0);
            }
            // A light is accepted whatever the tile.
            let accepted = |i: usize| number(&methods[i], "contributing_per_pixel");
            assert_eq!(accepted(0), accepted(1));
            assert!(pictures.contains(&"indirect.png".into()));
        }
    }
    let (points, _) = small_run("points", &["--lights", "vpl"]);
    assert_eq!(points["lights"], "vpl");
    assert_eq!(points["clusters"], Value::Null);
}

#[test]
fn lights_receivers_with_and_without_knowing_them() {
    // Coarse, so that something is left to chance.
    let coat = ["--receiver-alpha", "0.3", "--receiver-f0", "0.5"];
    let coarse = ["--delta", "1", "--tile", "4", "--interleave", "1"];
    let arguments = [&coarse[..], &["--bound", "tight"], &coat].concat();
    let (json, pictures) = small_run("receivers", &arguments);
    for name in ["receivers.png", "receivers-all.png"] {
        assert!(pictures.contains(&name.into()), "{pictures:?}");
    }
    let methods = json["methods"].as_array().expect("a list of methods");
    let names: Vec<&Value> = methods.iter().map(|row| &row["bound"]).collect();
    let expected = [
        "tight",
        "tight",
        "blind",
        "blind tile",
        "aware",
        "aware tile",
    ];
    assert_eq!(names, expected);
    for row in &methods[2..] {
        assert!(number(row, "contributing_per_pixel") > 0.0);
        assert!(number(row, "contributing_per_pixel") <= number(row, "lights_per_pixel"));
        assert!(number(row, "rmse") > 0.0);
    }
    // What a pixel accepts blindly does not depend on what it reflects.
    assert!(
        number(&methods[2], "contributing_per_pixel")
            <= number(&methods[1], "contributing_per_pixel")
    );

    let (without, _) = small_run("no_receivers", &["--bound", "tight"]);
    let methods = without["methods"].as_array().expect("a list of methods");
    assert_eq!(methods.len(), 2);
}

#[test]
fn measures_every_bound() {
    let (json, pictures) = small_run("small", &["--alpha", "0.1", "--seed", "3"]);
    let [indirect, lights, picture] = ["indirect", "lights", "picture"];
    let bounds = ["sphere", "enclosing", "spheroid", "triaxial", "tight"];
    let mut expected: Vec<String> = bounds
        .into_iter()
        .flat_map(|bound| ["", "-refined"].map(|kind| format!("{lights}-{bound}{kind}.png")))
        .collect();
    expected.extend([indirect, picture, "reference"].map(|name| format!("{name}.png")));
    expected.sort_unstable();
    assert_eq!(pictures, expected);

    assert_eq!(json["scene"], "ring");
    assert_eq!(json["alpha"], 0.1);
    assert_eq!(json["f0"], 0.9);
    assert_eq!(json["delta"], 0.001);
    assert_eq!(json["vpls"], 256);
    assert_eq!(json["size"], serde_json::json!([64, 48]));
    assert_eq!(json["seed"], 3);

    let methods = json["methods"].as_array().expect("a list of methods");
    let by_kind = |refined: bool| {
        let rows = methods.iter().filter(move |row| row["refined"] == refined);
        let rows: Vec<&Value> = rows.collect();
        let names: Vec<&Value> = rows.iter().map(|row| &row["bound"]).collect();
        assert_eq!(names, bounds);
        rows
    };
    let kinds = [by_kind(false), by_kind(true)];
    assert_eq!(json["diffuse"]["refined"], false);
    for row in methods.iter().chain([&json["diffuse"]]) {
        for name in ["cull_ms", "shade_ms", "rmse"] {
            assert!(number(row, name) >= 0.0);
        }
        let [all, contributing, false_positives] = [
            "lights_per_pixel",
            "contributing_per_pixel",
            "false_positives_per_pixel",
        ]
        .map(|name| number(row, name));
        assert!(contributing > 0.0);
        assert!((all - contributing - false_positives).abs() < 1e-9);
    }
    let [tiles, pixels] = &kinds;
    let refinements = tiles.iter().zip(pixels).map(|(a, b)| [a, b]);
    // The smallest ellipsoid is not inside the others, though it mostly lists fewer lights.
    let nested = kinds.iter().map(|rows| &rows[..4]);
    let bounds = nested.flat_map(|rows| rows.windows(2));
    let bounds = bounds.map(|pair| [&pair[0], &pair[1]]);
    for [looser, tighter] in refinements.chain(bounds) {
        assert!(number(tighter, "lights_per_pixel") <= number(looser, "lights_per_pixel"));
    }
    for row in methods {
        assert_eq!(
            row["contributing_per_pixel"],
            methods[0]["contributing_per_pixel"]
        );
        assert_eq!(row["rmse"], methods[0]["rmse"]);
    }
}

#[test]
fn measures_what_is_asked_for() {
    let asked = ["--bound", "spheroid", "--reference", "off", "--no-denoise"];
    let (json, pictures) = small_run("asked", &asked);
    let lights = ["lights-spheroid-refined.png", "lights-spheroid.png"];
    let expected = [&["indirect.png"], &lights[..], &["picture.png"]];
    assert_eq!(pictures, expected.concat());
    let methods = json["methods"].as_array().expect("a list of methods");
    assert_eq!(methods.len(), 2);
    for (row, refined) in methods.iter().zip([false, true]) {
        assert_eq!(
            (&row["bound"], &row["refined"]),
            (&"spheroid".into(), &refined.into())
        );
        assert!(row["rmse"].is_null());
    }
}

#[test]
fn renders_the_box() {
    let (json, pictures) = small_run("box", &["--scene", "cornell"]);
    assert_eq!(json["scene"], "cornell");
    assert_eq!(pictures.len(), 13);
    assert!(number(&json["diffuse"], "contributing_per_pixel") > 0.0);
}

#[test]
fn renders_a_mesh_without_materials() {
    let folder = fresh_folder("mesh");
    let tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    let with_missing_library = format!("mtllib missing.mtl\nusemtl gone\n{tetrahedron}");
    for (name, content) in [
        ("plain.obj", tetrahedron.as_bytes()),
        ("missing.obj", with_missing_library.as_bytes()),
        ("one.gltf", gltf(3, 36).as_bytes()),
        ("one.glb", &glb()),
        ("one.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    ] {
        let path = folder.join(name);
        fs::write(&path, content).expect("a file can be written");
        let path = path.to_str().expect("the path is UTF-8");
        let (json, _) = small_run("mesh_out", &["--scene", path]);
        assert_eq!(json["scene"], path);
        assert!(number(&json["diffuse"], "lights_per_pixel") >= 0.0);
    }
}
