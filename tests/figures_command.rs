//! The example `figures` as a command: the pictures of the documentation.

use std::ffi::OsString;
use std::fs;

use support::command;

#[test]
fn draws_the_pictures_of_the_documentation() {
    let folder = command::fresh_path("figures", "draws");
    let out = ["--coarse".into(), "4".into(), "--out".into()];
    let output = command::run(
        "figures",
        out.into_iter().chain([folder.clone().into_os_string()]),
    );
    assert_eq!(output.status.code(), Some(0));
    let text = |name: &str| {
        let text = fs::read_to_string(folder.join(name)).expect("it was drawn");
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"));
        text
    };
    // What is said of each bound.
    let numbers = |text: &str, key: &str| -> Vec<f64> {
        let after = text.split(key).skip(1);
        let number = |after: &str| {
            let end = after.find(|c: char| !c.is_ascii_digit() && c != '.');
            after[..end.unwrap_or(after.len())]
                .trim_end_matches('.')
                .parse()
        };
        after
            .map(|after| number(after).expect("a number"))
            .collect()
    };
    let culling = text("culling.svg");
    for list in [", 16×16 tiles: ", ", pixels: "] {
        let means = numbers(&culling, list);
        assert_eq!(means.len(), 3);
        assert!(
            means[0] > 2.0 * means[1] && means[1] >= means[2],
            "{means:?}"
        );
    }
    assert_eq!(culling.matches("<image").count(), 7);

    let lobe = text("lobe.svg");
    let volumes = ["sphere (2016): ", "spheroid (2017): ", "tight ellipsoid: "];
    let volumes = volumes.map(|name| numbers(&lobe, name)[0]);
    assert!(volumes[0] > volumes[1] && volumes[1] > volumes[2] && volumes[2] >= 1.0);

    assert_eq!(text("tiles.svg").matches("<image").count(), 1);

    let frames = text("frames.svg");
    let shares = numbers(&frames, "lights a pixel, ");
    assert_eq!(shares[0], 100.0);
    // Of 64 frames the mean is near all of the light; of ranges that end, far.
    assert!(
        (shares[2] - 100.0).abs() < 5.0 && shares[3] < 80.0,
        "{shares:?}"
    );
}

#[test]
fn refuses_what_it_cannot_draw() {
    command::assert_refused("figures", "refuses", &["cube"], "'cube'");
    command::assert_refused("figures", "refuses", &["--coarse", "0"], "'0'");
    command::assert_leaves_files_alone("figures", &["lobe"]);
    command::assert_needs_no_reader("figures", &["--help"]);
    let folder = OsString::from(command::fresh_path("figures", "unread"));
    let folder = folder.to_str().expect("the path is UTF-8");
    command::assert_needs_no_reader("figures", &["lobe", "--out", folder]);
}
