//! The two fixed workloads: how many lights are listed, and that later frames allocate nothing.

use stochastic_light_culling::{Culler, LightBatch, LightLists, ProjectedEllipsoid};
use support::workload::{self, Depths, Subregion};

/// The lights in all near intervals together, and in all far ones.
fn hits(frame: &[Subregion], depths: Depths, mut culler: Culler<ProjectedEllipsoid>) -> [usize; 2] {
    let camera = workload::camera();
    let mut lists = LightLists::new();
    let mut hits = [0; 2];
    for subregion in frame {
        let stretches = subregion.lights.iter().map(|light| light.stretch(&camera));
        let mut batch = LightBatch::new();
        batch.extend((0..).zip(stretches));
        culler
            .cull(&batch, &subregion.tile_depths(depths), &mut lists)
            .unwrap();
        for (slot, [start, end]) in lists.ranges().iter().enumerate() {
            hits[slot % 2] += (end - start) as usize;
        }
    }
    hits
}

/// The numbers are those of the same test in `f64`. The paper's box test lists 189,187 and 11,364.
#[test]
fn finds_the_known_lights_of_the_fixed_workloads() {
    let frame = workload::frame();
    let kinds: [(Depths, [usize; 2]); 2] = [
        (|tile| tile.scattered, [16_251, 28_337]),
        (|tile| tile.coherent, [2_282, 3_039]),
    ];
    for (depths, known) in kinds {
        let found = hits(&frame, depths, Culler::new());
        for (found, known) in found.into_iter().zip(known) {
            assert!(
                known <= found && found <= known + known / 200,
                "{found}, known {known}"
            );
        }
    }
}

#[test]
fn later_frames_allocate_nothing() {
    let frame = workload::frame();
    let subregion = &frame[0];
    let tiles = subregion.tile_depths(|tile| tile.scattered);
    let camera = workload::camera();
    let (mut batch, mut culler, mut lists) = (LightBatch::new(), Culler::new(), LightLists::new());
    let mut draw_frame = || {
        batch.clear();
        for (number, light) in (0..).zip(&subregion.lights) {
            batch.push(number, &light.stretch(&camera));
        }
        culler.cull(&batch, &tiles, &mut lists).unwrap();
    };
    let first = allocation_counter::measure(&mut draw_frame);
    assert!(first.count_total > 0, "nothing is counted");
    let second = allocation_counter::measure(&mut draw_frame);
    assert_eq!(second.count_total, 0);
}

/// As parry3d decides too, but for three pairs: `benches/cull.rs` compares them.
#[test]
fn exact_test_finds_the_known_lights_of_the_fixed_workloads() {
    let frame = workload::frame();
    let kinds: [(Depths, usize); 2] = [
        (|tile| tile.scattered, 41_608),
        (|tile| tile.coherent, 4_866),
    ];
    for (depths, known) in kinds {
        let found: usize = hits(&frame, depths, Culler::new().with_exact_test())
            .iter()
            .sum();
        assert!(
            found.abs_diff(known) <= known / 1000,
            "{found}, known {known}"
        );
    }
}
