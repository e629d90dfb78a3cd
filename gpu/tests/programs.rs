//! The examples run as a user runs them, and what they print is right.

use std::process::Output;

use stochastic_light_culling::{Direction, Ggx, GgxLobe, Incidence, Schlick, Vpl, glam::Vec3};
use support::command;

fn printed(output: &Output) -> String {
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The mean radiance of the floor by all lights, each at the pixels of its own subregion.
fn radiance_of_all_lights() -> f64 {
    let incoming = Direction::new(Vec3::new(2.0, 6.0, 3.0) / 7.0).unwrap();
    let incidence = Incidence {
        normal: Direction::Z,
        incoming,
    };
    let gold = GgxLobe::new(
        Ggx::new(0.2).unwrap(),
        Schlick::new(0.9).unwrap(),
        incidence,
    );
    let mut sum = 0.0;
    for i in 0..8192 {
        let position = Vec3::new(
            (i % 128) as f32 / 16.0 - 4.0,
            (i / 128) as f32 / 16.0 + 0.5,
            0.0,
        );
        let light = Vpl::new(position, 0.01, gold).unwrap();
        let phase = [i % 16 % 4, i % 16 / 4];
        for pixel in (0..80 * 80).map(|k| [4 * (k % 80) + phase[0], 4 * (k / 80) + phase[1]]) {
            let [x, z] = pixel.map(|n| 8.0 * (n as f32 + 0.5) / 320.0);
            let (direction, squared) = light.direction_to(Vec3::new(x - 4.0, 0.0, z));
            let radiance = light.radiant_intensity(direction) / squared / std::f32::consts::PI;
            sum += f64::from(radiance * (-direction.y).max(0.0));
        }
    }
    // A sixteenth of the pixels, with 16 times the flux.
    sum / (80.0 * 80.0)
}

#[test]
fn the_program_of_the_documentation_is_right_on_average() {
    let line = printed(&command::run("cull_and_shade", [""; 0]));
    let mean = line
        .strip_prefix("mean radiance ")
        .and_then(|line| line.split(' ').next());
    let mean: f64 = mean.unwrap().parse().unwrap();
    let expected = radiance_of_all_lights();
    println!("{line}{expected:.6} by all lights");
    assert!(
        (mean / expected - 1.0).abs() < 0.01,
        "{mean}, expected {expected}"
    );
}

#[test]
fn the_ring_prints_its_error_and_the_time_of_each_pass() {
    let out = command::fresh_path("ring", "prints");
    let size = [
        "--size",
        "64",
        "36",
        "--vpls",
        "2000",
        "--repeat",
        "1",
        "--out",
        out.to_str().unwrap(),
    ];
    let text = printed(&command::run("ring", size));
    println!("{text}");
    for pass in [
        "slc_bound_lights",
        "slc_cull_and_shade",
        "slc_part_depths",
        "slc_list_lights",
        "slc_shade",
    ] {
        let line = text
            .lines()
            .find(|line| line.trim_start().starts_with(pass))
            .unwrap();
        assert!(
            line.ends_with("ms") || line.ends_with("no timestamps"),
            "{line}"
        );
    }
    assert_eq!(text.matches("RMSE").count(), 4);
    for name in ["gpu.png", "cpu.png"] {
        assert!(out.join(name).exists());
    }
    for (arguments, reason) in [
        (&["--alpha", "7"][..], "roughness"),
        (&["--size", "0", "9"], "image size"),
        (&["--interleave", "0"], "interleaving"),
        (&["--delta", "0"], "δ"),
        (&["--vpls", "0"], "vpls"),
    ] {
        command::assert_refused("ring", "refused", arguments, reason);
    }
}
