use std::time::Duration;

use bytemuck::Pod;
use stochastic_light_culling::{
    Camera, GpuBuffer, GpuFrame, GpuKernel, GpuLight, Interleave, wgsl,
};
use wgpu::Buffer;

use crate::{Dispatch, Error, Gpu, Kernel};

/// The buffers of a frame, and the kernels of the crate over them.
pub struct Frame<'a> {
    gpu: &'a Gpu,
    record: GpuFrame,
    /// In the order of `GpuBuffer`.
    buffers: Vec<Buffer>,
}

/// A kernel, and the time that it took, where the adapter has timestamps.
pub type Time = (&'static str, Option<Duration>);

/// The text of a kernel.
fn text(kernel: GpuKernel) -> &'static str {
    match kernel {
        GpuKernel::Bounds => wgsl::BOUNDS_KERNEL,
        GpuKernel::Tiles => wgsl::TILE_KERNEL,
        GpuKernel::Depths => wgsl::DEPTHS_KERNEL,
        GpuKernel::Lists => wgsl::LISTS_KERNEL,
        GpuKernel::Shade => wgsl::SHADE_KERNEL,
    }
}

impl<'a> Frame<'a> {
    /// Makes the buffers of a frame of `lights`, as the record has many.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] if there are fewer. [`Error::Invalid`] if the device has no room.
    pub fn new(
        gpu: &'a Gpu,
        record: GpuFrame,
        lights: &[GpuLight],
        (camera, interleave): (&Camera, &Interleave),
    ) -> Result<Self, Error> {
        let edges: Vec<[f32; 2]> = record.edges(camera, interleave).collect();
        let buffer = |buffer| match buffer {
            GpuBuffer::Frame => gpu.upload(&[record]),
            GpuBuffer::Lights => gpu.upload(lights),
            GpuBuffer::Edges => gpu.upload(&edges),
            _ => gpu.zeroed::<u32>(record.bytes(buffer) as usize / 4),
        };
        let buffers = GpuBuffer::ALL
            .map(buffer)
            .into_iter()
            .collect::<Result<_, _>>()?;
        let frame = Self {
            gpu,
            record,
            buffers,
        };
        frame.check(&frame.record)?;
        Ok(frame)
    }

    /// One of the buffers.
    #[must_use]
    pub fn buffer(&self, buffer: GpuBuffer) -> &Buffer {
        &self.buffers[buffer.binding() as usize]
    }

    /// Puts `records` in the place of a buffer.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] if there are too few.
    pub fn replace<T: Pod>(&mut self, buffer: GpuBuffer, records: &[T]) -> Result<(), Error> {
        self.buffers[buffer.binding() as usize] = self.gpu.upload(records)?;
        self.check(&self.record)
    }

    /// Writes another record, such as that of the next frame.
    ///
    /// # Errors
    ///
    /// [`Error::Refused`] if the buffers are too small for it.
    pub fn set_record(&self, record: &GpuFrame) -> Result<(), Error> {
        self.check(record)?;
        self.gpu
            .queue
            .write_buffer(self.buffer(GpuBuffer::Frame), 0, bytemuck::bytes_of(record));
        Ok(())
    }

    fn check(&self, record: &GpuFrame) -> Result<(), Error> {
        for buffer in GpuBuffer::ALL {
            record.check(buffer, self.buffer(buffer).size())?;
        }
        Ok(())
    }

    /// Compiles passes, with what `caller` adds to bounds and to shading.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`] if what the caller adds does not compile.
    pub fn compile<'c>(
        &self,
        method: Method,
        [bounds, shading]: [Caller<'c>; 2],
    ) -> Result<Compiled<'c>, Error> {
        let depths = Caller {
            buffers: &shading.buffers[..shading.of_surface],
            ..shading
        };
        let passes = match method {
            Method::Tiles => vec![(GpuKernel::Bounds, bounds), (GpuKernel::Tiles, shading)],
            Method::Lists => vec![
                (GpuKernel::Bounds, bounds),
                (GpuKernel::Depths, depths),
                (GpuKernel::Lists, Caller::NONE),
                (GpuKernel::Shade, shading),
            ],
            Method::ListsAlone => vec![(GpuKernel::Lists, Caller::NONE)],
        };
        let compiled = |(kernel, caller): (GpuKernel, Caller<'c>)| {
            let texts = [wgsl::FUNCTIONS, wgsl::KERNEL, text(kernel)];
            let texts = [&texts, caller.texts].concat();
            let compiled = self.gpu.kernel(&texts, kernel.entry_point())?;
            Ok((kernel, caller, compiled))
        };
        passes
            .into_iter()
            .map(compiled)
            .collect::<Result<_, _>>()
            .map(Compiled)
    }

    /// Runs passes one after the other.
    ///
    /// # Errors
    ///
    /// Those of [`Gpu::run`].
    pub fn run(&self, Compiled(passes): &Compiled) -> Result<Vec<Time>, Error> {
        self.gpu
            .queue
            .write_buffer(self.buffer(GpuBuffer::Needed), 0, &[0; 4]);
        let mut bound = Vec::new();
        for (kernel, caller, _) in passes {
            let of_kernel = kernel.buffers().iter();
            let of_kernel = of_kernel.map(|buffer| (buffer.binding(), self.buffer(*buffer)));
            bound.push(
                of_kernel
                    .chain(caller.buffers.iter().copied())
                    .collect::<Vec<_>>(),
            );
        }
        let mut dispatches = Vec::new();
        for ((kernel, _, compiled), buffers) in passes.iter().zip(&bound) {
            dispatches.push(Dispatch {
                kernel: compiled,
                buffers,
                workgroups: self.record.workgroups(*kernel),
            });
        }
        let times = self.gpu.run(&dispatches)?;
        Ok(passes
            .iter()
            .map(|(kernel, ..)| kernel.entry_point())
            .zip(times)
            .collect())
    }
}

/// How a frame is culled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Bounds, then depths, lists and shading of each tile in one pass.
    Tiles,
    /// Bounds, depths, lists in memory, and shading by these.
    Lists,
    /// Lists in memory, of what the buffers hold.
    ListsAlone,
}

/// Compiled passes.
pub struct Compiled<'a>(Vec<(GpuKernel, Caller<'a>, Kernel)>);

/// What a caller adds to a kernel.
#[derive(Clone, Copy)]
pub struct Caller<'a> {
    /// The functions that the kernel asks for.
    pub texts: &'a [&'a str],
    /// What is bound besides the buffers of the kernel, from binding 16 on.
    pub buffers: &'a [(u32, &'a Buffer)],
    /// How many of these `slc_surface` and `slc_depth` use; they come first.
    pub of_surface: usize,
}

impl Caller<'_> {
    /// For a kernel that asks for nothing.
    pub const NONE: Self = Self {
        texts: &[],
        buffers: &[],
        of_surface: 0,
    };
}
