//! Each room of `src/` imports from itself and from the rooms before it, and from the room that owns an item.

use std::fs;
use std::path::Path;

/// The rooms, in the order in which they may know each other.
const ROOMS: [&str; 10] = [
    "num", "base", "lobe", "light", "bound", "view", "project", "touch", "cull", "interop",
];

/// The imports in `source`, a file of `room`, that run against the order.
fn violations(room: &str, source: &str) -> Vec<String> {
    let own = place(room).expect("a room");
    let code = source
        .lines()
        .map(|line| line.split("//").next().unwrap_or_default());
    let mut found = Vec::new();
    for (number, line) in (1..).zip(code) {
        for (start, _) in line.match_indices("crate::") {
            // Not the end of a longer name.
            if line[..start].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
                continue;
            }
            let path = &line[start + "crate::".len()..];
            let first = path
                .split(|c: char| !(c.is_alphanumeric() || c == '_'))
                .next()
                .unwrap_or_default();
            match place(first) {
                Some(place) if place <= own => {}
                Some(_) => found.push(format!("line {number} of {room} imports from {first}")),
                None => found.push(format!("line {number} of {room} imports through lib.rs")),
            }
        }
    }
    found
}

fn place(room: &str) -> Option<usize> {
    ROOMS.iter().position(|name| *name == room)
}

fn visit(folder: &Path, room: &str, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder of src") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            visit(&path, room, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let source = fs::read_to_string(&path).expect("text");
            let path = path.display();
            found.extend(
                violations(room, &source)
                    .iter()
                    .map(|v| format!("{path}: {v}")),
            );
        }
    }
}

#[test]
fn rooms_import_only_from_earlier_rooms() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    for entry in fs::read_dir(&src).expect("src") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            let name = path.file_name().and_then(|name| name.to_str());
            let room = name.filter(|name| place(name).is_some());
            let room = room.unwrap_or_else(|| panic!("{} is no room", path.display()));
            visit(&path, room, &mut found);
        } else {
            assert!(path.ends_with("lib.rs"), "{} is in no room", path.display());
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn imports_against_the_order_are_found() {
    let is_found = |room, source| !violations(room, source).is_empty();
    assert!(is_found("bound", "use crate::view::Camera;"));
    assert!(is_found("lobe", "fn f(light: crate::light::Vpl<()>) {}"));
    assert!(is_found("cull", "use crate::Camera;"));
    assert!(is_found("cull", "use crate::{Camera, Error};"));
    assert!(!is_found(
        "cull",
        "use crate::view::Camera; // crate::interop::X"
    ));
    assert!(!is_found(
        "lobe",
        "/// See [`Vpl`](crate::Vpl).\nuse crate::lobe::Lobe;"
    ));
}
