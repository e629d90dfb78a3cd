//! The records of a batch are those of its shapes, and its bounds are those of its records.

use alloc::vec::Vec;

use glam::Vec3;

use super::{BatchBuilder, LightBatch};
use crate::base::Direction;
use crate::bound::{Bounded, Shape};
use crate::light::{Roulette, Seed, Vpl, Xi};
use crate::lobe::{ConstantLobe, SpotLobe};
use crate::project::{Project, Projected, ProjectedBound};
use crate::view::Camera;

/// The bits of the bounds that are stored apart from the records.
fn bounds<P: Projected>(batch: &LightBatch<P>) -> Vec<u32> {
    let bits = |ends: &Vec<f32>| {
        ends[..batch.len()]
            .iter()
            .map(|end| end.to_bits())
            .collect()
    };
    batch
        .bounds
        .iter()
        .flat_map(|ends| -> Vec<u32> { bits(ends) })
        .collect()
}

/// The bits of the shapes that the records are of.
fn shapes<P: Projected>(batch: &LightBatch<P>) -> Vec<u32> {
    let bits = |shape: P| -> Vec<u32> {
        let fields = shape.to_fields();
        fields
            .as_ref()
            .iter()
            .map(|field| field.to_bits())
            .collect()
    };
    batch.iter().flat_map(|(_, shape)| bits(shape)).collect()
}

/// Batches lights of which every `dark`-th sheds no light, and compares with the same shapes one by one.
fn test<L: Bounded<Shape: Project> + Clone>(count: usize, dark: usize, lobe: &L) {
    let roulette = Roulette::new(0.01).unwrap();
    let camera = Camera::look_at(Vec3::ZERO, Vec3::Z, Vec3::Y, 1.0, 1.0, 0.1..100.0).unwrap();
    let light = |i: usize| {
        let xi = |frame| Seed(5).frame(frame).hashed_xi(i as u32).get();
        let position = 10.0 * Vec3::new(xi(0) - 0.5, xi(1) - 0.5, xi(2) + 0.2);
        let flux = if i % dark == dark - 1 { 0.0 } else { 1.0 };
        let light = Vpl::new(position, flux, lobe.clone()).unwrap();
        (light, Xi::new(xi(3)).unwrap())
    };
    let lights: Vec<_> = (0..count).map(light).collect();
    let mut expected = LightBatch::<ProjectedBound<L>>::new();
    let mut projected = Vec::new();
    for (i, (light, xi)) in (0..).zip(&lights) {
        let bound = light.bound(&roulette, *xi);
        if !Shape::is_empty(&bound) {
            let shape = Project::project(&bound, &camera).expect("not empty");
            projected.extend(
                shape
                    .to_fields()
                    .as_ref()
                    .iter()
                    .map(|field| field.to_bits()),
            );
            expected.push(i, &shape);
        }
    }
    assert_eq!(shapes(&expected), projected, "pushed, {count} lights");
    for lanes in [16, 8, 4] {
        let mut batch = LightBatch::new();
        let indexed = (0..).zip(&lights).map(|(i, (light, xi))| (i, light, *xi));
        let builder = BatchBuilder::new(&roulette, &camera).with_lanes(lanes);
        builder.add(indexed, &mut batch);
        assert_eq!(batch.lights(), expected.lights());
        assert_eq!(shapes(&batch), projected, "{lanes} lanes, {count} lights");
        assert_eq!(
            bounds(&batch),
            bounds(&expected),
            "{lanes} lanes, {count} lights"
        );
    }
}

#[test]
fn records_and_bounds_are_those_of_the_shapes() {
    let spot = SpotLobe::new(0.3, 0.5, Direction::X).unwrap();
    for count in [1, 15, 16, 31, 33, 64, 100, 200] {
        for dark in [1, 2, 7, 33, 1000] {
            test(count, dark, &ConstantLobe);
            test(count, dark, &spot);
        }
    }
}
