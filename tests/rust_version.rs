//! The least Rust version of each feature, as `lib.rs` states it: no dependency needs a newer one. Clippy holds the
//! crate's own code to the least of them.

use std::{
    collections::{BTreeMap, BTreeSet},
    process::Command,
};

use serde_json::Value;

/// Features, and the Rust version that the newest of their dependencies needs, if that is newer than the crate's own.
const STATED: [(&str, Option<[u32; 2]>); 4] = [
    ("std", None),
    ("libm,ltc,serde,bytemuck,wgsl", None),
    ("libm,cull", Some([1, 89])),
    ("rayon", Some([1, 89])),
];

#[test]
fn no_dependency_needs_a_newer_rust_than_is_stated() {
    let newest = newest_by_package();
    let own = newest[concat!("stochastic-light-culling v", env!("CARGO_PKG_VERSION"))];
    assert_eq!(Some(own), version(env!("CARGO_PKG_RUST_VERSION")));
    for (features, stated) in STATED {
        let packages = packages_of(features);
        assert!(packages.len() > 1, "{packages:?}");
        let needed = packages.iter().map(|package| newest[package]).max();
        assert_eq!(
            needed,
            Some(stated.unwrap_or(own)),
            "{features}: {packages:?}"
        );
    }
}

/// Rust version of each package of the lock file, as `name vVERSION`; zero where the package states none.
fn newest_by_package() -> BTreeMap<String, [u32; 2]> {
    let metadata = cargo(&["metadata", "--locked", "--format-version", "1"]);
    let metadata: Value = serde_json::from_str(&metadata).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let entry = |package: &Value| {
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
        let newest = version(&text("rust_version")).unwrap_or_default();
        (format!("{} v{}", text("name"), text("version")), newest)
    };
    packages.iter().map(entry).collect()
}

/// Packages that a user with these features compiles, the crate among them, as `name vVERSION`.
fn packages_of(features: &str) -> BTreeSet<String> {
    let tree = cargo(&[
        "tree",
        "--locked",
        "--edges",
        "no-dev",
        "--prefix",
        "none",
        "--no-default-features",
        "--features",
        features,
    ]);
    let package = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    tree.lines().map(package).collect()
}

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Major and minor version.
fn version(text: &str) -> Option<[u32; 2]> {
    let mut parts = text.split('.').map_while(|part| part.parse().ok());
    Some([parts.next()?, parts.next()?])
}
