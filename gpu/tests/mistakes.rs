//! What is wrong is an error before anything runs, and what is empty is black.

use gpu::{Caller, Error, Frame, Gpu, Method};
use stochastic_light_culling::{
    Camera, ConstantLobe, GpuBuffer, GpuFrame, GpuLight, Interleave, Roulette, Vpl, glam::Vec3,
};

/// A wall, and constant lights in front of it.
const WALL: &str = "
    struct SlcSurface { point: vec3f }
    @group(0) @binding(16) var<storage, read_write> picture: array<f32>;
    fn slc_surface(pixel: vec2u) -> SlcSurface {
        let place = (vec2f(pixel) + 0.5) / vec2f(slc_this.image_size) - 0.5;
        return SlcSurface(vec3f(place, -4.0));
    }
    fn slc_depth(surface: SlcSurface) -> f32 { return slc_depth_of_point(slc_this.camera, surface.point); }
    fn slc_reflected(surface: SlcSurface, light: SlcLight, index: u32, xi: f32) -> vec4f {
        let way = slc_way(slc_this, light, surface.point);
        return vec4f(slc_estimate(light.flux * SLC_CONSTANT, way.distance_squared, slc_this.delta, xi));
    }
    fn slc_store(pixel: vec2u, surface: SlcSurface, sum: vec4f) {
        picture[pixel.y * slc_this.image_size.x + pixel.x] = 1.0 + sum.x;
    }";
const BOUND: &str =
    "fn slc_unit_bound(light: SlcLight) -> SlcBound { return slc_paper_constant(); }";

const SIZE: [u32; 2] = [20, 13];

fn record(lights: u32) -> (GpuFrame, Camera, Interleave) {
    let camera = Camera::look_at(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, 1.0, 1.5, 0.1..100.0).unwrap();
    let interleave = Interleave::new(SIZE, 2).unwrap();
    let roulette = Roulette::new(1e-6).unwrap();
    let frame = GpuFrame::new(&camera, &interleave, &roulette, lights).unwrap();
    (frame, camera, interleave)
}

fn lights(count: u32) -> Vec<GpuLight> {
    let light = Vpl::new(Vec3::new(0.0, 0.0, -3.0), 1.0, ConstantLobe).unwrap();
    vec![GpuLight::from(&light); count as usize]
}

/// One more than the radiance at each pixel.
fn picture(gpu: &Gpu, count: u32, method: Method) -> Vec<f32> {
    let (record, camera, interleave) = record(count);
    let frame = Frame::new(gpu, record, &lights(count), (&camera, &interleave)).unwrap();
    let picture = gpu.zeroed::<f32>((SIZE[0] * SIZE[1]) as usize).unwrap();
    let shading = Caller {
        texts: &[WALL],
        buffers: &[(16, &picture)],
        of_surface: 0,
    };
    let bounds = Caller {
        texts: &[BOUND],
        ..Caller::NONE
    };
    frame
        .run(&frame.compile(method, [bounds, shading]).unwrap())
        .unwrap();
    gpu.read(&picture).unwrap()
}

#[test]
fn no_light_is_black_and_every_pixel_is_written() {
    let gpu = Gpu::new().unwrap();
    for method in [Method::Tiles, Method::Lists] {
        assert!(picture(&gpu, 0, method).iter().all(|value| *value == 1.0));
        // One light for one subregion of four.
        let lit = picture(&gpu, 1, method);
        let is_lit =
            |(i, value): (usize, &f32)| (*value > 1.0) == (i % 20 % 2 == 0 && i / 20 % 2 == 0);
        assert!(lit.iter().enumerate().all(is_lit));
        // A thousand for each, more than a shared list holds.
        assert!(picture(&gpu, 4000, method).iter().all(|value| *value > 1.0));
    }
}

#[test]
fn buffers_too_small_are_refused() {
    let gpu = Gpu::new().unwrap();
    let (record, camera, interleave) = record(100);
    let of = (&camera, &interleave);
    let refused = |result: Result<(), Error>| {
        let message = result.unwrap_err().to_string();
        assert!(message.starts_with("bytes in the buffer of"), "{message}");
    };
    refused(Frame::new(&gpu, record, &lights(99), of).map(drop));
    let mut frame = Frame::new(&gpu, record, &lights(100), of).unwrap();
    for buffer in [
        GpuBuffer::Edges,
        GpuBuffer::Intervals,
        GpuBuffer::Ranges,
        GpuBuffer::Lists,
    ] {
        let words = record.bytes(buffer) as usize / 4;
        refused(frame.replace(buffer, &vec![0_u32; words - 1]));
        frame.replace(buffer, &vec![0_u32; words]).unwrap();
    }
    let (more, ..) = self::record(101);
    refused(frame.set_record(&more));
}

#[test]
fn functions_that_are_missing_or_wrong_are_named() {
    let gpu = Gpu::new().unwrap();
    let (record, camera, interleave) = record(1);
    let frame = Frame::new(&gpu, record, &lights(1), (&camera, &interleave)).unwrap();
    let Err(Error::Invalid(message)) = frame.compile(Method::Tiles, [Caller::NONE; 2]) else {
        panic!("kernels compile without what they call");
    };
    assert!(message.contains("slc_unit_bound"), "{message}");
    // Without the buffer that the shading writes.
    let bounds = Caller {
        texts: &[BOUND],
        ..Caller::NONE
    };
    let unbound = Caller {
        texts: &[WALL],
        ..Caller::NONE
    };
    let compiled = frame.compile(Method::Tiles, [bounds, unbound]).unwrap();
    assert!(matches!(frame.run(&compiled), Err(Error::Invalid(_))));
}
