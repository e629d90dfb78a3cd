//! The kernels are valid, take the records of the crate, and ask for no more than any adapter of WebGPU has.

use std::mem::size_of;

use naga::proc::Layouter;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, Module, ShaderStage};
use stochastic_light_culling::wgsl::{
    BOUNDS_KERNEL, DEPTHS_KERNEL, FUNCTIONS, KERNEL, LISTS_KERNEL, SHADE_KERNEL, TILE_KERNEL,
};
use stochastic_light_culling::{
    GpuBound, GpuCamera, GpuFrame, GpuKernel, GpuLight, GpuProjected, GpuTile,
};

use crate::valid::module;

/// What a caller defines.
const CALLER: &str = "
    struct SlcSurface { depth: f32 }
    fn slc_surface(pixel: vec2u) -> SlcSurface { return SlcSurface(f32(pixel.x)); }
    fn slc_depth(surface: SlcSurface) -> f32 { return surface.depth; }
    fn slc_reflected(surface: SlcSurface, light: SlcLight, index: u32, xi: f32) -> vec4f { return vec4f(xi); }
    fn slc_store(pixel: vec2u, surface: SlcSurface, sum: vec4f) {}
    fn slc_unit_bound(light: SlcLight) -> SlcBound { return slc_paper_constant(); }";

const KERNELS: [GpuKernel; 5] = [
    GpuKernel::Bounds,
    GpuKernel::Tiles,
    GpuKernel::Depths,
    GpuKernel::Lists,
    GpuKernel::Shade,
];

fn all() -> Module {
    let kernels = [
        BOUNDS_KERNEL,
        TILE_KERNEL,
        DEPTHS_KERNEL,
        LISTS_KERNEL,
        SHADE_KERNEL,
    ];
    module(&[&[FUNCTIONS, KERNEL, CALLER], &kernels[..]].concat())
}

#[test]
fn each_kernel_is_valid_by_itself() {
    module(&[FUNCTIONS]);
    for kernel in [
        BOUNDS_KERNEL,
        TILE_KERNEL,
        DEPTHS_KERNEL,
        LISTS_KERNEL,
        SHADE_KERNEL,
    ] {
        module(&[FUNCTIONS, KERNEL, CALLER, kernel]);
    }
    let entries = all()
        .entry_points
        .iter()
        .map(|entry| entry.name.clone())
        .collect::<Vec<_>>();
    assert_eq!(entries, KERNELS.map(GpuKernel::entry_point));
}

#[test]
fn records_have_the_sizes_of_structures() {
    let module = all();
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).expect("sized types");
    for (name, size) in [
        ("SlcLight", size_of::<GpuLight>()),
        ("SlcBound", size_of::<GpuBound>()),
        ("SlcProjected", size_of::<GpuProjected>()),
        ("SlcCamera", size_of::<GpuCamera>()),
        ("SlcTile", size_of::<GpuTile>()),
        ("SlcFrame", size_of::<GpuFrame>()),
    ] {
        let (handle, _) = (module.types.iter())
            .find(|(_, kind)| kind.name.as_deref() == Some(name))
            .expect("a structure");
        assert_eq!(layouter[handle].to_stride() as usize, size, "{name}");
    }
}

/// The limits that every adapter of WebGPU has: eight storage buffers, of which the caller's shading needs some, 256
/// threads, and 16 KiB of shared memory.
#[test]
fn kernels_run_anywhere() {
    let module = all();
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).expect("valid");
    let mut layouter = Layouter::default();
    layouter.update(module.to_ctx()).expect("sized types");
    for (i, entry) in module.entry_points.iter().enumerate() {
        assert_eq!(entry.stage, ShaderStage::Compute);
        assert!(entry.workgroup_size.iter().product::<u32>() <= 256);
        let (mut buffers, mut shared, mut bindings) = (0, 0, Vec::new());
        for (handle, variable) in module.global_variables.iter() {
            if info.get_entry_point(i)[handle].is_empty() {
                continue;
            }
            match variable.space {
                AddressSpace::Storage { .. } => buffers += 1,
                AddressSpace::WorkGroup => shared += layouter[variable.ty].to_stride(),
                _ => {}
            }
            if let Some(binding) = &variable.binding {
                assert_eq!(binding.group, 0);
                bindings.push(binding.binding);
            }
        }
        bindings.sort_unstable();
        let kernel = KERNELS[i];
        let known = kernel.buffers().iter().map(|buffer| buffer.binding());
        assert!(
            bindings.iter().copied().eq(known),
            "{kernel:?}: {bindings:?}"
        );
        let most = if kernel == GpuKernel::Lists { 6 } else { 5 };
        assert!(buffers <= most, "{kernel:?} has {buffers} storage buffers");
        assert!(shared <= 16384, "{kernel:?} shares {shared} bytes");
    }
}
