use std::time::Duration;

use bytemuck::Pod;
use stochastic_light_culling::GpuBuffer::{
    self, Edges, Frame as Record, Intervals, Lights, Lists, Needed, Projected, Ranges, Xis,
};
use stochastic_light_culling::{Camera, GpuFrame, GpuLight, Interleave, wgsl};
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

/// A text of a kernel, its entry point, and the buffers that it uses.
type Pass = (&'static str, &'static str, &'static [GpuBuffer]);

const BOUNDS: Pass = (
    wgsl::BOUNDS_KERNEL,
    "slc_bound_lights",
    &[Record, Lights, Projected, Xis],
);
const TILES: Pass = (
    wgsl::TILE_KERNEL,
    "slc_cull_and_shade",
    &[Record, Lights, Projected, Xis, Edges],
);
const DEPTHS: Pass = (wgsl::DEPTHS_KERNEL, "slc_part_depths", &[Record, Intervals]);
const LISTS: Pass = (
    wgsl::LISTS_KERNEL,
    "slc_list_lights",
    &[Record, Projected, Edges, Intervals, Ranges, Lists, Needed],
);
const SHADE: Pass = (
    wgsl::SHADE_KERNEL,
    "slc_shade",
    &[Record, Lights, Xis, Intervals, Ranges, Lists],
);

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
            Record => gpu.upload(&[record]),
            Lights => gpu.upload(lights),
            Edges => gpu.upload(&edges),
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
            .write_buffer(self.buffer(Record), 0, bytemuck::bytes_of(record));
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
            own: &shading.own[..shading.of_surface],
            ..shading
        };
        let passes = match method {
            Method::Tiles => vec![(BOUNDS, bounds), (TILES, shading)],
            Method::Lists => vec![
                (BOUNDS, bounds),
                (DEPTHS, depths),
                (LISTS, Caller::NONE),
                (SHADE, shading),
            ],
            Method::ListsAlone => vec![(LISTS, Caller::NONE)],
        };
        let compiled = |(pass, caller): (Pass, Caller<'c>)| {
            let texts = [wgsl::FUNCTIONS, wgsl::KERNEL, pass.0];
            let kernel = self.gpu.kernel(&[&texts, caller.texts].concat(), pass.1)?;
            Ok((pass, caller, kernel))
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
        self.gpu.queue.write_buffer(self.buffer(Needed), 0, &[0; 4]);
        let bound = |(pass, ..): &(Pass, Caller, Kernel)| -> Vec<(u32, &Buffer)> {
            let buffers = pass.2.iter();
            buffers
                .map(|buffer| (buffer.binding(), self.buffer(*buffer)))
                .collect()
        };
        let bound: Vec<_> = passes.iter().map(bound).collect();
        let mut dispatches = Vec::new();
        for ((pass, caller, kernel), buffers) in passes.iter().zip(&bound) {
            dispatches.push(Dispatch {
                kernel,
                buffers,
                own: caller.own,
                workgroups: if *pass == BOUNDS {
                    self.record.workgroups_of_bounds()
                } else {
                    self.record.workgroups()
                },
            });
        }
        let times = self.gpu.run(&dispatches)?;
        Ok(passes.iter().map(|(pass, ..)| pass.1).zip(times).collect())
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
pub struct Compiled<'a>(Vec<(Pass, Caller<'a>, Kernel)>);

/// What a caller adds to a kernel.
#[derive(Clone, Copy)]
pub struct Caller<'a> {
    /// The functions that the kernel asks for.
    pub texts: &'a [&'a str],
    /// What is bound to group 1.
    pub own: &'a [(u32, &'a Buffer)],
    /// How many of these `slc_surface` and `slc_depth` use; they come first.
    pub of_surface: usize,
}

impl Caller<'_> {
    /// For a kernel that asks for nothing.
    pub const NONE: Self = Self {
        texts: &[],
        own: &[],
        of_surface: 0,
    };
}
