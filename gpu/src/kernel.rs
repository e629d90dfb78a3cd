use std::time::Duration;

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, ComputePassDescriptor,
    ComputePassTimestampWrites, ComputePipeline, ComputePipelineDescriptor, PollType, QuerySet,
    QuerySetDescriptor, QueryType, ShaderModuleDescriptor, ShaderSource,
};

use crate::{Error, Gpu};

/// A compiled entry point.
pub struct Kernel {
    entry: String,
    pipeline: ComputePipeline,
}

/// A kernel with what is bound to its group 0, and how often it runs.
pub struct Dispatch<'a> {
    /// The entry point.
    pub kernel: &'a Kernel,
    /// Each `@binding` of group 0 that the entry point uses, no others, with its buffer.
    pub buffers: &'a [(u32, &'a Buffer)],
    /// The number of workgroups along each axis.
    pub workgroups: [u32; 3],
}

impl Gpu {
    /// Compiles the compute entry point `entry` of the module that `sources` make when they are joined.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`], with the place in the text, if it does not compile.
    pub fn kernel(&self, sources: &[&str], entry: &str) -> Result<Kernel, Error> {
        let module = ShaderModuleDescriptor {
            label: Some(entry),
            source: ShaderSource::Wgsl(sources.join("\n").into()),
        };
        let module = self.checked(|| self.device.create_shader_module(module))?;
        let descriptor = ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        };
        let pipeline = self.checked(|| self.device.create_compute_pipeline(&descriptor))?;
        let entry = entry.to_owned();
        Ok(Kernel { entry, pipeline })
    }

    /// Runs `dispatches` one after the other, each of which sees what those before it wrote, and waits for them.
    ///
    /// Returns the time that each took, where the adapter has timestamps.
    ///
    /// # Errors
    ///
    /// [`Error::Invalid`], before anything runs, if what is bound is not what an entry point declares or there are more
    /// workgroups than the device takes. [`Error::Device`] if it is lost.
    pub fn run(&self, dispatches: &[Dispatch]) -> Result<Vec<Option<Duration>>, Error> {
        let queries = self.nanoseconds_per_tick.map(|_| {
            self.device.create_query_set(&QuerySetDescriptor {
                label: None,
                ty: QueryType::Timestamp,
                count: 2 * dispatches.len() as u32,
            })
        });
        let ticks = self.zeroed::<[u64; 2]>(dispatches.len())?;
        let resolved = self.checked(|| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size: ticks.size(),
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        })?;
        let commands = self.checked(|| {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            for (place, dispatch) in dispatches.iter().enumerate() {
                self.encode(
                    &mut encoder,
                    dispatch,
                    queries.as_ref().map(|set| (set, 2 * place as u32)),
                );
            }
            if let Some(queries) = &queries {
                encoder.resolve_query_set(queries, 0..2 * dispatches.len() as u32, &resolved, 0);
                encoder.copy_buffer_to_buffer(&resolved, 0, &ticks, 0, ticks.size());
            }
            encoder.finish()
        })?;
        self.checked(|| self.queue.submit([commands]))?;
        let lost = |error: wgpu::PollError| Error::Device(error.to_string());
        self.device
            .poll(PollType::wait_indefinitely())
            .map_err(lost)?;
        let Some(period) = self.nanoseconds_per_tick else {
            return Ok(vec![None; dispatches.len()]);
        };
        let time = |[start, end]: [u64; 2]| {
            let nanoseconds = end.saturating_sub(start) as f64 * f64::from(period);
            Some(Duration::from_nanos(nanoseconds as u64))
        };
        Ok(self.read(&ticks)?.into_iter().map(time).collect())
    }

    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        dispatch: &Dispatch,
        queries: Option<(&QuerySet, u32)>,
    ) {
        let Dispatch {
            kernel,
            workgroups: [x, y, z],
            ..
        } = *dispatch;
        let group = self.bind(kernel, dispatch.buffers);
        let timestamp_writes = queries.map(|(query_set, first)| ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        });
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some(&kernel.entry),
            timestamp_writes,
        });
        pass.set_pipeline(&kernel.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(x, y, z);
    }

    fn bind(&self, kernel: &Kernel, buffers: &[(u32, &Buffer)]) -> BindGroup {
        let entries: Vec<_> = buffers
            .iter()
            .map(|(binding, buffer)| BindGroupEntry {
                binding: *binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        self.device.create_bind_group(&BindGroupDescriptor {
            label: Some(&kernel.entry),
            layout: &kernel.pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }
}
