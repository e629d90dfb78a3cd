//! What the other tests rely on: results come back in order, and mistakes are errors.

use gpu::{Dispatch, Error, Gpu, Map};

const DOUBLE: Map = Map {
    sources: &["fn twice(x: f32) -> f32 { return x + x; }"],
    input: "f32",
    output: "f32",
    body: "return twice(input);",
};

#[test]
fn maps_records_in_order() {
    let gpu = Gpu::new().unwrap();
    // More than one row of workgroups.
    let inputs: Vec<f32> = (0..5_000_000).map(|i| i as f32).collect();
    let doubled: Vec<f32> = gpu.map(&DOUBLE, &inputs).unwrap();
    assert_eq!(doubled.len(), inputs.len());
    assert!(
        inputs
            .iter()
            .zip(&doubled)
            .all(|(input, output)| *output == 2.0 * input)
    );
    assert!(gpu.map::<f32, f32>(&DOUBLE, &[]).unwrap().is_empty());
}

#[test]
fn mistakes_are_errors_with_their_place() {
    let gpu = Gpu::new().unwrap();
    let broken = Map {
        body: "return thrice(input);",
        ..DOUBLE
    };
    let Err(Error::Invalid(message)) = gpu.map::<f32, f32>(&broken, &[1.0]) else {
        panic!("an unknown function compiles");
    };
    assert!(message.contains("thrice"), "{message}");

    // A `vec3f` takes 16 bytes, not 12.
    let packed = Map {
        input: "vec3f",
        body: "return input.x;",
        ..DOUBLE
    };
    let Err(Error::Invalid(message)) = gpu.map::<[f32; 3], f32>(&packed, &[[0.0; 3]; 8]) else {
        panic!("records of another size are taken");
    };
    assert!(message.contains("vec3f"), "{message}");

    let one = "@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;
        @compute @workgroup_size(1) fn one() { numbers[0] = 1u; }";
    let (kernel, numbers) = (
        gpu.kernel(&[one], "one").unwrap(),
        gpu.zeroed::<u32>(1).unwrap(),
    );
    let run = |binding, groups| {
        let dispatch = Dispatch {
            kernel: &kernel,
            buffers: &[(binding, &numbers)],
            workgroups: [groups, 1, 1],
        };
        gpu.run(&[dispatch])
    };
    assert!(matches!(run(1, 1), Err(Error::Invalid(_))));
    assert!(matches!(run(0, 65536), Err(Error::Invalid(_))));
    assert_eq!(gpu.read::<u32>(&numbers).unwrap(), [0]);
    run(0, 1).unwrap();
    assert_eq!(gpu.read::<u32>(&numbers).unwrap(), [1]);
}

#[test]
fn an_adapter_without_what_is_needed_is_an_error() {
    let limits = wgpu::Limits {
        max_compute_workgroup_storage_size: u32::MAX,
        ..Default::default()
    };
    assert!(matches!(Gpu::with_limits(limits), Err(Error::Adapter(_))));
}
