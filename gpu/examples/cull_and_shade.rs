//! Culls and shades on a GPU by wgpu and the crate alone: 8192 lights on a gold wall light the floor before it.
//! Run it with `cargo run --release --manifest-path gpu/Cargo.toml --example cull_and_shade`.

use std::error::Error;

use bytemuck::{bytes_of, cast_slice};
use pollster::block_on;
use stochastic_light_culling::{
    Camera, Direction, Ggx, GgxLobe, GpuBuffer, GpuFrame, GpuKernel, GpuLight, Incidence,
    Interleave, Roulette, Schlick, Seed, Vpl, glam::Vec3, wgsl,
};
use wgpu::{util::DownloadBuffer, *};

/// What the kernels ask for: bounds, what a pixel sees, and what that reflects.
const SHADER: &str = "
@group(0) @binding(16) var<storage, read_write> picture: array<f32>;
fn slc_unit_bound(light: SlcLight) -> SlcBound { return slc_paper_ggx(light, slc_max_schlick(light)); }
struct SlcSurface { point: vec3f }
fn slc_surface(pixel: vec2u) -> SlcSurface {
    let place = 8.0 * (vec2f(pixel) + 0.5) / vec2f(slc_this.image_size);
    return SlcSurface(vec3f(place.x - 4.0, 0.0, place.y));
}
fn slc_depth(surface: SlcSurface) -> f32 { return slc_depth_of_point(slc_this.camera, surface.point); }
fn slc_reflected(surface: SlcSurface, light: SlcLight, index: u32, xi: f32) -> vec4f {
    let way = slc_way(slc_this, light, surface.point);
    let intensity = light.flux * slc_ggx_schlick(light, way.direction);
    let arriving = slc_estimate(intensity, way.distance_squared, slc_this.delta, xi);
    return vec4f(arriving * max(-way.direction.y, 0.0) / 3.1415927);
}
fn slc_store(pixel: vec2u, surface: SlcSurface, sum: vec4f) { picture[pixel.y * 320u + pixel.x] = sum.x; }";

fn entry(binding: u32, buffer: &Buffer) -> BindGroupEntry<'_> {
    let resource = buffer.as_entire_binding();
    BindGroupEntry { binding, resource }
}

fn main() -> Result<(), Box<dyn Error>> {
    // The camera looks straight down, so that its pixels are the points of `slc_surface`.
    let (eye, fov) = (Vec3::new(0.0, 10.0, 4.0), 2.0 * 0.4_f32.atan());
    let camera = Camera::look_at(eye, eye - Vec3::Y, Vec3::NEG_Z, fov, 1.0, 0.1..100.0)?;
    let (normal, to_lamp) = (Direction::Z, Vec3::new(2.0, 6.0, 3.0) / 7.0);
    let incoming = Direction::new(to_lamp)?;
    let (ggx, fresnel) = (Ggx::new(0.2)?, Schlick::new(0.9)?);
    let gold = GgxLobe::new(ggx, fresnel, Incidence { normal, incoming });
    let place = |i: u32| Vec3::new((i % 128) as f32 - 64.0, (i / 128) as f32 + 8.0, 0.0) / 16.0;
    let light = |i: u32| Vpl::new(place(i), 0.01, gold);
    let lights = (0..8192).map(light).collect::<Result<Vec<_>, _>>()?;

    // What the crate tells a GPU.
    let (interleave, roulette) = (Interleave::new([320, 320], 4)?, Roulette::new(1e-3)?);
    let frame = GpuFrame::new(&camera, &interleave, &roulette, 8192)?.seeded(Seed(1), 0);
    let records: Vec<GpuLight> = lights.iter().map(GpuLight::from).collect();
    let edges: Vec<[f32; 2]> = frame.edges(&camera, &interleave).collect();

    // The device, the buffers and the kernels.
    let adapter = block_on(Instance::default().request_adapter(&Default::default()))?;
    let (device, queue) = block_on(adapter.request_device(&Default::default()))?;
    let buffer = |size, usage| {
        device.create_buffer(&BufferDescriptor {
            label: None,
            size,
            usage,
            mapped_at_creation: false,
        })
    };
    let usages = BufferUsages::STORAGE | BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    let buffers = GpuBuffer::ALL.map(|kind| buffer(frame.bytes(kind), usages));
    let of = |kind: GpuBuffer| &buffers[kind.binding() as usize];
    queue.write_buffer(of(GpuBuffer::Frame), 0, bytes_of(&frame));
    queue.write_buffer(of(GpuBuffer::Lights), 0, cast_slice(&records));
    queue.write_buffer(of(GpuBuffer::Edges), 0, cast_slice(&edges));
    let picture = buffer(
        4 * 320 * 320,
        BufferUsages::STORAGE | BufferUsages::COPY_SRC,
    );
    let kernels = [wgsl::KERNEL, wgsl::BOUNDS_KERNEL, wgsl::TILE_KERNEL];
    let source = ShaderSource::Wgsl([wgsl::FUNCTIONS, &kernels.concat(), SHADER].concat().into());
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: None,
        source,
    });

    // A frame: two passes.
    let mut encoder = device.create_command_encoder(&Default::default());
    for kernel in [GpuKernel::Bounds, GpuKernel::Tiles] {
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: Some(kernel.entry_point()),
            compilation_options: Default::default(),
            cache: None,
        });
        let kinds = kernel.buffers().iter();
        let bound = kinds.map(|kind| entry(kind.binding(), of(*kind)));
        let own = (kernel == GpuKernel::Tiles).then(|| entry(16, &picture));
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &bound.chain(own).collect::<Vec<_>>(),
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        let [x, y, z] = frame.workgroups(kernel);
        pass.dispatch_workgroups(x, y, z);
    }
    queue.submit([encoder.finish()]);
    DownloadBuffer::read_buffer(&device, &queue, &picture.slice(..), |read| {
        let read = read.expect("the device is there");
        let radiance: &[f32] = cast_slice(&read);
        let mean = radiance.iter().sum::<f32>() / radiance.len() as f32;
        println!("mean radiance {mean:.6} W/(m² sr)");
    });
    device.poll(PollType::wait_indefinitely())?;
    Ok(())
}
