//! The example `render` as a command: what it refuses, and what it leaves behind.

use std::ffi::OsStr;
use std::fs;
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

#[test]
fn refuses_values_outside_their_range() {
    for (arguments, reason) in [
        (["--alpha", "0"], "roughness α is 0"),
        (["--alpha", "NaN"], "roughness α is NaN"),
        (["--alpha", "rough"], "'rough'"),
        (["--f0", "1.5"], "F0 is 1.5"),
        (["--f0", "-0.1"], "-0.1"),
        (["--receiver-alpha", "0"], "roughness α is 0"),
        (["--receiver-alpha", "smooth"], "'smooth'"),
        (["--receiver-f0", "2"], "F0 is 2"),
        (["--delta", "0"], "δ is 0"),
        (["--delta", "inf"], "δ is inf"),
        (["--vpls", "0"], "'0'"),
        (["--size", "0x0"], "'0x0'"),
        (["--size", "640"], "'640'"),
        (["--size", "-1x5"], "-1x5"),
        (["--size", "99999x99999"], "'99999x99999'"),
        (["--size", "16384x32"], "aspect ratio is 512"),
        (["--tile", "0"], "tile size is 0×0"),
        (["--interleave", "0"], "interleaving width is 0×0"),
        (["--interleave", "361"], "interleaving width is 361×361"),
        (["--bound", "cube"], "'cube'"),
        (["--reference", "half"], "'half'"),
        (["--seed", "-1"], "-1"),
        (["--colour", "red"], "--colour"),
        (["--glossy", "Gold"], "Gold"),
        (["--lights", "lamps"], "'lamps'"),
        (["--clusters", "0"], "'0'"),
        (["--clusters", "16"], "--lights vsgl"),
        (["--clustering", "fis"], "--lights vsgl"),
        (["--clustering", "colour"], "'colour'"),
    ] {
        // `=`, so that a negative number is not taken for an option.
        assert_refused("ranges", &[&arguments.join("=")], reason);
    }
}

#[test]
fn refuses_bounds_that_smooth_lights_do_not_have() {
    let arguments = ["--lights", "vsgl", "--bound", "sphere"];
    assert_refused("smooth_bound", &arguments, "one bound, tight");
    let arguments = ["--lights", "vsgl", "--receiver-f0", "0.5"];
    assert_refused("smooth_receivers", &arguments, "--lights vpl");
}

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
fn refuses_files_that_are_no_scene() {
    let folder = fresh_folder("scenes");
    let corner = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (name, text, reason) in [
        ("empty.obj", String::new(), "no triangles"),
        ("points.obj", corner.into(), "no triangles"),
        (
            "line.obj",
            "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".into(),
            "no triangles",
        ),
        (
            "nan.obj",
            corner.replace("1 0 0", "nan 0 0") + "f 1 2 3\n",
            "NaN",
        ),
        (
            "infinite.obj",
            corner.replace("1 0 0", "1e99 0 0") + "f 1 2 3\n",
            "inf",
        ),
        (
            "far.obj",
            corner.replace("1 0 0", "1e30 0 0") + "f 1 2 3\n",
            "10⁹",
        ),
        ("beyond.obj", corner.to_owned() + "f 1 2 9\n", "beyond.obj"),
        (
            "before.obj",
            corner.to_owned() + "f -1 -2 -9\n",
            "before.obj",
        ),
        ("zeroth.obj", corner.to_owned() + "f 0 1 2\n", "zeroth.obj"),
        ("words.obj", "v one two three\n".into(), "words.obj"),
        (
            "binary.obj",
            "\u{0}\u{1}\u{2}v\u{7f}\u{0}".into(),
            "binary.obj",
        ),
        ("empty.glb", String::new(), "empty.glb"),
        (
            "broken.glb",
            "glTF\u{2}\u{0}\u{0}\u{0}".into(),
            "broken.glb",
        ),
        (
            "broken.gltf",
            "{\"asset\": {\"version\": ".into(),
            "broken.gltf",
        ),
        (
            "bare.gltf",
            r#"{"asset": {"version": "2.0"}}"#.into(),
            "no scene",
        ),
        ("short.gltf", gltf(4, 36), "short.gltf"),
        ("long.gltf", gltf(3, 37), "long.gltf"),
        ("none.gltf", gltf(0, 36), "none.gltf"),
        ("picture.png", corner.into(), "picture.png"),
    ] {
        let path = folder.join(name);
        fs::write(&path, text).expect("a file can be written");
        let path = path.to_str().expect("the path is UTF-8");
        assert_refused("no_scene", &["--scene", path], reason);
    }
    let folder = folder.to_str().expect("the path is UTF-8");
    assert_refused("no_scene", &["--scene", folder], folder);
    assert_refused("no_scene", &["--scene", "no/such.obj"], "no/such.obj");
}

/// A box, open to the front, and a block in it.
fn box_at(place: [f32; 3]) -> String {
    let corners = [
        [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]],
        [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]],
        [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]],
        [[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]],
        [[1, 0, -1], [1, 0, 1], [1, 2, 1], [1, 2, -1]],
        [[-1, 1, 1], [0, 1, 1], [0, 1, 0], [-1, 1, 0]],
        [[-1, 0, 1], [0, 0, 1], [0, 1, 1], [-1, 1, 1]],
    ];
    let vertices = corners.as_flattened().iter().map(|corner| {
        let [x, y, z] = [0, 1, 2].map(|i| place[i] + corner[i] as f32);
        format!("v {x} {y} {z}\n")
    });
    let faces = (0..corners.len()).map(|face| {
        let [a, b, c, d] = [1, 2, 3, 4].map(|corner| 4 * face + corner);
        format!("f {a} {b} {c} {d}\n")
    });
    vertices.chain(faces).collect()
}

#[test]
fn refuses_scenes_too_far_from_the_origin() {
    let folder = fresh_folder("far");
    let path = folder.join("box.obj");
    let name = path.to_str().expect("the path is UTF-8");
    let arguments = ["--scene", name, "--size", "64x48", "--vpls", "256"];
    for place in [[1e7, 0.0, 0.0], [7e6, 9e6, -1e7]] {
        fs::write(&path, box_at(place)).expect("a file can be written");
        assert_refused("far_out", &arguments, "f32 positions are too coarse");
    }
    for place in [[0.0; 3], [1e3, -1e3, 2e3]] {
        fs::write(&path, box_at(place)).expect("a file can be written");
        small_run("not_far", &["--scene", name]);
    }
}

#[test]
fn refuses_a_folder_that_is_a_file() {
    command::assert_leaves_files_alone("render", &["--vpls", "64", "--size", "32x24"]);
}

#[test]
fn helps() {
    let output = render(["--help"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stdout).contains("--scene"));
}

/// `render --help | head -3`, and the like.
#[test]
fn examples_need_no_reader() {
    for example in [
        "render",
        "report",
        "engine",
        "stability",
        "tabulate",
        "tightness",
    ] {
        command::assert_needs_no_reader(example, &["--help"]);
    }
    let out = fresh_path("unread");
    let out = ["--out", out.to_str().expect("the path is UTF-8")];
    let small = ["--size", "32x24", "--vpls", "64"];
    command::assert_needs_no_reader("render", &[&small[..], &out].concat());
    command::assert_needs_no_reader("engine", &["--frames", "3", "--lights", "64"]);
    command::assert_needs_no_reader("stability", &["--cases", "2000"]);
}

/// A glTF file of one triangle whose accessor claims `count` vertices in a view of `length` bytes.
fn gltf(count: u64, length: u64) -> String {
    let bytes = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    serde_json::json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [0.0, 1.0, 0.0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3",
            "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0],
        }],
        "bufferViews": [{"buffer": 0, "byteLength": length}],
        "buffers": [{
            "byteLength": 36,
            "uri": format!("data:application/octet-stream;base64,{bytes}"),
        }],
    })
    .to_string()
}

/// The same triangle as binary glTF: a header, a chunk of JSON and a chunk of bytes.
fn glb() -> Vec<u8> {
    let mut json: Value = serde_json::from_str(&gltf(3, 36)).expect("it is JSON");
    json["buffers"] = serde_json::json!([{"byteLength": 36}]);
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let vertices = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = vertices.into_iter().flat_map(f32::to_le_bytes).collect();
    let size = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
    let chunks = [
        &size(&text),
        b"JSON".as_slice(),
        &text,
        &size(&bytes),
        b"BIN\0",
        &bytes,
    ]
    .concat();
    let total = (12 + chunks.len() as u32).to_le_bytes();
    [b"glTF", &2_u32.to_le_bytes(), &total, &*chunks].concat()
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
    let pictures = fs::read_dir(&out).expect("the folder was made");
    let mut pictures: Vec<String> = pictures
        .map(|entry| {
            entry
                .expect("readable")
                .file_name()
                .to_string_lossy()
                .into()
        })
        .collect();
    pictures.sort_unstable();
    for picture in &pictures {
        image::open(out.join(picture)).unwrap_or_else(|error| panic!("{picture}: {error}"));
    }
    let json = serde_json::from_slice(&output.stdout);
    (json.expect("standard output is one JSON object"), pictures)
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
