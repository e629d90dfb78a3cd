//! What the kernels of a frame are told: edges of tiles, sizes of buffers, and what is refused.
#![cfg(feature = "bytemuck")]

use stochastic_light_culling::{
    Camera, Direction, Ellipsoid, Error, Ggx, GgxLobe, GpuBound, GpuBuffer, GpuCamera, GpuFrame,
    GpuKernel, GpuLight, GpuTile, Incidence, Interleave, LambertLobe, NoFresnel, Roulette, Schlick,
    Seed, TileGrid, Vpl,
    glam::{Mat3, Vec3},
};

const SIZES: [([u32; 2], u32); 5] = [
    ([1920, 1080], 8),
    ([37, 53], 3),
    ([16, 16], 1),
    ([1, 1], 1),
    ([257, 19], 16),
];

fn camera() -> Camera {
    let (eye, target) = (Vec3::new(3.0, 2.0, 5.0), Vec3::new(0.0, 0.5, -1.0));
    Camera::look_at(eye, target, Vec3::Y, 1.2, 1.5, 0.1..100.0).unwrap()
}

fn frame(size: [u32; 2], width: u32, lights: u32) -> Result<(GpuFrame, Interleave), Error> {
    let interleave = Interleave::new(size, width)?;
    let roulette = Roulette::new(0.01)?;
    Ok((
        GpuFrame::new(&camera(), &interleave, &roulette, lights)?,
        interleave,
    ))
}

/// As a kernel looks them up.
#[test]
fn edges_are_those_of_the_tiles_bit_for_bit() {
    let camera = camera().jittered([37, 53], [0.25, -0.5]).unwrap();
    for (size, width) in SIZES {
        let (frame, interleave) = frame(size, width, 5).unwrap();
        let edges: Vec<_> = frame.edges(&camera, &interleave).collect();
        let [columns, rows] = frame.tiles;
        assert_eq!(8 * edges.len() as u64, frame.bytes(GpuBuffer::Edges));
        for subregion in 0..interleave.subregions() {
            let grid = TileGrid::new(interleave.subregion_size(subregion), 16).unwrap();
            for [x, y] in grid.tiles() {
                let tile = camera.interleaved_tile(&interleave, subregion, &grid, [x, y]);
                let across = edges[(subregion % width * columns + x) as usize];
                let down = (width * columns + subregion / width * rows + y) as usize;
                let found = GpuTile {
                    min: [across[0], edges[down][0]],
                    max: [across[1], edges[down][1]],
                };
                assert_eq!(found, GpuTile::from(&tile));
            }
        }
    }
}

#[test]
fn every_pixel_and_light_has_its_thread() {
    for (size, width) in SIZES {
        for lights in [0, 1, 64, 65, 70_000] {
            let (frame, interleave) = frame(size, width, lights).unwrap();
            let [columns, rows, subregions] = frame.workgroups(GpuKernel::Tiles);
            assert_eq!(subregions, interleave.subregions());
            for subregion in 0..subregions {
                let [x, y] = interleave.subregion_size(subregion);
                assert!(x <= 16 * columns && y <= 16 * rows);
            }
            assert!(64 * frame.workgroups(GpuKernel::Bounds)[0] >= lights);
            assert_eq!(frame.lists(), u64::from(2 * columns * rows * subregions));
        }
    }
}

#[test]
fn a_buffer_too_small_is_refused_by_name() {
    let (frame, _) = frame([640, 360], 4, 1000).unwrap();
    for buffer in GpuBuffer::ALL {
        let bytes = frame.bytes(buffer);
        assert_eq!(frame.check(buffer, bytes), Ok(()));
        let refused = frame.check(buffer, bytes - 1).unwrap_err().to_string();
        assert!(refused.starts_with("bytes in the buffer of"), "{refused}");
        assert!(refused.contains(&(bytes - 1).to_string()), "{refused}");
    }
    let bindings = GpuBuffer::ALL.map(GpuBuffer::binding);
    assert_eq!(bindings, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    // What no light needs is bound all the same.
    let (none, _) = self::frame([640, 360], 4, 0).unwrap();
    assert_eq!(none.bytes(GpuBuffer::Lights), 64);
    let listless = none.with_lists(1, 0).unwrap();
    assert_eq!(listless.bytes(GpuBuffer::Lists), 4);
}

#[test]
fn what_a_gpu_does_not_run_is_refused() {
    assert!(matches!(
        frame([640, 360], 4, 4_194_241),
        Err(Error::Count { .. })
    ));
    assert!(frame([640, 360], 4, 4_194_240).is_ok());
    assert!(matches!(frame([999, 999], 256, 1), Err(Error::Size { .. })));
    assert!(frame([999, 999], 255, 1).is_ok());
    for size in [[u32::MAX, 1], [1_048_561, 1], [1_048_560, 1_048_560]] {
        assert!(matches!(frame(size, 1, 1), Err(Error::Size { .. })));
    }
    assert!(frame([1_048_560, 1], 1, 1).is_ok());
    let (frame, _) = frame([640, 360], 4, 1000).unwrap();
    for intervals in [0, 33] {
        assert!(matches!(
            frame.with_lists(intervals, 9),
            Err(Error::Count { .. })
        ));
    }
    for squared in [0.0, f32::NAN, f32::INFINITY, 1e-21, -1.0] {
        assert!(frame.with_least_distance_squared(squared).is_err());
    }
}

#[test]
fn records_hold_what_the_crate_computes() {
    let lobe = LambertLobe::new(0.7, Direction::Y).unwrap();
    let light = GpuLight::from(&Vpl::new(Vec3::X, 2.0, lobe).unwrap());
    assert_eq!(
        (light.position, light.flux, light.normal),
        ([1.0, 0.0, 0.0], 2.0, [0.0, 1.0, 0.0])
    );
    assert_eq!((light.fresnel, light.roughness), ([0.7, 0.0], 0.0));

    let incidence = Incidence {
        normal: Direction::Y,
        incoming: Direction::new(Vec3::new(0.6, 0.8, 0.0)).unwrap(),
    };
    let ggx = Ggx::new(0.3).unwrap();
    let schlick = GgxLobe::new(ggx, Schlick::new(0.04).unwrap(), incidence);
    let light = GpuLight::from(&Vpl::new(Vec3::X, 2.0, schlick).unwrap());
    assert_eq!(
        (light.cosine, light.roughness),
        (schlick.incident_cosine(), 0.3)
    );
    assert_eq!(light.fresnel, [0.04, 0.0]);
    assert!(light.majorant[0] >= 0.04 && light.majorant[1] >= 0.96);
    let bare = GgxLobe::new(ggx, NoFresnel, incidence);
    let light = GpuLight::from(&Vpl::new(Vec3::X, 2.0, bare).unwrap());
    assert_eq!(light.majorant, [1.0, 0.0]);

    // The image of a point, by the numbers of the record.
    let camera = camera();
    let record = GpuCamera::from(&camera);
    let point = Vec3::new(0.3, 1.7, -4.0);
    let from_anchor = point - Vec3::from(record.anchor);
    let rows = [record.right, record.up, record.forward].map(Vec3::from);
    let image = Vec3::from(rows.map(|row| row.dot(from_anchor))) + Vec3::from(record.image);
    assert!((image - camera.to_camera_space(point)).length() < 1e-5);
    let depth = record.depth_numerator / (0.5 + record.depth_offset);
    assert_eq!(depth, camera.depth(0.5));

    let everything = Ellipsoid::new(Vec3::ZERO, Mat3::IDENTITY, Vec3::splat(f32::MAX)).unwrap();
    assert_eq!(GpuBound::from(&everything).semi_axes, [1e30; 3]);
    let (frame, _) = frame([8, 8], 1, 1).unwrap();
    let seeded = frame.seeded(Seed(3), 4);
    assert_eq!((seeded.seed, seeded.frame, seeded.delta), (3, 4, 0.01));
}
