//! The bytes that a GPU is given are those that the documentation promises, and enough for the tile test.
#![cfg(all(feature = "bytemuck", feature = "cull"))]

use std::mem::{align_of, offset_of, size_of};

use proptest::prelude::*;
use stochastic_light_culling::{
    Camera, Culler, DepthInterval, GpuBound, GpuCamera, GpuEllipsoid, GpuFrame, GpuLight,
    GpuProjected, GpuSphere, GpuTile, LightBatch, LightLists, Sphere, TileDepths, TileRectangle,
    glam::{Vec2, Vec3},
};
use support::generators::{self, cases};

fn camera() -> Camera {
    Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.2, 1.5, 0.1..100.0).unwrap()
}

fn word(bytes: &[u8], offset: usize) -> [u8; 4] {
    bytes[offset..offset + 4].try_into().unwrap()
}

fn number(bytes: &[u8], offset: usize) -> f32 {
    f32::from_ne_bytes(word(bytes, offset))
}

/// The rules of std430 and of WGSL's storage buffers: a `vec3` or `vec4` begins at a multiple of 16, what
/// follows a `vec3` may fill its fourth place, and an array's elements are apart by a multiple of 16.
#[test]
fn records_lie_as_shaders_expect() {
    assert_eq!(offset_of!(GpuEllipsoid, x_and_y_axes), 0);
    assert_eq!(offset_of!(GpuEllipsoid, z_axis), 16);
    assert_eq!(offset_of!(GpuEllipsoid, light), 28);
    assert_eq!(offset_of!(GpuEllipsoid, center), 32);
    assert_eq!(offset_of!(GpuEllipsoid, unused), 44);
    assert_eq!(size_of::<GpuEllipsoid>(), 48);
    assert_eq!(offset_of!(GpuSphere, center), 0);
    assert_eq!(offset_of!(GpuSphere, radius_squared), 12);
    assert_eq!(size_of::<GpuSphere>(), 16);
    // No more than bytes that were read from anywhere as words have.
    assert_eq!(
        (align_of::<GpuEllipsoid>(), align_of::<GpuSphere>()),
        (4, 4)
    );
}

/// The same rules for the records of the shaders: each `vec3` and `mat3x3` at a multiple of 16, each `vec2` at one of 8,
/// and no padding that Rust would add.
#[test]
fn records_of_kernels_lie_as_shaders_expect() {
    macro_rules! offsets {
        ($record:ident, $size:literal, $($field:ident $offset:literal),*) => {
            $(assert_eq!(offset_of!($record, $field), $offset);)*
            assert_eq!((size_of::<$record>(), align_of::<$record>()), ($size, 4));
        };
    }
    offsets!(GpuLight, 64, position 0, flux 12, normal 16, cosine 28, incoming 32, roughness 44, fresnel 48, majorant 56);
    offsets!(GpuBound, 96, light 0, offset 16, axes 32, semi_axes 80);
    offsets!(GpuProjected, 64, x_and_y_axes 0, z_axis 16, near 28, center 32, far 44, slopes 48);
    offsets!(
        GpuCamera, 80,
        right 0, deviation 12, up 16, secant 28, forward 32, rounding 44, anchor 48, depth_numerator 60, image 64,
        depth_offset 76
    );
    offsets!(GpuTile, 16, min 0, max 8);
    offsets!(
        GpuFrame, 128,
        camera 0, image_size 80, tiles 88, interleave 96, lights 100, intervals 104, room 108, delta 112,
        least_distance_squared 116, seed 120, frame 124
    );
}

#[test]
fn lists_are_buffers_already() {
    let camera = camera();
    let rectangle = |[x, _]: [u32; 2]| {
        let left = x as f32 - 1.0;
        TileRectangle::new(Vec2::new(left, -0.5), Vec2::new(left + 1.0, 0.5)).unwrap()
    };
    let mut tiles = TileDepths::from_rectangles([2, 1], 1, rectangle).unwrap();
    for tile in [[0, 0], [1, 0]] {
        tiles.set(tile, [DepthInterval::new(1.0, 20.0).unwrap()]);
    }
    let mut batch = LightBatch::new();
    for (light, x) in [(3, -3.0), (5, 3.0), (9, 4.0)] {
        let sphere = Sphere::new(Vec3::new(x, 0.0, -10.0), 1.0).unwrap();
        batch.push(light, &sphere.project(&camera).unwrap());
    }
    let mut lists = LightLists::new();
    Culler::new().cull(&batch, &tiles, &mut lists).unwrap();

    let ranges: &[u32] = bytemuck::cast_slice(lists.ranges());
    assert_eq!(ranges, [0, 1, 1, 3]);
    let numbers: &[u8] = bytemuck::cast_slice(lists.lights());
    assert_eq!(numbers, [3_u32, 5, 9].map(u32::to_ne_bytes).as_flattened());
}

/// The paper's box test, as a shader does it with nothing but the bytes of a record.
fn touches(bytes: &[u8], rectangle: &TileRectangle, depths: &DepthInterval) -> bool {
    let [xx, xy, yx, yy] = [0, 4, 8, 12].map(|offset| number(bytes, offset));
    let z_axis = [16, 20, 24].map(|offset| number(bytes, offset));
    let center = [32, 36, 40].map(|offset| number(bytes, offset));
    let (min, max) = (rectangle.min(), rectangle.max());
    let ends = |a: f32, b: f32| [a.min(b), a.max(b)];
    let mut apart_squared = 0.0;
    for (i, [x, y]) in [[xx, yx], [xy, yy], [0.0; 2]].into_iter().enumerate() {
        let (across, down) = (ends(x * min.x, x * max.x), ends(y * min.y, y * max.y));
        let [low, high] = [0, 1].map(|end| across[end] + (down[end] + z_axis[i]));
        let [low, _] = ends(low * depths.near(), low * depths.far());
        let [_, high] = ends(high * depths.near(), high * depths.far());
        let apart = center[i] - center[i].max(low).min(high);
        apart_squared += apart * apart;
    }
    // NaN touches.
    !matches!(
        apart_squared.partial_cmp(&1.0),
        Some(std::cmp::Ordering::Greater)
    )
}

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn a_record_is_all_that_the_box_test_needs(
        shape in generators::ellipsoid(),
        light in any::<u32>(),
        corner in [-1.0..0.8_f32, -0.6..0.5_f32],
        size in [0.0..0.3_f32, 0.0..0.3_f32],
        depth in 0.1..60.0_f32,
        thickness in 1.0..3.0_f32,
    ) {
        let stretch = shape.project(&camera()).unwrap();
        let record = GpuEllipsoid::new(&stretch, light);
        let bytes = bytemuck::bytes_of(&record);
        prop_assert_eq!(word(bytes, 28), light.to_ne_bytes());
        prop_assert_eq!(word(bytes, 44), [0; 4]);
        let corner = Vec2::from(corner);
        let rectangle = TileRectangle::new(corner, corner + Vec2::from(size)).unwrap();
        let depths = DepthInterval::new(depth, depth * thickness).unwrap();
        prop_assert!(touches(bytes, &rectangle, &depths) || !stretch.touches(&rectangle, &depths));
    }

    #[test]
    fn a_sphere_is_four_numbers(x in -9.0..9.0_f32, y in -9.0..9.0_f32, radius in 0.1..30.0_f32) {
        let sphere = Sphere::new(Vec3::new(x, y, -8.0), radius).unwrap();
        let sphere = sphere.project(&camera()).unwrap();
        let record = GpuSphere::from(&sphere);
        let [x, y, z] = sphere.center().to_array();
        let numbers: [f32; 4] = bytemuck::cast(record);
        prop_assert_eq!(numbers, [x, y, z, sphere.radius_squared()]);
    }
}
