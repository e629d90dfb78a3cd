//! What `render` refuses, and what it says.

use std::fs;

use support::command;

use crate::files::{box_at, gltf};
use crate::{assert_refused, fresh_folder, fresh_path, render, small_run};

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
