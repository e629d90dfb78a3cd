//! The example `engine`: its frames allocate nothing, and it sees the same in views of either handedness.
#![cfg(feature = "cull")]

#[path = "../examples/engine/light_pass.rs"]
mod light_pass;
#[path = "../examples/engine/world.rs"]
mod world;

use stochastic_light_culling::{AnyCamera, Camera, Projection};
use support::{command, with_camera};

use light_pass::LightPass;
use world::{Handedness, World, lights};

const SIZE: [u32; 2] = [256, 144];

/// The view of a frame.
fn camera(world: &World, frame: u32) -> AnyCamera {
    let (view, projection) = world.matrices(frame);
    AnyCamera::new(view, projection).unwrap()
}

fn pass<P: Projection>(camera: &Camera<P>) -> LightPass<P> {
    LightPass::new(lights(2000, 0.1).unwrap(), 0.01, camera, SIZE, 16).unwrap()
}

/// Those that views of either hand and of either projection make.
fn worlds() -> impl Iterator<Item = World> {
    let hands = [Handedness::Right, Handedness::Left].into_iter();
    hands.flat_map(|hand| {
        [false, true].map(|is_orthographic| World::new(SIZE, hand, is_orthographic))
    })
}

#[test]
fn frames_after_the_first_allocate_nothing() {
    fn draw<P: Projection>(
        world: &mut World,
        pass: &mut LightPass<P>,
        camera: &Camera<P>,
        frame: u32,
    ) {
        let depths = world.draw_depths(frame);
        let counters = pass.cull(camera, depths, frame).unwrap();
        assert!(counters.pairs > 0 && pass.lights_in_reach() > 0);
        let radiance = pass.shade(camera, depths);
        assert!(radiance.iter().any(|radiance| *radiance > 0.0));
    }
    fn frames<P: Projection>(mut world: World, cameras: &[Camera<P>]) {
        let mut pass = pass(&cameras[0]);
        let first = allocation_counter::measure(|| draw(&mut world, &mut pass, &cameras[0], 0));
        assert!(first.count_total > 0, "nothing is counted");
        for (camera, frame) in cameras.iter().zip(0..) {
            let later = allocation_counter::measure(|| draw(&mut world, &mut pass, camera, frame));
            assert_eq!(later.count_total, 0, "frame {frame}");
        }
    }
    for world in worlds() {
        let (mut perspective, mut orthographic) = (Vec::new(), Vec::new());
        for frame in 0..40 {
            match camera(&world, frame) {
                AnyCamera::Perspective(camera) => perspective.push(camera),
                AnyCamera::Orthographic(camera) => orthographic.push(camera),
            }
        }
        if orthographic.is_empty() {
            frames(world, &perspective);
        } else {
            frames(world, &orthographic);
        }
    }
}

/// The same world, to the left-handed eye a mirror image: each list at the other end of its row. Rounding
/// may add a light here or there.
#[test]
fn views_of_either_handedness_see_the_same_lights() {
    for is_orthographic in [false, true] {
        let lengths = [Handedness::Right, Handedness::Left].map(|handedness| {
            let mut world = World::new(SIZE, handedness, is_orthographic);
            with_camera!(&camera(&world, 0), camera => {
                let mut pass = pass(camera);
                pass.cull(camera, world.draw_depths(0), 0).unwrap();
                pass.list_lengths().collect::<Vec<_>>()
            })
        });
        let in_a_row = 2 * (SIZE[0] as usize / 16);
        let [right, left] = lengths.each_ref().map(|lengths| lengths.chunks(in_a_row));
        for (right, left) in right.zip(left) {
            let mirrored = left.chunks(2).rev().flatten();
            for (right, left) in right.iter().zip(mirrored) {
                assert!(right.abs_diff(*left) <= 1 + right / 20, "{right}, {left}");
            }
        }
    }
}

/// A list holds what its pixels need: the mean over frames is the light of all lights.
#[test]
fn the_mean_over_frames_is_what_all_lights_give() {
    for is_orthographic in [false, true] {
        let world = World::new(SIZE, Handedness::Right, is_orthographic);
        with_camera!(&camera(&world, 0), camera => mean_is_exact(world, camera));
    }
}

fn mean_is_exact<P: Projection>(mut world: World, camera: &Camera<P>) {
    const FRAMES: u32 = 400;
    let mut pass = pass(camera);
    let depths = world.draw_depths(0).to_vec();
    let pixel = [128, 54];
    let mut total = 0.0;
    for frame in 0..FRAMES {
        pass.cull(camera, &depths, frame).unwrap();
        total += f64::from(pass.radiance(camera, &depths, pixel));
    }
    let [last, shaded] = [
        pass.radiance(camera, &depths, pixel),
        pass.shade(camera, &depths)[(pixel[1] * SIZE[0] + pixel[0]) as usize],
    ];
    assert_eq!(last.to_bits(), shaded.to_bits());
    let point = camera.point_in_pixel(
        SIZE,
        pixel,
        camera.depth(depths[(pixel[1] * SIZE[0] + pixel[0]) as usize]),
    );
    let point = camera.to_world_space(point);
    let radiance = |light: &light_pass::Light| {
        let way = point - light.position();
        f64::from(light.radiant_intensity(way.normalize()) / way.length_squared())
    };
    let lights = lights(2000, 0.1).unwrap();
    let exact: f64 = lights.iter().map(radiance).sum();
    let mean = total / f64::from(FRAMES);
    // δ is the largest share of one light: its variance is at most δL, so the standard deviation of the
    // mean is at most √(δ·exact/FRAMES); five of them are crossed once in two million seeds, and this seed
    // is fixed.
    let deviation = (0.01 * exact / f64::from(FRAMES)).sqrt();
    assert!(exact > 0.1, "the wall is dark");
    assert!((mean - exact).abs() < 5.0 * deviation, "{mean}, {exact}");
}

#[test]
fn prints_a_line_for_each_frame() {
    for arguments in [
        &["--frames=3"][..],
        &["--frames=3", "--left-handed"],
        &["--frames=3", "--orthographic"],
        &["--frames=3", "--lights=0"],
    ] {
        let output = command::run("engine", arguments);
        assert!(output.status.success() && output.stderr.is_empty());
        let table = String::from_utf8(output.stdout).expect("tables are UTF-8");
        assert_eq!(table.lines().count(), 4, "{table}");
    }
}

#[test]
fn refuses_what_no_engine_has() {
    for (argument, reason) in [
        ("--frames=0", "0 is not in"),
        ("--lights=-1", "-1"),
        ("--alpha=0", "roughness α is 0"),
        ("--delta=NaN", "δ is NaN"),
        ("--right-handed", "--right-handed"),
    ] {
        command::assert_refusal(&command::run("engine", [argument]), reason);
    }
}
