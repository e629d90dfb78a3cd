//! The example `render` on scenes with lamps, cameras and materials of their own, and where it looks from without.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use common::room::Room;
use image::RgbImage;
use serde_json::Value;
use support::command;

const WHOLE: Room = Room {
    has_camera: true,
    has_lights: true,
};
const BARE: Room = Room {
    has_camera: false,
    has_lights: false,
};

/// What a small run leaves behind.
struct Run {
    json: Value,
    notes: Vec<String>,
    folder: PathBuf,
}

impl Run {
    #[track_caller]
    fn of(test: &str, arguments: &[&str]) -> Self {
        let folder = command::fresh_path("render_scenes", test);
        let small = ["--size", "96x64", "--vpls", "2048", "--bound", "tight"];
        let rest = ["--reference", "off", "--json", "--out"];
        let all = [&small[..], arguments, &rest].concat();
        let all = all.into_iter().map(OsString::from);
        let output = command::run("render", all.chain([folder.clone().into()]));
        let error = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(0), "{error}");
        let notes = error.lines().filter_map(|line| line.strip_prefix("note: "));
        Self {
            json: serde_json::from_slice(&output.stdout).expect("one JSON object"),
            notes: notes.map(Into::into).collect(),
            folder,
        }
    }

    fn picture(&self, name: &str) -> RgbImage {
        let picture = image::open(self.folder.join(name)).expect("a picture");
        picture.into_rgb8()
    }

    /// The share of the finished picture that is nearly black.
    fn dark_share(&self) -> f64 {
        let picture = self.picture("picture.png");
        let is_dark = |pixel: &&image::Rgb<u8>| pixel.0.iter().all(|channel| *channel < 12);
        picture.pixels().filter(is_dark).count() as f64 / (96.0 * 64.0)
    }
}

fn written(test: &str, name: &str, bytes: &[u8]) -> String {
    let path = command::fresh_folder("render_scenes", test).join(name);
    fs::write(&path, bytes).expect("a file can be written");
    path.to_str().expect("the path is UTF-8").into()
}

fn room(test: &str, room: Room) -> String {
    written(test, "room.glb", &room.glb().expect("it fits"))
}

#[test]
fn renders_a_room_as_its_file_says() {
    let path = room("whole", WHOLE);
    let run = Run::of("whole_out", &["--scene", &path]);
    assert_eq!(run.notes, [""; 0]);
    // Its materials have roughnesses and reflectances of their own.
    assert!(run.json["alpha"].is_null() && run.json["f0"].is_null());
    let of_glossy = &run.json["methods"][0]["contributing_per_pixel"];
    assert!(of_glossy.as_f64().expect("a number") > 0.1);
    assert!(run.dark_share() < 0.002, "{}", run.dark_share());
    // The middle of the ball, which shows the room behind the eye.
    let ball = run.picture("picture.png").get_pixel(58, 32).0;
    assert!(ball.iter().all(|channel| *channel > 40), "{ball:?}");
    // The red wall on the right.
    let wall = run.picture("picture.png").get_pixel(91, 20).0;
    assert!(wall[0] > 2 * wall[2], "{wall:?}");

    let asked = ["--scene", &path, "--alpha", "0.2", "--f0", "0.5"];
    let run = Run::of("asked_out", &asked);
    assert_eq!([&run.json["alpha"], &run.json["f0"]], [0.2, 0.5]);
}

#[test]
fn says_what_it_takes_without_camera_or_light() {
    for (test, has_camera, has_lights, note) in [
        (
            "dark",
            true,
            false,
            "has no light: it is lit by what shines by itself",
        ),
        (
            "blind",
            false,
            true,
            "has no camera: it is seen from inside",
        ),
        (
            "bare",
            false,
            false,
            "has no camera and no light: it is seen from inside, and lit by what shines by itself",
        ),
    ] {
        let path = room(
            test,
            Room {
                has_camera,
                has_lights,
            },
        );
        let run = Run::of(&format!("{test}_out"), &["--scene", &path]);
        assert_eq!(run.notes, [format!("scene {path} {note}")]);
        assert!(run.dark_share() < 0.01, "{test}: {}", run.dark_share());
    }
}

/// A box that is closed on all sides, and a block in it.
fn closed_box() -> String {
    let boxes = [[[-3, 0, -2], [3, 3, 2]], [[-1, 0, -1], [0, 1, 0]]];
    let corner = |[low, high]: [[i32; 3]; 2], corner: usize| {
        let [x, y, z] = [0, 1, 2].map(|axis| [low, high][corner >> axis & 1][axis]);
        format!("v {x} {y} {z}\n")
    };
    let corners = boxes
        .iter()
        .flat_map(|ends| (0..8).map(|i| corner(*ends, i)));
    let faces = [
        [1, 2, 4, 3],
        [5, 6, 8, 7],
        [1, 2, 6, 5],
        [3, 4, 8, 7],
        [1, 3, 7, 5],
        [2, 4, 8, 6],
    ];
    let faces = [0, 8].into_iter().flat_map(|first| {
        let face = move |face: [i32; 4]| face.map(|corner| corner + first);
        faces.map(|corners| {
            let [a, b, c, d] = face(corners);
            format!("f {a} {b} {c} {d}\n")
        })
    });
    corners.chain(faces).collect()
}

/// Of metal, since it has no material, and of paint.
#[test]
fn looks_and_lights_from_inside_a_closed_box() {
    let metal = written("metal", "box.obj", closed_box().as_bytes());
    let text = "mtllib box.mtl\nusemtl paint\n".to_owned() + &closed_box();
    let paint = written("paint", "box.obj", text.as_bytes());
    let library = Path::new(&paint).with_extension("mtl");
    fs::write(library, "newmtl paint\nKd 0.7 0.6 0.5\n").expect("a file can be written");
    for (test, path) in [("metal_out", metal), ("paint_out", paint)] {
        let run = Run::of(test, &["--scene", &path]);
        assert_eq!(run.notes, [""; 0]);
        assert!(run.dark_share() < 0.02, "{test}: {}", run.dark_share());
        let of_diffuse = &run.json["diffuse"]["contributing_per_pixel"];
        assert!(of_diffuse.as_f64().expect("a number") > 0.5);
    }
}

#[test]
fn lights_where_it_is_told_to() {
    let of = |test: &str, arguments: &[&str]| Run::of(test, arguments).picture("indirect.png");
    let ring = of("ring", &[]);
    // Where the ring's own light is.
    assert!(of("ring_same", &["--light", "4.6,4.4,2.4"]) == ring);
    let other = of("ring_other", &["--light", "-4.6,4.4,2.4"]);
    assert!(other != ring);
    let both = ["--light", "-4.6,4.4,2.4", "--light", "4.6,4.4,2.4"];
    let both = of("ring_both", &both);
    assert!(both != ring && both != other);
}

#[test]
fn looks_where_it_is_told_to() {
    let of = |test: &str, arguments: &[&str]| Run::of(test, arguments).picture("picture.png");
    let path = room("look", WHOLE);
    // From the eye of its camera to what that looks at, with its angle.
    let own = of("own", &["--scene", &path]);
    let same = [
        "--scene",
        &path,
        "--eye=-0.5,1.45,2.35",
        "--fov",
        "57.29578",
    ];
    let same = of("same", &same);
    let unlike = own.pixels().zip(same.pixels());
    let unlike = unlike
        .filter(|(a, b)| (0..3).any(|i| a[i].abs_diff(b[i]) > 40))
        .count();
    assert!(unlike < 96 * 64 / 20, "{unlike}");
    // Straight down, where no upright is.
    let down = ["--scene", &path, "--eye", "0,2.9,0", "--target", "0,0,0"];
    let down = of("down", &down);
    let floor = down.get_pixel(48, 60).0;
    assert!(floor[0] > floor[2] && floor[0] > 40, "{floor:?}");
    let narrow = of("narrow", &["--scene", &path, "--fov", "10"]);
    assert!(narrow != own);
}

#[test]
fn refuses_looks_that_show_nothing() {
    for (arguments, reason) in [
        (&["--eye", "1,2"][..], "X,Y,Z"),
        (&["--eye", "1,2,nan"], "X,Y,Z"),
        (&["--target", "1,2,1e10"], "X,Y,Z"),
        (&["--light", "inf,0,0"], "X,Y,Z"),
        (&["--light", "here"], "X,Y,Z"),
        (&["--fov", "0"], "degrees"),
        (&["--fov", "180"], "degrees"),
        (&["--fov", "NaN"], "degrees"),
        (
            &["--eye", "0,5,0", "--target", "0,5,0"],
            "eye to its target",
        ),
        (
            &["--eye", "0,5,0", "--target", "0,9,1"],
            "nothing of it is in view",
        ),
    ] {
        command::assert_refused("render", "looks", arguments, reason);
    }
}

#[test]
fn refuses_broken_rooms() {
    let whole = WHOLE.glb().expect("it fits");
    let folder = command::fresh_folder("render_scenes", "broken");
    let assert_refused = |bytes: &[u8], reason: &str| {
        let path = folder.join("broken.glb");
        fs::write(&path, bytes).expect("a file can be written");
        let path = path.to_str().expect("the path is UTF-8");
        command::assert_refused("render", "broken", &["--scene", path], reason);
    };
    for (from, to, reason) in [
        (
            r#""intensity":60.0"#,
            r#""intensity":-6.0"#,
            "light 0 with an intensity",
        ),
        (r#""intensity":300.0"#, r#""intensity":1e999"#, "broken.glb"),
        (
            r#""outerConeAngle":0.6"#,
            r#""outerConeAngle":0.3"#,
            "light 1 with a cone",
        ),
        (
            r#""outerConeAngle":0.6"#,
            r#""outerConeAngle":1.7"#,
            "light 1 with a cone",
        ),
        (r#","spot":{"#, r#","sp0t":{"#, "broken.glb"),
        (r#""type":"spot""#, r#""type":"spit""#, "broken.glb"),
        (r#""light":1"#, r#""light":9"#, "broken.glb"),
        (r#""camera":0"#, r#""camera":7"#, "broken.glb"),
        (r#""yfov":1.0"#, r#""yfov":0.0"#, "camera 0"),
        (r#""yfov":1.0"#, r#""yfov":3.9"#, "camera 0"),
        (r#""mesh":11"#, r#""mesh":99"#, "broken.glb"),
        (
            r#""metallicFactor":1.0,"roughnessFactor":0.4"#,
            r#""metallicFactor":1e9,"roughnessFactor":x.4"#,
            "broken.glb",
        ),
        (
            r#""translation":[0.75,0.7,"#,
            r#""translation":[1e39,0.7,"#,
            "broken.glb",
        ),
        (r#""nodes":[0,1,"#, r#""nodes":[0,0,"#, "two parents"),
    ] {
        assert_refused(&replaced(&whole, from, to), reason);
    }
    for length in (0..whole.len()).step_by(whole.len() / 12) {
        assert_refused(&whole[..length], "broken.glb");
    }
}

/// `bytes` with another text of the same length in the place of one.
#[track_caller]
fn replaced(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len(), "{from} {to}");
    let place = bytes
        .windows(from.len())
        .position(|window| window == from.as_bytes());
    let place = place.unwrap_or_else(|| panic!("{from} is in the file"));
    let mut bytes = bytes.to_vec();
    bytes[place..][..to.len()].copy_from_slice(to.as_bytes());
    bytes
}

#[test]
fn writes_the_room() {
    let folder = command::fresh_path("render_scenes", "writes");
    let output = command::run("room", ["--out".into(), folder.clone().into_os_string()]);
    assert_eq!(output.status.code(), Some(0));
    let bytes = fs::read(Path::new(&folder).join("room.glb")).expect("it was written");
    assert_eq!(bytes, WHOLE.glb().expect("it fits"));
    assert!(bytes.len() < 40_000 && bytes.len() > BARE.glb().expect("it fits").len());
    command::assert_refused("room", "writes", &["--no-walls"], "--no-walls");
    command::assert_leaves_files_alone("room", &[]);
    command::assert_needs_no_reader("room", &["--help"]);
}
